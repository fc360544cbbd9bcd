//! The register map (data sheet, chapter 6): who may do what with which bits, and the reset values.

use crate::registers::{Registers, both, fixed, flags, read, write};

/// Addresses of the registers that do something here; all others only keep what is written.
pub(super) mod address {
    /// Global configuration flags (6.1).
    pub const GCONF: u8 = 0x00;
    /// Global status flags: reset, driver error, charge pump (6.1); a written one clears.
    pub const GSTAT: u8 = 0x01;
    /// State of the input pins, and VERSION in the upper byte (6.1).
    pub const IOIN: u8 = 0x04;
    /// Programs a bit of the one-time memory (6.1.1).
    pub const OTP_PROG: u8 = 0x06;
    /// Levels and filter of the short detectors (6.1).
    pub const SHORT_CONF: u8 = 0x09;
    /// Scale of both motor currents, n/256; 0 stands for 256 (6.1).
    pub const GLOBALSCALER: u8 = 0x0B;
    /// Currents at standstill and in motion, and the delay between them (6.2).
    pub const IHOLD_IRUN: u8 = 0x10;
    /// Delay from standstill to the reduced current, 2¹⁸ clocks (6.2).
    pub const TPOWERDOWN: u8 = 0x11;
    /// Measured time between two microsteps of 1/256, clocks (6.2).
    pub const TSTEP: u8 = 0x12;
    /// TSTEP below which `StallGuard2` and `CoolStep` work, clocks (6.2).
    pub const TCOOLTHRS: u8 = 0x14;
    /// How the ramp is made: to a position, to a velocity either way, or not at all (6.3.1).
    pub const RAMPMODE: u8 = 0x20;
    /// Actual position, microsteps, two's complement (6.3.1).
    pub const XACTUAL: u8 = 0x21;
    /// Actual velocity, two's complement of 24 bits, 2⁻²⁴ microsteps per clock (6.3.1).
    pub const VACTUAL: u8 = 0x22;
    /// Velocity at the start of a ramp, 2⁻²⁴ microsteps per clock (6.3.1).
    pub const VSTART: u8 = 0x23;
    /// Acceleration between VSTART and V1, 2⁻⁴¹ microsteps per clock² (6.3.1).
    pub const A1: u8 = 0x24;
    /// Velocity between the first and the second slope, 2⁻²⁴ microsteps per clock (6.3.1).
    pub const V1: u8 = 0x25;
    /// Acceleration between V1 and VMAX, 2⁻⁴¹ microsteps per clock² (6.3.1).
    pub const AMAX: u8 = 0x26;
    /// Velocity of the ramp's top, 2⁻²⁴ microsteps per clock (6.3.1).
    pub const VMAX: u8 = 0x27;
    /// Deceleration between VMAX and V1, 2⁻⁴¹ microsteps per clock² (6.3.1).
    pub const DMAX: u8 = 0x28;
    /// Deceleration between V1 and VSTOP, 2⁻⁴¹ microsteps per clock²; not zero in positioning (6.3.1).
    pub const D1: u8 = 0x2A;
    /// Velocity at the end of a ramp, 2⁻²⁴ microsteps per clock; not zero in positioning (6.3.1).
    pub const VSTOP: u8 = 0x2B;
    /// Rest after a ramp to zero before the next motion, 512 clocks (6.3.1).
    pub const TZEROWAIT: u8 = 0x2C;
    /// Target of the positioning mode, microsteps, two's complement (6.3.1).
    pub const XTARGET: u8 = 0x2D;
    /// What reference switches and stalls do (6.3.2.1).
    pub const SW_MODE: u8 = 0x34;
    /// Status of ramp, switches and stall (6.3.2.2).
    pub const RAMP_STAT: u8 = 0x35;
    /// XACTUAL as latched at an edge of a switch, microsteps (6.3.2).
    pub const XLATCH: u8 = 0x36;
    /// Place in the sine table, 0 to 1023 (6.5).
    pub const MSCNT: u8 = 0x6A;
    /// Currents of both coils as the sine table gives them, nine bits each (6.5).
    pub const MSCURACT: u8 = 0x6B;
    /// Chopper: off time, hysteresis, blank time, resolution (6.5.2).
    pub const CHOPCONF: u8 = 0x6C;
    /// Load value and flags of the driver (6.5.5).
    pub const DRV_STATUS: u8 = 0x6F;
}

