//! Sine and cosine in integers against those in `f64`, and against exact values.

use orientation::math::turn::sine_and_cosine;
use proptest::prelude::*;

/// 2⁶², one.
const ONE: f64 = 4_611_686_018_427_387_904.0;

#[test]
fn sines_of_known_angles_are_exact_to_their_last_digits() {
    // mpmath 1.3.0, mp.dps = 40: nint(2⁶² sin(2π a/2⁶⁴)), nint(2⁶² cos(…)).
    let cases: [(u64, i64, i64); 5] = [
        (0x0000_0000_0000_0000, 0, 4_611_686_018_427_387_904),
        (0x1234_5678_9abc_def0, 1_992_643_806_511_830_222, 4_158_968_452_985_511_368),
        (0x4000_0000_0000_0001, 4_611_686_018_427_387_904, -2),
        (0x8765_4321_1234_5678, -832_497_618_711_833_019, -4_535_922_799_982_136_100),
        (0xfedc_ba98_7654_3210, -128_765_830_913_063_343, 4_609_887_991_410_195_028),
    ];
    for (angle, sine, cosine) in cases {
        let (shown_sine, shown_cosine) = sine_and_cosine(angle);
        assert!((shown_sine - sine).abs() <= 32, "{angle}: {shown_sine} {sine}");
        assert!((shown_cosine - cosine).abs() <= 32, "{angle}: {shown_cosine} {cosine}");
    }
}

proptest! {
    #[test]
    fn sines_are_those_of_f64(angle in any::<u64>()) {
        let (sine, cosine) = sine_and_cosine(angle);
        let turns = angle.cast_signed() as f64 / (4.0 * ONE);
        let (expected_sine, expected_cosine) = (std::f64::consts::TAU * turns).sin_cos();
        prop_assert!((sine as f64 / ONE - expected_sine).abs() < 6e-16);
        prop_assert!((cosine as f64 / ONE - expected_cosine).abs() < 6e-16);
    }
}
