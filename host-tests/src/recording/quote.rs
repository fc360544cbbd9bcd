//! Text of a file in a message: in one line, and no longer than the message bears.

use crate::output::printable;

/// Longest excerpt of a recording that a message quotes, in characters.
const EXCERPT: usize = 40;

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
