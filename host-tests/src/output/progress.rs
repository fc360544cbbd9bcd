//! Progress on standard error, with the time that is left: a bar on a terminal, elsewhere a dozen lines, and of what is read
//! or done in pieces only while it is long.

use std::fmt::Write;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use orientation::alignment::stepwise::session::Session;
use orientation::units::Radians;

use super::manner::Manner;
use super::say;
use crate::interrupt;
use crate::work::Follower;

/// Lines that a whole task may print where there is no terminal.
const LINES: u64 = 12;
/// A task that is shorter on the whole needs no lines.
const LONG: Duration = Duration::from_secs(5);
/// Least time between two lines.
const APART: Duration = Duration::from_secs(3);
/// How often the bar is drawn while nothing comes.
const REDRAWN: Duration = Duration::from_millis(500);
/// What the steps of a session are called.
const POSITIONS: &str = "positions";
/// How long nothing may be done before the bar shows how long that has been.
const SOON: Duration = Duration::from_secs(1);
/// What the bar shows: of 80 columns half are left to the words, and the rest of a line is cut.
const TEMPLATE: &str = "{bar:10} {share}{left}{wide_msg}";

/// The progress of one task; shared by the threads that work at it.
pub struct Progress {
    bar: ProgressBar,
    /// What its steps are called.
    what: &'static str,
    /// Whether lines take the place of a bar, where there is no terminal.
    prints_lines: bool,
    printed: AtomicU64,
    /// Whether lines are for long tasks alone, which a simulated run's are not: they tell its own time, too.
    only_if_long: bool,
    /// When the next line may be printed, ms after the beginning.
    next: AtomicU64,
}

/// Whether a line is due of a task that has taken so long and has so much left: where the whole is long, and the line before
/// it was not just now.
#[must_use]
pub fn is_due(elapsed: Duration, left: Option<Duration>, next: Duration) -> bool {
    elapsed >= next && left.is_some_and(|left| elapsed + left >= LONG)
}

impl Progress {
    /// Progress of a task of `length` steps, shown as a command is asked to; `what` names them.
    #[must_use]
    pub fn of_steps(manner: Manner, length: u64, what: &'static str) -> Self {
        let this = Self::beginning(manner, length, what, counted(what, 0, length));
        Self { only_if_long: true, ..this }
    }

    /// Progress of what is read, and of what is found in that.
    #[must_use]
    pub fn of_reading(manner: Manner) -> Self {
        Self { only_if_long: true, ..Self::new(manner, "reading") }
    }

    /// Progress of a task of which it is not known yet what will be counted; `words` say what it begins with.
    #[must_use]
    pub fn new(manner: Manner, words: &'static str) -> Self {
        Self::beginning(manner, 1, POSITIONS, words.to_owned())
    }

    fn beginning(manner: Manner, length: u64, what: &'static str, words: String) -> Self {
        let bar = ProgressBar::new(length.max(1));
        if !manner.shows_progress() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let bar = match ProgressStyle::with_template(TEMPLATE) {
            Ok(style) => {
                let style = style.with_key("left", write_left).with_key("share", write_share);
                bar.with_style(style.progress_chars("━╸ "))
            }
            Err(_) => bar,
        };
        let prints_lines = manner.shows_progress() && bar.is_hidden();
        if !bar.is_hidden() {
            bar.set_message(words);
            bar.enable_steady_tick(REDRAWN);
        }
        let [printed, next] = [0, 0].map(AtomicU64::new);
        Self { bar, what, prints_lines, printed, only_if_long: false, next }
    }

    /// One more step is done.
    pub fn step(&self) {
        self.bar.inc(1);
        self.show(&self.counted(), String::new);
    }

    /// Shows how far a session is and what its dwells so far would give.
    pub fn session(&self, session: &Session) {
        self.bar.set_length(session.planned().max(1) as u64);
        self.bar.set_position(session.dwells().len() as u64);
        self.show(&self.counted(), || so_far(session));
    }

    /// Shows how much of a whole is done, and says in words what that is.
    pub fn reached(&self, (done, all): (u64, u64), words: &str) {
        self.bar.set_length(all.max(1));
        self.bar.set_position(done.min(all));
        self.show(words, String::new);
    }

