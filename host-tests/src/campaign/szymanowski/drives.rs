//! Drives between stops with gyros of the LN-200 class: the azimuth that averaging gave at the first stop,
//! the paper's, and that of everything that is known.

use hal_mock::vehicle::scenario::Scenario;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stops::plain;
use orientation::alignment::stops::stop_detector::Rests;
use orientation::units::Seconds;
use serde::Serialize;

use super::world::{Day, Known, live};
use crate::campaign::statistics::{Answer, Precision, greatest, rms};
use crate::campaign::{Tick, over};
use crate::output::{azimuth_error, degrees, degrees_per_hour};

/// Length of a stop, s.
pub const STOP_S: f64 = 60.0;
/// Driving in all, s.
pub const DRIVE_S: f64 = 900.0;
/// Latitude, °.
pub const LATITUDE_DEG: f64 = 52.0;
/// The gyros' N, °/√h, and 1σ of their biases, °/h.
pub const GYRO: [f64; 2] = [0.05, 1.0];

/// What a row's vehicles do, and what the session is given of it.
#[derive(Clone, Copy, Debug)]
struct Case {
    name: &'static str,
    stops: usize,
    /// Whether the stops are stated; else the criteria find them.
    is_stated: bool,
    knows_displacement: bool,
}

/// Two stops of which all is given.
const TWO: Case = Case { name: "two stops", stops: 2, is_stated: true, knows_displacement: true };

const CASES: [Case; COUNT] = [
    TWO,
    Case { name: "two stops, found by the criteria", is_stated: false, ..TWO },
    Case { name: "two stops, displacement not known", knows_displacement: false, ..TWO },
    Case { name: "three stops", stops: 3, ..TWO },
];

/// How many rows there are.
pub const COUNT: usize = 4;

/// Many drives. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// What the vehicles did and what was known of it.
    pub case: &'static str,
    /// How many stops they made.
    pub stops: usize,
    /// Before: RMS error of averaging over the first stop, at the start.
    pub averaging_rms_deg: f64,
    /// RMS error of the paper's method at the start.
    pub plain_rms_deg: f64,
    /// RMS of the σ that goes with it.
    pub plain_sigma_deg: f64,
    /// Greatest difference between the closed form and Brent's search for the least angle.
    pub brent_difference_deg: f64,
    /// Greatest difference between the closed form and the least of the paper's Euler form.
    pub euler_difference_deg: f64,
    /// RMS of the biases' errors over their σ; not a number where no drive showed them.
    pub bias_ratio: Option<f64>,
    /// RMS of the biases' σ, °/h.
    pub bias_sigma_dph: Option<f64>,
    /// The azimuths at the end by everything that is known, against limit and σ.
    #[serde(flatten)]
    pub precision: Precision,
    /// Error of averaging and error of the azimuth at the end, drive by drive.
    #[serde(skip)]
    pub errors: Vec<(f64, f64)>,
}

/// One drive, °.
struct Run {
    averaging: f64,
    /// Error of the paper's method, its σ, and by how much Brent's search and the Euler form differ.
    plain: Option<[f64; 4]>,
    /// Errors of the biases over their σ, and those σ, °/h.
    biases: Option<[[f64; 2]; 3]>,
    answer: Result<Answer, Refusal>,
}

/// One of the cases alone.
///
/// # Panics
/// Where the index is not below [`COUNT`].
#[must_use]
pub fn row(case: usize, runs: usize, tick: Tick<'_>) -> Row {
    let case = CASES[case];
    let runs = over(runs, tick, |seed| case.run(seed));
    let plain = |part: usize| runs.iter().filter_map(move |run| Some(run.plain?[part]));
    let biases: Vec<[f64; 2]> = runs.iter().filter_map(|run| run.biases).flatten().collect();
    let of_biases =
        |part: usize| (!biases.is_empty()).then(|| rms(biases.iter().map(|both| both[part])));
    let errors = runs.iter().filter_map(|run| Some((run.averaging, run.answer.ok()?.error)));
    Row {
        case: case.name,
        stops: case.stops,
        averaging_rms_deg: rms(runs.iter().map(|run| run.averaging)),
        plain_rms_deg: rms(plain(0)),
        plain_sigma_deg: rms(plain(1)),
        brent_difference_deg: greatest(plain(2)),
        euler_difference_deg: greatest(plain(3)),
        bias_ratio: of_biases(0),
        bias_sigma_dph: of_biases(1),
        precision: Precision::of(runs.iter().map(|run| &run.answer)),
        errors: errors.collect(),
    }
}

impl Case {
    fn run(&self, seed: u64) -> Run {
        let drives = (self.stops - 1) as f64;
        let stops = self.stops as f64;
        // As long as two stops and one drive, whatever the number of stops.
        let drive_s = (DRIVE_S - (stops - 2.0) * STOP_S) / drives;
        let scenario = Scenario::stops(seed, self.stops, STOP_S, drive_s);
        let stated = scenario.configuration().stops().map(|stop| stop.map(Seconds)).collect();
        let rests = if self.is_stated { Rests::Stated(stated) } else { Rests::Found };
        let known = Known { rests, knows_displacement: self.knows_displacement };
        Run::of(&live(&scenario, seed, known))
    }
}

impl Run {
    fn of(day: &Day) -> Self {
        let averaging = azimuth_error(degrees(day.first.azimuth()), degrees(day.start));
        let found = day.conclusion.found.as_ref();
        Self {
            averaging,
            plain: found.map(|found| plainly(&found.plain, day.start)),
            biases: found.filter(|found| found.are_biases_observed).map(|found| {
                std::array::from_fn(|axis| {
                    let sigma = found.bias_sigmas[axis];
                    [(found.biases[axis].0 - day.biases[axis]) / sigma.0, degrees_per_hour(sigma.0)]
                })
            }),
            answer: day.answer(),
        }
    }
}

/// Error and σ of the paper's method at the start, and by how much its other forms differ from the closed one, °.
fn plainly(plain: &plain::Plain, start: f64) -> [f64; 4] {
    let closed = plain.azimuth.0;
    let [error, brent, euler] =
        [(closed, start), (plain.angle.at, closed), (plain.euler.at, closed)]
            .map(|(azimuth, from)| azimuth_error(degrees(azimuth), degrees(from)));
    [error, plain.sigma.degrees(), brent, euler]
}
