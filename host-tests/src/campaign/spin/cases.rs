//! Many flights with noise: every method beside the Cramér–Rao bound, and whether σ covers the error.

use serde::Serialize;

use super::paper::{errors, track};
use super::world::{Flight, Recorded, SCALE_ERROR, drawn};
use crate::campaign::over;
use crate::campaign::statistics::{Spread, rms};
use crate::methods::spin::METHODS;
use crate::methods::spin::errors::bound_rms;
use crate::output::degrees;

/// What the flights of a row are like.
#[derive(Clone, Copy, Debug)]
struct Case {
    name: &'static str,
    seconds: f64,
    lift_m_s2: &'static [(f64, f64)],
    noise_m_s2: f64,
    gyro_n_deg_sqrt_h: f64,
    /// The last moment without lift, s.
    held_s: Option<f64>,
}

/// A lift that holds a heavy body and grows a little: that of the recordings.
const STEADY: &[(f64, f64)] = &[(0.0, 30.0), (1.0, 35.0)];
/// A lift that is gone for 0.3 s.
const FADING: &[(f64, f64)] = &[(0.5, 30.0), (0.52, 0.0), (0.82, 0.0), (0.84, 30.0)];

/// Flights with so much noise in the accelerometers.
const fn noisy(name: &'static str, noise_m_s2: f64) -> Case {
    Case { name, seconds: 1.0, lift_m_s2: STEADY, noise_m_s2, gyro_n_deg_sqrt_h: 0.0, held_s: None }
}

const CASES: [Case; COUNT] = [
    noisy("noise of 0.01 m/s²", 0.01),
    noisy("noise of 1.5 m/s²", 1.5),
    Case { gyro_n_deg_sqrt_h: 10.0, ..noisy("the same, and a gyro of 10 °/√h", 1.5) },
    Case {
        seconds: 1.2,
        lift_m_s2: FADING,
        held_s: Some(0.82),
        ..noisy("noise of 1.5 m/s², no lift for 0.3 s", 1.5)
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
    /// RMS errors after the first 0.1 s, in the order of [`METHODS`].
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
        let pairs: Vec<[f64; 2]> =
            sights.iter().map(|[error, sigma, _]| [*error, *sigma]).collect();
        let bounds: Vec<f64> = sights.iter().map(|[.., bound]| *bound).collect();
        Self { spread: Spread::of(&pairs), limit_deg: rms(&bounds) }
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
pub fn row(case: usize, runs: usize, tick: &(impl Fn() + Sync)) -> Row {
    let case = CASES[case];
    let all = over(runs, tick, |seed| fly(&case, seed));
    let ends: Vec<Sight> = all.iter().filter_map(|one| one.end).collect();
    let held: Vec<Sight> = all.iter().filter_map(|one| one.held).collect();
    let scales: Vec<[f64; 2]> = all.iter().filter_map(|one| one.scale).collect();
    let of = |value: &dyn Fn(&One) -> f64| rms(&all.iter().map(value).collect::<Vec<f64>>());
    let of_scale = |index: usize| rms(&scales.iter().map(|scale| scale[index]).collect::<Vec<_>>());
    Row {
        case: case.name,
        runs,
        lost: runs - ends.len(),
        rms_deg: [0, 1, 2].map(|index: usize| of(&|one| one.rms_deg[index])),
        limit_deg: of(&|one| one.limit_deg),
        miscounted: all.iter().filter(|one| one.is_miscounted).count(),
        end: Spot::of(&ends),
        held: case.held_s.map(|_| Spot::of(&held)),
        scale_rms: of_scale(0),
        scale_sigma: of_scale(1),
    }
}

fn fly(case: &Case, seed: u64) -> One {
    let (roll_rad, spin_rad_s) = drawn(seed, case.seconds);
    let Case { seconds, lift_m_s2, noise_m_s2, gyro_n_deg_sqrt_h, .. } = *case;
    let spin_rad_s = &spin_rad_s;
    let flight = Flight { seconds, roll_rad, spin_rad_s, lift_m_s2, noise_m_s2, gyro_n_deg_sqrt_h };
    seen(case, &flight.fly(seed))
}

/// What the methods make of a flight.
fn seen(case: &Case, recorded: &Recorded) -> One {
    let tracks = METHODS.map(|method| track(method, recorded));
    let errors = [0, 1, 2].map(|index: usize| errors(&tracks[index], recorded));
    let bounds = recorded.bounds();
    let ([.., locked], [.., of_locked]) = (&tracks, &errors);
    let sight = |index: usize| {
        let sigma = locked.sigmas_rad[index];
        let all = [of_locked.wrapped_rad[index], sigma, bounds[index]];
        (!sigma.is_nan()).then(|| all.map(degrees))
    };
    let index_at = |time_s: f64| locked.times_s.partition_point(|t| *t <= time_s) - 1;
    One {
        rms_deg: [0, 1, 2].map(|i: usize| degrees(errors[i].rms_rad.unwrap_or(f64::NAN))),
        limit_deg: degrees(bound_rms(locked, &bounds).unwrap_or(f64::NAN)),
        is_miscounted: of_locked.turns_lost > 0,
        end: sight(bounds.len() - 1),
        held: case.held_s.and_then(|time_s| sight(index_at(time_s))),
        scale: locked.end.scale.map(|[scale, sigma]| [scale - SCALE_ERROR, sigma]),
    }
}
