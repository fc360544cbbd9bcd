//! One simulated alignment in a vehicle that goes from stop to stop: what is true, what the board is given.
//!
//! Site, gyro and sample rate are those of a [`Scenario`], which also says how the vehicle faces at first;
//! the way, the stops and the calibrated accelerometer are its own.

mod site;

pub use site::{Place, VehicleAiding};

use drivers::adxl355::registers::OutputRate;
use embassy_time::Instant;
use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::vehicle::plant::{GYROS, VehicleBoard, VehiclePlant, VehiclePlantConfiguration};
use hal_mock::vehicle::{self as world, Drive, Event, Leg, Stop, VehicleConfiguration};
use orientation::alignment::site::Site;
use orientation::alignment::stops::Setting;
use orientation::alignment::stops::session::Procedure;
use orientation::attitude as keep;
use orientation::earth::Latitude;
use orientation::navigation::{Policy, Realignment};
use orientation::timebase::{Clock, Timebase};
use orientation::units::{
    ForceNoise, GSensitivity, Metres, MetresPerSecondSquared, RadiansPerSecond, Seconds,
};

use super::fault::{Fault, Injection, PortWrapper};
use super::hold::{Hold, STOP_SECONDS};
use super::scenario::{self, Scenario};
use super::{SimulatedAccelerometer, SimulatedGyro, Wires};
use firmware::chips::AnalogueGyro;
use firmware::configuration;
use firmware::ports::VehicleSensors;

/// The clocks of a vehicle: an oscillator feeds its converters.
const CLOCKS: Timebase = Timebase::nominal(Clock::Crystal, Clock::Crystal);
/// 1σ of the accelerometers, m/s²: in a vehicle their biases are tilt, so they are calibrated, to 0.1 mg.
const FORCE_BIAS_SIGMA: MetresPerSecondSquared = MetresPerSecondSquared(1e-4 * 9.80665);
/// How long the board levels at the stops of a brief run, and how long it drives, s.
const BRIEF_STOP_SECONDS: f64 = 15.0;
const BRIEF_DRIVE_SECONDS: f64 = 45.0;
/// For how long it then keeps what it found, s: from amid the last stop into another drive.
const BRIEF_KEPT_SECONDS: f64 = 30.0;
/// What a stop that is too short lasts, s.
const SHORT_SECONDS: f64 = 12.0;
/// Amplitude of the sway at stops that sway, °, and its frequencies, Hz.
const SWAY_DEG: f64 = 0.2;
const SWAY_HERTZ: [f64; 3] = [0.31, 0.73, 1.7];
/// How much longer than the board levels the vehicle stands, s: until the stop is found, and before the
/// vehicle sets off.
const FIND_SECONDS: f64 = 20.0;
/// Time before the day's end at which the board gives up, s.
const END_SECONDS: f64 = 2.0;
/// Force at which the ADXL355 clips, m/s².
const FORCE_FULL_SCALE: f64 = 2.048 * 9.80665;
/// Time between two doors that fall shut, s.
const BUMPS_SECONDS: f64 = 9.0;

/// No sway.
const STILL: SwayConfiguration = SwayConfiguration {
    components: [SwayComponent {
        azimuth_deg: 0.0,
        pitch_deg: 0.0,
        roll_deg: 0.0,
        frequency_hz: 0.0,
        phase_rad: 0.0,
    }; 3],
};

/// A stop on ground that is inclined by so many degrees.
const fn stop(pitch_deg: f64, roll_deg: f64) -> Leg {
    let sway = STILL;
    let settling_deg = [0.2, 0.05];
    let seconds = BRIEF_STOP_SECONDS + FIND_SECONDS;
    Leg::Stop(Stop { seconds, pitch_deg, roll_deg, sway, settling_deg })
}

