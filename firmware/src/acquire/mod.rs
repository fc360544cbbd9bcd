//! Acquisition: on every conversion of the gyro one sample for the session, or none and the reason.
//!
//! ```text
//!  stage, turntable   gyro ─────────┬─▶ Sample          ─┐
//!                     encoder ──────┤                    ├─▶ outlet ─▶ session
//!  vehicle            three gyros ──┼─▶ InertialSample  ─┤
//!                     accelerometer ┘                    │
//!  spinning body      three gyros ──┼─▶ SpinSample      ─┘
//!                     two forces ───┘
//! ```
//!
//! Both kinds of platform share the checks of a sensor's readings: `rates` for a gyro, `forces` for
//! the accelerometer. A sample is passed on only when it is complete, and a missing one shows in
//! the next one's time.

mod coarse;
mod forces;
mod in_step;
mod one_by_one;
mod outlet;
mod rates;
mod spin;
mod stage;
mod triad;

pub use one_by_one::OneByOne;
pub use spin::SpinAcquisition;
pub use stage::{on_mount, on_stage};
pub use triad::TriadAcquisition;

use core::convert::Infallible;
use core::pin::{Pin, pin};
use core::task::Poll;

use embassy_futures::poll_once;
use embassy_time::{Duration, TimeoutError, Timer, with_timeout};
use orientation::alignment::refusal::Refusal;
use orientation::units::{AngleIncrement, AngularRate};

use crate::check_ins::Part;
use crate::repeat_counter::{RepeatCounter, STUCK};
use crate::retry_budget::Symptom;
use outlet::Outlet;

/// Longest time at the limit of the range, s: a slammed door is over by then.
const SATURATED_SECONDS: f64 = 5.0;
/// Number of periods without a conversion after which a gyro counts as silent.
const SILENCE: u32 = 8;

/// The sensors of a carrier as the source of its samples.
pub trait Source<'a> {
    /// The kind of sample.
    type Sample: 'static;

    /// The outlet of the samples.
    fn outlet(&mut self) -> &mut Outlet<'a, Self::Sample>;

    /// Starts the sensors.
    ///
    /// # Errors
    /// A sensor is given up.
    async fn start(&mut self) -> Result<(), Refusal>;

    /// Takes samples and hands them over without end.
    ///
    /// # Errors
    /// A sensor is given up without which the others do not suffice.
    async fn run(&mut self) -> Result<Infallible, Refusal>;

    /// Restores the full retry budget of all sensors.
    fn renew(&mut self);
}

/// Acquires samples without end. Where a sensor is given up, reports the reason, which ends the
/// session, and, while an azimuth is held, tries again later.
pub async fn acquire<'a>(source: &mut impl Source<'a>) {
    let shared = source.outlet().shared();
    loop {
        let Err(reason) = shared.checked(Part::Acquisition, pin!(sample_for_ever(source))).await;
        shared.fail(reason);
        shared.rest().await;
        source.renew();
    }
}

/// Starts the sensors and samples until one is given up.
async fn sample_for_ever<'a>(source: &mut impl Source<'a>) -> Result<Infallible, Refusal> {
    source.start().await?;
    source.run().await
}

/// Number of successive conversions that had waited for acquisition after which it rests: they come
/// faster than they are read. More than a board keeps for it, at most 32.
const MOST_BEHIND: u8 = 48;
/// How long it rests then, as long as it takes to read a few: no transfer of a serial bus yields, so
/// that what has less priority would never get its turn.
const REST: Duration = Duration::from_millis(1);

/// Pace at which conversions are read.
#[derive(Clone, Copy, Debug, Default)]
struct Pace {
    /// Number of successive conversions that had waited.
    behind: u8,
}

impl Pace {
    /// Rests where too many conversions in a row have waited.
    async fn rest(&mut self) {
        if self.behind == MOST_BEHIND {
            self.rest_for(REST).await;
        }
    }

    /// Rests for so long.
    async fn rest_for(&mut self, time: Duration) {
        Timer::after(time).await;
        self.behind = 0;
    }

    /// Awaits conversions, at most for so long, and notes whether they had waited; then no time limit is set.
    async fn within<T>(
        &mut self,
        limit: Duration,
        mut conversions: Pin<&mut impl Future<Output = T>>,
    ) -> Result<T, TimeoutError> {
        if let Poll::Ready(had_waited) = poll_once(conversions.as_mut()) {
            self.behind += 1;
            return Ok(had_waited);
        }
        self.behind = 0;
        with_timeout(limit, conversions).await
    }
}

/// Increments of the rates about three axes over a time, ns, with the remainders of whole steps,
/// 10⁻¹⁸ rad.
fn increments(
    rates: [AngularRate; 3],
    nanoseconds: u64,
    carried: &mut [i64; 3],
) -> [AngleIncrement; 3] {
    let [forward, right, down] = carried;
    let [about_forward, about_right, about_down] = rates;
    [
        AngleIncrement::of_rate_over(about_forward, nanoseconds, forward),
        AngleIncrement::of_rate_over(about_right, nanoseconds, right),
        AngleIncrement::of_rate_over(about_down, nanoseconds, down),
    ]
}

/// Checks of the successive readings of a sensor.
#[derive(Clone, Copy, Debug)]
struct Plausibility<T> {
    /// Counter of identical readings.
    repeats: RepeatCounter<T>,
    /// Successive samples at the limit of the range.
    saturated: u32,
    /// Greatest number of these that is tolerated.
    longest: u32,
}

impl<T: Copy + PartialEq> Plausibility<T> {
    /// Checks of a sensor with this sample rate, Hz.
    fn new(sample_rate: f64) -> Self {
        let longest = (SATURATED_SECONDS * sample_rate) as u32;
        Self { repeats: RepeatCounter::new(), saturated: 0, longest }
    }

    /// Takes a reading that stands for `samples` samples.
    ///
    /// # Errors
    /// [`Symptom::Saturated`] of a sensor that has been at the limit of its range for too long, and
    /// [`Symptom::Stuck`] of one that repeats itself too often.
    fn judge(&mut self, value: T, is_clipped: bool, samples: u32) -> Result<(), Symptom> {
        self.saturated = if is_clipped { self.saturated + samples } else { 0 };
        if self.saturated > self.longest {
            return Err(Symptom::Saturated);
        }
        if self.repeats.push(value) < STUCK || is_clipped {
            return Ok(());
        }
        self.repeats = RepeatCounter::new();
        Err(Symptom::Stuck)
    }
}
