//! Words for people in the letters that every receiver has, and in parts that a sentence or a message takes.

use core::fmt::{self, Display, Write};

use heapless::String;

/// Most characters of words: six sentences.
const LONGEST: usize = 6 * crate::nmea::WORDS;

/// Words in printable ASCII characters.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Words(String<LONGEST>);

impl Words {
    /// Words, of which signs become letters; what is too long is cut.
    #[must_use]
    pub fn new(words: impl Display) -> Self {
        let mut text = Self::default();
        // It never fails, as it cuts.
        let _ = write!(text, "{words}");
        text
    }

    /// Number of parts of so many characters at most, one at least, into which the words go.
    #[must_use]
    pub fn count(&self, of: usize) -> u8 {
        u8::try_from(self.0.len().div_ceil(of).max(1)).unwrap_or(u8::MAX)
    }

    /// The part of this number from zero, of so many characters at most; empty beyond the last.
    #[must_use]
    pub fn part(&self, of: usize, number: u8) -> &str {
        let begin = (of * usize::from(number)).min(self.0.len());
        self.0.get(begin..(begin + of).min(self.0.len())).unwrap_or_default()
    }
}

/// What a sign becomes that is not of ASCII.
const fn spelt(sign: char) -> &'static str {
    match sign {
        '°' => " deg",
        '±' => "+-",
        '√' => "sqrt",
        '²' => "2",
        'µ' => "u",
        'σ' => "sigma",
        '−' => "-",
        _ => " ",
    }
}

impl Write for Words {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        for letter in words.chars() {
            let _ = if matches!(letter, ' '..='~') {
                self.0.push(letter).is_ok()
            } else {
                self.0.push_str(spelt(letter)).is_ok()
            };
        }
        Ok(())
    }
}
