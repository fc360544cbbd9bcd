//! Days drawn from a seed: a drive between two stops, several stops, a parked vehicle.

use heapless::Vec;

use super::{Drive, Event, Leg, Stop, VehicleConfiguration};
use crate::accelerometer::AccelerometerConfiguration;
use crate::gyro::GyroConfiguration;
use crate::noise::{Generator, source};
use crate::plant::sway::{SwayComponent, SwayConfiguration};

/// Most legs of a day.
pub const LEGS: usize = 64;

/// Most events of a day.
pub const EVENTS: usize = 16;

/// Legs of a drive between two stops.
const PARTS: usize = 6;

/// A gyro of the LN-200 class (J. Szymanowski et al. 2003: fibre-optic, 1 °/h): N 0.05 °/√h, bias 1 °/h
/// 1σ from start to start.
#[must_use]
pub fn fog() -> GyroConfiguration {
    GyroConfiguration { n_deg_sqrt_h: 0.05, bias_sigma_deg_h: 1.0, ..GyroConfiguration::default() }
}

/// Accelerometers beside that gyro: 0.01 m/s² of noise in a sample at 25 Hz, without bias.
#[must_use]
pub fn silicon() -> AccelerometerConfiguration {
    // 0.01·√(2/25): half the sample rate is the band.
    AccelerometerConfiguration {
        noise_m_s2_sqrt_hz: 0.002_828_427_124_746_19,
        ..AccelerometerConfiguration::default()
    }
}

/// A drawn day. Everything may be changed before it is run.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Site, start azimuth and sensors; legs and events are the day's own.
    pub vehicle: VehicleConfiguration<'static>,
    /// The stops and drives of the vehicle, in order.
    pub legs: Vec<Leg, LEGS>,
    /// What happens to the vehicle, in any order.
    pub events: Vec<Event, EVENTS>,
}

impl Scenario {
    /// 60 s at rest, 15 min of driving over some kilometres with turns and hills, 60 s at rest at any
    /// heading; ground at rest within ±3°, latitude 52°, gyros of the LN-200 class.
    pub fn siap(seed: u64) -> Self {
        Self::stops(seed, 2, 60.0, 900.0)
    }

    /// A day of `count` stops (at most 10) of `stop_s` seconds each, with drives of `drive_s` seconds
    /// between them.
    pub fn stops(seed: u64, count: usize, stop_s: f64, drive_s: f64) -> Self {
        let mut draw = Draw::new(seed, source::VEHICLE_SCENARIO);
        let mut day = Self::empty(&mut draw);
        for index in 0..count {
            let parts = if index == 0 { 0 } else { PARTS };
            let drives = [(); PARTS].map(|()| draw.drive(drive_s / PARTS as f64));
            // What does not fit any more is not driven.
            let _ = day.legs.extend_from_slice(&drives[..parts]);
            let _ = day.legs.push(draw.stop(stop_s, SwayConfiguration::default()));
        }
        day
    }

    /// Lets the day go on for at least `seconds` (as far as there is room for legs): drives of about
    /// `drive_s` seconds with stops of `stop_s` between them. What came before stays as it was.
    pub fn go_on(&mut self, seed: u64, seconds: f64, drive_s: f64, stop_s: f64) {
        let mut draw = Draw::new(seed, source::VEHICLE_AFTERWARDS);
        let mut left_s = seconds;
        while left_s > 0.0 {
            let legs = [
                draw.drive(0.5 * drive_s),
                draw.drive(0.5 * drive_s),
                draw.stop(stop_s, SwayConfiguration::default()),
            ];
            if self.legs.extend_from_slice(&legs).is_err() {
                break;
            }
            left_s -= drive_s + stop_s;
        }
    }

    /// A vehicle parked for `seconds`: three sinusoids of roll and pitch of 0.1 to 2 Hz with amplitudes
    /// that
    /// come to 0.5° together, sensors 1 m above the axis, a slammed door every 60 s or so.
    pub fn parked(seed: u64, seconds: f64) -> Self {
        let mut draw = Draw::new(seed, source::VEHICLE_SCENARIO);
        let mut day = Self::empty(&mut draw);
        let sway = draw.sway();
        let _ = day.legs.push(draw.stop(seconds, sway));
        let mut at_s = draw.between(20.0, 60.0);
        while at_s < seconds && day.events.push(Event::door_slam(at_s)).is_ok() {
            at_s += draw.between(30.0, 90.0);
        }
        day.vehicle.lever_m = [0.0, 0.0, -1.0];
        day
    }

