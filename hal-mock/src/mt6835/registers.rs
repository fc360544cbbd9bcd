//! The register map of the MT6835: which bits can be written where, and what its EEPROM holds.

/// Addresses of the RAM that mirrors the EEPROM, up to the last correction.
pub const SIZE: usize = 0xD3;

/// A byte for the user.
pub const USER_ID: u16 = 0x001;
/// First byte of the angle; status and checksum follow within the next three.
pub const ANGLE: u16 = 0x003;
/// The checksum over angle and status.
pub const CRC: u16 = 0x006;
/// Upper eight of the twelve bits of the zero position.
pub const ZERO_HIGH: u16 = 0x009;
/// Lower four of the twelve bits of the zero position, in the upper half of the byte.
pub const ZERO_LOW: u16 = 0x00A;
/// Direction of counting (bit 3) and hysteresis (bits 0 to 2).
pub const DIRECTION: u16 = 0x00D;
/// State of the self-calibration, in the upper two bits.
pub const CALIBRATION: u16 = 0x113;

/// The EEPROM of a chip from the factory. Fields with a name hold their documented defaults
/// (hysteresis 0.011°, bandwidth × 32, calibration at 400 … 800 1/min, all else zero); the maker's
/// bits are any pattern: a driver must keep them without knowing them.
pub const FACTORY: [u8; SIZE] = {
    let mut values = [0; SIZE];
    values[0x00C] = 0x80;
    values[0x00D] = 0xA7;
    values[0x00E] = 0x35;
    values[0x011] = 0x95;
    values
};

/// The bits of a register that the user may write; `None` where there is no such register.
#[must_use]
pub const fn writable(address: u16) -> Option<u8> {
    match address {
        USER_ID | 0x007..=0x00B | 0x013..=0x0D2 => Some(0xFF),
        0x00C => Some(0x3F),
        DIRECTION => Some(0x0F),
        0x00E => Some(0xF0),
        0x011 => Some(0x07),
        ANGLE..=CRC | CALIBRATION => Some(0x00),
        _ => None,
    }
}

/// Hysteresis of each setting, degrees.
const HYSTERESES: [f64; 8] = [0.022, 0.044, 0.088, 0.176, 0.0, 0.003, 0.006, 0.011];

/// Hysteresis of a direction register, turns.
#[must_use]
pub fn hysteresis(direction: u8) -> f64 {
    HYSTERESES[usize::from(direction & 0x07)] / 360.0
}
