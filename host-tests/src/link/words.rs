//! The words of a command that is to be sent: what no instrument would take is refused before.

use std::fmt;

use protocol::command::{NoCommand, WORDS, parse, sentence};
use protocol::nmea::{LONGEST, Sentence, is_allowed};

/// A command that can be sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    words: Vec<String>,
    sentence: Sentence,
}

/// Why words are no command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoWords {
    /// There is no command of this name.
    Unknown(String),
    /// Something else, in words.
    Wrong(String),
}

impl fmt::Display for NoWords {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown(name) => write!(f, "there is no command {name}"),
            Self::Wrong(words) => f.write_str(words),
        }
    }
}

impl Words {
    /// The command of these words; a text may hold several of them, with blanks between.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn of<'w>(texts: impl IntoIterator<Item = &'w str>) -> Result<Self, NoWords> {
        let words = texts.into_iter().flat_map(str::split_whitespace);
        let words: Vec<_> = words.map(str::to_owned).collect();
        for word in &words {
            check(word).map_err(NoWords::Wrong)?;
        }
        let line = words.join(" ");
        match parse(&line) {
            Some(Ok(_)) => {}
            Some(Err(NoCommand::Unknown)) | None => {
                return Err(NoWords::Unknown(words.first().cloned().unwrap_or_default()));
            }
            Some(Err(NoCommand::Words)) => return Err(NoWords::Wrong(usage(&words[0]))),
            Some(Err(wrong)) => return Err(NoWords::Wrong(format!("{line}: {wrong}"))),
        }
        let too_long = || format!("{line}: as a sentence it is longer than {LONGEST} characters");
        let sentence = sentence(words.iter().map(String::as_str));
        Ok(Self { sentence: sentence.ok_or_else(too_long).map_err(NoWords::Wrong)?, words })
    }

    /// The words.
    #[must_use]
    pub fn words(&self) -> Vec<&str> {
        self.words.iter().map(String::as_str).collect()
    }

    /// The command in one line.
    #[must_use]
    pub fn line(&self) -> String {
        self.words.join(" ")
    }

    /// The sentence that is sent.
    #[must_use]
    pub fn sentence(&self) -> &str {
        &self.sentence
    }
}

/// Refuses a word with a character that a sentence may not have.
///
/// # Errors
/// The word and the character.
pub fn check(word: &str) -> Result<(), String> {
    match word.chars().find(|letter| !is_allowed(*letter)) {
        Some(letter) => Err(format!("{word}: a sentence may not have the character `{letter}`")),
        None => Ok(()),
    }
}

/// How many words a command takes.
fn usage(command: &str) -> String {
    let takes = match command {
        "azimuth" => "an azimuth and its 1σ, °, as in `azimuth 213.7 0.5`",
        "get" => "the name of one setting, or none for all",
        "set" => "the name of a setting and its value, as in `set latitude 47.58`",
        _ => "no further word",
    };
    format!("{command} takes {takes}")
}

/// The commands that there are.
#[must_use]
pub fn commands() -> &'static [&'static str] {
    &WORDS
}
