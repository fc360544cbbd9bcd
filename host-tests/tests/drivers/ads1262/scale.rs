//! The integer scale against floating point.

use drivers::ads1262::configuration::Gain;
use drivers::ads1262::scale::{INTERNAL_REFERENCE_VOLTS, Scale};
use orientation::units::AngularRate;
use proptest::prelude::*;

const GAINS: [Gain; 6] = [Gain::X1, Gain::X2, Gain::X4, Gain::X8, Gain::X16, Gain::X32];

/// A gyro of 1 V per rad/s behind gain 1: full scale is 2.5 rad/s, beyond the range of a rate.
#[test]
fn known_voltages_give_known_rates() {
    let scale = Scale::new(1.0, INTERNAL_REFERENCE_VOLTS, Gain::X1).expect("it is one");
    assert_eq!(scale.rate(0), AngularRate(0));
    // One quarter of 2.5 V is 0.625 rad/s.
    assert_eq!(scale.rate(1 << 29), AngularRate(625_000_000));
    assert_eq!(scale.rate(-(1 << 29)), AngularRate(-625_000_000));
    assert_eq!(scale.rate(i32::MAX), AngularRate(i32::MAX));
    assert!(scale.rate(i32::MIN).is_saturated());
    let reversed = Scale::new(-1.0, INTERNAL_REFERENCE_VOLTS, Gain::X32).expect("it is one");
    assert_eq!(reversed.rate(1 << 29), AngularRate(-19_531_250));
}

#[test]
fn rates_are_rounded_to_nearest_with_ties_upwards() {
    // Half a nrad/s per code.
    let factor = INTERNAL_REFERENCE_VOLTS / 2_147_483_648.0 * 1e9 / 0.5;
    let scale = Scale::new(factor, INTERNAL_REFERENCE_VOLTS, Gain::X1).expect("it is one");
    for (code, rate) in [(1, 1), (2, 1), (3, 2), (-1, 0), (-2, -1), (-3, -1)] {
        assert_eq!(scale.rate(code), AngularRate(rate), "{code}");
    }
}

#[test]
fn there_is_no_scale_without_a_finite_factor() {
    for volts in [0.0, -0.0, f64::NAN, f64::INFINITY, 1e-12, 1e12] {
        assert_eq!(Scale::new(volts, INTERNAL_REFERENCE_VOLTS, Gain::X1), None, "{volts}");
    }
    for reference in [0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(Scale::new(1.0, reference, Gain::X1), None, "{reference}");
    }
}

#[test]
fn gains_are_powers_of_two() {
    let factors: Vec<f64> = GAINS.into_iter().map(Gain::factor).collect();
    assert_eq!(factors, [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]);
}

proptest! {
    #[test]
    fn a_rate_is_that_of_floating_point_within_the_stated_bound(
        code: i32,
        exponent in -3.0_f64..3.0,
        is_reversed: bool,
        gain in 0_usize..6,
    ) {
        let volts = 10_f64.powf(exponent) * if is_reversed { -1.0 } else { 1.0 };
        let scale = Scale::new(volts, 2.5, GAINS[gain]).expect("it is one");
        let amplified = f64::from(code) / 2_147_483_648.0 * 2.5;
        let exact = amplified / GAINS[gain].factor() / volts * 1e9;
        let found = f64::from(scale.rate(code).0);
        let limit = f64::from(i32::MAX);
        if exact.abs() < limit - 2.0 {
            let bound = 0.5 + exact.abs() / 2_147_483_648.0 + 1e-6;
            prop_assert!((found - exact).abs() <= bound, "{found} {exact}");
        } else if exact.abs() > limit + 2.0 {
            prop_assert!(scale.rate(code).is_saturated());
            prop_assert_eq!(found > 0.0, exact > 0.0);
        }
    }

    #[test]
    fn a_greater_code_is_no_smaller_rate(one: i32, other: i32, exponent in -3.0_f64..3.0) {
        let scale = Scale::new(10_f64.powf(exponent), 2.5, Gain::X1).expect("it is one");
        prop_assert!(scale.rate(one.min(other)) <= scale.rate(one.max(other)));
    }
}
