//! Settings in a file, as TOML: what the instrument is at the top, its settings below in the order of their names.

use std::fmt::Write as _;
use std::ops::Range;

use protocol::answer::{is_name, is_value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{IDENTITY, Snapshot, value};

/// The table with the settings.
const TABLE: &str = "settings";

/// What a file holds.
#[must_use]
pub fn text(snapshot: &Snapshot) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: &str| {
        // Memory takes it.
        let _ = writeln!(text, "{name} = {}", value::in_file(name, value));
    };
    for name in IDENTITY {
        snapshot.identity(name).iter().for_each(|value| line(name, value));
    }
    text += "\n[settings]\n";
    for (name, value) in &snapshot.settings {
        let _ = writeln!(text, "{name} = {}", value::in_file(name, value));
    }
    text
}

/// What is wrong with a file, and where.
struct Wrong {
    words: String,
    at: Range<usize>,
}

/// What the text of a file of this name says.
///
/// # Errors
/// What is wrong, with its line and column.
pub fn parse(file: &str, text: &str) -> Result<Snapshot, String> {
    read(text).map_err(|Wrong { words, at }| {
        let before = text.get(..at.start.min(text.len())).unwrap_or_default();
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
        format!("{file}: line {line}, column {column}: {words}")
    })
}

fn read(text: &str) -> Result<Snapshot, Wrong> {
    let table = DeTable::parse(text).map_err(|error| Wrong {
        words: error.message().replace('\n', ", "),
        at: error.span().unwrap_or(0..0),
    })?;
    let mut snapshot = Snapshot::default();
    for (key, found) in table.get_ref() {
        let name = key.get_ref().as_ref();
        match found.get_ref() {
            DeValue::Table(settings) if name == TABLE => {
                snapshot.settings = settings.iter().map(setting).collect::<Result<_, _>>()?;
            }
            _ if IDENTITY.contains(&name) => {
                snapshot.identity.insert(name.to_owned(), words(found)?);
            }
            _ => {
                let words = format!(
                    "{name} is none of {}, nor the table [{TABLE}] with the settings",
                    IDENTITY.join(", ")
                );
                return Err(Wrong { words, at: key.span() });
            }
        }
    }
    Ok(snapshot)
}

/// A setting's name and value.
fn setting(
    (key, found): (&Spanned<std::borrow::Cow<'_, str>>, &Spanned<DeValue>),
) -> Result<(String, String), Wrong> {
    let name = key.get_ref().as_ref();
    let wrong = |words: String| Wrong { words, at: key.span() };
    if IDENTITY.contains(&name) {
        return Err(wrong(format!("{name} cannot be set; it stands above [{TABLE}]")));
    }
    if !is_name(name) {
        return Err(wrong(format!(
            "{name} is no name of a setting: small letters, digits and underscores, at most sixteen"
        )));
    }
    Ok((name.to_owned(), words(found)?))
}

/// A value as it is sent.
fn words(found: &Spanned<DeValue>) -> Result<String, Wrong> {
    let wrong = |words: String| Wrong { words, at: found.span() };
    let value = match found.get_ref() {
        DeValue::String(text) => Ok(text.to_string()),
        DeValue::Integer(whole) => value::decimal(whole.as_str(), whole.radix()),
        DeValue::Float(real) => value::decimal(real.as_str(), 10),
        DeValue::Boolean(is_so) => Ok(is_so.to_string()),
        _ => Err("a number or a text in quotation marks is meant".to_owned()),
    };
    let value = value.map_err(wrong)?;
    if is_value(&value) {
        return Ok(value);
    }
    Err(wrong(format!("`{value}` is empty, or has a character that a sentence may not have")))
}
