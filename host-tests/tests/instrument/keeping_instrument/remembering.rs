//! A store that fails while the keeper's heading is to be kept or forgotten.

use std::cell::{Cell, RefCell};

use drivers::fault::Fault;
use embassy_time::{Duration, Instant, Timer};
use firmware::event::Event;
use firmware::keep::remember;
use firmware::ports::{Observer, Store};
use firmware::shared::{Saving, Shared};
use host::virtual_time;
use orientation::attitude::restart::Remembered;
use orientation::units::{Radians, RadiansPerSecond, Seconds};

/// How often it was reported that the heading cannot be kept.
#[derive(Default)]
struct Reported(Cell<u32>);

impl Observer for Reported {
    fn event(&self, _: Instant, event: &Event) {
        let counted = u32::from(matches!(event, Event::HeadingNotKept(_)));
        self.0.set(self.0.get() + counted);
    }
}

/// A store that fails so many times, and what it was asked to do. It is empty, or cannot be read.
struct Failing<'a> {
    failures: usize,
    is_readable: bool,
    asked: &'a RefCell<Vec<Asked>>,
}

/// What a store was asked to do, and when, s.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Asked {
    Save(u64),
    Forget(u64),
}

impl Failing<'_> {
    /// Notes what it is asked to do, which may fail.
    fn fail(&self, asked: Asked) -> Result<(), Fault> {
        self.asked.borrow_mut().push(asked);
        let is_failing = self.asked.borrow().len() <= self.failures;
        if is_failing { Err(Fault::NotReady) } else { Ok(()) }
    }
}

impl Store for Failing<'_> {
    async fn read(&mut self, _: u8, _: &mut [u8]) -> Result<Option<usize>, Fault> {
        if self.is_readable { Ok(None) } else { Err(Fault::NotReady) }
    }

    async fn save<const N: usize>(&mut self, _: u8, _: &[u8; N]) -> Result<(), Fault> {
        self.fail(Asked::Save(Instant::now().as_secs()))
    }

    async fn forget(&mut self, _: u8) -> Result<(), Fault> {
        self.fail(Asked::Forget(Instant::now().as_secs()))
    }
}

/// Any heading.
fn heading() -> Remembered {
    let [azimuth, sigma, pitch, roll] = [1.0, 1e-3, 0.0, 0.0].map(Radians);
    let (rates, rest) = ([RadiansPerSecond(0.0); 3], Seconds(15.0));
    Remembered { azimuth, sigma, pitch, roll, rates, rest }
}

/// What a store that fails so many times is asked to do, and how often that is reported, where it is given these items at
/// these times, s, and can be read or not.
fn asked((failures, is_readable): (usize, bool), given: &[(u64, Saving)]) -> (Vec<Asked>, u32) {
    let (reported, asked) = (Reported::default(), RefCell::default());
    let shared = Shared::new(&reported);
    let mut store = Failing { failures, is_readable, asked: &asked };
    let driving = async {
        for (second, saving) in given {
            Timer::at(Instant::from_secs(*second)).await;
            shared.saving.signal(*saving);
        }
        Timer::after(Duration::from_secs(120)).await;
    };
    let remembering = async {
        remember(&mut store, None, &shared).await;
    };
    virtual_time::run_beside(remembering, driving).expect("time wakes both");
    (asked.take(), reported.0.get())
}

/// A heading from before the drive must not be recalled after it.
#[test]
fn a_heading_that_could_not_be_forgotten_is_forgotten_again_until_it_is() {
    let (asked, reported) = asked((3, true), &[(0, Saving::Nothing)]);
    assert_eq!(asked, [0, 10, 20, 30].map(Asked::Forget));
    assert_eq!(reported, 1, "it is told once");
}

/// The heading of the next rest does not make that of before the drive valid again.
#[test]
fn a_heading_that_could_not_be_forgotten_is_forgotten_before_the_next_is_kept() {
    let (asked, _) = asked((1, true), &[(0, Saving::Nothing), (5, Saving::Heading(heading()))]);
    assert_eq!(asked, [Asked::Forget(0), Asked::Forget(5), Asked::Save(5)]);
}

/// What is stored then may be of before a drive whose end came before it was forgotten.
#[test]
fn a_heading_that_could_not_be_kept_is_kept_later_and_the_one_before_it_forgotten() {
    let (asked, reported) = asked((1, true), &[(5, Saving::Heading(heading()))]);
    assert_eq!(asked, [Asked::Save(5), Asked::Forget(15), Asked::Save(15)]);
    assert_eq!(reported, 1, "it is told once");
}

/// What cannot be read at the start may be read after a drive.
#[test]
fn a_heading_that_cannot_be_read_is_forgotten() {
    let (asked, reported) = asked((1, false), &[]);
    assert_eq!(asked, [10, 20].map(Asked::Forget));
    assert_eq!(reported, 1, "it is told once");
}
