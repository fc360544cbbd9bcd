//! The paper's Table 1: five classes of orientation system, each with a gyro that meets its row.
//!
//! The rows of azimuth and time are met by simulation: three classes find north themselves, for the
//! two lightest an azimuth is handed over from outside and stored by the gyro until the time is over.

use hal_mock::gyro::Gyro;
use orientation::alignment::{Azimuth, Refusal, Solution};
use orientation::attitude::{Gyro as Known, Keeper, Setting};
use orientation::planner::{Plan, Rotation, for_time};
use orientation::signal::InertialSample;
use orientation::units::{Radians, RadiansPerSecond, Seconds};
use serde::Serialize;

use super::{BIAS_DEG_H, Grade, RATE_HZ, Trial, latitude};
use crate::campaign::chance::Chance;
use crate::campaign::keep::limit::stored_sigma;
use crate::campaign::statistics::{Answer, Precision};
use crate::campaign::{Tick, one_by_one, over};
use crate::methods::stops::samples::Converter;

/// How long the stage turns: its motor driver's ramp at 0.35 rad/s, with slopes and rest.
const STAGE: Rotation =
    Rotation { rest: Seconds(0.7), speed: RadiansPerSecond(0.35), wraps: false };
/// What comes before the first dwell and after the last, s: homing, levelling, the answer.
const OVERHEAD: f64 = 25.0;
/// Rest before an azimuth is stored, s, in which the gyro's bias is learnt.
const REST: f64 = 20.0;

/// How a class comes to its azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Way {
    /// The board finds north itself.
    Gyrocompassing,
    /// An azimuth is handed over with this 1σ, °, and stored.
    HandedOver(f64),
}

/// A class of the paper's Table 1, and the gyro that is to meet it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Class {
    /// Name of the class.
    #[serde(rename = "class")]
    pub name: &'static str,
    /// Azimuth that is wanted, °, 3σ.
    pub wanted_deg: f64,
    /// In so many minutes.
    pub minutes: f64,
    /// Azimuth after half an hour of storage, and pitch and roll meanwhile, °, 1σ.
    #[serde(skip)]
    pub(crate) stored_deg: f64,
    #[serde(skip)]
    pub(crate) level_deg: f64,
    /// The gyro in words.
    pub gyro: &'static str,
    /// Gyro of the class.
    pub grade: Grade,
    #[serde(skip)]
    pub(crate) way: Way,
}

/// The five rows.
pub(crate) const CLASSES: [Class; 5] = [
    Class {
        name: "very lightweight",
        wanted_deg: 0.60,
        minutes: 1.0,
        stored_deg: 1.20,
        level_deg: 0.60,
        gyro: "MEMS",
        grade: grade(0.15, 0.5, 2.0, 0.0),
        way: Way::HandedOver(0.15),
    },
    Class {
        name: "light",
        wanted_deg: 0.48,
        minutes: 5.0,
        stored_deg: 0.60,
        level_deg: 0.36,
        gyro: "good MEMS or small fibre-optic",
        grade: grade(0.03, 0.2, 0.2, 0.0),
        way: Way::HandedOver(0.12),
    },
    Class {
        name: "light reconnaissance",
        wanted_deg: 0.36,
        minutes: 5.0,
        stored_deg: 0.36,
        level_deg: 0.24,
        gyro: "fibre-optic",
        grade: grade(0.003, 0.01, 0.0, 0.1),
        way: Way::Gyrocompassing,
    },
    Class {
        name: "average multifunctional",
        wanted_deg: 0.24,
        minutes: 5.0,
        stored_deg: 0.15,
        level_deg: 0.12,
        gyro: "fibre-optic, OIUS-1000",
        grade: grade(0.001, 0.007, 0.0, 0.127),
        way: Way::Gyrocompassing,
    },
    Class {
        name: "remote-control station",
        wanted_deg: 0.48,
        minutes: 6.0,
        stored_deg: 0.18,
        level_deg: 0.12,
        gyro: "fibre-optic",
        grade: grade(0.004, 0.015, 0.0, 0.1),
        way: Way::Gyrocompassing,
    },
];

const fn grade(n: f64, b: f64, k: f64, r: f64) -> Grade {
    Grade { n_deg_sqrt_h: n, b_deg_h: b, k_deg_h_sqrt_h: k, r_deg_h2: r }
}

/// A row of the table.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The class and its gyro.
    #[serde(flatten)]
    pub class: Class,
    /// How it comes to its azimuth.
    pub way: String,
    /// Three times the RMS error, °.
    pub three_rms_deg: f64,
    /// Three times what is the least for this gyro and schedule, °.
    pub three_limit_deg: f64,
    /// Per cent of errors within 1, 2 and 3 σ.
    pub coverage_percent: [f64; 3],
    /// Number of runs.
    pub runs: usize,
    /// Runs that were refused.
    pub refused: usize,
    /// Whether the row is met.
    pub is_met: bool,
}

/// The five rows over `runs` runs each.
#[must_use]
pub fn rows(runs: usize, tick: Tick<'_>) -> Vec<Row> {
    one_by_one(&CLASSES, tick, |class| class.row(runs, tick))
}

