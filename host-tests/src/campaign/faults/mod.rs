//! Every fault on every platform: recovered within 5 σ or refused with a reason, and noticed where it must be.

pub(crate) mod notice;
pub(super) mod report;
mod runs;

use std::ops::RangeInclusive;

use serde::Serialize;
use simulated::fault::{Fault, Platform};

use self::runs::Ended;
use super::{Tick, side_by_side};

/// Error in σ beyond which an azimuth is a wrong north, and a roll a wrong one.
pub const WRONG_SIGMAS: f64 = 5.0;

/// What came of one fault.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The platform's name.
    pub platform: &'static str,
    /// The fault's name.
    pub fault: String,
    /// `ok`, `refused`, `wrong` for an azimuth or roll off by more than 5 σ, or `failed` for a board that
    /// did not come to an end.
    pub outcome: &'static str,
    /// Error in σ, where there is an azimuth or a roll.
    pub error_sigmas: Option<f64>,
    /// Why there is none.
    pub reason: Option<String>,
    /// What the board noticed first.
    pub noticed: Option<String>,
    /// Whether what must be noticed of the fault was noticed; none where nothing must be.
    pub is_noticed: Option<bool>,
    /// Readings lost, restarts, samples missing or overflowed.
    pub faults: u32,
    /// Dwells that were measured again; none on a platform without dwells.
    pub repeated: Option<usize>,
    /// Dwells that were left out; none on a platform without dwells.
    pub left_out: Option<usize>,
    /// Virtual time until the end, s.
    pub seconds: f64,
    /// Accesses that a data sheet forbids.
    pub violations: usize,
}

impl Row {
    /// Whether the fault did what no fault may.
    #[must_use]
    pub fn is_bad(&self) -> bool {
        matches!(self.outcome, "wrong" | "failed") || self.is_noticed == Some(false)
    }
}

/// How many faults these platforms have.
#[must_use]
pub fn count(platforms: &[Platform]) -> usize {
    platforms.iter().flat_map(|platform| Fault::all(*platform)).count()
}

/// Runs every fault of these platforms with every seed; `tick` after each.
pub fn rows(platforms: &[Platform], seeds: RangeInclusive<u64>, tick: Tick<'_>) -> Vec<Row> {
    let faults = platforms.iter().flat_map(|of| Fault::all(*of).map(move |fault| (*of, fault)));
    let cases: Vec<(Platform, Fault, u64)> = faults
        .flat_map(|(platform, fault)| seeds.clone().map(move |seed| (platform, fault, seed)))
        .collect();
    side_by_side(cases.into_iter(), tick, |(platform, fault, seed)| row(platform, fault, seed))
}

/// Runs one fault; a board that does not come to an end has failed.
fn row(platform: Platform, fault: Fault, seed: u64) -> Row {
    let ended = runs::run(platform, fault, seed);
    let failed = ended.as_ref().err().map(ToString::to_string);
    let Ended { error_sigmas, reason, events, health, dwells, seconds, violations } =
        ended.unwrap_or_default();
    Row {
        platform: platform.name(),
        fault: fault.to_string(),
        outcome: match error_sigmas {
            _ if failed.is_some() => "failed",
            None => "refused",
            Some(sigmas) if sigmas.abs() <= WRONG_SIGMAS => "ok",
            Some(_) => "wrong",
        },
        error_sigmas,
        reason: failed.or(reason),
        noticed: notice::first(&events).map(ToString::to_string),
        is_noticed: notice::is_noticed(fault.notice(), &events),
        faults: health.faults(),
        repeated: dwells.map(|[repeated, _]| repeated),
        left_out: dwells.map(|[_, left_out]| left_out),
        seconds,
        violations,
    }
}
