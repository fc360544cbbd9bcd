//! The register map (data sheet, chapter 6): who may do what with which bits, and the reset values.

/// Addresses of the registers that do something here; all others only keep what is written.
pub(super) mod address {
    pub const GCONF: u8 = 0x00;
    pub const GSTAT: u8 = 0x01;
    pub const IOIN: u8 = 0x04;
    pub const OTP_PROG: u8 = 0x06;
    pub const SHORT_CONF: u8 = 0x09;
    pub const GLOBALSCALER: u8 = 0x0B;
    pub const IHOLD_IRUN: u8 = 0x10;
    pub const TPOWERDOWN: u8 = 0x11;
    pub const TSTEP: u8 = 0x12;
    pub const TCOOLTHRS: u8 = 0x14;
    pub const RAMPMODE: u8 = 0x20;
    pub const XACTUAL: u8 = 0x21;
    pub const VACTUAL: u8 = 0x22;
    pub const VSTART: u8 = 0x23;
    pub const A1: u8 = 0x24;
    pub const V1: u8 = 0x25;
    pub const AMAX: u8 = 0x26;
    pub const VMAX: u8 = 0x27;
    pub const DMAX: u8 = 0x28;
    pub const D1: u8 = 0x2A;
    pub const VSTOP: u8 = 0x2B;
    pub const TZEROWAIT: u8 = 0x2C;
    pub const XTARGET: u8 = 0x2D;
    pub const SW_MODE: u8 = 0x34;
    pub const RAMP_STAT: u8 = 0x35;
    pub const XLATCH: u8 = 0x36;
    pub const MSCNT: u8 = 0x6A;
    pub const MSCURACT: u8 = 0x6B;
    pub const CHOPCONF: u8 = 0x6C;
    pub const DRV_STATUS: u8 = 0x6F;
}

/// Addresses that the seven bits can name.
pub(super) const ADDRESSES: usize = 128;

/// What the bus may do with a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Access {
    Read,
    Write,
    ReadWrite,
    /// Writing a one clears the bit.
    WriteToClear,
    /// IOIN where it is read, OUTPUT where it is written.
    Split,
}

impl Access {
    pub const fn can_read(self) -> bool {
        !matches!(self, Self::Write)
    }

    pub const fn can_write(self) -> bool {
        !matches!(self, Self::Read)
    }
}

/// One register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Register {
    pub access: Access,
    /// Bits that may be written as one.
    pub mask: u32,
    pub reset: u32,
}

const fn read() -> Register {
    Register { access: Access::Read, mask: 0, reset: 0 }
}

const fn write(mask: u32, reset: u32) -> Register {
    Register { access: Access::Write, mask, reset }
}

const fn both(mask: u32, reset: u32) -> Register {
    Register { access: Access::ReadWrite, mask, reset }
}

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
