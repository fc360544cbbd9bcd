//! Answers to commands as sentences: how the instrument writes them, and how the other side reads them.
//!
//! | sentence | what |
//! |---|---|
//! | `$PMRDR,save,ok*hh` | the command was done, or all that it asked for has been sent |
//! | `$PMRDR,save,refused,why in words*hh` | it was not done |
//! | `$PMRDR,get,latitude,47.58*hh` | the value of a setting, to `get`, and as it is kept now, to `set` |
//! | `$PMRDR,log,412,0,0A1B*hh` | a part of a record of the log: the record's number, the part's from 0 on, bytes |
//!
//! `get` with a name and `set` are answered by one value. `get` without a name is answered by a value for every setting, and
//! `log` by the parts of every record; `ok` follows them.

use core::fmt::{self, Display, Write};

use orientation::words;

use crate::command::content;
use crate::nmea::{FRAME, LONGEST, Sentence, Writer, is_allowed, plain};

/// The address of an answer.
pub const ANSWER: &str = "PMRDR";
/// Most characters of the name of a setting, or of a device.
pub const LONGEST_NAME: usize = 24;
/// Most bytes of a record in a part of it: with the greatest numbers before it, it still fits into a sentence.
pub const PART: usize = 24;
/// Most characters of a reason: what is left of a sentence for the longest command.
const REASON: usize = LONGEST - FRAME - "PMRDR,realign,refused,".len();

/// What an answer says in the place of a value: that the command was done.
const DONE: &str = "ok";
/// What it says before a reason: that the command was not done.
const REFUSED: &str = "refused";
/// The command that is answered by parts of records.
const LOG: &str = "log";

// A part with the greatest numbers fits.
const _: () = assert!("PMRDR,log,4294967295,255,".len() + 2 * PART <= LONGEST - FRAME);

/// An answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer<'a> {
    /// The first word of the command that it answers.
    pub command: &'a str,
    /// What it says.
    pub content: Content<'a>,
}

/// What an answer says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content<'a> {
    /// The command was done.
    Done,
    /// It was not done, for this reason, which may be empty.
    Refused(&'a str),
    /// The setting of a name has a value: a decimal number without exponent, or words.
    Value(&'a str, &'a str),
    /// A part of a record of the log.
    Part(Part<'a>),
}

/// A part of a record of the log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part<'a> {
    /// Number of the record.
    pub record: u32,
    /// Number of the part in it, from 0 on.
    pub number: u32,
    /// Its bytes, two hexadecimal digits each.
    digits: &'a str,
}

impl Part<'_> {
    /// The bytes of the part.
    pub fn bytes(&self) -> impl Iterator<Item = u8> {
        let (pairs, _) = self.digits.as_bytes().as_chunks::<2>();
        pairs.iter().map(|pair| pair.iter().fold(0, |byte, digit| byte << 4 | nibble(*digit)))
    }
}

/// The value of a hexadecimal digit.
fn nibble(digit: u8) -> u8 {
    char::from(digit).to_digit(16).unwrap_or(0) as u8
}

/// Why a line that is meant as an answer is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoAnswer {
    /// Its checksum is wrong or lacks.
    Checksum,
    /// Its fields are not those of an answer.
    Fields,
}

words! { NoAnswer:
    Self::Checksum => "checksum";
    Self::Fields => "not the fields of an answer";
}

/// The answer of a line; [`None`] where it is another sentence, or none.
///
/// # Errors
/// What is wrong with a line that is meant as an answer.
#[must_use]
pub fn parse(line: &str) -> Option<Result<Answer<'_>, NoAnswer>> {
    let sentence = line.strip_prefix('$')?;
    sentence.strip_prefix(ANSWER)?.strip_prefix(',')?;
    let fields = content(sentence).and_then(|content| content.get(ANSWER.len() + 1..));
    Some(fields.ok_or(NoAnswer::Checksum).and_then(of_fields))
}

