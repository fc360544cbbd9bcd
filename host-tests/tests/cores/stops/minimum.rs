//! Bounded minimisation against scipy's `fminbound` and known minima.

use orientation::math::brent::minimise;
use proptest::prelude::*;

use super::assert_near;

/// Values of scipy 1.17.1, `fminbound(f, a, b, xtol=1e-10, maxfun=100, full_output=True)`: x, f(x), calls.
#[test]
fn minima_are_those_of_scipy() {
    type Case = (fn(f64) -> f64, [f64; 2], f64, f64, u32);
    let cases: [Case; 6] = [
        (
            |x| x.cos() + 0.3 * (3.0 * x).sin(),
            [2.0, 5.0],
            3.523_044_880_393_326,
            -1.201_258_253_739_482_5,
            12,
        ),
        (
            |x| (x - 1.25).powi(4) + 0.5 * (x - 1.25).powi(2),
            [-3.0, 4.0],
            1.250_000_000_149_443_3,
            0.0,
            13,
        ),
        (|x| x.exp() - 3.0 * x, [0.0, 3.0], 1.098_612_271_947_164_7, -0.295_836_866_004_329_1, 11),
        (|x| -x * (-x).exp(), [0.0, 5.0], 0.999_999_987_770_065_5, -0.367_879_441_171_442_33, 13),
        (|x| x, [1.0, 2.0], 1.000_000_015_087_588_3, 1.000_000_015_087_588_3, 37),
        (
            |x| (x - 0.3).abs(),
            [-1.0, 1.0],
            0.299_999_999_852_316_1,
            1.476_838_651_370_826_5e-10,
            26,
        ),
    ];
    for (function, bounds, at, value, calls) in cases {
        let minimum = minimise(bounds, 1e-10, 100, function);
        // √ε of the function's own scale blurs a smooth minimum.
        assert_near(minimum.at, at, 5e-8);
        assert_near(minimum.value, value, 5e-8);
        assert!(minimum.evaluations <= calls + 25, "{} for {calls}", minimum.evaluations);
    }
}

#[test]
fn the_limit_of_evaluations_holds() {
    let mut count = 0;
    let minimum = minimise([-1.0, 1.0], 0.0, 30, |x| {
        count += 1;
        (x - 0.3).abs()
    });
    assert_eq!(count, 30);
    assert_eq!(minimum.evaluations, 30);
}

proptest! {
    #[test]
    fn no_argument_lies_outside_and_a_parabola_is_found(
        lower in -10.0..10.0f64,
        width in 1e-3..20.0f64,
        place in -0.5..1.5f64,
        steepness in 1e-3..1e3f64,
    ) {
        let upper = lower + width;
        let vertex = lower + place * width;
        let mut is_inside = true;
        let minimum = minimise([lower, upper], 1e-9, 100, |x| {
            is_inside &= (lower..=upper).contains(&x);
            steepness * (x - vertex) * (x - vertex)
        });
        prop_assert!(is_inside);
        prop_assert!(minimum.evaluations <= 100);
        prop_assert!((minimum.at - vertex.clamp(lower, upper)).abs() < 1e-7 * width.max(1.0));
    }

    #[test]
    fn whatever_the_function_returns_the_search_stays_inside_and_ends(values in prop::collection::vec(any::<f64>(), 100)) {
        let mut next = values.iter();
        let minimum = minimise([0.0, 1.0], 1e-10, 60, |x| {
            assert!((0.0..=1.0).contains(&x), "{x}");
            *next.next().unwrap_or(&0.0)
        });
        prop_assert!((0.0..=1.0).contains(&minimum.at));
        prop_assert!(minimum.evaluations <= 60);
    }
}
