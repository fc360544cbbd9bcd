//! The register map (data sheet, chapter 6): who may do what with which bits, and the reset values.

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

/// What the bus may do with a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    /// The bus can read it, but not write it.
    Read,
    /// The bus can write it, but not read it.
    Write,
    /// The bus can read and write it.
    ReadWrite,
    /// Writing a one clears the bit.
    WriteToClear,
    /// IOIN where it is read, OUTPUT where it is written.
    Split,
}

impl Access {
    /// Whether the data sheet lists it as readable.
    pub const fn can_read(self) -> bool {
        !matches!(self, Self::Write)
    }

    /// Whether the data sheet lists it as writable.
    pub const fn can_write(self) -> bool {
        !matches!(self, Self::Read)
    }
}

/// One register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Register {
    /// What the bus may do with it.
    pub access: Access,
    /// Bits that may be written as one.
    pub mask: u32,
    /// Its value after a reset.
    pub reset: u32,
}

/// A register that can be read only, zero after a reset.
const fn read() -> Register {
    Register { access: Access::Read, mask: 0, reset: 0 }
}

/// A register that can be written only.
const fn write(mask: u32, reset: u32) -> Register {
    Register { access: Access::Write, mask, reset }
}

/// A register that can be read and written.
const fn both(mask: u32, reset: u32) -> Register {
    Register { access: Access::ReadWrite, mask, reset }
}

/// A register in which a written one clears the bit.
const fn flags(mask: u32, reset: u32) -> Register {
    Register { access: Access::WriteToClear, mask, reset }
}

/// The register at an address, if there is one.
pub(super) const fn register(address: u8) -> Option<Register> {
    match address {
        0x00..=0x0C => general(address),
        0x10..=0x15 => velocity_dependent(address),
        0x20..=0x36 => ramp(address),
        0x38..=0x3D => encoder(address),
        0x60..=0x69 => Some(write(wave_mask(address), wave(address))),
        0x6A..=0x73 => driver(address),
        _ => None,
    }
}

/// Section 6.1. `SHORT_CONF` and `DRV_CONF` with all memory bits programmed to zero, as delivered;
/// the scaler's note allows 256 in a register of eight bits.
const fn general(address: u8) -> Option<Register> {
    Some(match address {
        0x00 => both(0x0003_FFFF, 0x0000_0008),
        0x01 => flags(0x0000_0007, 0x0000_0001),
        0x03 => write(0x0000_0FFF, 0),
        0x04 => Register { access: Access::Split, mask: 1, reset: 1 },
        0x05 => write(u32::MAX, 0),
        0x06 => write(0x0000_FF37, 0),
        0x02 | 0x0C => read(),
        0x07 => Register { access: Access::Read, mask: 0, reset: 0x0F },
        0x08 => both(0x0000_001F, 0x0F),
        0x09 => write(0x0007_0F0F, 0x0001_0606),
        0x0A => write(0x003F_0F1F, 0x0008_0400),
        0x0B => write(0x0000_01FF, 0),
        _ => return None,
    })
}

/// Section 6.2.
const fn velocity_dependent(address: u8) -> Option<Register> {
    Some(match address {
        0x10 => write(0x000F_1F1F, 0),
        0x11 => write(0x0000_00FF, 10),
        0x12 => read(),
        0x13..=0x15 => write(0x000F_FFFF, 0),
        _ => return None,
    })
}

/// Section 6.3.
const fn ramp(address: u8) -> Option<Register> {
    Some(match address {
        0x20 => both(0x0000_0003, 0),
        0x21 | 0x2D => both(u32::MAX, 0),
        0x22 | 0x36 => read(),
        0x23 => write(0x0003_FFFF, 0),
        0x24 | 0x26 | 0x28 | 0x2A | 0x2C => write(0x0000_FFFF, 0),
        0x25 => write(0x000F_FFFF, 0),
        0x27 | 0x33 => write(0x007F_FFFF, 0),
        0x2B => write(0x0003_FFFF, 1),
        0x34 => both(0x0000_0FFF, 0),
        // The data sheet has it written back as it was read.
        0x35 => flags(0x0000_3FFF, 0),
        _ => return None,
    })
}

/// Section 6.4.
const fn encoder(address: u8) -> Option<Register> {
    Some(match address {
        0x38 => both(0x0000_07FF, 0),
        0x39 => both(u32::MAX, 0),
        0x3A => write(u32::MAX, 0x0001_0000),
        0x3B => flags(0x0000_0003, 0),
        0x3C => read(),
        0x3D => write(0x000F_FFFF, 0),
        _ => return None,
    })
}

/// Section 6.5.
const fn driver(address: u8) -> Option<Register> {
    Some(match address {
        0x6A | 0x6B | 0x6F | 0x71..=0x73 => read(),
        0x6C => both(0xFFFD_DFFF, 0x1041_0150),
        0x6D => write(0x017F_EF6F, 0),
        0x6E => write(0x00FF_03FF, 0),
        0x70 => write(0xFF3F_FFFF, 0xC40C_001E),
        _ => return None,
    })
}

/// MSLUTSTART has gaps.
const fn wave_mask(address: u8) -> u32 {
    if address == 0x69 { 0x00FF_00FF } else { u32::MAX }
}

/// The sine wave that the chip holds after a reset.
const fn wave(address: u8) -> u32 {
    /// `MSLUT[0]` to `MSLUT[7]`, MSLUTSEL and MSLUTSTART.
    const WAVE: [u32; 10] = [
        0xAAAA_B554,
        0x4A95_54AA,
        0x2449_2929,
        0x1010_4222,
        0xFBFF_FFFF,
        0xB5BB_777D,
        0x4929_5556,
        0x0040_4222,
        0xFFFF_8056,
        0x00F7_0000,
    ];
    WAVE[address as usize - 0x60]
}

/// All registers after a reset.
pub(super) const fn reset_values() -> [u32; ADDRESSES] {
    let mut values = [0; ADDRESSES];
    let mut address = 0;
    while address < ADDRESSES {
        if let Some(register) = register(address as u8) {
            values[address] = register.reset;
        }
        address += 1;
    }
    values
}
