//! Recordings with and without a fault that the data can tell: what gets past every check, and what is
//! refused without need.
//!
//! A class is one fault of any severity, from harmless to gross. Each of its runs draws an instrument, a place
//! and a severity, and is aligned twice: as it is, and with the fault. The same noise is in both, so that the
//! difference is the fault's alone.

mod axes;
mod chance;
mod faults;
mod gyro;
pub mod spin;
pub mod stage;
pub mod turning;
mod unit;
pub mod vehicle;

use serde::Serialize;

use super::over;
use super::statistics::{Answer, Precision};
use hal_mock::noise::Generator;

/// Error in σ beyond which an answer is wrong.
pub const WRONG_SIGMAS: f64 = 5.0;
/// Residuals below which σ rests on few.
pub const FEW_RESIDUALS: usize = 10;
/// Part of the answers whose σ rests on few residuals that may be wrong.
const WRONG_OF_FEW: f64 = 0.01;
/// Part of the runs whose fault does no harm that must be answered.
const ANSWERED_OF_HARMLESS: f64 = 0.9;
/// How many times the σ of the healthy run such an answer may have.
const GREATEST_SIGMA: f64 = 3.0;
/// The random stream of a severity: none of those that a world draws from.
const SEVERITY: u64 = 2_000;

/// One run, with its fault and without.
#[derive(Clone, Debug)]
pub struct Pair {
    /// What the healthy recording gave, or why it gave nothing.
    pub healthy: Result<Answer, String>,
    /// The same with the fault.
    pub faulty: Result<Answer, String>,
    /// Error of the fault's recording when nothing is checked, °; none where even that has no answer.
    pub unchecked_deg: Option<f64>,
    /// By how much a slow motion of the base may put the fault's answer off unseen, as is told beside it, °.
    pub untold_deg: f64,
    /// Whether σ rests on fewer than [`FEW_RESIDUALS`] residuals.
    pub is_few: bool,
}

impl Pair {
    /// Whether the fault moves the answer by less than the healthy run's σ.
    fn is_harmless(&self) -> bool {
        let (Ok(healthy), Some(unchecked)) = (&self.healthy, self.unchecked_deg) else {
            return false;
        };
        (unchecked - healthy.error).abs() <= healthy.sigma
    }

    /// Error of the fault's answer in its own σ; infinite where either is no number.
    fn sigmas(&self) -> Option<f64> {
        let sigmas = self.faulty.as_ref().ok().map(|answer| (answer.error / answer.sigma).abs());
        sigmas.map(|sigmas| if sigmas.is_nan() { f64::INFINITY } else { sigmas })
    }

    /// Whether the fault's answer is wrong, and by how much it may be is told beside it.
    fn is_told(&self) -> bool {
        let is_within = |answer: &Answer| answer.error.abs() <= self.untold_deg;
        self.is_wrong() && self.faulty.as_ref().is_ok_and(is_within)
    }

    /// Whether the fault's answer is beyond [`WRONG_SIGMAS`].
    fn is_wrong(&self) -> bool {
        self.sigmas().is_some_and(|sigmas| sigmas > WRONG_SIGMAS)
    }

    /// Whether the fault's run was answered about as well as the healthy one.
    fn is_answered_well(&self) -> bool {
        match (&self.healthy, &self.faulty) {
            (Ok(healthy), Ok(faulty)) => faulty.sigma <= GREATEST_SIGMA * healthy.sigma,
            _ => false,
        }
    }
}

/// A fault of any severity.
#[derive(Clone, Copy)]
pub struct Class {
    /// Its name on the command line.
    pub name: &'static str,
    /// What happens.
    pub fault: &'static str,
    /// From harmless to gross; severities are drawn evenly in their logarithm.
    pub severity: [f64; 2],
    /// Unit of the severity.
    pub unit: &'static str,
    /// Part of the answers that may be wrong; zero but where the data cannot tell.
    pub wrong_allowed: f64,
    /// The run of a seed and a severity.
    pub draw: fn(u64, f64) -> Pair,
}

/// Every class, method by method.
pub fn classes() -> impl Iterator<Item = &'static Class> {
    let of_carriers = stage::CLASSES.iter().chain(turning::CLASSES).chain(vehicle::CLASSES);
    of_carriers.chain(spin::CLASSES)
}

/// Healthy recordings of a method.
#[derive(Clone, Copy)]
pub struct Healthy {
    /// The method.
    pub name: &'static str,
    /// The answer of a seed's run.
    pub draw: fn(u64) -> Result<Answer, String>,
}

/// The methods whose healthy recordings are drawn.
pub const HEALTHY: [Healthy; 4] = [
    Healthy { name: "stage", draw: stage::healthy },
    Healthy { name: "turning", draw: turning::healthy },
    Healthy { name: "vehicle", draw: vehicle::healthy },
    Healthy { name: "spin", draw: spin::healthy },
];

/// What healthy recordings gave.
#[derive(Clone, Debug, Serialize)]
pub struct HealthyRow {
    /// The method.
    pub method: &'static str,
    /// Errors against σ and limit.
    #[serde(flatten)]
    pub precision: Precision,
}

