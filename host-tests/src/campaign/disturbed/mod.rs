//! Recordings with and without a fault that the data can show: what gets past every check, and what is
//! refused without need.
//!
//! A class is one fault of any severity, from harmless to gross. Each of its runs draws an instrument, a place
//! and a severity, and is aligned twice: as it is, and with the fault. The same noise is in both, so that the
//! difference is the fault's alone.

mod axes;
mod class;
mod faults;
mod gyro;
pub(super) mod report;
mod spin;
mod stage;
mod turning;
mod unit;
mod vehicle;

use serde::Serialize;

use super::chance::Chance;
use super::statistics::{Answer, Precision};
use super::{Tick, one_by_one, over};

use self::class::Subject;
pub use class::{Class, Fault, Pair};

/// Residuals below which σ rests on few.
pub const FEW_RESIDUALS: usize = 10;
/// Part of the answers whose σ rests on few residuals that may be wrong.
const WRONG_OF_FEW: f64 = 0.01;
/// Part of the runs whose fault does no harm that must be answered.
const ANSWERED_OF_HARMLESS: f64 = 0.9;
/// The random stream of a severity: none of those that a world draws from.
const SEVERITY: u64 = 2_000;

/// What is drawn with and without faults.
#[derive(Clone, Copy)]
pub struct Platform {
    /// Name of the platform on the command line.
    pub name: &'static str,
    /// The answer of a seed's healthy recording, or why there is none.
    pub healthy: fn(u64) -> Result<Answer, String>,
    /// Classes of faults that are drawn on the platform.
    pub classes: fn() -> Vec<Class>,
}

impl Platform {
    /// Describes a platform by the units that are drawn on it.
    const fn of<S: Subject>(name: &'static str, classes: fn() -> Vec<Class>) -> Self {
        Self { name, healthy: |seed| S::drawn(seed).align().answer, classes }
    }
}

/// The platforms that are drawn.
pub const PLATFORMS: [Platform; 4] =
    [stage::PLATFORM, turning::PLATFORM, vehicle::PLATFORM, spin::PLATFORM];

/// Every class, platform by platform.
pub fn classes() -> impl Iterator<Item = Class> {
    PLATFORMS.iter().flat_map(|platform| (platform.classes)())
}

/// What healthy recordings gave.
#[derive(Clone, Debug, Serialize)]
pub struct HealthyRow {
    /// The platform.
    pub method: &'static str,
    /// Errors against σ and limit.
    #[serde(flatten)]
    pub precision: Precision,
}

/// Draws healthy recordings of every platform, so many in all; the last row has all of them.
pub fn healthy(runs: usize, tick: Tick<'_>) -> Vec<HealthyRow> {
    let mut all = Vec::new();
    let mut rows = one_by_one(PLATFORMS, tick, |Platform { name, healthy, .. }| {
        let answers = over(runs / PLATFORMS.len(), tick, healthy);
        let row = HealthyRow { method: name, precision: Precision::of(&answers) };
        all.extend(answers);
        row
    });
    rows.push(HealthyRow { method: "all", precision: Precision::of(&all) });
    rows
}

/// What became of a class.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The class's fault.
    #[serde(flatten)]
    pub fault: Fault,
    /// Number of runs.
    pub runs: usize,
    /// Runs that were answered with the fault.
    pub answered: usize,
    /// Answers beyond [`WRONG_SIGMAS`](super::faults::WRONG_SIGMAS), and how many of these rest on few residuals.
    pub wrong: usize,
    /// Wrong answers that rest on few residuals.
    pub wrong_of_few: usize,
    /// Wrong answers whose error a slow motion of the base may explain, as is stated beside them.
    pub wrong_stated: usize,
    /// The greatest error of an answer in its σ.
    pub worst_sigmas: f64,
    /// Seed, severity and error in σ of every wrong answer.
    pub wrong_runs: Vec<(u64, f64, f64)>,
    /// Seed and severity of each harmless run that was not answered well.
    pub lost_runs: Vec<(u64, f64)>,
    /// Runs in which the fault does no harm.
    pub harmless: usize,
    /// Harmless runs that were answered, with a σ not much greater than without the fault.
    pub harmless_answered: usize,
    /// Healthy runs that were refused, and the first reason.
    pub healthy_refused: usize,
    /// Reasons for which runs with the fault were refused, without their numbers, and how often.
    pub reasons: Vec<(String, usize)>,
    /// Whether the class passes.
    pub is_met: bool,
}

/// Draws a class with seeds 1 to `runs`; `tick` after each.
#[must_use]
pub fn row(class: &Class, runs: usize, tick: Tick<'_>) -> Row {
    let runs = over(runs, tick, |seed| {
        let [low, high] = class.fault.severity;
        let severity = Chance::new(seed, SEVERITY).scaled(low, high);
        Run { seed, severity, pair: (class.draw)(seed, severity) }
    });
    summary(class, &runs)
}

/// One run of a class.
struct Run {
    seed: u64,
    severity: f64,
    pair: Pair,
}

fn summary(class: &Class, all: &[Run]) -> Row {
    let such = |is: fn(&Pair) -> bool| all.iter().filter(move |run| is(&run.pair));
    let count = |is: fn(&Pair) -> bool| such(is).count();
    let answered = count(|pair| pair.faulty.answer.is_ok());
    let (wrong, wrong_of_few) =
        (count(Pair::is_wrong), count(|pair| pair.is_few && pair.is_wrong()));
    let (harmless, lost) = (count(Pair::is_harmless), count(Pair::is_lost));
    let harmless_answered = harmless - lost;
    let allowed = |part: f64| (part * answered as f64).floor() as usize;
    let is_right = wrong - wrong_of_few <= allowed(class.wrong_allowed)
        && wrong <= allowed(class.wrong_allowed.max(WRONG_OF_FEW));
    let is_useful = harmless_answered as f64 >= ANSWERED_OF_HARMLESS * harmless as f64;
    Row {
        fault: class.fault.clone(),
        runs: all.len(),
        answered,
        wrong,
        wrong_of_few,
        wrong_stated: count(Pair::is_reported),
        worst_sigmas: all.iter().filter_map(|run| run.pair.sigmas()).fold(0.0, f64::max),
        wrong_runs: such(Pair::is_wrong)
            .filter_map(|run| Some((run.seed, run.severity, run.pair.sigmas()?)))
            .collect(),
        lost_runs: such(Pair::is_lost).map(|run| (run.seed, run.severity)).collect(),
        harmless,
        harmless_answered,
        healthy_refused: count(|pair| pair.healthy.is_err()),
        reasons: reasons(all),
        is_met: is_right && is_useful,
    }
}

/// Why runs with the fault were refused, the commonest first.
fn reasons(all: &[Run]) -> Vec<(String, usize)> {
    let mut counted: Vec<(String, usize)> = Vec::new();
    for reason in all.iter().filter_map(|run| run.pair.faulty.answer.as_ref().err()) {
        let words = without_numbers(reason);
        match counted.iter_mut().find(|(other, _)| *other == words) {
            Some((_, count)) => *count += 1,
            None => counted.push((words, 1)),
        }
    }
    counted.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counted
}

/// A reason without its numbers, so that equal ones can be counted.
fn without_numbers(reason: &str) -> String {
    let mut words = String::new();
    for letter in reason.chars() {
        let is_number = letter.is_ascii_digit() || (letter == '.' && words.ends_with('#'));
        if !is_number {
            words.push(letter);
        } else if !words.ends_with('#') {
            words.push('#');
        }
    }
    words
}
