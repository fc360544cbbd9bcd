//! Commands, register addresses and bits (SBAS661C table 9-33 and section 9.6).

use crate::fault::{Fault, compare};

/// Resets the chip to its default registers.
pub const RESET: u8 = 0x06;
/// Starts conversions.
pub const START1: u8 = 0x08;
/// Reads the newest conversion.
pub const RDATA1: u8 = 0x12;
/// Reads registers: the first address in the low five bits, then their number less one (figure 9-56).
pub const RREG: u8 = 0x20;
/// Writes registers, in the same form (figure 9-57).
pub const WREG: u8 = 0x40;

/// Device and revision.
pub const ID: u8 = 0x00;
/// Reset flag, bias, internal reference.
pub const POWER: u8 = 0x01;
/// Form of the data frame.
pub const INTERFACE: u8 = 0x02;
/// Conversion mode, chopping, delay.
pub const MODE0: u8 = 0x03;
/// Filter, sensor bias.
pub const MODE1: u8 = 0x04;
/// Amplifier gain and data rate.
pub const MODE2: u8 = 0x05;
/// Input multiplexer.
pub const INPMUX: u8 = 0x06;
/// Highest byte of the full-scale calibration.
pub const FSCAL2: u8 = 0x0C;
/// Pins of the excitation currents.
pub const IDACMUX: u8 = 0x0D;
/// Positive half of the test voltage.
pub const TDACP: u8 = 0x10;
/// Negative half of the test voltage.
pub const TDACN: u8 = 0x11;

/// ID: what remains after the revision's five bits; zero is an ADS1262, one an ADS1263.
pub const DEVICE_SHIFT: u32 = 5;
/// POWER after a reset: a reset has occurred, internal reference on.
pub const POWER_RESET_VALUE: u8 = 0x11;
/// POWER: internal reference on. The reset flag (bit 4) is written as zero: the next reset shows.
pub const POWER_REFERENCE: u8 = 0x01;
/// INTERFACE after a reset, and as this driver uses it: status byte, checksum byte as a sum.
pub const INTERFACE_STATUS_AND_SUM: u8 = 0x05;
/// MODE0: continuous conversions, no chopping, no delay.
pub const MODE0_CONTINUOUS: u8 = 0x00;
/// MODE1: the filter's place; sensor bias off.
pub const FILTER_SHIFT: u32 = 5;
/// MODE2: the gain's place, above the data rate; amplifier in use.
pub const GAIN_SHIFT: u32 = 4;
/// INPMUX: AIN0 positive, AIN1 negative.
pub const INPUTS_GYRO: u8 = 0x01;
/// INPMUX: both inputs at the test voltage.
pub const INPUTS_TEST: u8 = 0xEE;
/// FSCAL2 of a calibration of exactly one.
pub const FULL_SCALE_ONE: u8 = 0x40;
/// IDACMUX: excitation currents go nowhere.
pub const CURRENTS_NOWHERE: u8 = 0xBB;
/// TDACP: 3.0 V of a 5 V supply; each step less halves the distance from mid-supply.
pub const TEST_HIGH: u8 = 0x07;
/// TDACN: 2.0 V of a 5 V supply; each step less halves the distance from mid-supply.
pub const TEST_LOW: u8 = 0x17;

/// Number of registers that this driver writes, POWER to TDACN: all that affect a conversion.
pub const WRITTEN: usize = 17;

/// Bytes of the command that writes or reads these registers.
const COMMAND: usize = 2 + WRITTEN;

/// The command that reads POWER to TDACN; the answer comes behind its first two bytes.
pub(super) const READ_BACK: [u8; COMMAND] = {
    let mut command = [0; COMMAND];
    command[0] = RREG | POWER;
    command[1] = WRITTEN as u8 - 1;
    command
};

/// Contents of the registers POWER to TDACN.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Image([u8; WRITTEN]);

impl Image {
    /// Status byte and checksum as a sum, continuous conversions, internal reference; no
    /// calibration, no excitation currents, no test voltage.
    pub const fn plain() -> Self {
        Self([0; WRITTEN])
            .with(POWER, POWER_REFERENCE)
            .with(INTERFACE, INTERFACE_STATUS_AND_SUM)
            .with(MODE0, MODE0_CONTINUOUS)
            .with(INPMUX, INPUTS_GYRO)
            .with(FSCAL2, FULL_SCALE_ONE)
            .with(IDACMUX, CURRENTS_NOWHERE)
    }

    /// These contents with another value at `address`, which must be within POWER to TDACN; another
    /// address changes nothing.
    pub const fn with(mut self, address: u8, value: u8) -> Self {
        let index = address.wrapping_sub(POWER) as usize;
        if index < WRITTEN {
            self.0[index] = value;
        }
        self
    }

    /// The bytes of the contents, from POWER on.
    #[must_use]
    pub const fn bytes(&self) -> &[u8; WRITTEN] {
        &self.0
    }

    /// The command that writes the contents.
    pub(super) fn written(&self) -> [u8; COMMAND] {
        let mut command = [0; COMMAND];
        let head = [WREG | POWER, WRITTEN as u8 - 1];
        command.iter_mut().zip(head.iter().chain(&self.0)).for_each(|(byte, from)| *byte = *from);
        command
    }

    /// Compares the contents with the answer to [`READ_BACK`].
    pub(super) fn verify(&self, [_, _, found @ ..]: &[u8; COMMAND]) -> Result<(), Fault> {
        compare(POWER, found, &self.0)
    }
}
