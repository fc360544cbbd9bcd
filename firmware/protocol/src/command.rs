//! Commands as lines of text; [`answer`](crate::answer) has what the instrument says to them.
//!
//! A person types a command as words, `set latitude 47.58`; a program sends it as a sentence with a checksum,
//! `$PMRDC,set,latitude,47.58*hh`. Both are answered by a sentence: `$PMRDR,set,latitude,47.58*hh`, or the reason why not in its
//! place.
//!
//! | command | what |
//! |---|---|
//! | `start` | begins an alignment |
//! | `stop` | ends the one that runs |
//! | `realign` | begins one anew |
//! | `azimuth 213.7 0.5` | states the azimuth of body x and its 1σ from outside, ° |
//! | `get`, `get latitude` | all settings, or one |
//! | `set latitude 47.58` | changes a setting |
//! | `save` | keeps the settings in flash |
//! | `restore` | takes those of the image again |
//! | `test` | which devices have passed their self-tests |
//! | `log` | the lines of the log that are kept in flash |
//! | `reboot` | starts the instrument anew |

use orientation::words;

use crate::nmea::{Sentence, Writer, checksum};

/// The address of a command as a sentence.
const COMMAND: &str = "PMRDC";

/// A command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command<'c> {
    /// Begins an alignment.
    Start,
    /// Ends the alignment that runs.
    Stop,
    /// Begins an alignment anew.
    Realign,
    /// States the azimuth of body x and its 1σ, °.
    Azimuth(f64, f64),
    /// Asks for the setting of this name, or for all.
    Get(Option<&'c str>),
    /// Gives the setting of this name a value.
    Set(&'c str, &'c str),
    /// Keeps the settings in flash.
    Save,
    /// Takes the settings of the image again.
    Restore,
    /// Asks which devices have passed their self-tests since the power-on.
    Test,
    /// Asks for the lines of the log that are kept in flash.
    Log,
    /// Starts the instrument anew.
    Reboot,
}

impl Command<'_> {
    /// Its first word, which an answer repeats.
    #[must_use]
    pub const fn word(&self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Stop => "stop",
            Self::Realign => "realign",
            Self::Azimuth(..) => "azimuth",
            Self::Get(_) => "get",
            Self::Set(..) => "set",
            Self::Save => "save",
            Self::Restore => "restore",
            Self::Test => "test",
            Self::Log => "log",
            Self::Reboot => "reboot",
        }
    }
}

/// Why a line is no command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoCommand {
    /// Its checksum is wrong or lacks.
    Checksum,
    /// There is no such command.
    Unknown,
    /// It has too few or too many words.
    Words,
    /// A word that is to be a number is none.
    Number,
}

words! { NoCommand:
    Self::Checksum => "checksum";
    Self::Unknown => "unknown command";
    Self::Words => "wrong number of words";
    Self::Number => "not a number";
}

/// The command of a line; [`None`] where it is a sentence for others.
///
/// # Errors
/// What is wrong with a line that is meant as a command.
#[must_use]
pub fn parse(line: &str) -> Option<Result<Command<'_>, NoCommand>> {
    let Some(sentence) = line.strip_prefix('$') else {
        return (!line.starts_with('!')).then(|| of_words(line));
    };
    let words = sentence.strip_prefix(COMMAND)?.strip_prefix(',')?;
    // The checksum has three characters.
    let words = content(sentence).and_then(|_| words.get(..words.len().checked_sub(3)?));
    Some(words.map_or(Err(NoCommand::Checksum), of_words))
}

/// `$PMRDC,set,latitude,47.58*hh`: a command of these words; [`None`] where it is too long for a sentence. That no word has a
/// character which a sentence may not have is the caller's to see ([`is_allowed`](crate::nmea::is_allowed)).
#[must_use]
pub fn sentence<'w>(words: impl IntoIterator<Item = &'w str>) -> Option<Sentence> {
    let mut writer = Writer::new(COMMAND);
    for word in words {
        writer.words(word);
    }
    writer.finish()
}

/// The content of a sentence without `$`, where its checksum is right.
#[must_use]
pub fn content(sentence: &str) -> Option<&str> {
    let (content, sum) = sentence.rsplit_once('*')?;
    let is_right = sum.len() == 2
        && sum.bytes().all(|digit| digit.is_ascii_hexdigit())
        && u8::from_str_radix(sum, 16) == Ok(checksum(content.as_bytes()));
    is_right.then_some(content)
}

/// The command of words that blanks or commas part.
fn of_words(line: &str) -> Result<Command<'_>, NoCommand> {
    let mut words = line.split([' ', ',']).filter(|word| !word.is_empty());
    let mut next = || words.next();
    let of = [next(), next(), next(), next()];
    let command = match of {
        [Some("start"), None, ..] => Command::Start,
        [Some("stop"), None, ..] => Command::Stop,
        [Some("realign"), None, ..] => Command::Realign,
        [Some("azimuth"), Some(angle), Some(sigma), None] => {
            Command::Azimuth(number(angle)?, number(sigma)?)
        }
        [Some("get"), name, None, _] => Command::Get(name),
        [Some("set"), Some(name), Some(value), None] => Command::Set(name, value),
        [Some("save"), None, ..] => Command::Save,
        [Some("restore"), None, ..] => Command::Restore,
        [Some("test"), None, ..] => Command::Test,
        [Some("log"), None, ..] => Command::Log,
        [Some("reboot"), None, ..] => Command::Reboot,
        [Some(word), ..] if WORDS.contains(&word) => return Err(NoCommand::Words),
        _ => return Err(NoCommand::Unknown),
    };
    Ok(command)
}

/// The first words of commands.
pub const WORDS: [&str; 11] = [
    "start", "stop", "realign", "azimuth", "get", "set", "save", "restore", "test", "log", "reboot",
];

/// Most digits of a number: what has as many, and as many of them behind its point, is exact until one division.
const DIGITS: usize = 15;

/// A decimal number, as `-12.5`; that which is nearest to it.
///
/// # Errors
/// [`NoCommand::Number`] for anything else, for an exponent, and for more than fifteen digits.
pub fn number(word: &str) -> Result<f64, NoCommand> {
    let (sign, digits) = word.strip_prefix('-').map_or((1.0, word), |digits| (-1.0, digits));
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let is_number = (1..=DIGITS).contains(&(whole.len() + part.len()))
        && whole.bytes().chain(part.bytes()).all(|digit| digit.is_ascii_digit());
    if !is_number {
        return Err(NoCommand::Number);
    }
    let count = whole
        .bytes()
        .chain(part.bytes())
        .fold(0_u64, |count, digit| 10 * count + u64::from(digit - b'0'));
    Ok(sign * (count as f64 / 10_u64.pow(part.len() as u32) as f64))
}
