//! One simulated alignment: what is true, and what the board is given.

use drivers::ads1262::configuration::{self as converter, DataRate, Gain};
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use drivers::adxl355::registers::OutputRate;
use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::plant::PlantConfiguration;
use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::plant::train::StageConfiguration;
use hal_mock::stage::{EncoderConfiguration, Harmonic};
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::session::Prepared;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::procedure::Survey;
use orientation::alignment::stepwise::session::schedule::Schedule;
use orientation::alignment::stepwise::setting::{Half, Setting};
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::planner::order::Order;
use orientation::planner::{Conditions, FEWEST, Rotation, for_sigma, for_time};
use orientation::timebase::{Clock, Timebase};
use orientation::units::{
    AngularRate, DEGREE, GSensitivity, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds,
};

use super::coarse::CoarseClass;
use super::hold::Hold;
use firmware::calibration::Harmonics;
use firmware::configuration::Configuration;

/// The gyro's g-sensitivity along and across its axis as it is calibrated, °/h/g.
const G_SENSITIVITY: [f64; 2] = [0.05, -0.03];
/// 1σ of that calibration, °/h/g.
pub(super) const G_SENSITIVITY_SIGMA: f64 = 0.002;
/// 1σ of the gyro's scale factor.
pub(super) const SCALE_SIGMA: f64 = 5e-4;
/// Noise density of the ADXL355, 25 µg/√Hz (data sheet, table 1), m/s²/√Hz.
pub(super) const FORCE_NOISE: f64 = 25e-6 * 9.80665;
/// 1σ of the ADXL355's offset, 25 mg at most (data sheet, table 1), m/s².
const FORCE_BIAS_SIGMA: MetresPerSecondSquared = MetresPerSecondSquared(0.0083 * 9.80665);
/// What the accelerometer's driver is given: more outputs than are read.
pub const FORCE: OutputRate = OutputRate::Hz125;
/// Magnet's eccentricity and ellipticity as the encoder shows them, rad: 0.05° and 0.02°.
const HARMONICS: [Harmonic; 2] = [
    Harmonic { amplitude_rad: 0.05 * DEGREE, phase_rad: 0.7 },
    Harmonic { amplitude_rad: 0.02 * DEGREE, phase_rad: -1.1 },
];
/// 1σ of what the calibration of the harmonics leaves, rad: 2″.
const ENCODER_SIGMA: f64 = 2.0 / 3600.0 * DEGREE;
/// 1σ of the gyro's g-sensitivity, °/h/g, and of the encoder, rad, as an image states them that has no calibration.
const UNCALIBRATED_SIGMAS: (f64, f64) = (0.1, 0.05 * DEGREE);

/// Data rates of the converter at which a stage path runs.
pub const RATES: [DataRate; 7] = [
    DataRate::Sps20,
    DataRate::Sps50,
    DataRate::Sps60,
    DataRate::Sps100,
    DataRate::Sps400,
    DataRate::Sps1200,
    DataRate::Sps2400,
];
/// White noise of the converter, V RMS per conversion: 1 µV, below the gyro's own.
pub(super) const CONVERTER_NOISE: f64 = 1e-6;
/// Play of the stage's gear, rad: 0.01°.
const BACKLASH: f64 = 0.01 * DEGREE;
/// The clocks of a stage: its converter runs on its own oscillator.
pub(super) const CLOCKS: Timebase = Timebase::nominal(Clock::Converter, Clock::Crystal);
/// How the stage rings after it has stopped.
const RINGING_HZ: f64 = 15.0;
/// Damping ratio of that ringing.
const RINGING_DAMPING: f64 = 0.08;
/// For how long it rings, s: until 56 µrad, a/ω² at the end of its ramp, are below what stands.
pub(super) const RINGS_SECONDS: f64 = 0.25;

/// How long the stage takes to turn: its motor driver's ramp, 1.20 s for 15° and 18.41 s for 360°, and
/// what it rests and looks around after it.
pub(super) const ROTATION: Rotation =
    Rotation { rest: Seconds(0.45 + 0.3), speed: RadiansPerSecond(0.35), wraps: false };
