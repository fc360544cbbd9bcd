//! Burov's Table 1, what it says of keeping: the azimuth stored for half an hour, pitch and roll meanwhile.
//!
//! The classes and their gyros are those of [`crate::campaign::burov::classes`]; each is driven without a halt, after an alignment
//! as good as its gyro allows or with an azimuth from outside.

pub mod limit;
pub(super) mod report;
mod world;

use serde::Serialize;

use self::limit::stored_sigma;
use self::world::{Fitting, MARK_S, Mark, Mount, Pair, STORED_S, Sheet};
use super::burov::classes::{CLASSES, Class, Way};
use super::burov::{BIAS_DEG_H, Grade};
use super::statistics::Spread;
use super::{Tick, over};
use crate::output::degrees;

/// A class, and what it is fitted with.
struct Case {
    class: usize,
    fitting: Fitting,
    /// Whether the row is to be met; else it stands beside one that is.
    is_wanted: bool,
}

/// Bias of tactical micromechanical gyros, 1σ, °/h, and their scale: STIM300 (data sheet TS1524, ±500 ppm), after
/// it has warmed up.
const TACTICAL: [f64; 2] = [5.0, 5e-4];
/// Bias of calibrated fibre-optic gyros, 1σ, °/h, as for [`classes`](super::burov::classes), and their scale: 100 ppm.
const FIBRE: [f64; 2] = [BIAS_DEG_H, 1e-4];
/// Biases of accelerometers, 1σ, m/s²: 0.75 mg of STIM300 from start to start; half a milli-g once calibrated.
const FORCE: [f64; 2] = [7.5e-3, 5e-3];

/// The rows, then what stands beside them.
const CASES: [Case; COUNT] = [
    Case::wanted(0, Mount::Strapdown, TACTICAL, FORCE[0]),
    Case::wanted(1, Mount::Strapdown, [BIAS_DEG_H, 2e-4], FORCE[1]),
    Case::wanted(2, Mount::TwoFrame(Pair::Tactical), FIBRE, FORCE[1]),
    Case::wanted(3, Mount::TwoFrame(Pair::Tactical), FIBRE, FORCE[1]),
    Case::wanted(4, Mount::TwoFrame(Pair::Tactical), FIBRE, FORCE[1]),
    Case { is_wanted: false, ..Case::wanted(2, Mount::TwoFrame(Pair::Coarse), FIBRE, FORCE[1]) },
    Case { is_wanted: false, ..Case::wanted(3, Mount::Strapdown, FIBRE, FORCE[1]) },
];

/// How many rows there are.
pub const COUNT: usize = 7;

/// The errors so many seconds after the azimuth was handed over.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Growth {
    /// How long.
    pub seconds: f64,
    /// Errors of the azimuth.
    pub azimuth: Spread,
    /// Errors of pitch and roll.
    pub level: Spread,
}

/// A row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Name of the class.
    pub class: &'static str,
    /// What its azimuth may be off after the half hour, 1σ, °.
    pub wanted_azimuth_deg: f64,
    /// What its pitch and roll may be off, 1σ, °.
    pub wanted_level_deg: f64,
    /// The gyro in words.
    pub gyro: &'static str,
    /// Gyros of the unit.
    pub grade: Grade,
    /// How the unit is mounted.
    pub mount: String,
    /// 1σ of the accelerometers' biases.
    pub force_bias_m_s2: f64,
    /// How the unit came to its azimuth.
    pub way: String,
    /// Number of runs.
    pub runs: usize,
    /// Runs in which the azimuth was lost.
    pub lost: usize,
    /// The azimuth after the half hour, at rest.
    pub azimuth: Spread,
    /// The azimuth when the vehicle stops driving.
    pub azimuth_driving: Spread,
    /// What its start and the gyro after its rest leave at least.
    pub azimuth_limit_deg: f64,
    /// Pitch and roll after the half hour, at rest.
    pub level_at_rest: Spread,
    /// Pitch and roll on the way.
    pub level: Spread,
    /// Minute by minute.
    pub growth: Vec<Growth>,
    /// Whether the row is to be met.
    pub is_wanted: bool,
    /// Whether it is met.
    pub is_met: bool,
}

