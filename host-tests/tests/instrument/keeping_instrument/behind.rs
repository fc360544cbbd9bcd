//! The aligner does not go on, as where the thread is busy or stuck: the keeper does.

use std::cell::RefCell;

use embassy_time::{Duration, Instant, Timer};
use firmware::event::Event;
use firmware::keep::{Keep as _, Keeping};
use firmware::ports::Observer;
use firmware::shared::{QUEUE, Shared};
use host::virtual_time;
use orientation::navigation::{self, Input, Motion, Navigator, Output};
use orientation::signal::InertialSample;
use orientation::units;

use super::handing::{TURN, azimuth, keeper, moved, policy, sample};

/// What was reported of the navigator.
#[derive(Default)]
struct Reported(RefCell<Vec<navigation::Progress>>);

impl Observer for Reported {
    fn event(&self, _: Instant, event: &Event) {
        if let Event::Navigation(progress) = event {
            self.0.borrow_mut().push(*progress);
        }
    }
}

/// How many motions are lost in thirty seconds to a keeper whose aligner takes no sample from then on, where they come
/// at this period and another is stated, and what is reported.
fn starved(period: Duration, stated: Duration) -> (usize, Vec<navigation::Progress>) {
    let reported = Reported::default();
    let shared = Shared::new(&reported);
    shared.period.set(stated);
    shared.motion_period.set(stated);
    shared.is_kept.set(true);
    shared.remembered.signal(None);
    shared.is_behind.set(true);
    let (mut keeper, policy) = (keeper(), policy());
    let mut keeping = Some(Keeping { keeper: &mut keeper, policy });
    let moving = async {
        let mut lost = 0;
        for _ in 0..30_000_000 / period.as_micros() {
            Timer::after(period).await;
            let time = units::Instant(Instant::now().as_micros());
            let still = Motion::Moved(InertialSample { time, ..sample(0, 0.0) });
            lost += usize::from(shared.motions.try_send(still).is_err());
        }
        lost
    };
    let lost = virtual_time::run_beside(keeping.keep(&(), &shared), moving);
    (lost.expect("time wakes both"), reported.0.take())
}

#[test]
fn the_keeper_takes_every_motion_where_the_aligner_takes_no_sample() {
    // A converter's oscillator and a controller's are 2 % and 1 % off at most, and the keeper's task may be late.
    for (micros, percent) in [400, 2_500, 5_000, 10_000, 20_000]
        .into_iter()
        .flat_map(|micros| [97, 100, 103].map(|percent| (micros, percent)))
    {
        let period = Duration::from_micros(micros * percent / 100);
        let (lost, reported) = starved(period, Duration::from_micros(micros));
        assert_eq!(lost, 0, "of a queue of {QUEUE} at {period:?}");
        assert!(!reported.contains(&navigation::Progress::NoMotion), "{reported:?}");
    }
}

/// What a navigator says of an azimuth of its 500th sample which is announced, or found at once, so many samples later.
fn left_behind(later: u64, announced: bool) -> Vec<Output> {
    let (mut keeper, mut outputs) = (keeper(), Vec::new());
    let policy = policy();
    let mut navigator = Navigator::new(&mut keeper, &policy);
    let mut take = |input| {
        navigator.take(&input, &mut |output| {
            if let Output::Progress(progress) = output
                && !matches!(progress, navigation::Progress::Keeping(_))
            {
                outputs.push(output);
            }
        });
    };
    (1..=500 + later).for_each(|index| take(moved(index, TURN)));
    let at = units::Instant(500 * 10_000);
    if announced {
        take(Input::Concluding(at));
    }
    take(moved(501 + later, TURN));
    take(Input::Found(at, azimuth(100.0, 0.01)));
    take(Input::Settled);
    outputs
}

#[test]
fn an_azimuth_of_a_sample_that_the_keeper_has_left_behind_is_not_taken_and_that_is_told() {
    for announced in [true, false] {
        assert_eq!(left_behind(20, announced), [Output::Progress(navigation::Progress::TooLate)]);
    }
}

#[test]
fn an_azimuth_that_is_announced_in_time_is_taken() {
    let outputs = left_behind(0, true);
    assert!(
        matches!(outputs[..], [Output::Progress(navigation::Progress::HandedOver(..))]),
        "{outputs:?}"
    );
}
