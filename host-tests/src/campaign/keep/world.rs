//! A vehicle that drives for half an hour with an azimuth that was handed over, and what its keeper makes of it.

use std::fmt;

use hal_mock::gyro::{Gyro as Simulated, GyroConfiguration};
use hal_mock::noise::Generator;
use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Leg, Stop, Vehicle, VehicleSample};
use orientation::alignment::Azimuth;
use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::units::{MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds};

use crate::campaign::burov::{Grade, LATITUDE_DEG, latitude};
use crate::campaign::chance::Chance;
use crate::methods::stops::samples::Converter;
use crate::output::{azimuth_error, degrees};

/// Samples a second: enough for the motion of a body on a road.
pub const RATE_HZ: f64 = 50.0;
/// Time of storage, s: Burov's half hour.
pub const STORED_S: f64 = 1800.0;
/// Time from one mark to the next, s.
pub const MARK_S: f64 = 60.0;
/// Rest before the azimuth is handed over, s, in which the biases are learnt.
const REST_S: f64 = 60.0;
/// Rest at the end, which belongs to the half hour, s.
const LAST_STOP_S: f64 = 30.0;
/// Drives of six parts each that are joined to one without a halt.
const DRIVES: usize = 3;
/// Upper cut-off of the flicker, Hz: below half the sample rate.
const FLICKER_HIGH_HZ: f64 = 10.0;
/// Part of the rest in which the precise gyro of a two-frame mount still lies level.
const LEVEL: f64 = 0.5;
/// Stream of the seed from which the error of what is handed over is drawn.
const HANDED: u64 = 1 << 20;
/// Stream of the seed for the coarse gyro beside the precise one.
const BESIDE: u64 = 1 << 21;

/// Stream of the seed for the wind.
const WIND: u64 = 1 << 22;

/// How the gyros sit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// Three equal gyros fixed to the vehicle.
    Strapdown,
    /// The precise gyro, turned vertical for storage, and a pair of others for the level axes.
    TwoFrame(Pair),
}

/// The gyros of the level axes beside a precise one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pair {
    /// Sensors of the class of the LSM6DSL, as [`Gyro::coarse`] has it.
    Coarse,
    /// Sensors of the class of the STIM300.
    Tactical,
}

impl fmt::Display for Mount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Strapdown => "three gyros",
            Self::TwoFrame(Pair::Tactical) => "vertical, with a tactical pair",
            Self::TwoFrame(Pair::Coarse) => "vertical, with a coarse pair",
        })
    }
}

/// How far a light wind turns a vehicle that stands, RMS about each axis, °: 4″.
const WIND_DEG: f64 = 4.0 / 3600.0;
/// How often, Hz.
const WIND_HZ: [(f64, f64); 3] = [(0.1, 0.3), (0.4, 0.9), (1.0, 2.0)];

/// The sway of a vehicle that stands.
fn wind(seed: u64) -> SwayConfiguration {
    let mut chance = Chance::new(seed, WIND);
    // Three waves make up the RMS together.
    let amplitude = WIND_DEG * (2.0 / 3.0_f64).sqrt();
    let components = WIND_HZ.map(|(low, high)| SwayComponent {
        azimuth_deg: amplitude,
        pitch_deg: amplitude,
        roll_deg: -amplitude,
        frequency_hz: chance.between(low, high),
        phase_rad: chance.between(0.0, std::f64::consts::TAU),
    });
    SwayConfiguration { components }
}

/// What the vehicle keeps its attitude with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitting {
    /// The gyro that stores the azimuth.
    pub precise: Sheet,
    /// How the unit is mounted.
    pub mount: Mount,
    /// 1σ of the biases of the accelerometers, m/s².
    pub force_bias_m_s2: f64,
}

/// The errors at one moment of storage, °.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mark {
    /// Error of the azimuth and its 1σ; none where it was lost.
    pub azimuth: Option<[f64; 2]>,
    /// Errors of pitch and of roll.
    pub level: [f64; 2],
    /// 1σ of either.
    pub level_sigma: f64,
}

/// A gyro as its data sheet has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Noise of the gyro.
    pub grade: Grade,
    /// 1σ of the bias from start to start, °/h.
    pub bias_deg_h: f64,
    /// 1σ of the scale factor.
    pub scale_sigma: f64,
}

impl Pair {
    /// The gyro of which it is a pair.
    const fn sheet(self) -> Sheet {
        let (n_deg_sqrt_h, b_deg_h, k_deg_h_sqrt_h, bias_deg_h, scale_sigma) = match self {
            Self::Coarse => (0.4, 10.0, 10.0, 1800.0, 5e-3),
            Self::Tactical => (0.15, 0.5, 2.0, 5.0, 5e-4),
        };
        let grade = Grade { n_deg_sqrt_h, b_deg_h, k_deg_h_sqrt_h, r_deg_h2: 0.0 };
        Sheet { grade, bias_deg_h, scale_sigma }
    }
}

impl Sheet {
    /// Errors of the gyro as the simulated sensor has them.
    fn simulated(&self) -> GyroConfiguration {
        GyroConfiguration {
            flicker_high_hz: Some(FLICKER_HIGH_HZ),
            bias_sigma_deg_h: self.bias_deg_h,
            scale_sigma: self.scale_sigma,
            ..self.grade.simulated()
        }
    }

    /// Errors of the gyro as the keeper is given them.
    fn stated(&self) -> Gyro {
        Gyro {
            noise: self.grade.noise(),
            bias_sigma: RadiansPerSecond::from_degrees_per_hour(self.bias_deg_h),
            scale_sigma: self.scale_sigma,
        }
    }
}

