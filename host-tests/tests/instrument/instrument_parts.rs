//! The small parts of the instrument, each against a closed form or its written rule.

use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_futures::select::select;
use embassy_time::{Duration, Timer};
use firmware::align::align;
use firmware::calibration::{Calibration, Harmonics};
use firmware::guarded::Guarded;
use firmware::health::Health;
use firmware::ports::{NoRecorder, Startable};
use firmware::retry_budget::{Remedy, RetryBudget, Symptom};
use firmware::shared::{Channels, Shared};
use firmware::timeline::{Arrival, Timeline};
use host::virtual_time;
use orientation::alignment::{Input, Listener, Method, Refusal, Request, Verdict};
use orientation::device::{Device, Trouble};
use orientation::navigation::Order;
use orientation::signal::Sample;
use orientation::units::{self, Angle};
use proptest::prelude::*;

/// The end of a conversion by a line whose edges are not counted.
fn timed(microseconds: u64) -> Edge {
    Edge { at: units::Instant(microseconds), count: 0 }
}

#[test]
fn samples_a_period_apart_are_in_time_and_a_quarter_is_forgiven() {
    let mut timeline = Timeline::new(2500);
    let times = [0, 2500, 5000 + 600, 7500 - 25, 10_000];
    assert!(times.iter().all(|time| timeline.judge(timed(*time)) == Arrival::InTime));
}

#[test]
fn a_sample_beside_its_time_is_late_or_early_by_what_it_is_beside() {
    let mut timeline = Timeline::new(2500);
    assert_eq!(timeline.judge(timed(0)), Arrival::InTime);
    assert_eq!(timeline.judge(timed(3400)), Arrival::Late(900));
    assert_eq!(timeline.judge(timed(5000)), Arrival::Late(-900));
}

#[test]
fn every_missing_sample_is_counted_however_many() {
    for missing in [1_u32, 2, 3, 40, 100_000] {
        let mut timeline = Timeline::new(417);
        timeline.judge(timed(0));
        let gap = u64::from(missing + 1) * 417 + 30;
        assert_eq!(timeline.judge(timed(gap)), Arrival::Missing(missing));
    }
}

#[test]
fn over_a_long_gap_the_count_is_better_than_a_clock_that_is_two_per_cent_off() {
    for conversions in [40_u32, 250, 5000] {
        let mut timeline = Timeline::new(2500);
        timeline.judge(Edge { count: u32::MAX - 2, ..timed(0) });
        let end =
            Edge { count: conversions.wrapping_sub(3), ..timed(u64::from(conversions) * 2550) };
        assert_eq!(timeline.judge(end), Arrival::Missing(conversions - 1));
    }
}

#[test]
fn the_count_of_a_converter_that_stood_still_is_not_taken_for_the_samples_that_are_missing() {
    let mut timeline = Timeline::new(2500);
    timeline.judge(timed(0));
    assert_eq!(timeline.judge(Edge { count: 3, ..timed(250_000) }), Arrival::Missing(99));
}

/// A device that always starts.
struct Willing;

impl Startable for Willing {
    async fn start(&mut self) -> Result<(), Fault> {
        Ok(())
    }
}

/// Faults that end in a restart until the device is given up, with this time between them; at most a hundred.
fn restarts_with(pause: Duration) -> usize {
    let run = async {
        let shared = Shared::new(&());
        let mut willing = Willing;
        let mut device = Guarded::new(&mut willing, Device::Encoder);
        for restarts in 0..100 {
            if device.mend(Symptom::Stuck, &shared).await.is_err() {
                return restarts;
            }
            Timer::after(pause).await;
        }
        100
    };
    virtual_time::run(run).expect("it ends")
}

#[test]
fn restarts_are_forgiven_to_a_device_that_has_worked_for_a_minute_since_the_latest() {
    assert_eq!(restarts_with(Duration::from_secs(59)), 5);
    assert_eq!(restarts_with(Duration::from_secs(60)), 100);
}

#[test]
fn a_failing_bus_costs_three_readings_before_the_device_is_started_again() {
    for fault in [Fault::Bus, Fault::Hung] {
        let mut retry_budget = RetryBudget::default();
        let remedies = [(); 5].map(|()| retry_budget.failed(Symptom::Chip(fault)));
        let [a, b, c, d, e] = remedies;
        assert_eq!([a, b, c], [Remedy::Drop; 3]);
        assert_eq!([d, e], [Remedy::Restart, Remedy::Drop]);
    }
}

#[test]
fn a_good_reading_restores_the_patience_with_the_bus() {
    let mut retry_budget = RetryBudget::default();
    let checksum = Symptom::Chip(Fault::Checksum);
    for _ in 0..100 {
        assert_eq!(retry_budget.failed(checksum), Remedy::Drop);
        retry_budget.succeeded();
    }
}

