//! The figures of the whole instrument against its budget.

use firmware::budget;
use serde::Serialize;

use super::collect::Figures;
use super::sections::Memory;

/// Instructions that the board executes in a second at best: one in a cycle, at 80 MHz.
const PER_SECOND: u64 = 80_000_000;
/// The highest sample rate of the stage path, Hz.
const GREATEST_RATE: u64 = 2000;
/// How many times the stack that was seen must fit: what was seen is not the worst there is.
const STACK_MARGIN: u64 = 2;

/// A figure and its limit.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Check {
    /// What was counted or measured.
    pub what: &'static str,
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

/// What was taken in each run.
#[derive(Clone, Debug)]
pub struct Runs {
    /// Figures of the usual run.
    pub figures: Figures,
    /// Figures of a brief run at the highest sample rate.
    pub brief: Figures,
    /// Figures of a run that learns its gyro's noise and plans by it.
    pub survey: Figures,
    /// Figures of a brief run on a platform that turns all the time, at the highest sample rate.
    pub turning: Figures,
    /// Figures of a run in a vehicle that goes from stop to stop.
    pub stops: Figures,
}

/// All checks, in the order of the printed table.
#[must_use]
pub fn all(runs: &Runs, memory: &Memory) -> Vec<Check> {
    let Runs { figures, brief, survey, turning, stops } = runs;
    let most = |what, count, budget| Check { what, count, budget, at_least: false };
    let worst = |of: &Figures| of.tasks.iter().map(|task| task.worst).max().unwrap_or(0);
    let least = |what, count, budget| Check { at_least: true, ..most(what, count, budget) };
    let stack = [figures, survey, turning, stops].map(|run| run.stack_bytes);
    let stack = stack.into_iter().max().unwrap_or(0);
    vec![
        most(
            "instructions a sample at 2400 Hz, the whole instrument",
            per_sample(brief),
            budget::SAMPLE_INSTRUCTIONS,
        ),
        most(
            "the same on a platform that turns all the time",
            per_sample(turning),
            budget::TURNING_SAMPLE_INSTRUCTIONS,
        ),
        most(
            "the same in a vehicle, three gyros at 50 Hz",
            per_sample(stops),
            budget::STOPS_SAMPLE_INSTRUCTIONS,
        ),
        most(
            "instructions of the longest poll of a task",
            worst(figures).max(worst(turning)).max(worst(stops)),
            budget::POLL_INSTRUCTIONS,
        ),
        most(
            "the same where the noise is learnt and a plan made",
            worst(survey),
            budget::SURVEY_POLL_INSTRUCTIONS,
        ),
        least(
            "percent idle with 2000 samples a second at 80 MHz, at least",
            idle_percent(brief),
            budget::IDLE_PERCENT,
        ),
        least(
            "the same on a platform that turns all the time, at least",
            idle_percent(turning),
            budget::IDLE_PERCENT,
        ),
        most(
            "bytes of flash, the etalon table included",
            memory.flash_bytes(),
            budget::FLASH_BYTES,
        ),
        most("bytes of static RAM", memory.ram_bytes(), budget::STATIC_RAM_BYTES),
        most("bytes of stack at its deepest", stack, budget::STACK_BYTES),
        most(
            "bytes of that stack twice, in what RAM leaves",
            stack * STACK_MARGIN,
            memory.stack_room_bytes,
        ),
    ]
}

/// Mean instructions for a sample, rounded up.
fn per_sample(figures: &Figures) -> u64 {
    figures.instructions.div_ceil(figures.samples.max(1))
}

/// Share of the core's time that a gyro at [`GREATEST_RATE`] leaves, rounded down; at best, as
/// instructions are not cycles.
fn idle_percent(figures: &Figures) -> u64 {
    let taken = per_sample(figures) * GREATEST_RATE;
    100 - (taken * 100).div_ceil(PER_SECOND).min(100)
}