    /// A part of the task begins whose length is not known yet; what was done before tells nothing of its time.
    pub fn begin(&self, words: &'static str) {
        self.bar.reset();
        self.printed.store(0, Ordering::Relaxed);
        self.next.store(0, Ordering::Relaxed);
        if !self.bar.is_hidden() {
            self.bar.set_message(words);
        }
    }

    /// How many steps are done, of how many.
    fn counted(&self) -> String {
        counted(self.what, self.bar.position(), self.bar.length().unwrap_or(0))
    }

    /// Prints a line of a log above the bar.
    pub fn log(&self, line: &str) {
        if self.bar.is_hidden() { say(line) } else { self.bar.println(line) }
    }

    /// The task is done: the bar goes, what came of it takes its place.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }

    /// Puts words behind the bar, and more of them; without a terminal, prints a line when something is done at first, and
    /// each time that another twelfth of the task is.
    fn show(&self, words: &str, more: impl FnOnce() -> String) {
        interrupt::note(words);
        if !self.bar.is_hidden() {
            return self.bar.set_message(format!("{words} {}", more()));
        }
        if self.prints_lines && self.bar.position() > 0 {
            self.print(words, more);
        }
    }

    fn print(&self, words: &str, more: impl FnOnce() -> String) {
        let (done, all) = (self.bar.position(), self.bar.length().unwrap_or(0).max(1));
        let part = 1 + done * LINES / all;
        let left = left(self.bar.elapsed(), done, all);
        let is_further = self.printed.load(Ordering::Relaxed) < part;
        if is_further && self.is_due(left) && self.printed.fetch_max(part, Ordering::Relaxed) < part
        {
            let left = left.map(|left| in_words(left, "left")).unwrap_or_default();
            let line = format!("{words}, {}, {left}{}", percent(done, all), more());
            say(line.trim_end());
        }
    }

    /// Whether a line may be printed now, and none again so soon.
    fn is_due(&self, left: Option<Duration>) -> bool {
        if !self.only_if_long {
            return true;
        }
        let elapsed = self.bar.elapsed();
        let next = Duration::from_millis(self.next.load(Ordering::Relaxed));
        let due = is_due(elapsed, left, next);
        if due {
            self.next.store((elapsed + APART).as_millis() as u64, Ordering::Relaxed);
        }
        due
    }
}

impl Follower for Progress {
    fn done(&self) {
        self.step();
    }

    fn wants_more(&self) -> bool {
        !interrupt::is_asked()
    }
}

/// So many of so many steps.
fn counted(what: &str, done: u64, all: u64) -> String {
    format!("{what} {done}/{all}")
}

/// Writes the share that is done into the bar; nothing before anything is.
fn write_share(state: &ProgressState, to: &mut dyn Write) {
    if state.pos() > 0 {
        let share = percent(state.pos(), state.len().unwrap_or(0));
        // A bar that lacks it does no harm.
        let _ = write!(to, "{share:>5} ");
    }
}

/// The part of a whole, in per cent: of a long task the first step is less than one.
fn percent(done: u64, all: u64) -> String {
    match done * 100 / all.max(1) {
        0 if done > 0 => "<1 %".to_owned(),
        percent => format!("{percent} %"),
    }
}

/// Writes the time that is left into the bar. Before anything is done there is nothing to tell it from: how long that has
/// been takes its place, where it is long.
fn write_left(state: &ProgressState, to: &mut dyn Write) {
    let (elapsed, done) = (state.elapsed(), state.pos());
    let words = match left(elapsed, done, state.len().unwrap_or(0)) {
        Some(left) => in_words(left, "left"),
        None if elapsed >= SOON => in_words(elapsed, "so far"),
        None => String::new(),
    };
    // A bar that lacks it does no harm.
    let _ = write!(to, "{words}");
}

/// The time that is left where the rest goes on as what is done; none before anything is.
fn left(elapsed: Duration, done: u64, all: u64) -> Option<Duration> {
    let rest = all.saturating_sub(done) as f64;
    (done > 0).then(|| elapsed.mul_f64(rest / done as f64))
}

/// A time, what it is, and a space.
fn in_words(time: Duration, what: &str) -> String {
    let seconds = time.as_secs_f64().ceil() as u64;
    let (hours, minutes, seconds) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
    match hours {
        0 => format!("{minutes}:{seconds:02} {what} "),
        _ => format!("{hours}:{minutes:02}:{seconds:02} {what} "),
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
