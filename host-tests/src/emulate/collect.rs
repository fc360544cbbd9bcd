//! What the image's log says for this program to read: the lines without level.
//!
//! Each begins with what it is; figures are `name=value` pairs, the bits of numbers a list.

use serde::Serialize;

use super::decode::Line;
use super::outcome::{Outcome, Row};

/// What the whole instrument took.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Instructions of the instrument in all polls.
    pub instructions: u64,
    /// How many of them are those of the emulator's time driver, which stands in for the board's.
    pub stand_ins: u64,
    /// Instructions of the simulated chips and world.
    pub simulation: u64,
    /// Samples of the gyro.
    pub samples: u64,
    /// Virtual time, µs.
    pub microseconds: u64,
    /// Stack at its deepest, bytes.
    pub stack_bytes: u64,
    /// The tasks.
    pub tasks: Vec<Task>,
}

impl Figures {
    /// A sample's part of so many instructions, rounded up.
    pub(crate) fn of_a_sample(&self, instructions: u64) -> u64 {
        instructions.div_ceil(self.samples.max(1))
    }

    /// Instructions of the longest poll of a task.
    pub(crate) fn longest_poll(&self) -> u64 {
        self.tasks.iter().map(|task| task.worst).max().unwrap_or(0)
    }
}

/// What one task took.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Task {
    /// Name of the task.
    pub name: String,
    /// How often it was polled.
    pub polls: u64,
    /// Instructions of all its polls.
    pub instructions: u64,
    /// Instructions of its longest poll.
    pub worst: u64,
}

/// What was read so far.
#[derive(Clone, Debug, Default)]
pub struct Collected {
    outcome: Outcome,
    is_measured: bool,
    figures: Figures,
}

impl Collected {
    /// Takes a line of the log.
    ///
    /// # Errors
    /// Where it lacks what such a line must have.
    pub fn take(&mut self, line: &Line) -> Result<(), String> {
        if line.level.is_some() {
            return Ok(());
        }
        self.read(&line.words).ok_or_else(|| format!("not understood: {}", line.words))
    }

    fn read(&mut self, words: &str) -> Option<()> {
        let number = |name| value(words, name)?.parse::<u64>().ok();
        let (word, rest) = words.split_once(' ')?;
        match word {
            "row" => self.outcome.rows.push(Row::parse(rest)?),
            "reason" => self.outcome.reason = Some(rest.to_owned()),
            "effort" => {
                self.figures.instructions = number("instructions")?;
                self.figures.stand_ins = number("stand-ins")?;
                self.figures.simulation = number("simulation")?;
                self.figures.samples = number("samples")?;
                self.figures.microseconds = number("microseconds")?;
                self.is_measured = true;
            }
            "task" => {
                let [polls, instructions, worst] = ["polls", "instructions", "worst"].map(number);
                let name = after(words, "name")?.to_owned();
                let task = Task { name, polls: polls?, instructions: instructions?, worst: worst? };
                self.figures.tasks.push(task);
            }
            "stack" => self.figures.stack_bytes = number("bytes")?,
            _ => return None,
        }
        Some(())
    }

    /// What the run found and took.
    ///
    /// # Errors
    /// Which line is missing.
    pub fn finish(self) -> Result<(Outcome, Figures), String> {
        let Self { outcome, is_measured, figures } = self;
        let is_there = [
            ("row", !outcome.rows.is_empty()),
            ("effort", is_measured),
            ("task", !figures.tasks.is_empty()),
            ("stack", figures.stack_bytes != 0),
        ];
        match is_there.into_iter().find(|(_, is_there)| !is_there) {
            Some((line, _)) => Err(format!("the emulator's log has no line `{line}`")),
            None => Ok((outcome, figures)),
        }
    }
}

/// The value of a pair, up to the next blank.
fn value<'w>(words: &'w str, name: &str) -> Option<&'w str> {
    after(words, name)?.split(' ').next()
}

/// All that stands behind a name.
fn after<'w>(words: &'w str, name: &str) -> Option<&'w str> {
    words.split_once(&format!(" {name}=")).map(|(_, rest)| rest)
}
