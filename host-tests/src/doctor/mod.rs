//! What is needed to build the firmware, to flash a board and to talk to it: what is there, and the command that brings what
//! is not.
//!
//! Each check is a function from an [`Environment`] to a [`Finding`]; nothing else touches the computer.

pub mod board;
pub mod environment;
#[cfg(feature = "probe")]
mod probe;
pub mod serial;
pub mod system;
pub mod tools;

use serde::Serialize;

use self::environment::Environment;

/// What something is needed for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Need {
    /// To build the firmware and flash a board.
    #[serde(rename = "cargo board")]
    Board,
    /// To talk to a board.
    #[serde(rename = "meridian send")]
    Link,
    /// To run the firmware without a board.
    #[serde(rename = "cargo emulate")]
    Emulator,
}

impl Need {
    /// The command that needs it.
    #[must_use]
    pub fn command(self) -> &'static str {
        match self {
            Self::Board => "cargo board",
            Self::Link => "meridian send",
            Self::Emulator => "cargo emulate",
        }
    }
}

/// Whether something is there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum State {
    /// It is: what exactly.
    Found(String),
    /// It is not: what exactly, and the command or deed that mends it.
    Missing(String, String),
    /// Nobody has looked: why, and the command with which it is looked for.
    Unseen(String, String),
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What was looked for.
    pub what: &'static str,
    /// What it is needed for.
    pub need: Need,
    /// Whether it is there.
    pub state: State,
}

impl Finding {
    /// What was found, or what is wrong with it.
    #[must_use]
    pub fn words(&self) -> &str {
        match &self.state {
            State::Found(words) | State::Missing(words, _) | State::Unseen(words, _) => words,
        }
    }

    /// One word for its state.
    #[must_use]
    pub fn state(&self) -> &'static str {
        match self.state {
            State::Found(_) => "found",
            State::Missing(..) => "missing",
            State::Unseen(..) => "not looked for",
        }
    }

    /// What mends it, where it is not there.
    #[must_use]
    pub fn remedy(&self) -> Option<&str> {
        match &self.state {
            State::Found(_) => None,
            State::Missing(_, remedy) | State::Unseen(_, remedy) => Some(remedy),
        }
    }

    /// Whether a board cannot be flashed for lack of it.
    #[must_use]
    pub fn stops_the_board(&self) -> bool {
        self.need == Need::Board && matches!(self.state, State::Missing(..))
    }
}

/// A check.
type Check = fn(&dyn Environment) -> Finding;

/// All checks, in the order in which their things are needed.
const CHECKS: [Check; 7] = [
    tools::target,
    tools::flasher,
    board::board,
    board::access,
    board::probe,
    serial::port,
    tools::emulator,
];

/// What came of all checks.
#[must_use]
pub fn findings(of: &dyn Environment) -> Vec<Finding> {
    CHECKS.iter().map(|check| check(of)).collect()
}