/// Shortest dwell of a plan, s.
const SHORTEST: f64 = 2.0;
/// Greatest 1σ of an azimuth that is accepted where none is asked for, rad.
const ACCEPTED_SIGMA: f64 = 10.0 * DEGREE;

/// Scale factor of the gyro, V per rad/s: 50 mV per °/s.
pub(super) const VOLTS: f64 = 0.05 / DEGREE;
/// Rate at which the gyro's output clips, rad/s: 40 °/s, 2 V of the converter's 2.5 V.
pub(super) const FULL_SCALE: f64 = 40.0 * DEGREE;
/// What the board takes for clipped: 97 % of that.
pub const LIMIT: AngularRate = AngularRate((0.97 * FULL_SCALE * 1e9) as i32);
/// The gyro's scale factor as the board is configured with it.
pub const SCALE: Scale = match Scale::new(VOLTS, INTERNAL_REFERENCE_VOLTS, Gain::X1) {
    Some(scale) => scale,
    None => unreachable!(),
};

/// How many seeds have phases of their own: more than this, and a phase of so many turns loses its digits.
const PHASES: u64 = 1 << 32;

/// A class of precise gyro.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroClass {
    /// N, angle random walk, °/√h.
    pub n_deg_sqrt_h: f64,
    /// B, bias instability, °/h.
    pub b_deg_h: f64,
    /// K, rate random walk, °/h/√h.
    pub k_deg_h_sqrt_h: f64,
    /// 1σ of the turn-on bias, °/h.
    pub bias_sigma_deg_h: f64,
}

impl GyroClass {
    /// Fibre-optic, OIUS-1000 class (Burov): the default.
    pub const FIBRE_OPTIC: Self =
        Self { n_deg_sqrt_h: 0.001, b_deg_h: 0.007, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 0.5 };
    /// Fibre-optic, of a lower grade.
    pub const FIBRE_OPTIC_COARSE: Self =
        Self { n_deg_sqrt_h: 0.02, b_deg_h: 0.1, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 3.0 };
    /// The best micromechanical ones.
    pub const MICROMECHANICAL_FINE: Self =
        Self { n_deg_sqrt_h: 0.036, b_deg_h: 0.3, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 10.0 };
    /// Micromechanical, tactical grade.
    pub const MICROMECHANICAL: Self =
        Self { n_deg_sqrt_h: 0.15, b_deg_h: 0.5, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 30.0 };

    /// A gyro of the class, with a scale error that is drawn.
    pub(super) fn simulated(&self) -> GyroConfiguration {
        GyroConfiguration {
            n_deg_sqrt_h: self.n_deg_sqrt_h,
            b_deg_h: self.b_deg_h,
            k_deg_h_sqrt_h: self.k_deg_h_sqrt_h,
            bias_sigma_deg_h: self.bias_sigma_deg_h,
            scale_sigma: SCALE_SIGMA,
            ..GyroConfiguration::default()
        }
    }

    pub(super) fn noise(&self) -> GyroNoise {
        GyroNoise::from_field_units(self.n_deg_sqrt_h, self.b_deg_h, self.k_deg_h_sqrt_h, 0.0)
    }
}

/// How a mount turns, and where it goes unless a plan says otherwise.
pub(super) struct Turning {
    pub(super) rotation: Rotation,
    pub(super) orders: &'static [Order],
    pub(super) usual: Schedule,
}

/// How the board is to go about its alignment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Aim {
    /// Equal dwells on the full circle, as many and as long as the scenario says.
    #[default]
    Circle,
    /// The best schedule for the gyro in so many seconds.
    Time(f64),
    /// Until a standard deviation is reached.
    Accuracy {
        /// 1σ, °.
        sigma_deg: f64,
        /// Time allowed, s.
        seconds: f64,
    },
}

