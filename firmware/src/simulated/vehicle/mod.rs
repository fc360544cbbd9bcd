//! One simulated alignment in a vehicle that goes from stop to stop: what is true, what the board is told.
//!
//! Site, gyro and sample rate are those of a [`Scenario`], which also says how the vehicle faces at first;
//! the way, the stops and the calibrated accelerometer are its own.

pub mod fault;
mod site;

pub use site::{KnownPlace, Place};

use core::cell::RefCell;

use drivers::ads1262::Ads1262;
use drivers::adxl355::registers::OutputRate;
use drivers::adxl355::{self, Adxl355};
use embassy_time::Delay;
use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::chip::{Rig, Select};
use hal_mock::gyro::GyroConfiguration;
use hal_mock::plant::sway::{SwayComponent, SwayConfiguration};
use hal_mock::spi::ReadyPin;
use hal_mock::vehicle::board::{CHIPS, GYROS, VehicleBoard};
use hal_mock::vehicle::plant::{VehiclePlant, VehiclePlantConfiguration};
use hal_mock::vehicle::{self as world, Event, Leg, VehicleConfiguration};
use hal_mock::violation::Violation;
use orientation::align::setting;
use orientation::align::stops::Setting;
use orientation::session::stops::{Procedure, Stops};
use orientation::units::{DEGREE, DEGREE_PER_HOUR};

use self::fault::{VehicleFault, VehiclePlan};
use super::scenario::{self, Scenario};
use super::{Around, Bus, CONVERTER_HERTZ, bus};
use crate::chips;
use crate::configuration;
use crate::ports::VehicleSensors;

/// 1σ of the accelerometers, m/s²: in a vehicle their biases are tilt, so they are calibrated, to 0.1 mg.
const FORCE_BIAS_SIGMA: f64 = 1e-4 * 9.80665;
/// What a stop that is too short lasts, s.
const SHORT_SECONDS: f64 = 12.0;
/// Amplitude of the sway at stops that sway, °, and its frequencies, Hz.
const SWAY_DEG: f64 = 0.2;
const SWAY_HERTZ: [f64; 3] = [0.31, 0.73, 1.7];
/// Time between two doors that fall shut, s.
const BUMPS_SECONDS: f64 = 9.0;

/// A day of a vehicle, as it is drawn from a seed.
pub type Day = world::scenario::Scenario;

/// A simulated alignment in a vehicle. Where it is and how it faces is for the simulation alone.
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
    /// Three stops of a minute at 100 Hz, five minutes of driving between them, a receiver that knows each
    /// to two metres.
    fn default() -> Self {
        Self {
            base: Scenario { sample_rate_hz: 100.0, ..Scenario::default() },
            stops: 3,
            stop_s: 60.0,
            drive_s: 300.0,
            place: Place::Known { sigma_m: 2.0 },
        }
    }
}
