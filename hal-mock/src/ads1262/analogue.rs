//! From the selected input to code and alarms (SBAS661C section 9.6, tables 9-8, 9-18, 9-19).

use super::registers::{BYPASS, REFERENCE_ON, Registers};

/// Codes in half of the range.
const CODES: f64 = 2_147_483_648.0;
/// Full-scale calibration word that stands for one (table 9-26).
const ONE: f64 = 4_194_304.0;

/// What is connected to the chip, V.
#[derive(Clone, Copy, Debug)]
pub struct Voltages {
    /// Analogue supply (5.0 in a healthy chip): test voltages and the amplifier's range follow it.
    pub supply: f64,
    /// The internal reference (2.5 in a healthy chip); at 0.4 V or less the status byte carries the alarm of
    /// a low reference.
    pub reference: f64,
}

/// What the multiplexer selects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Selected {
    /// The gyro, times this sign.
    Gyro(f64),
    /// A voltage of the chip's own, V.
    Own(f64),
}

/// What the inputs of INPMUX give. Pins other than AIN0 and AIN1 are not connected.
pub(super) fn selected(registers: &Registers, voltages: Voltages) -> Selected {
    let (positive, negative) = registers.test_codes();
    match registers.inputs() {
        (0, 1) => Selected::Gyro(1.0),
        (1, 0) => Selected::Gyro(-1.0),
        // Temperature sensor at 25 °C.
        (0xB, 0xB) => Selected::Own(0.1224),
        (0xC, 0xC) => Selected::Own(voltages.supply / 4.0),
        // A quarter of a digital supply of 3.3 V.
        (0xD, 0xD) => Selected::Own(0.825),
        (0xE, 0xE) => Selected::Own((test_part(positive) - test_part(negative)) * voltages.supply),
        _ => Selected::Own(0.0),
    }
}

/// A test voltage as part of the supply, by magnitude code (table 9-8, printed for 5 V).
fn test_part(code: u8) -> f64 {
    /// Distance of each magnitude code from the middle of the supply, V.
    const DISTANCE_VOLTS: [f64; 10] =
        [0.0, 0.007_812_5, 0.015_625, 0.031_25, 0.062_5, 0.125, 0.25, 0.5, 1.0, 2.0];
    let distance = DISTANCE_VOLTS.get(usize::from(code & 0x0F)).unwrap_or(&0.0);
    let volts = if code & 0x10 == 0 { 2.5 + distance } else { 2.5 - distance };
    volts / 5.0
}

/// The reference that the multiplexer selects, V; external ones are not connected.
fn reference(registers: &Registers, voltages: Voltages) -> f64 {
    match registers.references() {
        (0, 0) if registers.is_set(REFERENCE_ON) => voltages.reference,
        (4, 4) => voltages.supply,
        _ => 0.0,
    }
}

/// Converts a voltage between the inputs to a code and the alarm bits of the status byte.
pub(super) fn convert(registers: &Registers, voltages: Voltages, volts: f64) -> (i32, u8) {
    let amplified = volts * registers.gain();
    let reference = reference(registers, voltages);
    let alarms = alarms(registers, voltages, amplified, reference);
    if reference <= 0.0 {
        return (0, alarms);
    }
    let raw = saturated(amplified / reference * CODES);
    let offset = raw - f64::from(registers.offset()) * 256.0;
    let code = saturated(offset * f64::from(registers.full_scale()) / ONE);
    (code as i32, alarms)
}

/// A code rounded and held within the converter's range.
fn saturated(code: f64) -> f64 {
    libm::fmin(libm::fmax(libm::round(code), -CODES), CODES - 1.0)
}

/// Low reference (0.4 V); outputs of the amplifier, half of the difference either side of half the
/// supply, within 0.2 V of it; their difference beyond 105 % of the range.
fn alarms(registers: &Registers, voltages: Voltages, amplified: f64, reference: f64) -> u8 {
    let low_reference = u8::from(reference <= 0.4) << 4;
    if registers.is_set(BYPASS) {
        return low_reference;
    }
    let magnitude = libm::fabs(amplified);
    let at_supply = magnitude / 2.0 > voltages.supply / 2.0 - 0.2;
    let difference = magnitude > 1.05 * reference;
    low_reference | u8::from(at_supply) << 3 | u8::from(at_supply) << 2 | u8::from(difference) << 1
}