/// A simulated alignment. The true attitude is for the simulation alone: the board is never given it.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scenario {
    /// What fixes everything random.
    pub seed: u64,
    /// Latitude, °, which the board knows.
    pub latitude_deg: f64,
    /// True azimuth of body x, °.
    pub azimuth_deg: f64,
    /// True pitch, °.
    pub pitch_deg: f64,
    /// True roll, °.
    pub roll_deg: f64,
    /// The precise gyro.
    pub gyro: GyroClass,
    /// Whether the board is given a calibration of gyro and encoder; without one the encoder is true, and the board
    /// states greater σ.
    pub is_calibrated: bool,
    /// Samples a second: one of the converter's data rates, Hz.
    pub sample_rate_hz: f64,
    /// Positions on the full circle.
    pub positions: usize,
    /// Time at each, s.
    pub dwell_s: f64,
    /// How the schedule is chosen.
    pub aim: Aim,
    /// How long the stage stands still first, to know the gyro, s; zero for not at all.
    pub survey_s: f64,
    /// The half of the circle in which the azimuth is known to lie, where the board is given it.
    pub half: Option<Half>,
    /// Stage angle at power-on, °.
    pub start_deg: f64,
    /// Amplitude of the base's sway, °; zero for a base at rest.
    pub sway_deg: f64,
    /// Frequency of the sway, Hz.
    pub sway_hz: f64,
    /// Whether a coarse IMU stands on the base.
    pub has_base_imu: bool,
    /// Class of the coarse IMU.
    pub coarse: CoarseClass,
    /// How it goes on after the alignment.
    pub hold: Hold,
}

impl Default for Scenario {
    /// Fibre-optic class, latitude 47.58°, 24 positions of 10 s on the full circle at 400 Hz, a base
    /// that is not quite level and a stage that was left at 20°.
    fn default() -> Self {
        Self {
            seed: 1,
            latitude_deg: 47.58,
            azimuth_deg: 213.7,
            pitch_deg: 0.6,
            roll_deg: -0.4,
            gyro: GyroClass::FIBRE_OPTIC,
            is_calibrated: true,
            sample_rate_hz: 400.0,
            positions: 24,
            dwell_s: 10.0,
            aim: Aim::Circle,
            survey_s: 0.0,
            half: None,
            start_deg: 20.0,
            sway_deg: 0.0,
            sway_hz: 0.5,
            has_base_imu: false,
            coarse: CoarseClass::LSM6DSL,
            hold: Hold::default(),
        }
    }
}

impl Scenario {
    /// The default with another seed.
    pub fn usual(seed: u64) -> Self {
        Self { seed, ..Self::default() }
    }

    /// Four short dwells at 2400 Hz: what a sample costs at the highest rate of the stage path.
    pub fn brief(seed: u64) -> Self {
        Self { seed, sample_rate_hz: 2400.0, positions: 4, dwell_s: 1.0, ..Self::default() }
    }

    /// Two minutes of survey at 100 Hz, and the plan that follows for one minute more.
    pub fn surveying(seed: u64) -> Self {
        let base = Self::usual(seed);
        Self { sample_rate_hz: 100.0, survey_s: 120.0, aim: Aim::Time(60.0), ..base }
    }

    /// What the board is given about the mount too; none where the latitude is none.
    #[must_use]
    pub fn setting(&self) -> Option<Setting> {
        Some(Setting { half: self.half, ..Setting::new(self.site()?) })
    }

    /// What the board is given about place and instrument; none where the latitude is none.
    #[must_use]
    pub fn site(&self) -> Option<Site> {
        let latitude = Latitude::from_degrees(self.latitude_deg)?;
        let (g_sensitivity, (g_sensitivity_sigma, encoder_sigma)) = if self.is_calibrated {
            (G_SENSITIVITY, (G_SENSITIVITY_SIGMA, ENCODER_SIGMA))
        } else {
            ([0.0; 2], UNCALIBRATED_SIGMAS)
        };
        Some(Site {
            noise: StatedNoise::Whole(self.gyro.noise()),
            scale_sigma: SCALE_SIGMA,
            g_sensitivity: g_sensitivity.map(GSensitivity::from_degrees_per_hour),
            g_sensitivity_sigma: GSensitivity::from_degrees_per_hour(g_sensitivity_sigma),
            accelerometer_bias_sigma: FORCE_BIAS_SIGMA,
            encoder_sigma: Radians(encoder_sigma),
            required_sigma: Radians(self.required_sigma()),
            ..Site::at(latitude)
        })
    }

