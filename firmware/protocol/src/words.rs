//! Words for people in the letters that every receiver has, and in parts that a sentence or a message takes.

use core::fmt::{self, Display, Write};

use heapless::String;

/// Most characters of words: six sentences. What is longer is cut.
const LONGEST: usize = 6 * crate::nmea::WORDS;

/// Words in printable ASCII characters, of which signs become letters. They are written anew for each part, and kept
/// nowhere.
#[derive(Clone, Copy)]
pub struct Words<'w>(pub &'w dyn Display);

impl Words<'_> {
    /// Number of parts of so many characters at most, one at least, into which the words go.
    #[must_use]
    pub fn count(self, of: usize) -> u8 {
        let length = self.written(|_, _| ()).min(LONGEST);
        u8::try_from(length.div_ceil(of).max(1)).unwrap_or(u8::MAX)
    }

    /// The part of this number from zero, of `OF` characters at most; empty beyond the last.
    #[must_use]
    pub fn part<const OF: usize>(self, number: u8) -> String<OF> {
        let begin = OF * usize::from(number);
        let end = (begin + OF).min(LONGEST);
        let mut part = String::new();
        self.written(|place, letter| {
            if (begin..end).contains(&place) {
                // There is room for it.
                let _ = part.push(letter);
            }
        });
        part
    }

    /// Writes the words, letter by letter with its place; how many letters they have.
    fn written(self, mut take: impl FnMut(usize, char)) -> usize {
        let mut speller = Speller { place: 0, take: &mut take };
        // It never fails.
        let _ = write!(speller, "{}", self.0);
        speller.place
    }
}

/// Writes words in printable ASCII characters.
struct Speller<'s> {
    /// How many letters were written.
    place: usize,
    /// Takes each with its place.
    take: &'s mut dyn FnMut(usize, char),
}

impl Speller<'_> {
    /// Writes a letter.
    fn spell(&mut self, letter: char) {
        (self.take)(self.place, letter);
        self.place += 1;
    }
}

impl Write for Speller<'_> {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        for letter in words.chars() {
            if matches!(letter, ' '..='~') {
                self.spell(letter);
            } else {
                spelt(letter).chars().for_each(|letter| self.spell(letter));
            }
        }
        Ok(())
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