    /// A vehicle that stands and faces an azimuth, for now.
    pub fn standing(latitude_deg: f64, azimuth_deg: f64, stop: Stop) -> Self {
        let vehicle =
            VehicleConfiguration { latitude_deg, azimuth_deg, ..VehicleConfiguration::default() };
        let legs = core::iter::once(Leg::Stop(stop)).collect();
        Self { vehicle, legs, events: Vec::new() }
    }

    /// The day as a vehicle's configuration.
    #[must_use]
    pub fn configuration(&self) -> VehicleConfiguration<'_> {
        VehicleConfiguration { legs: &self.legs, events: &self.events, ..self.vehicle }
    }

    /// A day without legs, at 52° and at a drawn azimuth, with the gyros of [`fog`].
    fn empty(draw: &mut Draw) -> Self {
        let vehicle = VehicleConfiguration {
            latitude_deg: 52.0,
            azimuth_deg: draw.between(0.0, 360.0),
            gyros: [fog(); 3],
            accelerometer: silicon(),
            ..VehicleConfiguration::default()
        };
        Self { vehicle, legs: Vec::new(), events: Vec::new() }
    }
}

/// Greatest mean rate at which a vehicle takes a turn, °/s. A turn of least jerk is 15/8 times as fast in its
/// middle, where bends and weaving of the body add up to 12 °/s: the gyros' full scale is 40 °/s.
const TURNING_DEG_S: f64 = 15.0;

/// Draws what a day is like.
struct Draw(Generator);

impl Draw {
    /// Draws from a stream of a seed.
    fn new(seed: u64, stream: u64) -> Self {
        Self(Generator::stream(seed, stream))
    }

    /// A number uniform between two limits.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.uniform()
    }

    /// A stop on ground that is drawn, with the rocking of an arrival.
    fn stop(&mut self, seconds: f64, sway: SwayConfiguration) -> Leg {
        let [pitch_deg, roll_deg] = [(); 2].map(|()| self.between(-3.0, 3.0));
        let settling_deg = [self.between(0.1, 0.4), self.between(-0.1, 0.1)];
        Leg::Stop(Stop { seconds, pitch_deg, roll_deg, sway, settling_deg })
    }

    /// A drive of `seconds` with one turn.
    fn drive(&mut self, seconds: f64) -> Leg {
        let wanted_deg = self.between(-150.0, 150.0);
        let turn_s = seconds * self.between(0.1, 0.3);
        let most_deg = TURNING_DEG_S * turn_s;
        Leg::Drive(Drive {
            seconds,
            heading_change_deg: wanted_deg.max(-most_deg).min(most_deg),
            turn_s,
            speed_m_s: self.between(6.0, 14.0),
            winding_deg: self.between(5.0, 20.0),
            winding_s: self.between(20.0, 50.0),
            hills_deg: self.between(0.5, 3.0),
            hills_s: self.between(30.0, 80.0),
            weaving: self.weaving(),
            vibration_m_s2: 0.3,
        })
    }

    /// A body on a rough road: rolling at about 0.9 Hz, pitching at 1.4 Hz, shaking at 6 Hz.
    fn weaving(&mut self) -> SwayConfiguration {
        let mut wave = |azimuth_deg, pitch_deg, roll_deg, about_hz| SwayComponent {
            azimuth_deg,
            pitch_deg,
            roll_deg,
            frequency_hz: about_hz * self.between(0.9, 1.1),
            phase_rad: self.between(0.0, core::f64::consts::TAU),
        };
        let components =
            [wave(0.3, 0.2, 1.5, 0.9), wave(0.2, 1.0, 0.2, 1.4), wave(0.05, 0.1, 0.15, 6.0)];
        SwayConfiguration { components }
    }

    /// Sway at rest.
    fn sway(&mut self) -> SwayConfiguration {
        let bands = [(0.1, 0.3), (0.4, 0.9), (1.0, 2.0)];
        let components = bands.map(|(low, high)| SwayComponent {
            azimuth_deg: 0.0,
            pitch_deg: 0.5 / 3.0,
            roll_deg: -0.5 / 3.0,
            frequency_hz: self.between(low, high),
            phase_rad: self.between(0.0, core::f64::consts::TAU),
        });
        SwayConfiguration { components }
    }
}
