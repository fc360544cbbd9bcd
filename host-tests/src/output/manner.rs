//! How a command says what came of it: as an object or as text, and how much beside it.

use std::io::{IsTerminal as _, stderr, stdout};

use crate::report::Verbosity;

/// Whether results and errors come to a terminal both, so that a person reads the ones below the others.
#[must_use]
pub fn is_one_terminal() -> bool {
    stdout().is_terminal() && stderr().is_terminal()
}

/// How a command says what came of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Manner {
    /// Whether standard output gets one JSON object.
    pub as_json: bool,
    /// How much is told.
    pub verbosity: Verbosity,
}

impl Manner {
    /// Whether progress is shown: a program that reads objects is not disturbed by it, a person at a terminal is not left
    /// waiting.
    #[must_use]
    pub fn shows_progress(self) -> bool {
        self.verbosity != Verbosity::Quiet && (!self.as_json || stderr().is_terminal())
    }

    /// Whether the log of a run is shown, line by line.
    #[must_use]
    pub fn shows_log(self) -> bool {
        self.verbosity == Verbosity::Verbose
    }

    /// Whether warnings are said; an object holds them in any case.
    #[must_use]
    pub fn warns(self) -> bool {
        self.verbosity != Verbosity::Quiet
    }
}