impl Fitting {
    /// The gyros forward, right, down while the azimuth is stored.
    fn gyros(&self) -> [Sheet; 3] {
        match self.mount {
            Mount::Strapdown => [self.precise; 3],
            Mount::TwoFrame(pair) => [pair.sheet(), pair.sheet(), self.precise],
        }
    }

    /// What the keeper is given at first: on a two-frame mount the third of the pair's kind shows the down axis.
    fn setting(&self, latitude: Latitude) -> Setting {
        let [level, ..] = self.gyros().map(|sheet| sheet.stated());
        let setting = Setting::precise(latitude, Seconds(1.0 / RATE_HZ), level);
        Setting { force_bias_sigma: MetresPerSecondSquared(self.force_bias_m_s2), ..setting }
    }

    /// For how long the precise gyro rests as it will store, s.
    pub fn learnt_s(&self) -> f64 {
        match self.mount {
            Mount::Strapdown => REST_S,
            Mount::TwoFrame(_) => (1.0 - LEVEL) * REST_S,
        }
    }

    /// A day: a rest, half an hour of driving without a halt, a rest at its end.
    fn day(&self, seed: u64) -> Scenario {
        let drive_s = (STORED_S - LAST_STOP_S) / DRIVES as f64;
        let mut day = Scenario::stops(seed, 1 + DRIVES, LAST_STOP_S, drive_s);
        let (last, sway) = (day.legs.len() - 1, wind(seed));
        let without_halt = day.legs.into_iter().enumerate().filter_map(|(index, leg)| match leg {
            Leg::Stop(stop) if index == 0 => {
                Some(Leg::Stop(Stop { seconds: REST_S, sway, ..stop }))
            }
            Leg::Stop(stop) => (index == last).then_some(Leg::Stop(Stop { sway, ..stop })),
            Leg::Drive(_) => Some(leg),
        });
        day.legs = without_halt.collect();
        day.vehicle.latitude_deg = LATITUDE_DEG;
        day.vehicle.rate_hz = RATE_HZ;
        day.vehicle.gyros = self.gyros().map(|sheet| sheet.simulated());
        day.vehicle.accelerometer.bias_sigma_m_s2 = self.force_bias_m_s2;
        day
    }

    /// Lives through a day; a mark each minute of storage. The azimuth is handed over with this 1σ, °.
    pub fn live(&self, start_sigma_deg: f64, seed: u64) -> Vec<Mark> {
        let day = self.day(seed);
        let configuration = day.configuration();
        let mut vehicle = Vehicle::new(&configuration, seed);
        let mut board = Board::new(self, seed);
        let mut marks = Vec::new();
        let mut is_handed = false;
        let mut next_s = REST_S + MARK_S;
        while let Some(sample) = vehicle.next() {
            board.push(&sample);
            if !is_handed && sample.time_s >= REST_S {
                is_handed = true;
                board.hand_over(start_sigma_deg, seed, vehicle.truth().attitude.azimuth_rad);
            }
            if sample.time_s >= next_s - 0.5 / RATE_HZ {
                marks.push(board.mark(&vehicle));
                next_s += MARK_S;
            }
        }
        marks
    }
}

/// The keeper and what feeds it.
struct Board {
    keeper: Keeper,
    path: Converter,
    /// While the precise gyro lies level, a coarse one shows the down axis.
    coarse: Option<Simulated>,
    precise: Gyro,
}

impl Board {
    fn new(fitting: &Fitting, seed: u64) -> Self {
        let coarse = match fitting.mount {
            Mount::Strapdown => None,
            Mount::TwoFrame(pair) => {
                let seed = Generator::stream(seed, BESIDE).next_u64();
                Some(Simulated::new(&pair.sheet().simulated(), RATE_HZ, seed))
            }
        };
        let keeper = Keeper::new(&fitting.setting(latitude()));
        Self { keeper, path: Converter::default(), coarse, precise: fitting.precise.stated() }
    }

    fn push(&mut self, sample: &VehicleSample) {
        let VehicleSample { time_s, mut turned_rad, force_m_s2, .. } = *sample;
        if self.coarse.is_some() && time_s > LEVEL * REST_S {
            self.coarse = None;
            self.keeper.exchange_down(self.precise);
        }
        if let Some(gyro) = &mut self.coarse {
            // At rest nearly nothing but the Earth turns it.
            let steady = gyro.steady(-latitude().vertical_rate().0, [0.0; 2]);
            turned_rad[2] = gyro.sample(steady, time_s, 25.0) / RATE_HZ;
        }
        self.keeper.push(&self.path.sample(time_s, turned_rad, force_m_s2));
    }

    fn hand_over(&mut self, sigma_deg: f64, seed: u64, azimuth: f64) {
        let sigma = sigma_deg.to_radians();
        let error = sigma * Chance::new(seed, HANDED).normal();
        self.keeper.hand_over(Azimuth { angle: Radians(azimuth + error), sigma: Radians(sigma) });
    }

    fn mark(&self, vehicle: &Vehicle) -> Mark {
        let report = self.keeper.report();
        let truth = vehicle.truth().attitude;
        let azimuth = report.azimuth.map(|azimuth| {
            let error = azimuth_error(azimuth.angle.degrees(), degrees(truth.azimuth_rad));
            [error, azimuth.sigma.degrees()]
        });
        let level = [report.pitch.0 - truth.pitch_rad, report.roll.0 - truth.roll_rad].map(degrees);
        Mark { azimuth, level, level_sigma: report.level_sigma.degrees() }
    }
}