/// A way round a corner.
const fn drive(seconds: f64, heading_change_deg: f64) -> Leg {
    Leg::Drive(Drive {
        seconds,
        heading_change_deg,
        turn_s: 15.0,
        speed_m_s: 9.0,
        winding_deg: 0.0,
        winding_s: 1.0,
        hills_deg: 1.0,
        hills_s: 20.0,
        weaving: STILL,
        vibration_m_s2: 0.3,
    })
}

/// What the vehicle of [`VehicleScenario::brief`] does: there is little memory where that runs.
pub static BRIEF: [Leg; 4] = [
    stop(1.2, -0.7),
    drive(BRIEF_DRIVE_SECONDS, 130.0),
    stop(-0.4, 1.5),
    drive(BRIEF_KEPT_SECONDS, -70.0),
];

/// A day of a vehicle, as it is drawn from a seed.
pub type Day = world::scenario::Scenario;

/// A simulated alignment in a vehicle. Where it is and how it faces is for the simulation alone.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleScenario {
    /// Site, azimuth at first, gyros and sample rate; its positions, dwells and tilt are not looked at.
    pub base: Scenario,
    /// How many stops, at least two, at most ten.
    pub stops: usize,
    /// How long the board levels at each, s.
    pub stop_s: f64,
    /// How long the vehicle drives between them, s.
    pub drive_s: f64,
    /// Who knows how far it has come.
    pub place: Place,
}

impl Default for VehicleScenario {
    /// Three stops of a minute at 100 Hz, ten minutes of driving between them, a receiver that knows each
    /// to two metres.
    fn default() -> Self {
        Self {
            base: Scenario { sample_rate_hz: 100.0, ..Scenario::default() },
            stops: 3,
            stop_s: 60.0,
            drive_s: 600.0,
            place: Place::Known { sigma_m: 2.0 },
        }
    }
}

impl VehicleScenario {
    /// The default with another seed.
    pub fn usual(seed: u64) -> Self {
        let usual = Self::default();
        Self { base: Scenario { seed, ..usual.base }, ..usual }
    }

    /// Two stops of a quarter of a minute and a short drive at 50 Hz: what a sample costs, where a vehicle
    /// is dear to simulate.
    pub fn brief(seed: u64) -> Self {
        let usual = Self::usual(seed);
        let hold = Hold::of(BRIEF_KEPT_SECONDS);
        let base = Scenario { sample_rate_hz: 50.0, hold, ..usual.base };
        Self { base, stops: 2, stop_s: BRIEF_STOP_SECONDS, drive_s: BRIEF_DRIVE_SECONDS, ..usual }
    }

    /// What the board is given about place and instrument; none where the latitude is none.
    #[must_use]
    pub fn setting(&self) -> Option<Setting> {
        let site = Site {
            accelerometer_bias_sigma: FORCE_BIAS_SIGMA,
            g_sensitivity: [GSensitivity(0.0); 2],
            g_sensitivity_sigma: GSensitivity(0.0),
            ..self.base.site()?
        };
        let displacement_sigma = match self.place {
            Place::Known { sigma_m } => sigma_m,
            Place::Unknown => 0.0,
        };
        let setting = Setting::new(site);
        Some(Setting {
            bias_sigma: Some(RadiansPerSecond::from_degrees_per_hour(
                self.base.gyro.bias_sigma_deg_h,
            )),
            force_noise: ForceNoise(self.force_noise()),
            displacement_sigma: Metres(displacement_sigma),
            ..setting
        })
    }

    /// How the board goes about it.
    pub fn procedure(&self) -> Procedure {
        Procedure {
            stop_seconds: Seconds(self.stop_s),
            longest_seconds: Seconds(self.seconds() - END_SECONDS),
            period_tolerance: CLOCKS.period_tolerance(),
            ..Procedure::new(self.stops, Seconds(1.0 / self.base.sample_rate_hz))
        }
    }

    /// Setting and procedure, checked; none where the latitude is none or the procedure impossible.
    #[must_use]
    pub fn checked(&self) -> Option<(Setting, Procedure)> {
        let procedure = self.procedure();
        procedure.check().ok()?;
        Some((self.setting()?, procedure))
    }