    /// How the board goes about it.
    pub fn procedure(&self) -> Procedure {
        let circle = Schedule::closed_circle(self.positions, Seconds(self.dwell_s));
        self.procedure_on(&Turning { rotation: ROTATION, orders: &Order::COMPARED, usual: circle })
    }

    /// The procedure on any mount, which turns like this.
    pub(super) fn procedure_on(&self, turning: &Turning) -> Procedure {
        let procedure = Procedure::new(self.schedule(turning), Seconds(1.0 / self.sample_rate_hz));
        let mut procedure = Procedure {
            settle_seconds: Seconds(RINGS_SECONDS),
            period_tolerance: CLOCKS.period_tolerance(),
            ..procedure
        };
        if self.survey_s > 0.0 {
            procedure = procedure.after(self.survey(turning));
        }
        match self.aim {
            Aim::Accuracy { seconds, .. } => procedure.until_accurate(Seconds(seconds)),
            Aim::Circle | Aim::Time(_) => procedure,
        }
    }

    /// The greatest 1σ that is accepted, rad.
    fn required_sigma(&self) -> f64 {
        match self.aim {
            Aim::Accuracy { sigma_deg, .. } => sigma_deg * DEGREE,
            Aim::Circle | Aim::Time(_) => ACCEPTED_SIGMA,
        }
    }

    /// The schedule for the noise that is stated; for an accuracy that is out of reach the best in the
    /// time, so that the session can state how near it comes. A time that holds none has the usual one.
    fn schedule(&self, turning: &Turning) -> Schedule {
        let usual = || turning.usual.clone();
        let conditions = Conditions {
            noise: self.gyro.noise(),
            rotation: turning.rotation,
            shortest: Seconds(SHORTEST),
            fewest: FEWEST,
            orders: turning.orders,
        };
        let plan = match (self.aim, Latitude::from_degrees(self.latitude_deg)) {
            (Aim::Circle, _) | (_, None) => return usual(),
            (Aim::Time(seconds), _) => for_time(&conditions, Seconds(seconds)),
            (Aim::Accuracy { seconds, .. }, Some(latitude)) => {
                let wanted = self.required_sigma() * latitude.horizontal_rate().0;
                for_sigma(&conditions, RadiansPerSecond(wanted), Seconds(seconds))
                    .or_else(|_| for_time(&conditions, Seconds(seconds)))
            }
        };
        plan.map_or_else(|_| usual(), Schedule::Planned)
    }

    fn survey(&self, turning: &Turning) -> Survey {
        let plan_seconds = match self.aim {
            Aim::Circle => turning.usual.seconds(),
            Aim::Time(seconds) | Aim::Accuracy { seconds, .. } => Seconds(seconds),
        };
        Survey {
            seconds: Seconds(self.survey_s),
            rotation: turning.rotation,
            orders: turning.orders,
            shortest: Seconds(SHORTEST),
            plan_seconds,
        }
    }

    /// What its session needs; none where the latitude is none or the schedule impossible.
    #[must_use]
    pub fn prepared(&self) -> Option<Prepared> {
        Prepared::new(self.setting()?, self.procedure()).ok()
    }

    /// What the board is given about its devices.
    #[must_use]
    pub fn configuration(&self) -> Configuration {
        Configuration {
            encoder: calibration(self.harmonics()),
            ..Configuration::at(self.sample_rate_hz)
        }
    }

