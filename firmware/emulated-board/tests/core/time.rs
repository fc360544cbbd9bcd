//! Time in periods of a clock, against exact arithmetic.

use emulated_board::time::Time;

/// Clocks of the controller, its crystal and its buses, Hz.
const CLOCKS: [u64; 6] = [32_768, 100_000, 4_000_000, 4_194_304, 48_000_000, 80_000_000];

/// Units of 2⁻¹⁶ ns in a second.
const UNITS: u128 = 1_000_000_000 << 16;

#[test]
fn periods_are_as_long_as_exact_arithmetic_has_them_for_two_days() {
    let mut count = 1_u64;
    while count < 80_000_000 * 172_800 {
        for hertz in CLOCKS.into_iter().filter(|hertz| count / hertz < 172_800) {
            let units = (u128::from(count) * UNITS + u128::from(hertz / 2)) / u128::from(hertz);
            let time = Time::periods(count, hertz);
            assert_eq!(u128::from(time.as_nanoseconds()), units >> 16, "{count} at {hertz} Hz");
            let counted = (units + 1) * u128::from(hertz) / UNITS;
            assert_eq!(u128::from(time.count(hertz)), counted, "{count} at {hertz} Hz");
            // Rounded down, the last period may not have ended.
            assert!(
                counted == count.into() || counted + 1 == count.into(),
                "{count} at {hertz} Hz"
            );
        }
        count = count * 5 / 4 + 1;
    }
}
