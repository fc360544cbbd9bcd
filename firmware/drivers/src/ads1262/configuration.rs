//! The selectable data rate, filter and gain, with the register contents and times that follow from
//! them.

use core::time::Duration;

use super::registers::{self, Image};

/// Rate of the modulator with the internal oscillator, Hz: 7.3728 MHz / 8 (table 9-3).
const MODULATOR_HERTZ: f64 = 921_600.0;
/// Rate between the filter's stages at data rates up to 7200 SPS, Hz (table 9-3).
const STAGE_HERTZ: u64 = 14_400;
/// Delay that the digital part adds to the first conversion, ns: the constant with which
/// [`Configuration::latency`] reproduces table 9-13 to its last digit.
const OVERHEAD_NANOSECONDS: u64 = 76_800;
/// Decimation of the second stage at each data rate (table 9-3).
const SECOND_STAGE: [u16; 16] =
    [5760, 2880, 1440, 864, 720, 288, 240, 144, 36, 12, 6, 3, 2, 1, 1, 1];

/// Data rate, nominal: the internal oscillator is within 2 % (section 7.5), so measure it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum DataRate {
    /// 2.5 SPS.
    Sps2p5,
    /// 5 SPS.
    Sps5,
    /// 10 SPS.
    Sps10,
    /// 16⅔ SPS.
    Sps16p6,
    /// 20 SPS.
    Sps20,
    /// 50 SPS.
    Sps50,
    /// 60 SPS.
    Sps60,
    /// 100 SPS.
    Sps100,
    /// 400 SPS.
    #[default]
    Sps400,
    /// 1200 SPS.
    Sps1200,
    /// 2400 SPS.
    Sps2400,
    /// 4800 SPS.
    Sps4800,
    /// 7200 SPS.
    Sps7200,
    /// 14 400 SPS, by the fifth-order stage alone.
    Sps14400,
    /// 19 200 SPS, by the fifth-order stage alone.
    Sps19200,
    /// 38 400 SPS, by the fifth-order stage alone.
    Sps38400,
}

impl DataRate {
    /// Decimation of the fifth-order stage and of the second stage (table 9-3).
    const fn decimation(self) -> (u16, u16) {
        let first = match self {
            Self::Sps38400 => 24,
            Self::Sps19200 => 48,
            _ => 64,
        };
        (first, SECOND_STAGE[self as usize])
    }

    /// Conversions per second, Hz, exact but for the oscillator.
    #[must_use]
    pub fn hertz(self) -> f64 {
        let (first, second) = self.decimation();
        MODULATOR_HERTZ / (f64::from(first) * f64::from(second))
    }
}

/// Order of the second filter stage, for data rates up to 7200 SPS.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Filter {
    /// The mean over one conversion period: successive conversions share no second-stage input, so
    /// white noise stays nearly white. Correlation of neighbours, which the fifth-order first stage
    /// leaves: 0.9 % at 400 SPS, 2.9 % at 1200, 6.1 % at 2400, 24 % at 7200, 56 % above.
    #[default]
    Sinc1,
    /// The mean over two conversion periods: steeper, and neighbouring conversions are correlated.
    Sinc2,
    /// The mean over three conversion periods.
    Sinc3,
    /// The mean over four conversion periods.
    Sinc4,
}

/// Gain of the amplifier in front of the modulator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Gain {
    /// Gain 1: full scale is the reference voltage.
    #[default]
    X1,
    /// Gain 2.
    X2,
    /// Gain 4.
    X4,
    /// Gain 8.
    X8,
    /// Gain 16.
    X16,
    /// Gain 32.
    X32,
}

impl Gain {
    /// The gain as a factor, 1 … 32.
    #[must_use]
    pub const fn factor(self) -> f64 {
        (1_u8 << self as u8) as f64
    }
}

/// Configuration of the converter. Inputs are AIN0 and AIN1; reference and oscillator are the
/// internal ones. The default is 400 SPS, the mean over one period, gain 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Configuration {
    /// Data rate.
    pub rate: DataRate,
    /// Second filter stage.
    pub filter: Filter,
    /// Amplifier gain.
    pub gain: Gain,
}

impl Configuration {
    /// Time from the start command to the first conversion, rounded up to microseconds; later ones
    /// follow at the data rate. Table 9-13 as a formula: the filter's length in first-stage outputs
    /// and a constant, within the table's last printed digit (tested).
    ///
    /// The filter is symmetric: what a conversion shows was so, in the mean, half of its length before
    /// its window's end (1.39 ms at 400 SPS), and that end is within 0.08 ms of data-ready.
    #[must_use]
    pub fn latency(self) -> Duration {
        let (first, second) = self.rate.decimation();
        let order = self.filter as u64 + 1;
        let settling = if second == 1 { 5 } else { order * u64::from(second) + 5 };
        let shared = u64::from(second > 1 && order == 1);
        let stage_hertz = STAGE_HERTZ * 64 / u64::from(first);
        let filter = (settling - shared) * 1_000_000_000 / stage_hertz;
        Duration::from_micros((filter + OVERHEAD_NANOSECONDS).div_ceil(1000))
    }

    /// Registers for conversions of the gyro.
    pub const fn image(self) -> Image {
        Image::plain()
            .with(registers::MODE1, (self.filter as u8) << registers::FILTER_SHIFT)
            .with(registers::MODE2, (self.gain as u8) << registers::GAIN_SHIFT | self.rate as u8)
    }

    /// Registers for a conversion of the test voltage, ±1 V after the gain at a 5 V supply
    /// (table 9-8: its steps halve as the gains double).
    pub const fn test_image(self, sign: Sign) -> Image {
        let step = self.gain as u8;
        let (positive, negative) = match sign {
            Sign::Plus => (registers::TEST_HIGH - step, registers::TEST_LOW - step),
            Sign::Minus => (registers::TEST_LOW - step, registers::TEST_HIGH - step),
        };
        self.image()
            .with(registers::INPMUX, registers::INPUTS_TEST)
            .with(registers::TDACP, positive)
            .with(registers::TDACN, negative)
    }
}

/// Polarity of the test voltage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// The positive input is higher.
    Plus,
    /// The positive input is lower.
    Minus,
}
