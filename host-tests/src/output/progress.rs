//! Progress on standard error: a bar on a terminal, elsewhere a dozen lines.

use std::sync::atomic::{AtomicU64, Ordering};

use indicatif::{ProgressBar, ProgressStyle};
use orientation::alignment::stepwise::session::Session;
use orientation::units::Radians;

use super::say;

/// Lines that a whole task may print where there is no terminal.
const LINES: u64 = 12;

/// The progress of one task; shared by the threads that work at it.
pub struct Progress {
    bar: ProgressBar,
    what: &'static str,
    printed: AtomicU64,
}

impl Progress {
    /// Progress of a task of `length` steps; `what` names them.
    #[must_use]
    pub fn new(length: u64, what: &'static str) -> Self {
        let style = ProgressStyle::with_template("{prefix} [{bar:30}] {pos}/{len} {msg}");
        let bar = ProgressBar::new(length).with_prefix(what);
        let bar = match style {
            Ok(style) => bar.with_style(style.progress_chars("━╸ ")),
            Err(_) => bar,
        };
        Self { bar, what, printed: AtomicU64::new(0) }
    }

    /// One more step is done.
    pub fn step(&self) {
        self.bar.inc(1);
        self.show(String::new);
    }

    /// Shows how far a session is and what its dwells so far would give.
    pub fn session(&self, session: &Session) {
        self.bar.set_length(session.planned() as u64);
        self.bar.set_position(session.dwells().len() as u64);
        self.show(|| so_far(session));
    }

    /// Shows how many of the planned steps are done: dwells, a platform's turns, a vehicle's stops.
    pub fn steps(&self, (done, planned): (u64, u64)) {
        self.bar.set_length(planned);
        self.bar.set_position(done);
        self.show(String::new);
    }

    /// Prints a line of a log above the bar.
    pub fn log(&self, line: &str) {
        if self.bar.is_hidden() { say(line) } else { self.bar.println(line) }
    }

    /// The task is done: the bar stays as it is.
    pub fn finish(&self) {
        self.bar.abandon();
    }

    /// Puts a message behind the bar; without a terminal, prints a line each time that another
    /// twelfth of the task is done.
    fn show(&self, message: impl FnOnce() -> String) {
        if !self.bar.is_hidden() {
            self.bar.set_message(message());
            return;
        }
        let (done, all) = (self.bar.position(), self.bar.length().unwrap_or(0).max(1));
        let part = done * LINES / all;
        if self.printed.fetch_max(part, Ordering::Relaxed) < part {
            say(&format!("{} {done}/{all} {}", self.what, message()));
        }
    }
}

/// What the dwells so far would give.
fn so_far(session: &Session) -> String {
    match session.preview().fit {
        Some(fit) => {
            let [sigma, limit] = [fit.sigma(), fit.limit].map(Radians::degrees);
            format!("σ so far {sigma:.4}°, limit {limit:.4}°")
        }
        None => "not yet determined".to_owned(),
    }
}
