//! Datagrams and register contents, without a bus.

use super::configuration::{Configuration, Currents, Polarity, Stall};
use super::registers as register;
use super::registers::{Address, drv_status, gconf, gstat, ramp_stat, sw_mode};
use super::units::{Clock, Velocity};

/// Bytes of a datagram (4.1).
pub const DATAGRAM: usize = 5;

/// `SHORT_CONF` and `DRV_CONF` as after a reset (6.1): the bridges' own settings.
const SHORT_DETECTORS: u32 = 0x0001_0606;
const GATE_DRIVERS: u32 = 0x0008_0400;

/// PWMCONF as after a reset (6.5.4); `StealthChop` is not used.
const PWM: u32 = 0xC40C_001E;

/// 10·2¹⁸ clocks at full current after a motion, then 6·2¹⁸ clocks for each step down (23.1).
const POWER_DOWN: u32 = 10;
const HOLD_DELAY: u32 = 6 << 16;

/// `SpreadCycle` as in the data sheet's example (23.1): TOFF 3, HSTRT 4, HEND 1, TBL 2, 256 microsteps.
pub const CHOPPER: u32 = 0x0001_00C3;

/// Full scale of the sense resistors, rms: 325 mV/√2 (28.2, VSRT), µV.
const FULL_SCALE_UV: u64 = 229_810;

/// Slow enough for the open-load detector (11.3): one turn of the motor a second.
const OPEN_LOAD_BELOW: Velocity = Velocity(200 * 256);

/// The datagram that writes a register.
#[must_use]
pub fn write(address: Address, data: u32) -> [u8; DATAGRAM] {
    let [a, b, c, d] = data.to_be_bytes();
    [address.0 | register::WRITE, a, b, c, d]
}

/// The datagram that requests a register; its content comes with the next reply.
#[must_use]
pub fn read(address: Address) -> [u8; DATAGRAM] {
    [address.0, 0, 0, 0, 0]
}

/// Splits a reply into status byte and data.
#[must_use]
pub fn reply([status, a, b, c, d]: [u8; DATAGRAM]) -> (u8, u32) {
    (status, u32::from_be_bytes([a, b, c, d]))
}

/// The chopper with its bridges off, which also clears the flags of shorts (6.5.5).
pub const CHOPPER_OFF: u32 = CHOPPER & !0xF;

/// Registers of a coil current.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scales {
    /// 32 … 256.
    pub global: u16,
    /// 0 … 31.
    pub run: u8,
    /// 0 … 31, ≤ `run`.
    pub hold: u8,
}

impl Scales {
    /// I = GLOBALSCALER/256 · (CS + 1)/32 · 325 mV/R/√2 (chapter 9). IRUN is the largest of 31 … 15
    /// with which GLOBALSCALER is at least 129, as its register and IRUN's recommend; then the run
    /// current is exact to 0.4 %, the hold current to 1/32 of full scale. Saturates at full scale and
    /// at GLOBALSCALER 32.
    #[must_use]
    pub fn new(currents: Currents) -> Self {
        let mut run = 31;
        while run > 15 && Self::global(currents, run) < 129 {
            run -= 1;
        }
        let full = u32::from(currents.run_ma.max(1));
        let part = u32::from(currents.hold_ma.min(currents.run_ma));
        let hold = (part * (u32::from(run) + 1) + full / 2) / full;
        Self { global: Self::global(currents, run), run, hold: hold.max(1) as u8 - 1 }
    }

    fn global(currents: Currents, run: u8) -> u16 {
        let microvolt = u64::from(currents.run_ma) * u64::from(currents.sense_milliohm);
        let full = FULL_SCALE_UV * (u64::from(run) + 1);
        ((microvolt * 256 * 32 + full / 2) / full).clamp(32, 256) as u16
    }
}

/// The conditions that stop the motor. Soft stops and stall stops exclude each other (6.3.2.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guard {
    /// Switches stop by the ramp; stalls are not detected.
    Soft,
    /// Stalls and switches stop at once.
    Stall,
}

impl Guard {
    /// The stop conditions of a motion at a velocity: stalls are included where the velocity is
    /// high enough to detect them.
    #[must_use]
    pub fn at(stall: Option<Stall>, velocity: Velocity) -> Self {
        let can_tell = |stall: Stall| velocity.0.unsigned_abs() > stall.above.0.unsigned_abs();
        if stall.is_some_and(can_tell) { Self::Stall } else { Self::Soft }
    }
}

/// `SW_MODE`.
#[must_use]
pub fn switch_mode(configuration: &Configuration, guard: Guard) -> u32 {
    let switches = configuration.switches;
    let bits = |switch: Option<Polarity>, enabled: u32, low: u32| match switch {
        None => 0,
        Some(Polarity::ActiveHigh) => enabled,
        Some(Polarity::ActiveLow) => enabled | low,
    };
    let stops = |stop: u32| if switches.do_stop { stop } else { 0 };
    let left = stops(sw_mode::STOP_LEFT) | sw_mode::LATCH_LEFT;
    let left = bits(switches.left, left, sw_mode::LEFT_LOW);
    let right = bits(switches.right, stops(sw_mode::STOP_RIGHT), sw_mode::RIGHT_LOW);
    let stop = match guard {
        Guard::Soft => sw_mode::SOFT_STOP,
        Guard::Stall => sw_mode::STALL_STOP,
    };
    left | right | stop
}

