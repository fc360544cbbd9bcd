//! One simulated flight of a body in fast rotation: what is true, what the board is given.

mod course;

pub use course::Course;

use drivers::ads1262::GREATEST_BUS_HERTZ;
use drivers::ads1262::configuration::{Configuration as Converter, DataRate};
use embassy_time::Instant;
use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::spin::SpinConfiguration as World;
use hal_mock::spin::plant::{CHIPS, SpinBoard, SpinPlant, SpinPlantConfiguration};
use hal_mock::spin::profile::Profile;
use orientation::roll::{Flight, Method, Setting};
use orientation::timebase::{Clock, Timebase};
use orientation::units::{DEGREE_PER_SQRT_HOUR, Radians, RadiansPerRootSecond, Seconds, TURN};

use super::fault::{Fault, Injection, PortWrapper};
use super::{SimulatedConverter, Wires, scenario};
use firmware::acquire::OneByOne;
use firmware::ports::{Code, SpinSensors};
use firmware::spin::budget::SAMPLE_HERTZ;
use firmware::spin::configuration::{CHANNELS, Channel, SpinConfiguration};

/// The clocks of a spinning body: an oscillator feeds its converters.
const CLOCKS: Timebase = Timebase::nominal(Clock::Crystal, Clock::Crystal);
/// Conversions a second, Hz.
pub const SAMPLE_RATE: f64 = SAMPLE_HERTZ as f64;
/// Rates, rad/s, and force, m/s², at which the sensors clip; at 2 V each.
const FULL_SCALES: [f64; 3] = [700.0, 20.0, 20.0];
const FORCE_FULL_SCALE: f64 = 10_000.0;
const FULL_VOLTS: f64 = 2.0;
/// Part of a full scale beyond which the board takes a sensor for clipped.
const LIMIT: f64 = 0.97;
/// How long the board starts before samples come, s: reset, self-test and reference of five converters.
const STARTING_SECONDS: f64 = 0.6;

/// A simulated flight. How the body spins and what holds it is for the simulation alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinScenario {
    /// What fixes everything random.
    pub seed: u64,
    /// How long the roll is followed, s.
    pub seconds: f64,
    /// Turns a second.
    pub turns_per_s: f64,
    /// The lift, m/s².
    pub lift_m_s2: f64,
    /// Noise of an accelerometer in a sample, m/s².
    pub force_noise_m_s2: f64,
    /// N of the gyros, °/√h.
    pub gyro_n_deg_sqrt_h: f64,
    /// 1σ of their scale factors.
    pub scale_sigma: f64,
}

impl Default for SpinScenario {
    /// Two seconds at 100 turns a second on a lift of 30 m/s²; accelerometers with a twentieth of it as noise,
    /// micromechanical gyros of 0.5 °/√h, good to 0.1 %.
    fn default() -> Self {
        Self {
            seed: 1,
            seconds: 2.0,
            turns_per_s: 100.0,
            lift_m_s2: 30.0,
            force_noise_m_s2: 1.5,
            gyro_n_deg_sqrt_h: 0.5,
            scale_sigma: 1e-3,
        }
    }
}

impl SpinScenario {
    /// The default with another seed, for half a second.
    #[must_use]
    pub fn brief(seed: u64) -> Self {
        Self { seed, seconds: 0.5, ..Self::default() }
    }

    /// What the board is given about the gyro about x.
    #[must_use]
    pub fn setting(&self) -> Setting {
        Setting {
            period_tolerance: CLOCKS.period_tolerance(),
            angle_random_walk: RadiansPerRootSecond(self.gyro_n_deg_sqrt_h * DEGREE_PER_SQRT_HOUR),
            scale_sigma: self.scale_sigma,
            method: Method::PhaseLocked,
            ..Setting::new(Seconds(1.0 / SAMPLE_RATE))
        }
    }

