//! A gyro on a stage that stops: drawn instruments, and what goes wrong with stage, base, gyro and
//! accelerometer.

mod classes;

use std::f64::consts::TAU;

use hal_mock::disturbance::Effect;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::Instruments;
use hal_mock::stage::{Stage, Stop};
use orientation::alignment::Method;
use orientation::alignment::stepwise::{Session, level};
use orientation::math::regression::{Column as Coefficient, Regression};

use super::axes::shown;
use super::class::{Aligned, Subject};
use super::unit::{Grade, Rig, Unit};
use super::{FEW_RESIDUALS, Platform};
use crate::assumptions::unseen;
use crate::campaign::chance::Chance;
use crate::methods::asked::Asked;
use crate::methods::stepwise::replay;
use crate::output::degrees;
use crate::recording::{Body, StageRow};

/// A stage that stops.
pub(super) const PLATFORM: Platform = Platform::of::<Instrument>("stage", classes::classes);

/// The random stream of an instrument: none of those that a world draws from.
const DRAWN: u64 = 2_001;
/// N of its gyro, °/√h.
const N: [f64; 2] = [5e-4, 1e-2];

/// A drawn instrument on its stage.
#[derive(Clone, Debug)]
struct Instrument {
    unit: Unit,
    stops: Vec<Stop>,
    has_temperature: bool,
}

impl Instrument {
    /// One on an arc that does not come back.
    fn one_way(seed: u64) -> Self {
        let mut stops = stops(&mut Chance::new(seed, Self::FAULT + 3), 0.0);
        stops.pop();
        Self { stops, ..Self::drawn(seed) }
    }

    /// When the stage leaves its `index`-th stop, s.
    fn departure(&self, index: usize) -> f64 {
        let through =
            |(k, stop): (usize, &Stop)| stop.dwell_s + if k > 0 { stop.rotation_s } else { 0.0 };
        self.stops.iter().enumerate().take(index + 1).map(through).sum()
    }

    /// The recording.
    fn rows(&self) -> Vec<StageRow> {
        let mut instruments = Instruments::new(&self.unit.instruments, self.unit.seed);
        let mut stage = Stage::new(&self.stops, Self::RATE_HZ);
        let (mut drifting, mut column) = self.at_work();
        let mut rows = Vec::new();
        while let Some(state) = stage.state(rows.len() as u64) {
            let time_s = rows.len() as f64 / Self::RATE_HZ;
            match self.unit.base.at(time_s) {
                Some(motion) => instruments.turn_on(state, &motion),
                None => instruments.turn(state),
            }
            let rate_rad_s = drifting.rate(&self.unit.drift, time_s, state.angle_rad);
            let sample = instruments.sample(time_s, &Effect { rate_rad_s, ..Effect::default() });
            rows.push(StageRow {
                line: rows.len() as u64 + 1,
                time_s,
                stage_rad: self.unit.shown_rad(sample.stage_rad, time_s),
                rate_rad_s: column.show(sample.rate_rad_s),
                force_m_s2: shown(&self.unit.axes, sample.force_m_s2),
                temperature_c: self.has_temperature.then_some(sample.temperature_c),
                force_is_new: true,
                elevation_rad: None,
                base: None,
            });
        }
        rows
    }
}

impl Subject for Instrument {
    const NAME: &'static str = "";
    const FAULT: u64 = 2_002;

    fn drawn(seed: u64) -> Self {
        let mut chance = Chance::new(seed, DRAWN);
        let grade = Grade::drawn(&mut chance, N);
        let kappa = grade.g_sensitivity(&mut chance);
        let level = |_: &mut Chance| GyroConfiguration::default().axis_elevation_rad;
        let instruments = grade.instruments(&mut chance, Self::RATE_HZ, kappa, level);
        let header = grade.header(Self::RATE_HZ, chance.happens(0.7));
        Self {
            unit: Unit::new(seed, &instruments, header),
            stops: stops(&mut chance, 0.9),
            has_temperature: chance.happens(0.3),
        }
    }

