//! When conversions come (SBAS661C tables 9-3 and 9-13, section 9.6).

use embassy_time::Duration;
use embedded_hal::spi::MODE_1;

use crate::chip::BusLimits;

/// From power-on to the first communication: 65 536 clocks of 7.3728 MHz (figure 9-52).
pub(super) const POWER_UP: Duration = Duration::from_micros(8889);
/// From the reset command to the next one: 8 clocks, rounded up (table 9-32).
pub(super) const RESET: Duration = Duration::from_micros(2);
/// From the internal reference's switching on to a conversion with it (figure 7-33).
pub(super) const REFERENCE: Duration = Duration::from_millis(50);
/// Fastest bus clock, Hz (section 7.6).
pub(super) const GREATEST_BUS_HERTZ: u32 = 8_000_000;
/// The rest of the bus (sections 9.5.1 and 7.6: td(CSSC), td(SCCS), tw(CSH)).
pub(super) const BUS: BusLimits = BusLimits {
    mode: Some(MODE_1),
    select_to_clock_ns: 50,
    clock_to_deselect_ns: 40,
    deselected_ns: 30,
};

/// Conversions per second by code of the data rate.
pub(super) fn hertz(rate: u8) -> f64 {
    /// The nominal 16.6 samples per second.
    const SIXTEEN: f64 = 50.0 / 3.0;
    /// Data rates in the order of their codes (9.6, MODE2), samples per second.
    const HERTZ: [f64; 16] = [
        2.5, 5.0, 10.0, SIXTEEN, 20.0, 50.0, 60.0, 100.0, 400.0, 1200.0, 2400.0, 4800.0, 7200.0,
        14_400.0, 19_200.0, 38_400.0,
    ];
    HERTZ[usize::from(rate & 0x0F)]
}

/// From start to the first conversion by filter and data rate, µs, to the digits that the table
/// prints. The FIR filter has four data rates. Data rates above 7200 SPS do not use the second stage.
const LATENCY: [[u32; 13]; 5] = [
    [400_400, 200_400, 100_400, 60_350, 50_350, 20_350, 17_020, 10_350, 2855, 1188, 771, 563, 494],
    [
        800_400, 400_400, 200_400, 120_400, 100_400, 40_420, 33_760, 20_420, 5424, 2091, 1258, 841,
        702,
    ],
    [
        1_200_000, 600_400, 300_400, 180_400, 150_400, 60_420, 50_420, 30_420, 7924, 2924, 1674,
        1049, 841,
    ],
    [
        1_600_000, 800_400, 400_400, 240_400, 200_400, 80_420, 67_090, 40_420, 10_420, 3758, 2091,
        1258, 980,
    ],
    [402_200, 202_200, 102_200, 0, 52_220, 0, 0, 0, 0, 0, 0, 0, 0],
];
/// From start to the first conversion, µs, of the three data rates that the fifth-order stage gives
/// alone, whatever the filter (table 9-13).
const LATENCY_FAST: [u32; 3] = [424, 337, 207];
/// Programmable delay before the first conversion, µs.
const DELAY: [u32; 12] = [0, 9, 17, 35, 69, 139, 278, 555, 1100, 2200, 4400, 8800];

/// From start to the first conversion by the codes of filter, data rate and delay.
pub(super) fn latency(filter: u8, rate: u8, delay: u8) -> Duration {
    let (filter, rate, delay) = (usize::from(filter), usize::from(rate), usize::from(delay));
    let own = match rate.checked_sub(13) {
        Some(fast) => LATENCY_FAST.get(fast),
        None => LATENCY.get(filter).and_then(|row| row.get(rate)),
    };
    let micros = own.unwrap_or(&0) + DELAY.get(delay).unwrap_or(&0);
    Duration::from_micros(u64::from(micros))
}
