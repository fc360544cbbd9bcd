//! The clocks of an instrument: what a nominal second lasts, over what angles integrate, what is contradicted.

use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::session::{Procedure as Turning, Session as Rotating};
use orientation::alignment::rotating::{Sensor, Setting as Platform};
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::session::Session as Stepwise;
use orientation::alignment::stepwise::session::procedure::Procedure as Dwelling;
use orientation::alignment::stepwise::session::schedule::Schedule;
use orientation::alignment::stepwise::setting::Setting as Positions;
use orientation::alignment::stops::Setting as Stops;
use orientation::alignment::stops::session::{Procedure as Driving, Session as Stopping};
use orientation::alignment::stops::stop_detector::Rests;
use orientation::alignment::{Input, Method, Progress};
use orientation::earth::Latitude;
use orientation::roll;
use orientation::signal::{InertialSample, Sample, SpinSample, Timed};
use orientation::timebase::{Clock, Timebase};
use orientation::units::{
    AngleIncrement, AngularRate, Instant, Radians, RadiansPerSecond, Seconds, SpecificForce,
};
use proptest::prelude::*;

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

proptest! {
    #[test]
    fn true_time_is_shown_time_over_the_ratio_of_the_clocks_and_never_runs_back(
        shown in 0..1_u64 << 50,
        later in 0..1_u64 << 40,
        nominal in 1_000_000..100_000_000_u64,
        missing in 0..100_000_u64,
    ) {
        let clocks = Timebase::new(Clock::Converter, Clock::Crystal, [nominal - missing, nominal]);
        let at = |shown| clocks.instant(Instant(shown)).0;
        let exact = u128::from(shown) * u128::from(nominal) / u128::from(nominal - missing);
        let rounded = u128::from(at(shown));
        prop_assert!(rounded <= exact && exact - rounded <= 1 + u128::from(shown >> 32));
        // Whole parts of sums are sums of whole parts, or one more.
        let sum = at(shown) + at(later);
        prop_assert!((sum..=sum + 1).contains(&at(shown + later)));
    }
}

/// Number of the first sample that is missing in a gap, and of samples in it: half a second.
const GAP: [u64; 2] = [100, 50];

/// Whether a method refuses the period of samples that come so many seconds apart, with a gap or without one.
fn refuses<S: Timed>(
    method: &mut impl Method<S>,
    (period, has_gap): (f64, bool),
    sample: impl Fn(u64, Instant) -> S,
) -> bool {
    let mut is_contradicted = false;
    let mut listener = |progress| {
        if let Progress::Roll(roll::Progress::Ended(reason)) = progress {
            is_contradicted |= matches!(reason, Refusal::PeriodContradicted { .. });
        }
    };
    method.begin(&mut listener);
    let is_there = |index: &u64| !has_gap || !(GAP[0]..GAP[0] + GAP[1]).contains(index);
    for index in (1..3000).filter(is_there) {
        let sample = sample(index, Instant::from_seconds(index as f64 * period));
        method.take(Input::Sample(&sample), &mut listener);
    }
    method.take(Input::End, &mut listener);
    method.compute(&mut listener);
    let verdict = method.verdict().and_then(Result::err);
    is_contradicted || matches!(verdict, Some(Refusal::PeriodContradicted { .. }))
}

/// Nominal sample period, s.
const PERIOD: f64 = 0.01;

/// Whether a stage, a vehicle, a turntable and a spinning body with these clocks refuse samples whose period is off by
/// this part of the nominal one, of which some are missing or none.
fn refuse(clocks: Timebase, off: f64, has_gap: bool) -> [bool; 4] {
    let (period, nominal) = ((PERIOD * (1.0 + off), has_gap), Seconds(PERIOD));
    let period_tolerance = clocks.period_tolerance();
    let site = Site::at(Latitude::from_degrees(47.58).expect("a latitude"));
    let circle = Schedule::circle(12, Seconds(5.0));
    let dwelling = Dwelling { period_tolerance, ..Dwelling::new(circle, nominal) };
    let mut stage = Stepwise::new(Positions::new(site), dwelling).expect("a procedure");
    let at_rest = |index, time| {
        let force = Some([0.0, 0.0, -9.81].map(SpecificForce::from_m_per_s2));
        Sample { time, rate: AngularRate((index % 7) as i32), force, ..Sample::default() }
    };
    let on_stage = refuses(&mut stage, period, at_rest);
    let driving = Driving { period_tolerance, ..Driving::recorded(Rests::Whole, nominal) };
    let mut vehicle = Stopping::new(Stops::new(site), driving).expect("a procedure");
    let driven = refuses(&mut vehicle, period, |_, time| InertialSample {
        time,
        ..InertialSample::default()
    });
    let turning = Turning { period_tolerance, ..Turning::new(&[RadiansPerSecond(1.0)], nominal) };
    let turntable = Rotating::new(Platform::new(site, Sensor::GYRO), turning);
    let turned = refuses(&mut turntable.expect("a procedure"), period, at_rest);
    let setting = roll::Setting { period_tolerance, ..roll::Setting::new(nominal) };
    let mut flight = roll::Flight::new(&setting, [Radians(0.0); 2], None);
    let flown =
        refuses(&mut flight, period, |_, time| SpinSample { time, ..SpinSample::default() });
    [on_stage, driven, turned, flown]
}

#[test]
fn a_period_is_refused_beyond_what_two_crystals_or_the_data_sheets_allow_and_not_before() {
    use Clock::{Controller, Converter, Crystal};
    for (converter, controller, tolerance) in [
        (Crystal, Crystal, 0.002),
        (Converter, Crystal, 0.0201),
        (Crystal, Controller, 0.0101),
        (Converter, Controller, 0.03),
    ] {
        let clocks = of(converter, controller);
        for way in [-1.0, 1.0] {
            let sides = [-2e-5, 2e-5].map(|side| refuse(clocks, way * (tolerance + side), false));
            assert_eq!(sides, [[false; 4], [true; 4]], "{clocks:?}, {way}");
        }
    }
}

#[test]
fn samples_that_are_missing_show_no_other_period() {
    let clocks = Timebase::nominal(Clock::Crystal, Clock::Crystal);
    assert_eq!(refuse(clocks, 0.0, true), [false; 4]);
}
