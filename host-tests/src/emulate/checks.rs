//! The figures of the whole instrument against its budget.

use firmware::budget;
use serde::Serialize;

use super::Run;
use super::collect::Figures;
use super::jobs::SURVEY;
use super::sections::Memory;

/// Instructions that the board executes in a second at best: one in a cycle, at 64 MHz.
const PER_SECOND: u64 = 64_000_000;
/// The highest sample rate of the stage path, Hz.
const GREATEST_RATE: u64 = 2000;

/// A figure and its limit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Check {
    /// What was counted or measured.
    pub what: String,
    /// The figure.
    pub count: u64,
    /// Greatest figure that is allowed.
    pub budget: u64,
    /// Whether the limit is the least that is allowed, not the most.
    pub at_least: bool,
}

impl Check {
    /// Whether the limit is kept.
    #[must_use]
    pub fn is_kept(&self) -> bool {
        if self.at_least { self.count >= self.budget } else { self.count <= self.budget }
    }
}

/// All checks, in the order of the printed table.
#[must_use]
pub fn all(runs: &[Run], memory: &Memory) -> Vec<Check> {
    let samples = runs.iter().filter_map(|run| {
        let what = format!("instructions a sample, {}", run.job.title);
        Some(most(what, per_sample(&run.figures), run.job.sample_budget?))
    });
    let idle = runs.iter().filter(|run| run.job.is_idle).map(|run| {
        let what = format!("percent idle at 2000 Hz, at least, {}", run.job.title);
        let check = most(what, idle_percent(&run.figures), budget::IDLE_PERCENT);
        Check { at_least: true, ..check }
    });
    samples.chain(polls(runs)).chain(idle).chain(of_memory(runs, memory)).collect()
}

fn most(what: impl Into<String>, count: u64, budget: u64) -> Check {
    Check { what: what.into(), count, budget, at_least: false }
}

/// The longest polls of a task.
fn polls(runs: &[Run]) -> [Check; 2] {
    let longest = |is_survey: bool| {
        let runs = runs.iter().filter(|run| (run.job.word == SURVEY.word) == is_survey);
        runs.map(|run| run.figures.longest_poll()).max().unwrap_or(0)
    };
    let poll = "instructions of the longest poll of a task";
    let survey = "the same where the noise is learnt and a plan made";
    [
        most(poll, longest(false), budget::POLL_INSTRUCTIONS),
        most(survey, longest(true), budget::SURVEY_POLL_INSTRUCTIONS),
    ]
}

/// The memory of the image, and the stack that its runs took.
fn of_memory(runs: &[Run], memory: &Memory) -> [Check; 3] {
    let stack = runs.iter().map(|run| run.figures.stack_bytes).max().unwrap_or(0);
    let (flash, ram) = (memory.flash_bytes(), memory.ram_bytes());
    [
        most("bytes of flash, the etalon table included", flash, budget::FLASH_BYTES),
        most("bytes of static RAM", ram, budget::STATIC_RAM_BYTES),
        most("bytes of stack at its deepest", stack, budget::STACK_BYTES),
    ]
}

/// Mean instructions for a sample, rounded up.
pub(crate) fn per_sample(figures: &Figures) -> u64 {
    figures.of_a_sample(figures.instructions)
}

/// Share of the core's time that a gyro at [`GREATEST_RATE`] leaves, rounded down; at best, as
/// instructions are not cycles.
fn idle_percent(figures: &Figures) -> u64 {
    let taken = per_sample(figures) * GREATEST_RATE;
    100 - (taken * 100).div_ceil(PER_SECOND).min(100)
}
