//! One simulated alignment on a platform that turns all the time: what is true, what the board is given.
//!
//! Site, attitude, gyro and sample rate are those of a [`Scenario`]; slip ring, unevenness, speeds and
//! the sensor's own dynamics are its own. The chips are the same.

use drivers::adxl355::registers::OutputRate;
use drivers::tmc5160::configuration::{Configuration as Motor, Polarity, Switches};
use embassy_time::{Duration, Instant};
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::plant::PlantConfiguration;
use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::stage::{Ripple, Unevenness};
use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::alignment::rotating::session::Procedure;
use orientation::alignment::rotating::turn::SPEEDS;
use orientation::alignment::rotating::{Sensor, Setting};
use orientation::units::{DEGREE, Radians, RadiansPerSecond, Seconds, TURN};

use super::fault::{Fault, Injection};
use super::scenario::{CLOCKS, GyroClass, Scenario};
use super::{Chips, board_around};
use firmware::storage::Today;

/// The motor driver of a platform that turns without end: an index mark passes its left switch.
const MOTOR: Switches = Switches { left: Some(Polarity::ActiveHigh), right: None, do_stop: false };

/// The accelerometer of a platform that turns: its filter delays a force by two and a half outputs, in
/// which the platform is not to turn far.
pub const FORCE: OutputRate = OutputRate::Hz1000;
/// Output rate of the accelerometer, Hz.
const FORCE_HERTZ: f64 = 1000.0;

/// A molecular-electronic sensor: little noise at the turn's frequency, a drift that no gyro has.
pub const MOLECULAR_ELECTRONIC: GyroClass =
    GyroClass { n_deg_sqrt_h: 0.002, b_deg_h: 0.0, k_deg_h_sqrt_h: 0.0, bias_sigma_deg_h: 5.0 };

/// Dynamics of that sensor: 17° ahead at 0.1 Hz and 9° at 0.2 Hz by its high-pass, about 1° behind by its lag, and a
/// g-sensitivity that at 0.1 Hz and 0.7° of tilt is a fifth of the horizontal Earth rate.
pub const DYNAMICS: MolecularConfiguration =
    MolecularConfiguration { force_rad_s2_g: [4e-4, -2.5e-4], high_pass_hz: 0.03, lag_s: 0.02 };
/// Time constants of the high-pass until a change of the platform's rate, of which a raised axis shows a
/// hundredth, is below what the Earth's is to be known to: e⁻¹⁴ is 10⁻⁶.
const SETTLED: f64 = 14.0;

/// 1σ of the encoder's zero, rad: a platform without an index was set by hand.
const ENCODER_ZERO_SIGMA: f64 = 0.15 * DEGREE;

/// Until the platform is ready to turn, s.
const START_SECONDS: f64 = 1.0;

/// A simulated alignment on a turning platform.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurntableScenario {
    /// Site, attitude, gyro and sample rate; its positions and dwells are not looked at.
    pub base: Scenario,
    /// Dynamics of a molecular-electronic sensor; none for a gyro.
    pub molecular: Option<MolecularConfiguration>,
    /// Turns a second, the second speed zero where there is none, Hz.
    pub speeds_hz: [f64; 2],
    /// Modulated turns at each speed; none where a stored misalignment is to do.
    pub modulated_turns: u32,
    /// Turns in each direction at each speed.
    pub turns: u32,
    /// How far the sensitive axis rises over the platform's plane, °.
    pub elevation_deg: f64,
    /// From where to where in every turn the index mark closes its switch, °; none where the switch is
    /// broken.
    pub index_deg: Option<[f64; 2]>,
    /// How uneven the gear is, relative, once and twice per turn.
    pub unevenness: [f64; 2],
    /// Angles at which it is quickest, °.
    pub quickest_deg: [f64; 2],
    /// Axis misalignments that were stored, for each speed.
    pub stored: [Option<AxisMisalignment>; SPEEDS],
    /// The day, where the board keeps misalignments: without one it takes none from its store, and keeps none in it.
    pub today: Option<Today>,
}

impl Default for TurntableScenario {
    /// The default gyro, raised by 0.8°, at 0.137 Hz for twelve rate-modulated turns and ten each way, on a gear
    /// that is uneven by 0.2 % once and 0.05 % twice per turn; the index mark is from 30° to 40°.
    fn default() -> Self {
        Self {
            base: Scenario::default(),
            molecular: None,
            speeds_hz: [0.137, 0.0],
            modulated_turns: 12,
            turns: 10,
            elevation_deg: 0.8,
            index_deg: Some([30.0, 40.0]),
            unevenness: [0.002, 0.0005],
            quickest_deg: [35.0, 110.0],
            stored: [None; SPEEDS],
            today: None,
        }
    }
}

impl TurntableScenario {
    /// The default with another seed.
    pub fn usual(seed: u64) -> Self {
        Self { base: Scenario::usual(seed), ..Self::default() }
    }

