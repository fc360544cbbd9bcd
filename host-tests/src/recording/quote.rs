//! Text of a file in a message: in one line, and no longer than the message bears.

/// Longest excerpt of a recording that a message quotes, in characters.
const EXCERPT: usize = 40;

/// Replaces what would break the message's line or hide part of it.
pub(super) fn printable(text: &str) -> String {
    let hides = |c: char| c.is_control() || matches!(c, '\u{2028}'..='\u{202e}');
    text.chars().map(|c| if hides(c) { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// The text in one line and no longer than a message bears.
pub(super) fn shortened(text: &str) -> String {
    match text.char_indices().nth(EXCERPT) {
        Some((end, _)) => printable(&text[..end]) + "…",
        None => printable(text),
    }
}

/// The text in double quotes, escaped, and no longer than a message bears.
pub(super) fn quoted(text: &str) -> String {
    match text.char_indices().nth(EXCERPT) {
        Some((end, _)) => format!("{:?}…", &text[..end]),
        None => format!("{text:?}"),
    }
}
