//! What the image's log says for this program to read: the lines without level.
//!
//! Each begins with what it is, then `name=value` pairs; the bits of numbers are hexadecimal.

use serde::Serialize;

use super::decode::Line;
use super::outcome::{KEPT, KINDS, Kind, Outcome, Row};

/// What the whole instrument took.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Instructions of the instrument in all polls.
    pub instructions: u64,
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
    rows: Vec<Row>,
    outcome: Option<Outcome>,
    effort: bool,
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
        match words.split(' ').next()? {
            "outcome" => {
                self.outcome = Some(outcome(words)?);
                Some(())
            }
            "effort" => {
                self.figures.instructions = number("instructions")?;
                self.figures.simulation = number("simulation")?;
                self.figures.samples = number("samples")?;
                self.figures.microseconds = number("microseconds")?;
                self.effort = true;
                Some(())
            }
            "task" => {
                let [polls, instructions, worst] = ["polls", "instructions", "worst"].map(number);
                let name = rest(words, "name")?.to_owned();
                let task = Task { name, polls: polls?, instructions: instructions?, worst: worst? };
                self.figures.tasks.push(task);
                Some(())
            }
            "stack" => {
                self.figures.stack_bytes = number("bytes")?;
                Some(())
            }
            word => self.row(KINDS.into_iter().find(|kind| kind.word == word)?, words),
        }
    }

    /// Takes a row; one that is numbered must come after those before it.
    fn row(&mut self, kind: &'static Kind, words: &str) -> Option<()> {
        let before = self.rows.iter().filter(|row| row.kind == kind).count();
        if *kind != KEPT && value(words, "number")?.parse() != Ok(before + 1) {
            return None;
        }
        self.rows.push(Row::parse(kind, |name| value(words, name))?);
        Some(())
    }

    /// What the run found and took.
    ///
    /// # Errors
    /// Which line is missing.
    pub fn finish(self) -> Result<(Outcome, Figures), String> {
        let missing = |line| format!("the emulator's log has no line `{line}`");
        let outcome = self.outcome.ok_or_else(|| missing("outcome"))?;
        if !self.effort {
            return Err(missing("effort"));
        }
        if self.figures.tasks.is_empty() {
            return Err(missing("task"));
        }
        if self.figures.stack_bytes == 0 {
            return Err(missing("stack"));
        }
        Ok((Outcome { rows: self.rows, ..outcome }, self.figures))
    }
}

fn outcome(words: &str) -> Option<Outcome> {
    let bits = |name| value(words, name).map(|bits| u64::from_str_radix(bits, 16).ok());
    let reason = rest(words, "reason").map(ToOwned::to_owned);
    let (azimuth_bits, sigma_bits) = match &reason {
        Some(_) => (None, None),
        None => (Some(bits("azimuth")??), Some(bits("sigma")??)),
    };
    let seed = value(words, "seed")?.parse().ok()?;
    Some(Outcome { seed, azimuth_bits, sigma_bits, reason, ..Outcome::default() })
}

/// The value of a pair, up to the next blank.
fn value<'w>(words: &'w str, name: &str) -> Option<&'w str> {
    rest(words, name)?.split(' ').next()
}

/// All that stands behind a name.
fn rest<'w>(words: &'w str, name: &str) -> Option<&'w str> {
    words.split_once(&format!(" {name}=")).map(|(_, rest)| rest)
}
