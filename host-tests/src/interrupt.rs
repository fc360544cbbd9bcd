//! Ctrl-C: it ends the program at once, or only asks work that heeds it to come to an end; a second one ends the program.
//! What signals twice at once, as some shells and wrappers do, asks once.
//!
//! Many pieces of work end after the piece that runs ([`heed`]). A single one ends as if its input ended there: no further
//! row is read, and the simulated world stands still ([`end_input`]); what came of it so far is then shown.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Within this time of the first one a further Ctrl-C is no second one.
const ONCE: Duration = Duration::from_millis(500);
/// When an end was first asked for.
static FIRST: OnceLock<Instant> = OnceLock::new();

/// Whether an end was asked for.
static IS_ASKED: AtomicBool = AtomicBool::new(false);
/// Whether the work that runs heeds it.
static IS_HEEDED: AtomicBool = AtomicBool::new(false);
/// Whether the input ends where an end is asked for.
static ENDS_INPUT: AtomicBool = AtomicBool::new(false);
/// Whether an input has ended so.
static HAS_ENDED: AtomicBool = AtomicBool::new(false);
/// How far the work is, in words.
static HOW_FAR: Mutex<String> = Mutex::new(String::new());

/// Listens to Ctrl-C from now on: where it must not wait, `end` gets the reason, and ends the program.
///
/// # Errors
/// The system does not let it.
pub fn listen(end: impl Fn(&str) + Send + 'static) -> Result<(), ctrlc::Error> {
    ctrlc::set_handler(move || {
        let is_second = FIRST.get_or_init(Instant::now).elapsed() > ONCE;
        IS_ASKED.store(true, Ordering::Relaxed);
        if is_second || !IS_HEEDED.load(Ordering::Relaxed) {
            end(&reason());
        }
    })
}

/// Why the work ends, and how far it was.
#[must_use]
pub fn reason() -> String {
    match HOW_FAR.lock() {
        Ok(words) if !words.is_empty() => format!("interrupted at {words}"),
        _ => "interrupted".to_owned(),
    }
}

/// Notes how far the work is.
pub fn note(words: &str) {
    if let Ok(mut noted) = HOW_FAR.lock() {
        words.clone_into(&mut noted);
    }
}

/// From now on the work looks whether an end is asked for.
pub fn heed() {
    IS_HEEDED.store(true, Ordering::Relaxed);
}

/// Whether an end is asked for.
#[must_use]
pub fn is_asked() -> bool {
    IS_ASKED.load(Ordering::Relaxed)
}

/// From now on the input of the work ends where an end is asked for.
pub fn end_input() {
    ENDS_INPUT.store(true, Ordering::Relaxed);
    heed();
}

/// Whether the input ends here, because an end is asked for; what reads it, or makes it, asks before each further part.
#[must_use]
pub fn ends_input() -> bool {
    let ends = ENDS_INPUT.load(Ordering::Relaxed) && is_asked();
    if ends {
        HAS_ENDED.store(true, Ordering::Relaxed);
    }
    ends
}

/// Why the input has ended before its own end, and how far the work was; none where it has not.
#[must_use]
pub fn ended() -> Option<String> {
    HAS_ENDED.load(Ordering::Relaxed).then(reason)
}
