//! Time of the board that goes no faster than that of the computer, for those who watch it or talk to it.

use std::thread::sleep;
use std::time::{Duration, Instant};

/// Holds back an execution that runs ahead of the computer's clock. One that is slower does not catch up.
pub struct Pace {
    /// When the latest span that the board has executed is over at the earliest.
    due: Instant,
}

impl Pace {
    /// A board whose time begins now.
    pub fn begin() -> Self {
        Self { due: Instant::now() }
    }

    /// Waits until a span of time that the board has executed since the last call is over.
    pub fn keep(&mut self, executed: Duration) {
        let now = Instant::now();
        self.due = now.max(self.due + executed);
        sleep(self.due - now);
    }
}
