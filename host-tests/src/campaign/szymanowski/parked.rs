//! Vehicles that stand: averaging against all of the recording in inertial space, quiet, swaying, and with
//! doors slammed.

use hal_mock::gyro::GyroConfiguration;
use hal_mock::plant::sway::SwayConfiguration;
use hal_mock::vehicle::scenario::{Scenario, fog};
use hal_mock::vehicle::{Leg, Stop};
use orientation::alignment::stops::stop_detector::Rests;
use serde::Serialize;

use super::drives::{DRIVE_S, STOP_S};
use super::world::{Known, live};
use crate::campaign::statistics::{Precision, rms};
use crate::campaign::{Tick, over};
use crate::output::{azimuth_error, degrees};

/// How long a vehicle with good gyros stands, s.
pub const PARKED_S: f64 = 660.0;
/// N of good gyros, °/√h, and 1σ of their biases, °/h.
pub const GOOD: [f64; 2] = [0.01, 0.02];

/// A row's vehicles.
#[derive(Clone, Copy, Debug)]
struct Case {
    name: &'static str,
    /// Whether their gyros are the good ones; else of the LN-200 class, and they stand for as long as the
    /// others take for their drive and stops.
    has_good_gyros: bool,
    sways: bool,
    has_doors: bool,
}

/// Vehicles with good gyros that nothing moves.
const QUIET: Case = Case { name: "quiet", has_good_gyros: true, sways: false, has_doors: false };

const CASES: [Case; COUNT] = [
    Case {
        name: "quiet, gyros of 1 °/h, as long as a drive and its stops",
        has_good_gyros: false,
        ..QUIET
    },
    QUIET,
    Case { name: "swaying", sways: true, ..QUIET },
    Case { name: "swaying, doors slammed", sways: true, has_doors: true, ..QUIET },
];

/// How many rows there are.
pub const COUNT: usize = 4;

/// Many parked vehicles. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the case.
    pub case: &'static str,
    /// RMS error of averaging all of it.
    pub averaging_rms_deg: f64,
    /// The azimuths of method `static` against limit and σ.
    #[serde(flatten)]
    pub precision: Precision,
}

/// One of the cases alone.
///
/// # Panics
/// Where the index is not below [`COUNT`].
#[must_use]
pub fn row(case: usize, runs: usize, tick: Tick<'_>) -> Row {
    let case = &CASES[case];
    let days = over(runs, tick, |seed| {
        let known = Known { rests: Rests::Whole, knows_displacement: false };
        let day = live(&case.scenario(seed), seed, known);
        let averaging = azimuth_error(degrees(day.whole.azimuth()), degrees(day.end));
        (averaging, day.answer())
    });
    let (averaging, answers): (Vec<_>, Vec<_>) = days.into_iter().unzip();
    Row { case: case.name, averaging_rms_deg: rms(&averaging), precision: Precision::of(&answers) }
}

impl Case {
    fn scenario(&self, seed: u64) -> Scenario {
        let seconds = if self.has_good_gyros { PARKED_S } else { DRIVE_S + 2.0 * STOP_S };
        let mut day = standing(seed, seconds, self.has_doors, self.sways);
        let [n_deg_sqrt_h, bias_sigma_deg_h] = GOOD;
        let good = GyroConfiguration { n_deg_sqrt_h, bias_sigma_deg_h, ..fog() };
        day.vehicle.gyros = [if self.has_good_gyros { good } else { fog() }; 3];
        day
    }
}

/// A day of a vehicle that stands for so many seconds, whether its doors are slammed, and whether it sways.
pub(in crate::campaign) fn standing(
    seed: u64,
    seconds: f64,
    has_doors: bool,
    sways: bool,
) -> Scenario {
    let mut day = Scenario::parked(seed, seconds);
    if !has_doors {
        day.events.clear();
    }
    for leg in &mut day.legs {
        if let (Leg::Stop(Stop { sway, .. }), false) = (leg, sways) {
            *sway = SwayConfiguration::default();
        }
    }
    day
}
