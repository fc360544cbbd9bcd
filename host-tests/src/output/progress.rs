//! Progress on standard error: silent where that is no terminal.

use indicatif::{ProgressBar, ProgressStyle};
use orientation::session::Session;

use super::degrees;

/// A bar of `length` steps with a message behind it.
#[must_use]
pub fn bar(length: u64, what: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{prefix} [{bar:30}] {pos}/{len} {msg}");
    let bar = ProgressBar::new(length).with_prefix(what);
    match style {
        Ok(style) => bar.with_style(style.progress_chars("━╸ ")),
        Err(_) => bar,
    }
}

/// Shows how far a session is and what its dwells so far would give.
pub fn show(bar: &ProgressBar, session: &Session) {
    bar.set_length(session.planned() as u64);
    bar.set_position(session.dwells().len() as u64);
    if bar.is_hidden() {
        return;
    }
    let message = match session.preview().fit {
        Some(fit) => {
            let [sigma, limit] = [fit.sigma(), fit.limit].map(degrees);
            format!("σ so far {sigma:.4}°, limit {limit:.4}°")
        }
        None => "not yet determined".to_owned(),
    };
    bar.set_message(message);
}
