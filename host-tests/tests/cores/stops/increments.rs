//! Angle increments lose no rotation, whatever rounds.

use orientation::units::{AngleIncrement, AngularRate};
use proptest::prelude::*;

proptest! {
    #[test]
    fn increments_sum_to_the_angle_within_a_step(angles in prop::collection::vec(-0.5..0.5f64, 1..400)) {
        let mut carried = 0.0;
        let steps: i64 =
            angles.iter().map(|angle| i64::from(AngleIncrement::from_rad(*angle, &mut carried).0)).sum();
        let whole: f64 = angles.iter().sum();
        prop_assert!((steps as f64 * AngleIncrement::STEP - whole).abs() <= AngleIncrement::STEP);
    }

    #[test]
    fn rates_sum_to_the_angle_of_whole_numbers(
        rates in prop::collection::vec((-2_000_000_000..2_000_000_000i32, 1..20_000_000u64), 1..400),
    ) {
        let (mut carried, mut steps, mut exact) = (0, 0i128, 0i128);
        for (rate, nanoseconds) in rates {
            let increment = AngleIncrement::of_rate_over(AngularRate(rate), nanoseconds, &mut carried);
            steps += i128::from(increment.0);
            exact += i128::from(rate) * i128::from(nanoseconds);
        }
        // A step is 4 nrad, a product of whole numbers 10⁻¹⁸ rad, as is what is carried.
        prop_assert!((steps * 4_000_000_000 - exact).abs() < 4_000_000_000);
        prop_assert_eq!(exact - steps * 4_000_000_000, i128::from(carried));
    }
}

#[test]
fn a_rate_at_its_limit_makes_an_increment_at_its_limit() {
    for (rate, limit) in [(i32::MAX, i32::MAX), (i32::MIN, i32::MIN)] {
        let increment = AngleIncrement::of_rate_over(AngularRate(rate), 500_000, &mut 0);
        assert_eq!(increment.0, limit);
        assert!(increment.is_saturated());
    }
}