    fn seed(&self) -> u64 {
        self.unit.seed
    }

    fn align(&self) -> Aligned {
        let body = Body::Stage(self.rows());
        replay(&self.unit.header, &body, &Asked::default(), |_| ())
            .map_or_else(Aligned::refused, |replay| aligned(&replay.session, self.truth_deg()))
    }

    fn is_few(&self) -> bool {
        self.stops.len() < FEW_RESIDUALS + 3
    }
}

impl Rig for Instrument {
    const MEAN: &'static str = "dwell";
    const MIDWAY: &'static str = "between two dwells";
    /// The noise of a dwell does not depend on it.
    const RATE_HZ: f64 = 25.0;

    fn on_circle(seed: u64) -> Self {
        let stops = stops(&mut Chance::new(seed, Self::FAULT + 3), 1.0);
        Self { stops, ..Self::drawn(seed) }
    }

    fn unit(&self) -> &Unit {
        &self.unit
    }

    fn unit_mut(&mut self) -> &mut Unit {
        &mut self.unit
    }

    fn seconds(&self) -> f64 {
        Stage::new(&self.stops, Self::RATE_HZ).seconds()
    }

    /// In a rotation, with a quarter of the dwells or more on either side: in fewer, of some headings, neither the
    /// heading before nor that after shows.
    fn some_time(&self, chance: &mut Chance) -> f64 {
        let dwells = self.stops.len();
        let quarter = dwells.div_ceil(4);
        let (first, last) = (quarter - 1, dwells - 1 - quarter);
        let index = (chance.between(first as f64, last as f64 + 1.0) as usize).min(last);
        self.departure(index) + 0.5 * self.stops[index + 1].rotation_s
    }

    fn mean_sigma(&self) -> f64 {
        let seconds = self.stops.first().map_or(1.0, |stop| stop.dwell_s);
        self.sample_sigma() / (seconds * Self::RATE_HZ).sqrt()
    }

    fn rates(&self) -> Vec<f64> {
        self.rows().iter().map(|row| row.rate_rad_s).collect()
    }
}

/// What a session found, and what plain least squares on all dwells give: nothing is left out.
fn aligned(session: &Session, truth_deg: f64) -> Aligned {
    Aligned::of(session.verdict(), plain_deg(session), &unseen::of_stage(session), truth_deg)
}

/// The azimuth of plain least squares, °.
fn plain_deg(session: &Session) -> Option<f64> {
    let setting = &session.setting;
    let dwells = session.dwells();
    let tilt = level::tilt(setting, dwells.iter());
    let mut regression = Regression::<3>::default();
    for dwell in dwells {
        let axis = tilt.sensitive_axis(dwell.stage.rad());
        let left = dwell.rate.0 + setting.site.latitude.vertical_rate().0 * axis[2];
        regression.push(&[axis[0], -axis[1], 1.0], left);
    }
    let [north, east, _] = regression.solve(&[Coefficient::Free; 3])?.coefficients;
    Some(degrees(east.atan2(north)))
}

/// Where the stage goes: a circle, or an arc, and back to the first position.
fn stops(chance: &mut Chance, circles: f64) -> Vec<Stop> {
    let positions = chance.one_of(&[8, 12, 16, 24]);
    let (dwell_s, rotation_s) = (chance.between(5.0, 12.0), chance.between(1.0, 2.5));
    let is_circle = chance.happens(circles);
    let whole = if is_circle { TAU } else { chance.between(0.3, 0.6) * TAU };
    let start = chance.between(0.0, TAU);
    let step = whole / f64::from(positions);
    let mut list: Vec<f64> = (0..positions).map(|k| start + f64::from(k) * step).collect();
    list.push(start);
    list.into_iter().map(|angle| Stop::new(angle, dwell_s).after(rotation_s)).collect()
}
