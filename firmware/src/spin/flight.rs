//! The roll of a body while it flies, with course and pitch beside it.

use orientation::keep::spin::attitude::Attitude;
use orientation::keep::spin::{Setting, Spin, State};
use orientation::signal::SpinSample;
use orientation::units::{DEGREES_PER_RADIAN as DEGREES, Instant, TURN, wrapped};

use crate::event::Event;
use crate::link::Status;

/// Samples between two statuses: the link tells one a second, and each costs some soft-float arithmetic.
const STATUS_SAMPLES: u32 = 1024;

/// A flight that is followed.
#[derive(Clone, Debug)]
pub struct Flight {
    spin: Spin,
    attitude: Attitude,
    /// How long it is followed, s; none for ever.
    seconds: Option<f64>,
    begun: Option<Instant>,
    now: Instant,
    samples: u32,
    told: State,
}

impl Flight {
    /// A flight that begins with such a course and pitch, rad; it is followed for so many seconds, or for
    /// ever.
    #[must_use]
    pub fn new(setting: &Setting, [course, pitch]: [f64; 2], seconds: Option<f64>) -> Self {
        Self {
            spin: Spin::new(setting),
            attitude: Attitude::begin(course, pitch),
            seconds,
            begun: None,
            now: Instant::default(),
            samples: 0,
            told: State::Searching,
        }
    }

    /// The roll, as it is known.
    #[must_use]
    pub fn spin(&self) -> &Spin {
        &self.spin
    }

    /// The attitude that the gyros carry on, its roll overridden.
    #[must_use]
    pub fn attitude(&self) -> &Attitude {
        &self.attitude
    }

    /// Takes a sample.
    pub fn push(&mut self, sample: &SpinSample) {
        self.spin.push(sample);
        self.attitude.push(sample, &self.spin);
        self.begun.get_or_insert(sample.time);
        self.now = sample.time;
        self.samples = self.samples.wrapping_add(1);
    }

    /// Whether it has been followed for long enough.
    #[must_use]
    pub fn is_over(&self) -> bool {
        let elapsed = |begun: Instant| self.now.seconds() - begun.seconds();
        self.seconds.zip(self.begun).is_some_and(|(seconds, begun)| elapsed(begun) >= seconds)
    }

    /// What the latest sample changed of the state, if that is news.
    pub(super) fn news(&mut self) -> Option<Event> {
        let state = self.spin.state();
        let before = core::mem::replace(&mut self.told, state);
        if core::mem::discriminant(&before) == core::mem::discriminant(&state) {
            return None;
        }
        Some(match (before, state) {
            (State::Holding { seconds }, State::Locked) => Event::LiftBack(seconds),
            (_, state) => Event::Roll(state),
        })
    }

    /// Whether it is time for another status.
    pub(super) fn is_status_due(&self) -> bool {
        self.samples % STATUS_SAMPLES == 1
    }

    /// The status line's part.
    #[must_use]
    pub fn status(&self) -> Status {
        let thousandths = |angle: f64| libm::ceil(angle * DEGREES * 1e3) as u32;
        let sigma = self.spin.sigma().map(thousandths);
        let roll = libm::round(wrapped(self.spin.roll().rad()) * DEGREES * 1e3) as u32 % 360_000;
        Status::Rolling { roll: sigma.map(|sigma| [roll, sigma]), state: word(&self.spin.state()) }
    }

    /// What there is to tell at its end.
    #[must_use]
    pub fn ending(&self) -> Event {
        let roll = self.spin.roll().rad();
        let turns = libm::floor(roll / TURN);
        let sigma = self.spin.sigma().map(|sigma| sigma * DEGREES);
        Event::Flown { turns: turns as i32, roll: wrapped(roll) * DEGREES, sigma }
    }
}

/// A state in a word, for the status line.
fn word(state: &State) -> &'static str {
    match state {
        State::Searching => "searching",
        State::Locked => "locked",
        State::Holding { .. } => "holding",
        State::NotSpinning { .. } => "not spinning",
        State::ForceLost { .. } => "force lost",
        State::RotationLost { .. } => "rotation lost",
        State::AccelerometerStuck { .. } => "accelerometer stuck",
        State::GyroStuck { .. } => "gyro stuck",
        State::Mirrored { .. } => "forces mirrored",
        State::Elliptic { .. } => "forces elliptic",
        State::Contradicted { .. } => "forces contradict",
    }
}
