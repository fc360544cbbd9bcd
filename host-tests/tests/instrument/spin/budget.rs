//! The bus budget of five converters, counted by hand from the data sheet.

use drivers::ads1262::GREATEST_BUS_HERTZ;
use firmware::spin::budget::{BYTES, PAPER_HERTZ, SAMPLE_HERTZ, bus_percent};

#[test]
fn five_conversions_fit_on_the_bus_between_two_samples() {
    // RDATA1, status, four bytes, checksum: seven bytes each (SBAS661C section 9.4.7.2), 56 bits.
    assert_eq!(BYTES, 35);
    // 280 bits at 8 MHz are 35 µs of 69.4 µs, at 5 MHz they would be 56 µs.
    assert_eq!(bus_percent(GREATEST_BUS_HERTZ, SAMPLE_HERTZ), 51);
    assert_eq!(bus_percent(5_000_000, SAMPLE_HERTZ), 81);
    // Of the paper's 100 µs, which no data rate of the converter gives.
    assert_eq!(bus_percent(GREATEST_BUS_HERTZ, PAPER_HERTZ), 35);
}