    /// Four rate-modulated turns and two each way at 0.2 Hz: what a sample costs at the highest rate of the stage
    /// path, 2400 Hz.
    pub fn brief(seed: u64) -> Self {
        let base = Scenario { sample_rate_hz: 2400.0, ..Scenario::usual(seed) };
        Self { base, speeds_hz: [0.2, 0.0], modulated_turns: 4, turns: 2, ..Self::default() }
    }

    /// A molecular-electronic sensor at two speeds.
    pub fn molecular(seed: u64) -> Self {
        let base = Scenario { gyro: MOLECULAR_ELECTRONIC, ..Scenario::usual(seed) };
        let (molecular, speeds_hz) = (Some(DYNAMICS), [0.1, 0.2]);
        Self { base, molecular, speeds_hz, ..Self::default() }
    }

    /// What the board is given about place and instrument; none where the latitude is none.
    #[must_use]
    pub fn setting(&self) -> Option<Setting> {
        let setting = Setting::new(self.base.site()?, self.sensor());
        Some(Setting {
            misalignments: self.stored,
            encoder_zero_sigma: Radians(ENCODER_ZERO_SIGMA),
            ..setting
        })
    }

    fn sensor(&self) -> Sensor {
        let Some(dynamics) = self.molecular else { return Sensor::GYRO };
        let settle_seconds = Seconds(SETTLED / (TURN * dynamics.high_pass_hz));
        Sensor { settle_seconds, ..Sensor::MOLECULAR }
    }

    /// How the board goes about it.
    pub fn procedure(&self) -> Procedure {
        let speeds = self.speeds_hz.map(|speed| RadiansPerSecond(speed * TURN));
        let count = speeds.iter().take_while(|speed| speed.0 > 0.0).count();
        let Self { modulated_turns, turns, .. } = *self;
        let sample_seconds = Seconds(1.0 / self.base.sample_rate_hz);
        let period_tolerance = CLOCKS.period_tolerance();
        Procedure {
            modulated_turns,
            turns,
            period_tolerance,
            ..Procedure::new(&speeds[..count], sample_seconds)
        }
    }

    /// Setting and procedure, checked; none where the latitude is none or the procedure impossible.
    #[must_use]
    pub fn checked(&self) -> Option<(Setting, Procedure)> {
        let procedure = self.procedure();
        procedure.check().ok()?;
        Some((self.setting()?, procedure))
    }

    /// How long an alignment takes, s.
    #[must_use]
    pub fn alignment_seconds(&self) -> f64 {
        let procedure = self.procedure();
        let settled = procedure.ramp_seconds.0 + self.sensor().settle_seconds.0;
        let at = |(index, speed): (usize, &RadiansPerSecond)| {
            let modulated = f64::from(1 + procedure.modulated_turns);
            let each_way = f64::from(1 + procedure.turns_at(index));
            (modulated + 2.0 * each_way) * TURN / speed.0 + 3.0 * settled
        };
        procedure.level_seconds.0 + procedure.speeds.iter().enumerate().map(at).sum::<f64>()
    }

    /// What is true of everything that the chips feel and move, on a base that goes along a journey where
    /// there is one.
    pub fn plant<'a>(&self, journey: Option<JourneyConfiguration<'a>>) -> PlantConfiguration<'a> {
        let mut plant = PlantConfiguration { journey, ..self.base.plant() };
        plant.accelerometer_hz = FORCE_HERTZ;
        plant.instruments.gyro.axis_elevation_rad = self.elevation_deg * DEGREE;
        plant.instruments.gyro.molecular = self.molecular;
        let ripple = |harmonic: usize| Ripple {
            relative: self.unevenness[harmonic],
            phase_rad: self.quickest_deg[harmonic] * DEGREE,
        };
        let endless = StageConfiguration::endless();
        plant.stage = StageConfiguration {
            travel_rad: endless.travel_rad,
            switches_rad: endless.switches_rad,
            mark_rad: self.index_deg.map(|edges| edges.map(|edge| edge * DEGREE)),
            unevenness: Unevenness { first: ripple(0), second: ripple(1) },
            ..plant.stage
        };
        plant
    }

    /// What a fault does that comes amid the clockwise turns.
    pub fn injection(&self, fault: Option<Fault>) -> Injection {
        let Procedure { ramp_seconds, level_seconds, .. } = self.procedure();
        let turns = f64::from(self.modulated_turns) + 0.5 * f64::from(self.turns);
        let phases = if self.modulated_turns > 0 { 2.0 } else { 1.0 };
        let seconds = START_SECONDS + level_seconds.0 + phases * ramp_seconds.0;
        let seconds = seconds + turns / self.speeds_hz[0];
        Injection::at(fault, Instant::MIN + Duration::from_millis((seconds * 1e3) as u64))
    }

    /// The simulated board with what goes wrong with it, on a base that goes along a journey where there is
    /// one.
    pub fn board<'a>(
        &self,
        journey: Option<JourneyConfiguration<'a>>,
        injection: &'a Injection,
    ) -> Chips<'a> {
        board_around(&self.plant(journey), self.base.seed, injection)
    }
}

/// What its motor driver is given.
#[must_use]
pub fn motor() -> Motor {
    Motor { switches: MOTOR, ..Motor::default() }
}