/// The answer of its fields.
fn of_fields(fields: &str) -> Result<Answer<'_>, NoAnswer> {
    let (command, rest) = fields.split_once(',').ok_or(NoAnswer::Fields)?;
    let content = match rest.split_once(',') {
        None if rest == DONE => Some(Content::Done),
        None if rest == REFUSED => Some(Content::Refused("")),
        Some((REFUSED, reason)) => Some(Content::Refused(reason)),
        Some((record, rest)) if command == LOG => part(record, rest).map(Content::Part),
        Some((name, value)) if is_name(name) && is_value(value) => {
            Some(Content::Value(name, value))
        }
        _ => None,
    };
    let is_plain = is_value(command) && fields.chars().all(|c| c == ',' || is_allowed(c));
    let content = content.filter(|_| is_plain).ok_or(NoAnswer::Fields)?;
    Ok(Answer { command, content })
}

/// A part of a record: its numbers and bytes.
fn part<'a>(record: &str, rest: &'a str) -> Option<Part<'a>> {
    let (number, digits) = rest.split_once(',')?;
    let whole = |text: &str| text.bytes().all(|digit| digit.is_ascii_digit()).then(|| text.parse());
    let are_bytes = !digits.is_empty()
        && digits.len().is_multiple_of(2)
        && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let (record, number) = (whole(record)?.ok()?, whole(number)?.ok()?);
    are_bytes.then_some(Part { record, number, digits })
}

/// Whether a word may be the name of a setting or of a device: small letters, digits and underscores, and none of the words
/// that an answer has in the place of a name.
#[must_use]
pub fn is_name(word: &str) -> bool {
    let is_letter = |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || byte == b'_';
    (1..=LONGEST_NAME).contains(&word.len())
        && word.bytes().all(is_letter)
        && ![DONE, REFUSED].contains(&word)
}

/// Whether a text may be a value: characters that a field of a sentence may have, at least one.
#[must_use]
pub fn is_value(text: &str) -> bool {
    !text.is_empty() && text.chars().all(is_allowed)
}

/// `$PMRDR,save,ok*hh`: the command was done.
#[must_use]
pub fn done(command: &str) -> Option<Sentence> {
    Writer::new(ANSWER).words(command).words(DONE).finish()
}

/// `$PMRDR,save,refused,why*hh`: the command was not done. A reason that is too long is cut, a comma becomes a
/// semicolon, and what else a sentence may not have a space.
#[must_use]
pub fn refused(command: &str, reason: impl Display) -> Option<Sentence> {
    let mut plain = Plain(heapless::String::new());
    // It never fails, as it cuts.
    let _ = write!(plain, "{reason}");
    Writer::new(ANSWER).words(command).words(REFUSED).words(&plain.0).finish()
}

/// A reason in characters that a field may have, cut at its greatest length.
struct Plain(heapless::String<REASON>);

impl Write for Plain {
    fn write_str(&mut self, words: &str) -> fmt::Result {
        let _ = words.chars().map(plain).try_for_each(|letter| self.0.push(letter));
        Ok(())
    }
}

/// `$PMRDR,get,latitude,47.58*hh`: the value of a setting; [`None`] for a name or a value that no sentence has.
#[must_use]
pub fn value(command: &str, name: &str, value: impl Display) -> Option<Sentence> {
    let mut text = heapless::String::<LONGEST>::new();
    write!(text, "{value}").ok()?;
    if !is_name(name) || !is_value(&text) {
        return None;
    }
    Writer::new(ANSWER).words(command).words(name).words(&text).finish()
}

/// `$PMRDR,log,412,0,0A1B*hh`: a part of a record, of [`PART`] bytes at most.
#[must_use]
pub fn record(number: u32, part: u8, bytes: &[u8]) -> Option<Sentence> {
    if !(1..=PART).contains(&bytes.len()) {
        return None;
    }
    let mut writer = Writer::new(ANSWER);
    writer.words(LOG).whole(Some(number)).whole(Some(part.into())).bytes(bytes).finish()
}