/// Addresses that the seven bits can name.
pub(super) const ADDRESSES: usize = 128;

/// All registers. `SHORT_CONF` and `DRV_CONF` with all memory bits programmed to zero, as delivered; the
/// scaler's note allows 256 in a register of eight bits; the wave, from 60h on, is the sine.
pub(super) const MAP: &[Registers] = &[
    // General configuration (6.1); 04h is IOIN where it is read, OUTPUT where it is written.
    both(0x00, 0x0003_FFFF, 0x0000_0008),
    flags(0x01, 0x0000_0007, 0x0000_0001),
    read(0x02, 0x02),
    write(0x03, 0x0000_0FFF, 0),
    both(0x04, 1, 1),
    write(0x05, u32::MAX, 0),
    write(0x06, 0x0000_FF37, 0),
    fixed(0x07, 0x07, 0x0F),
    both(0x08, 0x0000_001F, 0x0F),
    write(0x09, 0x0007_0F0F, 0x0001_0606),
    write(0x0A, 0x003F_0F1F, 0x0008_0400),
    write(0x0B, 0x0000_01FF, 0),
    read(0x0C, 0x0C),
    // Velocity-dependent driver features (6.2).
    write(0x10, 0x000F_1F1F, 0),
    write(0x11, 0x0000_00FF, 10),
    read(0x12, 0x12),
    write(0x13, 0x000F_FFFF, 0).to(0x15),
    // Ramp generator (6.3); the data sheet has RAMP_STAT, 35h, written back as it was read.
    both(0x20, 0x0000_0003, 0),
    both(0x21, u32::MAX, 0),
    read(0x22, 0x22),
    write(0x23, 0x0003_FFFF, 0),
    write(0x24, 0x0000_FFFF, 0),
    write(0x25, 0x000F_FFFF, 0),
    write(0x26, 0x0000_FFFF, 0),
    write(0x27, 0x007F_FFFF, 0),
    write(0x28, 0x0000_FFFF, 0),
    write(0x2A, 0x0000_FFFF, 0),
    write(0x2B, 0x0003_FFFF, 1),
    write(0x2C, 0x0000_FFFF, 0),
    both(0x2D, u32::MAX, 0),
    write(0x33, 0x007F_FFFF, 0),
    both(0x34, 0x0000_0FFF, 0),
    flags(0x35, 0x0000_3FFF, 0),
    read(0x36, 0x36),
    // Encoder (6.4).
    both(0x38, 0x0000_07FF, 0),
    both(0x39, u32::MAX, 0),
    write(0x3A, u32::MAX, 0x0001_0000),
    flags(0x3B, 0x0000_0003, 0),
    read(0x3C, 0x3C),
    write(0x3D, 0x000F_FFFF, 0),
    // Motor driver (6.5): `MSLUT[0]` to `MSLUT[7]`, MSLUTSEL and MSLUTSTART, which has gaps.
    write(0x60, u32::MAX, 0xAAAA_B554),
    write(0x61, u32::MAX, 0x4A95_54AA),
    write(0x62, u32::MAX, 0x2449_2929),
    write(0x63, u32::MAX, 0x1010_4222),
    write(0x64, u32::MAX, 0xFBFF_FFFF),
    write(0x65, u32::MAX, 0xB5BB_777D),
    write(0x66, u32::MAX, 0x4929_5556),
    write(0x67, u32::MAX, 0x0040_4222),
    write(0x68, u32::MAX, 0xFFFF_8056),
    write(0x69, 0x00FF_00FF, 0x00F7_0000),
    read(0x6A, 0x6B),
    both(0x6C, 0xFFFD_DFFF, 0x1041_0150),
    write(0x6D, 0x017F_EF6F, 0),
    write(0x6E, 0x00FF_03FF, 0),
    read(0x6F, 0x6F),
    write(0x70, 0xFF3F_FFFF, 0xC40C_001E),
    read(0x71, 0x73),
];