/// Draws healthy recordings of every method, so many in all; the last row has all of them.
pub fn healthy(runs: usize, tick: &(impl Fn() + Sync)) -> Vec<HealthyRow> {
    let mut all = Vec::new();
    let mut rows: Vec<HealthyRow> = Vec::new();
    for Healthy { name, draw } in HEALTHY {
        let answers = over(runs / HEALTHY.len(), tick, draw);
        rows.push(HealthyRow { method: name, precision: Precision::of(&answers) });
        all.extend(answers);
    }
    rows.push(HealthyRow { method: "all", precision: Precision::of(&all) });
    rows
}

/// What became of a class.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The class.
    pub class: &'static str,
    /// What happens in it.
    pub fault: &'static str,
    /// The severities, and their unit.
    pub severity: [f64; 2],
    /// Unit of the severities.
    pub unit: &'static str,
    /// Runs.
    pub runs: usize,
    /// Runs that were answered with the fault.
    pub answered: usize,
    /// Answers beyond [`WRONG_SIGMAS`], and how many of these rest on few residuals.
    pub wrong: usize,
    /// Of the wrong answers those that rest on few residuals.
    pub wrong_of_few: usize,
    /// Of the wrong answers those that are off by no more than a slow motion of the base is said to put them.
    pub wrong_told: usize,
    /// The greatest error of an answer in its σ.
    pub worst_sigmas: f64,
    /// Seed, severity and error in σ of every wrong answer.
    pub wrong_runs: Vec<(u64, f64, f64)>,
    /// Seed and severity of each harmless run that was not answered well.
    pub lost_runs: Vec<(u64, f64)>,
    /// Runs in which the fault does no harm.
    pub harmless: usize,
    /// Of these, those that were answered, with a σ not much greater than without the fault.
    pub harmless_answered: usize,
    /// Healthy runs that were refused, and the first reason.
    pub healthy_refused: usize,
    /// Reasons for which runs with the fault were refused, without their numbers, and how often.
    pub reasons: Vec<(String, usize)>,
    /// Whether the class passes.
    pub is_met: bool,
}

/// The severity of a seed's run.
fn severity(class: &Class, seed: u64) -> f64 {
    let [low, high] = class.severity;
    low * (high / low).powf(Generator::stream(seed, SEVERITY).uniform())
}

/// Draws a class with seeds 1 to `runs`; `tick` after each.
#[must_use]
pub fn row(class: &'static Class, runs: usize, tick: &(impl Fn() + Sync)) -> Row {
    let pairs = over(runs, tick, |seed| {
        let severity = severity(class, seed);
        (seed, severity, (class.draw)(seed, severity))
    });
    summary(class, &pairs)
}

fn summary(class: &'static Class, pairs: &[(u64, f64, Pair)]) -> Row {
    let count = |of: &dyn Fn(&Pair) -> bool| pairs.iter().filter(|(.., pair)| of(pair)).count();
    let answered = count(&|pair| pair.faulty.is_ok());
    let (wrong, wrong_of_few) =
        (count(&Pair::is_wrong), count(&|pair| pair.is_few && pair.is_wrong()));
    let harmless = count(&Pair::is_harmless);
    let harmless_answered = count(&|pair| pair.is_harmless() && pair.is_answered_well());
    let worst_sigmas = pairs.iter().filter_map(|(.., pair)| pair.sigmas()).fold(0.0, f64::max);
    let wrong_runs = pairs.iter().filter(|(.., pair)| pair.is_wrong());
    let wrong_runs = wrong_runs
        .filter_map(|(seed, severity, pair)| Some((*seed, *severity, pair.sigmas()?)))
        .collect();
    let lost = |pair: &Pair| pair.is_harmless() && !pair.is_answered_well();
    let lost_runs = pairs.iter().filter(|(.., pair)| lost(pair));
    let lost_runs = lost_runs.map(|(seed, severity, _)| (*seed, *severity)).collect();
    let allowed = |part: f64, of: usize| (part * of as f64).floor() as usize;
    let is_right = wrong - wrong_of_few <= allowed(class.wrong_allowed, answered)
        && wrong <= allowed(class.wrong_allowed.max(WRONG_OF_FEW), answered);
    let is_useful = harmless_answered as f64 >= ANSWERED_OF_HARMLESS * harmless as f64;
    Row {
        class: class.name,
        fault: class.fault,
        severity: class.severity,
        unit: class.unit,
        runs: pairs.len(),
        answered,
        wrong,
        wrong_of_few,
        wrong_told: count(&Pair::is_told),
        worst_sigmas,
        wrong_runs,
        lost_runs,
        harmless,
        harmless_answered,
        healthy_refused: count(&|pair| pair.healthy.is_err()),
        reasons: reasons(pairs),
        is_met: is_right && is_useful,
    }
}

/// Why runs with the fault were refused, the commonest first.
fn reasons(pairs: &[(u64, f64, Pair)]) -> Vec<(String, usize)> {
    let mut counted: Vec<(String, usize)> = Vec::new();
    for reason in pairs.iter().filter_map(|(.., pair)| pair.faulty.as_ref().err()) {
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
