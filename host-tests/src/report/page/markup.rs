//! Elements of HTML from text.

/// An element around a text; `tag` may have attributes.
pub(super) fn element(tag: &str, text: &str) -> String {
    let name = tag.split(' ').next().unwrap_or(tag);
    format!("<{tag}>{}</{name}>\n", escaped(text))
}

/// The text without what a browser would take for markup.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '&' => safe += "&amp;",
            '"' => safe += "&quot;",
            other => safe.push(other),
        }
    }
    safe
}

/// A script of this type. JSON may hold `<` in strings alone, where it may be written by its number: so no text ends the
/// script.
pub(super) fn script(kind: &str, json: &str) -> String {
    format!("<script type=\"{kind}\">{}</script>\n", json.replace('<', "\\u003c"))
}