    /// The flight as the board follows it: level, northwards.
    #[must_use]
    pub fn flight(&self) -> Flight {
        Flight::new(&self.setting(), [Radians(0.0); 2], Some(Seconds(self.seconds)))
    }

    /// What the board is given about its devices; none where a scale factor is none.
    #[must_use]
    pub fn configuration(&self) -> Option<SpinConfiguration> {
        let gyro = |full: f64| Channel::gyro(FULL_VOLTS / full, LIMIT * full, SAMPLE_RATE);
        let force = FULL_VOLTS / FORCE_FULL_SCALE;
        let accelerometer = Channel::accelerometer(force, LIMIT * FORCE_FULL_SCALE)?;
        let [about_x, about_y, about_z] = FULL_SCALES.map(gyro);
        Some(SpinConfiguration {
            sample_rate: SAMPLE_RATE,
            gyros: [about_x?, about_y?, about_z?],
            accelerometers: [accelerometer; 2],
        })
    }

    /// When a fault shows that comes in the middle, s from power-on.
    #[must_use]
    pub fn middle_s(&self) -> f64 {
        STARTING_SECONDS + 0.5 * self.seconds
    }

    /// How the body flies, where nothing or something is wrong with that.
    #[must_use]
    pub fn course(&self, fault: Option<Fault>) -> Course {
        let (spin, middle) = (self.turns_per_s * TURN, self.middle_s());
        course::course(fault, spin, self.lift_m_s2, middle)
    }

    /// What a fault does that comes in the middle.
    pub fn injection(&self, fault: Option<Fault>) -> Injection {
        Injection::at(fault, Instant::from_micros((self.middle_s() * 1e6) as u64))
    }

    /// The simulated board of a body that flies so, with what goes wrong with it.
    pub fn board<'a>(&self, course: &'a Course, injection: &'a Injection) -> SpinBoard<'a> {
        let mut body = World {
            rate_hz: SAMPLE_RATE,
            spin_rad_s: Profile(&course.spin),
            gyros: [self.gyro(); 3],
            gyro_full_scale_rad_s: FULL_SCALES,
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: self.force_noise_m_s2 / libm::sqrt(0.5 * SAMPLE_RATE),
                full_scale_m_s2: Some(FORCE_FULL_SCALE),
                ..AccelerometerConfiguration::default()
            },
            faults: &injection.sensors,
            ..World::default()
        };
        body.forces.lift_m_s2 = Profile(&course.lift);
        let plant = SpinPlantConfiguration {
            body,
            gyro_volts_per_rad_s: FULL_SCALES.map(|full| FULL_VOLTS / full),
            volts_per_m_s2: FULL_VOLTS / FORCE_FULL_SCALE,
            converter_noise_v: scenario::CONVERTER_NOISE,
        };
        let mut board = SpinBoard::new(SpinPlant::new(&plant, self.seed));
        board.blackouts = &injection.blackouts;
        // One oscillator for all five.
        for converter in &mut board.chips.converters {
            converter.has_external_clock = true;
        }
        board
    }

    fn gyro(&self) -> GyroConfiguration {
        GyroConfiguration {
            n_deg_sqrt_h: self.gyro_n_deg_sqrt_h,
            scale_sigma: self.scale_sigma,
            ..GyroConfiguration::default()
        }
    }
}

/// The sensors of a spinning body on simulated chips.
pub type SimulatedSpin<'a, A> = SpinSensors<SimulatedConverter<'a, A>, OneByOne<Code, CHANNELS>>;

impl<'a, A: PortWrapper> Wires<'a, '_, A> {
    /// The sensors of a spinning body.
    #[must_use]
    pub fn spinning(&self) -> SimulatedSpin<'a, A> {
        let configuration = Converter { rate: DataRate::Sps14400, ..Converter::default() };
        let converter = |select| self.converter(select, GREATEST_BUS_HERTZ, configuration);
        let converters = CHIPS.map(|select| converter(select).clocked());
        SpinSensors { converters, reader: OneByOne::default() }
    }
}
