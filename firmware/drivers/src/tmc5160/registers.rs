//! Addresses and bits (data sheet, chapter 6).

/// The address of a register, 7 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address(pub u8);

/// Set in the first byte of a datagram that writes (4.1.1).
pub const WRITE: u8 = 0x80;

/// Global configuration.
pub const GCONF: Address = Address(0x00);
/// Global status; writing a one clears a flag.
pub const GSTAT: Address = Address(0x01);
/// Pins and version, read.
pub const IOIN: Address = Address(0x04);
/// Short detectors, write-only.
pub const SHORT_CONF: Address = Address(0x09);
/// Gate drivers, write-only.
pub const DRV_CONF: Address = Address(0x0A);
/// Scale of all currents, write-only.
pub const GLOBALSCALER: Address = Address(0x0B);
/// Currents, write-only.
pub const IHOLD_IRUN: Address = Address(0x10);
/// Delay before the current is reduced, write-only.
pub const TPOWERDOWN: Address = Address(0x11);
/// Upper velocity of `StealthChop`, write-only.
pub const TPWMTHRS: Address = Address(0x13);
/// Lower velocity of `StallGuard2`, write-only.
pub const TCOOLTHRS: Address = Address(0x14);
/// Lower velocity of full-stepping, write-only.
pub const THIGH: Address = Address(0x15);
/// Mode of the ramp generator.
pub const RAMPMODE: Address = Address(0x20);
/// The step counter.
pub const XACTUAL: Address = Address(0x21);
/// The velocity, read-only.
pub const VACTUAL: Address = Address(0x22);
/// Start velocity, write-only as are all others of the ramp.
pub const VSTART: Address = Address(0x23);
/// Acceleration below V1.
pub const A1: Address = Address(0x24);
/// Velocity between the slopes.
pub const V1: Address = Address(0x25);
/// Acceleration above V1.
pub const AMAX: Address = Address(0x26);
/// Highest velocity.
pub const VMAX: Address = Address(0x27);
/// Deceleration above V1.
pub const DMAX: Address = Address(0x28);
/// Deceleration below V1.
pub const D1: Address = Address(0x2A);
/// Stop velocity.
pub const VSTOP: Address = Address(0x2B);
/// Pause after a stop.
pub const TZEROWAIT: Address = Address(0x2C);
/// The target; read and write.
pub const XTARGET: Address = Address(0x2D);
/// Lower velocity of `DcStep`, write-only.
pub const VDCMIN: Address = Address(0x33);
/// Reference switches and stall stop.
pub const SW_MODE: Address = Address(0x34);
/// State of the ramp; writing a one clears an event.
pub const RAMP_STAT: Address = Address(0x35);
/// Position at which a switch became active, read-only.
pub const XLATCH: Address = Address(0x36);
/// The chopper.
pub const CHOPCONF: Address = Address(0x6C);
/// `StallGuard2` and `CoolStep`, write-only.
pub const COOLCONF: Address = Address(0x6D);
/// `DcStep`, write-only.
pub const DCCTRL: Address = Address(0x6E);
/// State of the bridges, read-only.
pub const DRV_STATUS: Address = Address(0x6F);
/// `StealthChop`, write-only.
pub const PWMCONF: Address = Address(0x70);

/// Bits of the status byte of every datagram (4.1.2).
pub mod spi_status {
    /// The chip has been reset.
    pub const RESET: u8 = 1;
    /// Overtemperature or a short has shut the bridges down.
    pub const DRIVER_ERROR: u8 = 1 << 1;
}

/// Bits of GCONF (6.1).
pub mod gconf {
    /// The motor counts as standing after 2¹⁸ clocks.
    pub const FAST_STANDSTILL: u32 = 1 << 1;
    /// Value after a reset; only `StealthChop` with external steps uses it.
    pub const MULTISTEP_FILTER: u32 = 1 << 3;
    /// The motor turns the other way.
    pub const SHAFT: u32 = 1 << 4;
}

/// Bits of GSTAT (6.1).
pub mod gstat {
    /// The bridges are or were shut down.
    pub const DRIVER_ERROR: u32 = 1 << 1;
    /// The charge pump's voltage is or was low.
    pub const CHARGE_PUMP: u32 = 1 << 2;
    /// All flags.
    pub const ALL: u32 = 7;
    /// Bits that are zero.
    pub const RESERVED: u32 = !ALL;
}

/// Bits of IOIN (6.1).
pub mod ioin {
    /// The bridges are switched off by the pin.
    pub const DISABLED: u32 = 1 << 4;
    /// External step pulses are selected.
    pub const STEP_MODE: u32 = 1 << 6;
    /// Bits that are zero.
    pub const RESERVED: u32 = 0x00FF_FF00;
    /// Position of the version in the register.
    pub const VERSION_SHIFT: u32 = 24;
    /// The only known version.
    pub const VERSION: u32 = 0x30;
}

/// Values of RAMPMODE (6.3.1).
pub mod ramp_mode {
    /// Position mode: towards XTARGET.
    pub const POSITION: u32 = 0;
    /// Velocity mode: towards +VMAX.
    pub const FORWARD: u32 = 1;
    /// Velocity mode: towards −VMAX.
    pub const BACKWARD: u32 = 2;
    /// Hold mode: the velocity stays.
    pub const HOLD: u32 = 3;
}

/// Bits of `SW_MODE` (6.3.2.1).
pub mod sw_mode {
    /// The left switch stops the motor.
    pub const STOP_LEFT: u32 = 1;
    /// The right switch stops the motor.
    pub const STOP_RIGHT: u32 = 1 << 1;
    /// The left switch is low when active.
    pub const LEFT_LOW: u32 = 1 << 2;
    /// The right switch is low when active.
    pub const RIGHT_LOW: u32 = 1 << 3;
    /// XLATCH takes the position at which the left switch becomes active.
    pub const LATCH_LEFT: u32 = 1 << 5;
    /// A stall stops the motor.
    pub const STALL_STOP: u32 = 1 << 10;
    /// Switches stop the motor by the ramp.
    pub const SOFT_STOP: u32 = 1 << 11;
}

/// Bits of `RAMP_STAT` (6.3.2.2).
pub mod ramp_stat {
    /// The left switch is active.
    pub const LEFT: u32 = 1;
    /// The right switch is active.
    pub const RIGHT: u32 = 1 << 1;
    /// XLATCH holds the position at which the left switch became active.
    pub const LATCHED_LEFT: u32 = 1 << 2;
    /// A stall has stopped the motor.
    pub const STALLED: u32 = 1 << 6;
    /// XACTUAL is XTARGET.
    pub const REACHED: u32 = 1 << 9;
    /// VACTUAL is zero.
    pub const STANDING: u32 = 1 << 10;
    /// All events that are cleared by writing a one.
    pub const EVENTS: u32 = 0x10CC;
    /// Bits that are zero.
    pub const RESERVED: u32 = !0x3FFF;
}

/// Bits of `DRV_STATUS` (6.5.5).
pub mod drv_status {
    /// A coil is short to the supply.
    pub const SHORT_TO_SUPPLY: u32 = 3 << 12;
    /// The bridges are too hot.
    pub const OVER_TEMPERATURE: u32 = 1 << 25;
    /// A coil is short to ground.
    pub const SHORT_TO_GROUND: u32 = 3 << 27;
    /// A coil is possibly not connected.
    pub const OPEN_LOAD: u32 = 3 << 29;
    /// The flags that switch the bridges off.
    pub const SHUT_DOWN: u32 = SHORT_TO_SUPPLY | OVER_TEMPERATURE | SHORT_TO_GROUND;
}