    /// What the keeper is given about place and gyros; none where the latitude is none.
    #[must_use]
    pub fn keeper(&self) -> Option<keep::Setting> {
        let latitude = Latitude::from_degrees(self.base.latitude_deg)?;
        let period = 1.0 / self.base.sample_rate_hz;
        Some(keep::Setting::precise(latitude, Seconds(period), self.base.precise()))
    }

    /// How the instrument goes on after its alignment.
    #[must_use]
    pub fn policy(&self) -> Policy {
        self.base.hold.policy(Realignment::BetweenStops, self.base.precise(), self.base.precise())
    }

    /// What the board is given about its devices.
    #[must_use]
    pub fn configuration(&self) -> configuration::VehicleConfiguration {
        configuration::VehicleConfiguration::at(self.base.sample_rate_hz)
    }

    /// What the vehicle does, where nothing or something is wrong with that.
    pub fn day(&self, fault: Option<Fault>) -> Day {
        let mut day = Day::stops(self.base.seed, self.stops, self.standing_s(), self.drive_s);
        day.vehicle = self.vehicle();
        let Hold { seconds, drive_s, .. } = self.base.hold;
        day.go_on(self.base.seed, seconds, drive_s, self.later_stop_s());
        match fault {
            Some(Fault::NeverDrives) => day.legs.truncate(1),
            Some(Fault::NeverStops) => never_stop(&mut day),
            Some(Fault::ShortStops) => {
                stops_of(&mut day).skip(1).for_each(|stop| stop.seconds = SHORT_SECONDS);
                drive_on(&mut day);
            }
            Some(Fault::Sway) => stops_of(&mut day).for_each(|stop| stop.sway = sway()),
            Some(Fault::Bumps) => bump(&mut day),
            _ => {}
        }
        day
    }

    /// What a fault does that comes amid the first drive.
    pub fn injection(&self, fault: Option<Fault>) -> Injection {
        let seconds = self.standing_s() + 0.5 * self.drive_s;
        Injection::at(fault, Instant::from_micros((seconds * 1e6) as u64))
    }

    /// The simulated board of a vehicle that does this, with what goes wrong with it.
    pub fn board<'a>(
        &self,
        legs: &'a [Leg],
        events: &'a [Event],
        injection: &'a Injection,
    ) -> VehicleBoard<'a> {
        let vehicle =
            VehicleConfiguration { legs, events, faults: &injection.sensors, ..self.vehicle() };
        let plant = VehiclePlantConfiguration {
            vehicle,
            accelerometer_hz: self.output().1,
            gyro_volts_per_rad_s: scenario::VOLTS,
            converter_noise_v: scenario::CONVERTER_NOISE,
        };
        let mut board = VehicleBoard::new(VehiclePlant::new(&plant, self.base.seed));
        board.blackouts = &injection.blackouts;
        // One oscillator for all three.
        for converter in &mut board.chips.converters {
            converter.has_external_clock = true;
        }
        board
    }

    /// How long the vehicle stands at a stop, s.
    fn standing_s(&self) -> f64 {
        self.stop_s + FIND_SECONDS
    }

    /// How long the vehicle stands at a stop after the alignment, s: as at those of the alignment where it aligns anew.
    fn later_stop_s(&self) -> f64 {
        let Hold { realigns, stop_s, .. } = self.base.hold;
        stop_s.unwrap_or(if realigns { self.standing_s() } else { STOP_SECONDS })
    }

    /// Length of the whole day, s.
    fn seconds(&self) -> f64 {
        self.stops as f64 * (self.standing_s() + self.drive_s) - self.drive_s
    }

    /// Site, azimuth and sensors.
    fn vehicle(&self) -> VehicleConfiguration<'static> {
        VehicleConfiguration {
            latitude_deg: self.base.latitude_deg,
            azimuth_deg: self.base.azimuth_deg,
            rate_hz: self.base.sample_rate_hz,
            gyros: [self.base.gyro.simulated(); 3],
            gyro_full_scale_rad_s: scenario::FULL_SCALE,
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: scenario::FORCE_NOISE,
                bias_sigma_m_s2: FORCE_BIAS_SIGMA.0,
                full_scale_m_s2: Some(FORCE_FULL_SCALE),
                ..AccelerometerConfiguration::default()
            },
            ..VehicleConfiguration::default()
        }
    }

    /// Rate at which the accelerometer is read, Hz.
    fn read_hz(&self) -> f64 {
        self.base.sample_rate_hz / f64::from(self.configuration().force_divider)
    }

    /// The accelerometer's output rate, the least of which every reading finds a new one; also in Hz.
    fn output(&self) -> (OutputRate, f64) {
        const RATES: [(OutputRate, f64); 3] =
            [(OutputRate::Hz62, 62.5), (OutputRate::Hz125, 125.0), (OutputRate::Hz250, 250.0)];
        let read = self.read_hz();
        let found = RATES.into_iter().find(|(_, hertz)| *hertz > read);
        found.unwrap_or((OutputRate::Hz500, 500.0))
    }

    /// Noise of the forces, m/s²/√Hz: outputs that are not read are lost to the mean.
    fn force_noise(&self) -> f64 {
        scenario::FORCE_NOISE * libm::sqrt((self.output().1 / self.read_hz()).max(1.0))
    }
}

