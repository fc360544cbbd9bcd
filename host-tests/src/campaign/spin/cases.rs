//! Many flights with noise: every method beside the Cramér–Rao bound, and whether σ covers the error.

use serde::Serialize;

use super::paper::rms_deg;
use super::world::{Flight, SCALE_ERROR, STEADY, drawn};
use crate::campaign::statistics::{Spread, rms};
use crate::campaign::{Tick, over};
use crate::methods::spin::errors::bound_rms;
use crate::output::degrees;

/// What the flights of a row are like.
#[derive(Clone, Copy, Debug)]
struct Case {
    name: &'static str,
    /// A flight but for its roll and spin, which are drawn.
    flight: Flight<'static>,
    /// The last moment without lift, s.
    held_s: Option<f64>,
}

/// A lift that is gone for 0.3 s.
const FADING: &[(f64, f64)] = &[(0.5, 30.0), (0.52, 0.0), (0.82, 0.0), (0.84, 30.0)];
/// A flight with much noise in the accelerometers.
const NOISY: Flight = Flight { noise_m_s2: 1.5, ..STEADY };

const CASES: [Case; COUNT] = [
    Case {
        name: "noise of 0.01 m/s²",
        flight: Flight { noise_m_s2: 0.01, ..STEADY },
        held_s: None,
    },
    Case { name: "noise of 1.5 m/s²", flight: NOISY, held_s: None },
    Case {
        name: "the same, and a gyro of 10 °/√h",
        flight: Flight { gyro_n_deg_sqrt_h: 10.0, ..NOISY },
        held_s: None,
    },
    Case {
        name: "noise of 1.5 m/s², no lift for 0.3 s",
        flight: Flight { seconds: 1.2, lift_m_s2: FADING, ..NOISY },
        held_s: Some(0.82),
    },
];

/// How many rows there are.
pub const COUNT: usize = 4;

/// What many flights amount to. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the flights' case.
    pub case: &'static str,
    /// Flights.
    pub runs: usize,
    /// Flights at whose end the roll was not known.
    pub lost: usize,
    /// RMS errors after the first 0.1 s, in the order of [`METHODS`](crate::methods::spin::METHODS).
    pub rms_deg: [f64; 3],
    /// RMS of the bounds over the same samples.
    pub limit_deg: f64,
    /// Flights in which the phase lock miscounted a turn.
    pub miscounted: usize,
    /// The phase lock at the end.
    pub end: Spot,
    /// The phase lock at the last moment without lift, of flights that have one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub held: Option<Spot>,
    /// RMS of the scale errors found less the true one.
    pub scale_rms: f64,
    /// RMS of their 1σ.
    pub scale_sigma: f64,
}

/// Errors of many flights at one moment.
#[derive(Clone, Debug, Serialize)]
pub struct Spot {
    /// Errors and the stated σ.
    #[serde(flatten)]
    pub spread: Spread,
    /// RMS of the bounds.
    pub limit_deg: f64,
}

/// One flight at one moment: error, σ and bound, °.
type Sight = [f64; 3];

impl Spot {
    fn of(sights: &[Sight]) -> Self {
        let spread = Spread::of(sights.iter().map(|[error, sigma, _]| [*error, *sigma]));
        Self { spread, limit_deg: rms(sights.iter().map(|[.., bound]| bound)) }
    }
}

/// What one flight gave.
struct One {
    rms_deg: [f64; 3],
    limit_deg: f64,
    is_miscounted: bool,
    end: Option<Sight>,
    held: Option<Sight>,
    scale: Option<[f64; 2]>,
}

/// One row.
///
/// # Panics
/// Where there is no such case.
pub fn row(case: usize, runs: usize, tick: Tick<'_>) -> Row {
    let case = CASES[case];
    let all = over(runs, tick, |seed| fly(&case, seed));
    let ends: Vec<Sight> = all.iter().filter_map(|one| one.end).collect();
    let held: Vec<Sight> = all.iter().filter_map(|one| one.held).collect();
    let scales: Vec<[f64; 2]> = all.iter().filter_map(|one| one.scale).collect();
    Row {
        case: case.name,
        runs: all.len(),
        lost: all.len() - ends.len(),
        rms_deg: [0, 1, 2].map(|index: usize| rms(all.iter().map(|one| one.rms_deg[index]))),
        limit_deg: rms(all.iter().map(|one| one.limit_deg)),
        miscounted: all.iter().filter(|one| one.is_miscounted).count(),
        end: Spot::of(&ends),
        held: case.held_s.map(|_| Spot::of(&held)),
        scale_rms: rms(scales.iter().map(|[error, _]| error)),
        scale_sigma: rms(scales.iter().map(|[_, sigma]| sigma)),
    }
}

/// What the methods make of a flight.
fn fly(case: &Case, seed: u64) -> One {
    let (roll_rad, spin) = drawn(seed, case.flight.seconds);
    let recorded = Flight { roll_rad, spin_rad_s: &spin, ..case.flight }.fly(seed);
    let (all, bounds) = (recorded.tracked(), recorded.bounds());
    let [.., (locked, errors)] = &all;
    let sight = |index: usize| {
        let sigma = locked.sigmas_rad[index];
        let sight = [errors.wrapped_rad[index], sigma, bounds[index]];
        (!sigma.is_nan()).then(|| sight.map(degrees))
    };
    let index_at = |time_s: f64| locked.times_s.partition_point(|t| *t <= time_s) - 1;
    One {
        rms_deg: all.each_ref().map(|(_, errors)| rms_deg(errors)),
        limit_deg: degrees(bound_rms(locked, &bounds).unwrap_or(f64::NAN)),
        is_miscounted: errors.turns_lost > 0,
        end: sight(bounds.len() - 1),
        held: case.held_s.and_then(|time_s| sight(index_at(time_s))),
        scale: locked.end.scale.map(|[scale, sigma]| [scale - SCALE_ERROR, sigma]),
    }
}
