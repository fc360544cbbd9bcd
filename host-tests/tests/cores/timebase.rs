//! The clocks of an instrument: what a nominal second lasts, over what angles integrate, what is contradicted.

use orientation::timebase::{Clock, Timebase};
use orientation::units::{AngleIncrement, AngularRate, Instant};

/// The MSI at 4 MHz, locked to the crystal: 122 times 32 768 Hz.
const LOCKED: [u64; 2] = [122 * 32_768, 4_000_000];

fn of(converter: Clock, controller: Clock) -> Timebase {
    Timebase::new(converter, controller, LOCKED)
}

#[test]
fn a_nominal_second_of_a_locked_oscillator_lasts_576_millionths_longer() {
    let clocks = of(Clock::Converter, Clock::Crystal);
    for seconds in [1, 60, 3600, 86_400, 100 * 86_400_u64] {
        let shown = seconds * 1_000_000;
        let exact = u128::from(shown) * 4_000_000 / u128::from(LOCKED[0]);
        let true_time = u128::from(clocks.instant(Instant(shown)).0);
        // A part in 2³² of the excess is left.
        assert!(exact.abs_diff(true_time) <= 1 + u128::from(shown >> 31), "{seconds} s");
        let parts = (true_time as f64 / shown as f64 - 1.0) * 1e6;
        assert!((parts - 576.3).abs() < 1.1, "{parts}");
    }
    let nominal = Timebase::nominal(Clock::Crystal, Clock::Crystal);
    assert_eq!(nominal.instant(Instant(u64::MAX)), Instant(u64::MAX));
}

#[test]
fn stamps_that_follow_each_other_add_up_whatever_is_rounded() {
    let clocks = of(Clock::Converter, Clock::Crystal);
    let at = |index: u64| clocks.instant(Instant(index * 2_500)).0;
    let steps: Vec<u64> = (0..10_000).map(|index| at(index + 1) - at(index)).collect();
    assert!(steps.iter().all(|step| (2501..=2502).contains(step)));
    let mean = steps.iter().sum::<u64>() as f64 / steps.len() as f64;
    assert!((mean / 2500.0 - 1.000_576_3).abs() < 1e-7, "{mean}");
}

#[test]
fn angles_integrate_over_the_better_clock() {
    use Clock::{Controller, Converter, Crystal};
    // In a vehicle an oscillator feeds the converters; on a stage none does, and its crystal may be dead.
    for (converter, controller, counts, sigma, tolerance) in [
        (Crystal, Crystal, true, 57.7e-6, 0.002),
        (Converter, Crystal, false, 57.7e-6, 0.0201),
        (Crystal, Controller, true, 57.7e-6, 0.0101),
        (Converter, Controller, true, 11.547e-3, 0.03),
    ] {
        let clocks = of(converter, controller);
        assert_eq!(clocks.counts_periods(), counts, "{clocks:?}");
        assert!((clocks.scale_sigma() / sigma - 1.0).abs() < 1e-3, "{}", clocks.scale_sigma());
        assert!((clocks.period_tolerance() - tolerance).abs() < 1e-12, "{clocks:?}");
        assert!(clocks.with_scale(5e-4) > 5e-4 && clocks.with_scale(5e-4) < 12e-3);
        // Three periods of 1200 Hz, of which a microsecond is no divisor, 2505 µs by the stamps.
        let integrated = clocks.integrated(3, 833_333, 2505);
        assert_eq!(integrated, if counts { 2_499_999 } else { 2_505_000 });
    }
}

#[test]
fn increments_over_periods_that_are_no_whole_microseconds_sum_to_the_angle() {
    let clocks = of(Clock::Crystal, Clock::Crystal);
    // A minute at 10 °/s and 1200 Hz.
    let rate = AngularRate::from_rad_per_s(10f64.to_radians());
    let mut carried = 0;
    let sum: f64 = (0..72_000)
        .map(|_| AngleIncrement::of_rate_over(rate, clocks.integrated(1, 833_333, 0), &mut carried))
        .map(AngleIncrement::rad)
        .sum();
    assert!((sum / 600f64.to_radians() - 1.0).abs() < 1e-6, "{sum}");
}