/// The stops of a day.
fn stops_of(day: &mut Day) -> impl Iterator<Item = &mut Stop> {
    day.legs.iter_mut().filter_map(|leg| match leg {
        Leg::Stop(stop) => Some(stop),
        Leg::Drive(_) => None,
    })
}

/// Has a vehicle drive on where it would stop.
fn never_stop(day: &mut Day) {
    let Some(on) = day.legs.get(1).copied() else { return };
    for leg in day.legs.iter_mut().skip(1).filter(|leg| matches!(leg, Leg::Stop(_))) {
        *leg = on;
    }
}

/// Has a vehicle drive on after its last stop.
fn drive_on(day: &mut Day) {
    if let Some(on) = day.legs.get(1).copied() {
        // Where there is no room for it, the day ends with the stop.
        let _ = day.legs.push(on);
    }
}

/// Doors fall shut at every stop, as long as there are events left.
fn bump(day: &mut Day) {
    let stops: heapless::Vec<[f64; 2], 16> = day.configuration().stops().collect();
    for [from, until] in stops {
        let mut at = from + BUMPS_SECONDS;
        while at < until && day.events.push(Event::door_slam(at)).is_ok() {
            at += BUMPS_SECONDS;
        }
    }
}

/// The sway of a vehicle in which people move.
fn sway() -> SwayConfiguration {
    let component = |frequency_hz| SwayComponent {
        roll_deg: SWAY_DEG,
        pitch_deg: -0.6 * SWAY_DEG,
        frequency_hz,
        ..SwayComponent::default()
    };
    SwayConfiguration { components: SWAY_HERTZ.map(component) }
}

/// The sensors of a vehicle on simulated chips.
pub type SimulatedTriad<'a, A> =
    VehicleSensors<SimulatedGyro<'a, A>, SimulatedAccelerometer<'a, A>>;

impl<'a, A: PortWrapper> Wires<'a, '_, A> {
    /// The sensors of a vehicle.
    #[must_use]
    pub fn triad(&self, scenario: &VehicleScenario) -> SimulatedTriad<'a, A> {
        let gyro = |select| {
            let gyro = self.gyro(select, &scenario.base);
            AnalogueGyro { converter: gyro.converter.clocked(), ..gyro }
        };
        let accelerometer = self.accelerometer(scenario.output().0);
        VehicleSensors { gyros: GYROS.map(gyro), accelerometer }
    }
}