/// Number of classes.
pub const COUNT: usize = CLASSES.len();

impl Class {
    fn row(&self, runs: usize, tick: Tick<'_>) -> Row {
        let (way, precision) = match self.way {
            Way::Gyrocompassing => self.found(runs, tick),
            Way::HandedOver(sigma) => self.stored(sigma, runs, tick),
        };
        let three_rms_deg = 3.0 * precision.rms_deg;
        Row {
            class: *self,
            way,
            three_rms_deg,
            three_limit_deg: 3.0 * precision.limit_deg,
            coverage_percent: precision.coverage_percent,
            runs: precision.runs,
            refused: precision.refused,
            is_met: precision.refused == 0 && three_rms_deg <= self.wanted_deg,
        }
    }

    /// The best schedule for the time that is left.
    fn plan(&self) -> Option<Plan> {
        for_time(&self.grade.conditions(STAGE), Seconds(60.0 * self.minutes - OVERHEAD)).ok()
    }

    /// 1σ of the azimuth that it finds, as planned, °.
    pub(crate) fn planned_sigma_deg(&self) -> Option<f64> {
        self.plan().map(|plan| plan.sigma(latitude()).degrees())
    }

    /// North by that schedule.
    fn found(&self, runs: usize, tick: Tick<'_>) -> (String, Precision) {
        let Some(plan) = self.plan() else {
            return ("no schedule fits".to_owned(), Precision::of::<Refusal>(&[]));
        };
        let trial = Trial { grade: self.grade, plan, rotation: STAGE };
        let answers = over(runs, tick, |seed| trial.answer(seed));
        let way = format!("{} positions of {:.1} s", plan.positions(), plan.dwell.0);
        (way, Precision::of(&answers))
    }

    /// An azimuth from outside, stored until the time is over.
    fn stored(&self, sigma_deg: f64, runs: usize, tick: Tick<'_>) -> (String, Precision) {
        let answers = over(runs, tick, |seed| self.keep(sigma_deg, seed));
        (format!("handed over with 1σ {sigma_deg}°, stored"), Precision::of(&answers))
    }

    /// One azimuth of zero, handed over with an error of its own and kept on a base that turns.
    fn keep(&self, sigma_deg: f64, seed: u64) -> Result<Answer, Refusal> {
        let azimuth = (sigma_deg * Chance::new(seed, 1 << 20).normal()).to_radians();
        let sigma = sigma_deg.to_radians();
        let mut base = Base::new(&self.grade, seed);
        let mut keeper = Keeper::new(&self.setting());
        for _ in 0..(REST * RATE_HZ) as u32 {
            keeper.push(&base.sample(0.0));
        }
        keeper.hand_over(Azimuth { angle: Radians(azimuth), sigma: Radians(sigma) });
        let samples = ((60.0 * self.minutes - REST) * RATE_HZ) as u32;
        // The vehicle turns by a turn and a half in all: an azimuth of 180° at the end.
        let turning = 3.0 * std::f64::consts::PI / (f64::from(samples) / RATE_HZ);
        for _ in 0..samples {
            keeper.push(&base.sample(turning));
        }
        let stored = f64::from(samples) / RATE_HZ;
        let limit = stored_sigma(&self.grade.noise(), sigma, REST, stored);
        let lost = Azimuth { angle: Radians(f64::NAN), sigma: Radians(f64::NAN) };
        let azimuth = keeper.report().azimuth.unwrap_or(lost);
        Answer::of(Ok(Solution { azimuth, limit: Radians(limit) }), 180.0)
    }

    /// What the keeper is given: the class's gyro about the axis down, coarse ones beside it.
    fn setting(&self) -> Setting {
        Setting::coarse(latitude(), Seconds(1.0 / RATE_HZ)).with_down(Known {
            noise: self.grade.noise(),
            bias_sigma: RadiansPerSecond::from_degrees_per_hour(BIAS_DEG_H),
            scale_sigma: 0.0,
        })
    }
}

/// A level base whose gyro down is simulated and whose other sensors are perfect.
struct Base {
    gyro: Gyro,
    path: Converter,
    azimuth: f64,
    index: u32,
}

impl Base {
    fn new(grade: &Grade, seed: u64) -> Self {
        let gyro = Gyro::new(&grade.simulated(), RATE_HZ, seed);
        Self { gyro, path: Converter::default(), azimuth: 0.0, index: 0 }
    }

    /// The next sample, the base turning at a rate, rad/s.
    fn sample(&mut self, turning: f64) -> InertialSample {
        let seconds = 1.0 / RATE_HZ;
        let elapsed = f64::from(self.index) * seconds;
        self.index += 1;
        let middle = self.azimuth + 0.5 * turning * seconds;
        self.azimuth += turning * seconds;
        let level = latitude().horizontal_rate();
        let steady = self.gyro.steady(turning - latitude().vertical_rate().0, [0.0; 2]);
        let down = self.gyro.sample(steady, elapsed, 25.0);
        let rates = [level.0 * middle.cos(), -level.0 * middle.sin(), down];
        let force = [0.0, 0.0, -latitude().gravity().0];
        self.path.sample(elapsed + seconds, rates.map(|rate| rate * seconds), force)
    }
}
