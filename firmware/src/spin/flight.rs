//! The roll angle of a spinning body during its flight, with course and pitch.

use orientation::roll::attitude::Attitude;
use orientation::roll::{Condition, Setting, Spin, State};
use orientation::signal::SpinSample;
use orientation::units::{DEGREES_PER_RADIAN as DEGREES, Instant, TURN, wrapped};

use crate::event::Event;
use crate::link::Status;

/// Samples between two updates of the status. The link sends one line per second, and an update
/// costs arithmetic in software floating point.
const STATUS_SAMPLES: u32 = 1024;

/// A flight whose roll is tracked.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Estimator of the roll by phase lock.
    spin: Spin,
    /// Attitude by integration of the gyros, its roll replaced by the estimate.
    attitude: Attitude,
    /// Duration of the tracking, s; [`None`] for ever.
    seconds: Option<f64>,
    /// Time of the first sample.
    begun: Option<Instant>,
    /// Time of the latest sample.
    now: Instant,
    /// Number of samples, modulo 2³².
    samples: u32,
    /// State that was reported last.
    reported: State,
}

impl Flight {
    /// A flight that begins with the given course and pitch, rad, and is tracked for `seconds`, or
    /// for ever.
    #[must_use]
    pub fn new(setting: &Setting, [course, pitch]: [f64; 2], seconds: Option<f64>) -> Self {
        Self {
            spin: Spin::new(setting),
            attitude: Attitude::begin(course, pitch),
            seconds,
            begun: None,
            now: Instant::default(),
            samples: 0,
            reported: State::default(),
        }
    }

    /// The estimator of the roll.
    #[must_use]
    pub fn spin(&self) -> &Spin {
        &self.spin
    }

    /// The attitude by integration of the gyros, with the roll of the estimator.
    #[must_use]
    pub fn attitude(&self) -> &Attitude {
        &self.attitude
    }

    /// Processes a sample.
    pub fn push(&mut self, sample: &SpinSample) {
        self.spin.push(sample);
        self.attitude.push(sample, &self.spin);
        self.begun.get_or_insert(sample.time);
        self.now = sample.time;
        self.samples = self.samples.wrapping_add(1);
    }

    /// Whether the duration of the tracking is over, by the time stamps of the samples.
    #[must_use]
    pub fn is_over(&self) -> bool {
        let elapsed = |begun: Instant| self.now.seconds() - begun.seconds();
        self.seconds.zip(self.begun).is_some_and(|(seconds, begun)| elapsed(begun) >= seconds)
    }

    /// The event of a change of state by the latest sample; [`None`] if the condition is the same.
    pub(super) fn news(&mut self) -> Option<Event> {
        let state = self.spin.state();
        let before = core::mem::replace(&mut self.reported, state);
        let is_back =
            [before, state].map(|state| state.condition) == [Condition::Holding, Condition::Locked];
        if before.condition == state.condition {
            None
        } else if is_back {
            Some(Event::LiftBack(before.seconds))
        } else {
            Some(Event::Roll(state))
        }
    }

    /// Whether the status is due for an update.
    pub(super) fn is_status_due(&self) -> bool {
        self.samples % STATUS_SAMPLES == 1
    }

    /// The status for the link: roll angle and 1σ in thousandths of a degree, the 1σ rounded up.
    #[must_use]
    pub fn status(&self) -> Status {
        let thousandths = |angle: f64| libm::ceil(angle * DEGREES * 1e3) as u32;
        let sigma = self.spin.sigma().map(thousandths);
        let roll = libm::round(wrapped(self.spin.roll().rad()) * DEGREES * 1e3) as u32 % 360_000;
        Status::Rolling {
            roll: sigma.map(|sigma| [roll, sigma]),
            state: word(self.spin.state().condition),
        }
    }

    /// The event that reports the end of the flight.
    #[must_use]
    pub fn ending(&self) -> Event {
        let roll = self.spin.roll().rad();
        let turns = libm::floor(roll / TURN);
        let sigma = self.spin.sigma().map(|sigma| sigma * DEGREES);
        Event::Flown { turns: turns as i32, roll: wrapped(roll) * DEGREES, sigma }
    }
}

/// The name of a condition for the status line.
fn word(condition: Condition) -> &'static str {
    match condition {
        Condition::Searching => "searching",
        Condition::Locked => "locked",
        Condition::Holding => "holding",
        Condition::NotSpinning => "not spinning",
        Condition::ForceLost => "force lost",
        Condition::RotationLost => "rotation lost",
        Condition::AccelerometerStuck(_) => "accelerometer stuck",
        Condition::GyroStuck => "gyro stuck",
        Condition::Mirrored => "forces mirrored",
        Condition::Elliptic => "forces elliptic",
        Condition::Contradicted => "forces contradict",
    }
}
