//! The codec against the data sheet's units in exact fractions.

use drivers::fault::Fault;
use drivers::lsm6dsl::registers::{ForceRange, OutputRate, RateRange, control_force, control_rate};
use drivers::lsm6dsl::{BITS_PER_CHECK, BITS_PER_SAMPLE, Configuration, TIME_PER_SAMPLE, codec};
use orientation::units::{SpecificForce, Temperature};
use proptest::prelude::*;

/// Sensitivities of the data sheet's table, m°/s and mg per count.
const RATES: [(RateRange, f64, u8); 5] = [
    (RateRange::Dps125, 4.375, 0x02),
    (RateRange::Dps250, 8.75, 0x00),
    (RateRange::Dps500, 17.5, 0x04),
    (RateRange::Dps1000, 35.0, 0x08),
    (RateRange::Dps2000, 70.0, 0x0C),
];
const FORCES: [(ForceRange, f64, u8); 4] = [
    (ForceRange::G2, 0.061, 0x00),
    (ForceRange::G4, 0.122, 0x08),
    (ForceRange::G8, 0.244, 0x0C),
    (ForceRange::G16, 0.488, 0x04),
];

#[test]
fn every_count_becomes_its_unit_to_nearest() {
    for count in i16::MIN..=i16::MAX {
        for (range, unit, _) in RATES {
            let exact = f64::from(count) * (unit * 1e-3).to_radians() * 1e9;
            let shown = codec::rate(count, range);
            let limited = exact.clamp(f64::from(i32::MIN), f64::from(i32::MAX));
            assert!((f64::from(shown.0) - limited).abs() <= 1.1, "{count} {range:?}");
        }
        for (range, unit, _) in FORCES {
            let exact = f64::from(count) * unit * 1e-3 * 9.806_65e6;
            let error = f64::from(codec::force(count, range).0) - exact;
            assert!(error.abs() <= 0.7, "{count} {range:?}: {error}");
        }
    }
}

#[test]
fn the_scale_is_that_of_the_data_sheet() {
    // 1 °/s is 17 453 293 nrad/s: 228.57 counts of 4.375 m°/s.
    assert_eq!(codec::rate(800, RateRange::Dps125).0, 61_086_524);
    assert_eq!(codec::force(-16_393, ForceRange::G2), SpecificForce(-9_806_385));
    assert_eq!(codec::temperature(0), Temperature(25_000));
    assert_eq!(codec::temperature(256), Temperature(26_000));
    assert_eq!(codec::temperature(-2560), Temperature(15_000));
}

#[test]
fn the_control_registers_are_those_of_the_tables() {
    for (output, code, hertz) in [
        (OutputRate::Hz12, 1, 13),
        (OutputRate::Hz26, 2, 26),
        (OutputRate::Hz52, 3, 52),
        (OutputRate::Hz104, 4, 104),
        (OutputRate::Hz208, 5, 208),
        (OutputRate::Hz416, 6, 416),
    ] {
        assert_eq!(output.hertz(), hertz);
        for (range, _, bits) in RATES {
            assert_eq!(control_rate(output, range), code << 4 | bits);
        }
        for (range, _, bits) in FORCES {
            assert_eq!(control_force(output, range), code << 4 | bits);
        }
    }
}

#[test]
fn beyond_the_range_is_clipped() {
    // 125 °/s over 4.375 m°/s is 28 571.4 counts, and so is each other range over its unit.
    for (count, is_clipped) in [(28_570, false), (28_571, true), (-28_571, true), (i16::MIN, true)]
    {
        assert_eq!(codec::is_rate_clipped(count), is_clipped);
    }
    for (count, is_clipped) in [(32_766, false), (32_767, true), (-32_766, false), (i16::MIN, true)]
    {
        assert_eq!(codec::is_force_clipped(count), is_clipped);
    }
}

#[test]
fn the_budget_is_that_of_the_documentation() {
    // Start, address, register, start, address, bytes, stop: 30 bits and nine for each byte.
    assert_eq!(BITS_PER_SAMPLE, 2 * 30 + 9 * 15);
    assert_eq!(BITS_PER_CHECK, 30 + 9 * 8);
    assert_eq!(TIME_PER_SAMPLE.as_nanos(), 487_500);
}

#[test]
fn a_changed_register_and_a_reset_are_distinguished() {
    let expected = codec::settings(&Configuration::default());
    assert_eq!(codec::compare(&expected, &expected), Ok(()));
    assert_eq!(codec::compare(&[0, 0, 4, 0, 0, 0, 0, 0], &expected), Err(Fault::Reset));
    assert_eq!(codec::compare(&[0xFF; 8], &expected), Err(Fault::Reset));
    for (index, register) in (0..8).zip(0x10..) {
        let mut found = expected;
        found[index] ^= 0x20;
        assert_eq!(codec::compare(&found, &expected), Err(Fault::NotAsWritten { register }));
    }
}

proptest! {
    #[test]
    fn a_burst_gives_back_what_went_in(words in prop::array::uniform7(any::<i16>())) {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let frame = codec::frame(&bytes.try_into().expect("there are fourteen"));
        let [temperature, rate @ .., x, y, z] = words;
        prop_assert_eq!(frame.temperature, temperature);
        prop_assert_eq!(frame.rate, rate);
        prop_assert_eq!(frame.force, [x, y, z]);
    }

    #[test]
    fn the_self_test_passes_within_its_limits_and_nowhere_else(
        force in 0.0..2000.0_f64, rate in 0.0..800.0_f64, sign in prop::bool::ANY, axis in 0..3_usize,
    ) {
        let sign = if sign { 1.0 } else { -1.0 };
        let mut with = [[sign * 5.0 * 400.0 / 0.07; 3], [sign * 5.0 * 500.0 / 0.122; 3]];
        with[0][axis] = sign * 5.0 * rate / 0.07;
        with[1][axis] = sign * 5.0 * force / 0.122;
        let passes = codec::self_test_passes(&[[0; 3]; 2], &with.map(|s| s.map(|c| c as i32)), 5);
        // Within a count of a limit either is right.
        let near = [90.0, 1700.0].iter().any(|limit| (force - limit).abs() < 0.2)
            || [150.0, 700.0].iter().any(|limit| (rate - limit).abs() < 0.1);
        let within = (90.0..=1700.0).contains(&force) && (150.0..=700.0).contains(&rate);
        prop_assert!(near || passes == within);
    }
}