/// GCONF: `SpreadCycle` always, because `StallGuard2` is blind in `StealthChop`.
#[must_use]
pub fn global_configuration(configuration: &Configuration) -> u32 {
    let shaft = if configuration.reversed { gconf::SHAFT } else { 0 };
    gconf::FAST_STANDSTILL | gconf::MULTISTEP_FILTER | shaft
}

/// Registers and values of a configuration, in the order in which they are written; `CHOPCONF`, which
/// switches the bridges on, is not among them.
#[must_use]
pub fn settings(configuration: &Configuration) -> [(Address, u32); 24] {
    let Configuration { clock, ramp, currents, stall, .. } = *configuration;
    let scales = Scales::new(currents);
    let scale = if scales.global == 256 { 0 } else { u32::from(scales.global) };
    let current = u32::from(scales.run) << 8 | u32::from(scales.hold) | HOLD_DELAY;
    let threshold = stall.map_or(0, |stall| stall.threshold.clamp(-64, 63));
    let above = stall.map_or(0, |stall| clock.step_time(stall.above));
    let start = clock.velocity_units(ramp.start).min((1 << 18) - 1);
    let stop = clock.velocity_units(ramp.stop).clamp(start.max(1), (1 << 18) - 1);
    [
        (register::GCONF, global_configuration(configuration)),
        (register::SHORT_CONF, SHORT_DETECTORS),
        (register::DRV_CONF, GATE_DRIVERS),
        (register::GLOBALSCALER, scale),
        (register::IHOLD_IRUN, current),
        (register::TPOWERDOWN, POWER_DOWN),
        (register::TPWMTHRS, 0),
        (register::TCOOLTHRS, above),
        (register::THIGH, 0),
        (register::VSTART, start),
        (register::A1, clock.acceleration_units(ramp.first)),
        (register::V1, clock.velocity_units(ramp.knee).min((1 << 20) - 1)),
        (register::AMAX, clock.acceleration_units(ramp.acceleration)),
        (register::VMAX, clock.velocity_units(ramp.peak).max(start)),
        (register::DMAX, clock.acceleration_units(ramp.deceleration)),
        (register::D1, clock.acceleration_units(ramp.last)),
        (register::VSTOP, stop),
        (register::TZEROWAIT, 0),
        (register::VDCMIN, 0),
        (register::SW_MODE, switch_mode(configuration, Guard::Soft)),
        (register::COOLCONF, u32::from(threshold.cast_unsigned() & 0x7F) << 16),
        (register::DCCTRL, 0),
        (register::PWMCONF, PWM),
        (register::RAMP_STAT, ramp_stat::EVENTS),
    ]
}

/// A failure of the bridges or the motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DriverError {
    /// The bridges are or were too hot: let them cool, then start the chip again.
    OverTemperature,
    /// A coil is short to ground or to the supply: check the wiring, then start the chip again.
    Short,
    /// A coil is not connected: check the wiring. Valid only at low velocity (11.3).
    OpenLoad,
    /// The charge pump's voltage is or was low: check the supply, then start the chip again.
    ChargePump,
}

/// The state of the motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "they are independent flags of the chip")]
pub struct Status {
    /// The step counter, microsteps.
    pub position: i32,
    /// The ramp's velocity.
    pub velocity: Velocity,
    /// Whether the position equals the target.
    pub reached: bool,
    /// Whether the motor stands.
    pub standing: bool,
    /// Whether a stall has stopped the motor and has not been acknowledged.
    pub stalled: bool,
    /// Whether XLATCH holds the position at which the left switch became active.
    pub latched_left: bool,
    /// Whether the left switch is active.
    pub left_switch: bool,
    /// Whether the right switch is active.
    pub right_switch: bool,
    /// The failure of the bridges or the motor, if there is one.
    pub driver_error: Option<DriverError>,
}

impl Status {
    /// Decodes `RAMP_STAT`, XACTUAL, VACTUAL, `DRV_STATUS` and GSTAT.
    #[must_use]
    pub fn new(clock: Clock, [ramp, position, velocity, driver, global]: [u32; 5]) -> Self {
        let is_set = |bit: u32| ramp & bit != 0;
        let velocity = clock.velocity(velocity);
        Self {
            position: position.cast_signed(),
            velocity,
            reached: is_set(ramp_stat::REACHED),
            standing: is_set(ramp_stat::STANDING),
            stalled: is_set(ramp_stat::STALLED),
            latched_left: is_set(ramp_stat::LATCHED_LEFT),
            left_switch: is_set(ramp_stat::LEFT),
            right_switch: is_set(ramp_stat::RIGHT),
            driver_error: driver_error(driver, global, velocity),
        }
    }
}

/// The gravest of the errors; the latched flag alone means a temperature that has passed, because
/// shorts stay until the bridges are switched off (6.5.5).
fn driver_error(driver: u32, global: u32, velocity: Velocity) -> Option<DriverError> {
    let is_slow = velocity.0 != 0 && velocity.0.unsigned_abs() < OPEN_LOAD_BELOW.0.unsigned_abs();
    if driver & (drv_status::SHORT_TO_GROUND | drv_status::SHORT_TO_SUPPLY) != 0 {
        Some(DriverError::Short)
    } else if driver & drv_status::OVER_TEMPERATURE != 0 || global & gstat::DRIVER_ERROR != 0 {
        Some(DriverError::OverTemperature)
    } else if global & gstat::CHARGE_PUMP != 0 {
        Some(DriverError::ChargePump)
    } else if is_slow && driver & drv_status::OPEN_LOAD != 0 {
        Some(DriverError::OpenLoad)
    } else {
        None
    }
}