/// One of the rows; those that are to be met come first.
///
/// # Panics
/// Where the index is not below [`COUNT`].
#[must_use]
pub fn row(case: usize, runs: usize, tick: Tick<'_>) -> Row {
    let case = &CASES[case];
    let class = &CLASSES[case.class];
    let fitting = &case.fitting;
    let (way, start_sigma_deg) = start(class);
    // No row shares its draws with another.
    let first = (case.class as u64 * 2 + u64::from(case.is_wanted)) << 32;
    let days = over(runs, tick, |seed| fitting.live(start_sigma_deg, first + seed));
    let last = || days.iter().filter_map(|day| day.last());
    let on_way = days.iter().flat_map(|day| day.split_last().map_or(&[][..], |(_, way)| way));
    let (azimuth, level) = (azimuths(last()), levels(on_way));
    let driving = days.iter().filter_map(|day| day.iter().nth_back(1));
    let lost = last().filter(|mark| mark.azimuth.is_none()).count();
    let is_good = azimuth.rms_deg <= class.stored_deg && level.rms_deg <= class.level_deg;
    Row {
        class: class.name,
        wanted_azimuth_deg: class.stored_deg,
        wanted_level_deg: class.level_deg,
        gyro: class.gyro,
        grade: class.grade,
        mount: fitting.mount.to_string(),
        force_bias_m_s2: fitting.force_bias_m_s2,
        way,
        runs: days.len(),
        lost,
        azimuth,
        azimuth_driving: azimuths(driving),
        azimuth_limit_deg: limit_deg(fitting, start_sigma_deg),
        level_at_rest: levels(last()),
        level,
        growth: growth(&days),
        is_wanted: case.is_wanted,
        is_met: lost == 0 && is_good,
    }
}

/// Errors of the azimuths.
fn azimuths<'a>(marks: impl Iterator<Item = &'a Mark> + Clone) -> Spread {
    Spread::of(marks.filter_map(|mark| mark.azimuth))
}

/// Errors of pitch and roll.
fn levels<'a>(marks: impl Iterator<Item = &'a Mark> + Clone) -> Spread {
    Spread::of(marks.flat_map(|mark| mark.level.map(|error| [error, mark.level_sigma])))
}

impl Case {
    const fn wanted(
        class: usize,
        mount: Mount,
        [bias_deg_h, scale_sigma]: [f64; 2],
        force_bias_m_s2: f64,
    ) -> Self {
        let precise = Sheet { grade: CLASSES[class].grade, bias_deg_h, scale_sigma };
        Self { class, fitting: Fitting { precise, mount, force_bias_m_s2 }, is_wanted: true }
    }
}

/// How a class comes to its azimuth, and 1σ of that, °.
fn start(class: &Class) -> (String, f64) {
    match (class.way, class.planned_sigma_deg()) {
        (Way::HandedOver(sigma), _) => (format!("handed over with 1σ {sigma}°"), sigma),
        (Way::Gyrocompassing, Some(sigma)) => (format!("aligned to 1σ {sigma:.3}°"), sigma),
        (Way::Gyrocompassing, None) => ("no schedule fits".to_owned(), f64::NAN),
    }
}

/// 1σ of the azimuth after the half hour, °, that the start and the gyro's N, B, K and R leave after its rest.
fn limit_deg(fitting: &Fitting, start_sigma_deg: f64) -> f64 {
    let (noise, start) = (fitting.precise.grade.noise(), start_sigma_deg.to_radians());
    degrees(stored_sigma(&noise, start, fitting.learnt_s(), STORED_S))
}

/// What the errors were minute by minute.
fn growth(days: &[Vec<Mark>]) -> Vec<Growth> {
    let minutes = (STORED_S / MARK_S) as usize;
    let of = |index: usize| {
        let marks = || days.iter().filter_map(move |day| day.get(index));
        Growth {
            seconds: (index + 1) as f64 * MARK_S,
            azimuth: azimuths(marks()),
            level: levels(marks()),
        }
    };
    (0..minutes).map(of).collect()
}