    /// What is true of the instruments.
    pub fn instruments(&self) -> InstrumentsConfiguration {
        let [first, second] = self.harmonics();
        InstrumentsConfiguration {
            latitude_deg: self.latitude_deg,
            azimuth_deg: self.azimuth_deg,
            pitch_deg: self.pitch_deg,
            roll_deg: self.roll_deg,
            rate_hz: self.sample_rate_hz,
            gyro: GyroConfiguration {
                g_sensitivity_deg_h_g: G_SENSITIVITY,
                axis_elevation_rad: 0.05 * DEGREE,
                ..self.gyro.simulated()
            },
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: FORCE_NOISE,
                bias_sigma_m_s2: FORCE_BIAS_SIGMA.0,
                ..AccelerometerConfiguration::default()
            },
            encoder: EncoderConfiguration { step_rad: 0.0, first, second },
            ..InstrumentsConfiguration::default()
        }
    }

    /// The encoder's harmonics, which are true and calibrated, or none.
    fn harmonics(&self) -> [Harmonic; 2] {
        if self.is_calibrated { HARMONICS } else { Default::default() }
    }

    /// What is true of everything that the chips feel and move.
    pub fn plant(&self) -> PlantConfiguration<'static> {
        PlantConfiguration {
            instruments: self.instruments(),
            gyro_volts_per_rad_s: VOLTS,
            gyro_full_scale_rad_s: FULL_SCALE,
            converter_noise_v: CONVERTER_NOISE,
            sway: self.sway(),
            stage: StageConfiguration {
                start_rad: self.start_deg * DEGREE,
                backlash_rad: BACKLASH,
                ringing_hz: RINGING_HZ,
                ringing_damping: RINGING_DAMPING,
                ..StageConfiguration::default()
            },
            ..PlantConfiguration::default()
        }
    }

    fn sway(&self) -> SwayConfiguration {
        if self.sway_deg > 0.0 { sway(self) } else { SwayConfiguration::default() }
    }

    /// The converter's configuration: the data rate nearest to the sample rate.
    #[must_use]
    pub fn converter(&self) -> converter::Configuration {
        let off = |rate: DataRate| (rate.hertz() - self.sample_rate_hz).abs();
        let nearer = |best, rate| if off(rate) < off(best) { rate } else { best };
        let rate = RATES.into_iter().fold(DataRate::Sps100, nearer);
        converter::Configuration { rate, ..converter::Configuration::default() }
    }
}

/// The sway of a scenario: roll and pitch of its amplitude, azimuth of half of it, at frequencies
/// that fall into no step with each other and phases that depend on the seed.
#[must_use]
pub fn sway(scenario: &Scenario) -> SwayConfiguration {
    let Scenario { sway_deg, sway_hz, .. } = *scenario;
    let seed = scenario.seed % PHASES;
    let phase = |step: u64| (seed * 7 + step * 3) as f64 * 2.399_963;
    let still = SwayComponent::default();
    let roll = SwayComponent { roll_deg: sway_deg, frequency_hz: sway_hz, ..still };
    let pitch = SwayComponent { pitch_deg: sway_deg, frequency_hz: 0.83 * sway_hz, ..still };
    let azimuth =
        SwayComponent { azimuth_deg: 0.5 * sway_deg, frequency_hz: 0.61 * sway_hz, ..still };
    let mut components = [roll, pitch, azimuth];
    for (step, component) in (0..).zip(&mut components) {
        component.phase_rad = phase(step);
    }
    SwayConfiguration { components }
}

/// The encoder's harmonics as a calibration found them: sine and cosine parts of what is true.
fn calibration([first, second]: [Harmonic; 2]) -> Harmonics {
    let parts = |harmonic: Harmonic| {
        let Harmonic { amplitude_rad, phase_rad } = harmonic;
        [amplitude_rad * libm::cos(phase_rad), amplitude_rad * libm::sin(phase_rad)]
            .map(|part| part as f32)
    };
    Harmonics { first: parts(first), second: parts(second) }
}