#[test]
fn what_no_repetition_mends_restarts_five_times_and_then_is_given_up_for_its_reason() {
    for (symptom, trouble) in [
        (Symptom::Chip(Fault::Reset), Trouble::Resets),
        (Symptom::Chip(Fault::Identity { found: 0 }), Trouble::Identity),
        (Symptom::Chip(Fault::SelfTest), Trouble::SelfTest),
        (Symptom::Chip(Fault::NotAsWritten { register: 1 }), Trouble::NotAsWritten),
        (Symptom::Chip(Fault::NotReady), Trouble::Silent),
        (Symptom::Chip(Fault::Alarm { status: 1 }), Trouble::Alarm),
        (Symptom::Silent, Trouble::Silent),
        (Symptom::Stuck, Trouble::Stuck),
    ] {
        let mut retry_budget = RetryBudget::default();
        for _ in 0..5 {
            assert_eq!(retry_budget.failed(symptom), Remedy::Restart);
        }
        assert_eq!(retry_budget.failed(symptom), Remedy::GiveUp(trouble));
    }
}

proptest! {
    #[test]
    fn a_calibrated_encoder_is_right_within_one_second_of_arc(
        truth in 0.0..core::f64::consts::TAU,
        first in 0.0..2e-3_f64,
        second in 0.0..1e-3_f64,
        phase in -3.0..3.0_f64,
    ) {
        let parts = |amplitude: f64| {
            [amplitude * phase.cos(), amplitude * phase.sin()].map(|part| part as f32)
        };
        let harmonics = Harmonics { first: parts(first), second: parts(second) };
        // The calibration is stated over the shown angle: find what is shown for this truth.
        let error = |shown: f64| first * (shown + phase).sin() + second * (2.0 * shown + phase).sin();
        let shown = (0..20).fold(truth, |shown, _| truth + error(shown));
        let corrected = Calibration::new(harmonics).correct(Angle::from_rad(shown));
        let off = (corrected - Angle::from_rad(truth)).signed_rad();
        prop_assert!(off.abs() < 4.85e-6 * (1.0 + 1e3 * (first + second)), "off by {} ″", off * 206_265.0);
    }
}

#[test]
fn without_harmonics_the_angle_is_untouched() {
    let mut calibration = Calibration::new(Harmonics::default());
    for step in (0..=u32::MAX).step_by(0x0123_4567) {
        assert_eq!(calibration.correct(Angle(step)), Angle(step));
    }
}

#[test]
fn every_fault_counts_once() {
    let mut health = Health::default();
    health.lose(Device::Gyro);
    health.lose(Device::Stage);
    health.restart(Device::Encoder);
    health.missing += 3;
    assert_eq!(health.faults(), 6);
}

/// A method that needs no sample, and ends where it has failed; how often it began, and whether it is over.
#[derive(Default)]
struct Begun {
    times: usize,
    verdict: Option<Verdict>,
}

impl Method<Sample> for Begun {
    fn begin(&mut self, _: Listener<'_>) -> Request {
        (self.times, self.verdict) = (self.times + 1, None);
        Request::Continue
    }

    fn take(&mut self, input: Input<'_, Sample>, _: Listener<'_>) -> Request {
        let Input::Failed(reason) = input else { return Request::Continue };
        self.verdict = Some(Err(*reason));
        Request::Done
    }

    fn compute(&mut self, _: Listener<'_>) -> Request {
        Request::Continue
    }

    fn verdict(&self) -> Option<Verdict> {
        self.verdict
    }
}

/// Begins an alignment after each ending of the one before, which fails; `between` is done before the aligner hears of the
/// order. Returns how many alignments began.
fn begun_after(orders: usize, between: impl Fn(&Shared<'_>)) -> usize {
    let channels = Channels::<Sample>::new(&());
    let shared = &channels.shared;
    let (mut method, mut recorder) = (Begun::default(), NoRecorder);
    virtual_time::run(async {
        let aligning = align(&mut method, &(), &mut recorder, &channels);
        let ordering = async {
            for _ in 0..orders {
                shared.fail(Refusal::TimeExhausted);
                Timer::after(Duration::from_secs(1)).await;
                assert!(shared.is_idle());
                shared.order(Order::Restart);
                between(shared);
                Timer::after(Duration::from_secs(1)).await;
            }
        };
        select(aligning, ordering).await;
    })
    .expect("time wakes everybody");
    method.times
}

#[test]
fn an_alignment_that_is_ordered_begins_whatever_fails_meanwhile() {
    assert_eq!(begun_after(3, |_| ()), 4);
    assert_eq!(begun_after(3, |shared| shared.fail(Refusal::MovedDuringAlignment)), 4);
    assert_eq!(begun_after(3, |shared| shared.order(Order::Skip)), 4);
}
