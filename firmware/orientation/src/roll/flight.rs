//! A flight of a spinning body, whose roll is tracked with course and pitch.

use super::attitude::Attitude;
use super::progress::Progress;
use super::setting::Setting;
use super::spin::Spin;
use super::state::{Condition, lasted};
use crate::alignment::{Input, Listener, Method, Request, Verdict};
use crate::signal::SpinSample;
use crate::units::{Instant, Radians, Seconds};

/// Samples between two reports of the roll: they cost arithmetic in software floating point.
const TRACKED_SAMPLES: u32 = 1024;

/// A flight whose roll is tracked.
#[derive(Clone, Debug)]
pub struct Flight {
    /// Properties of the gyro, and the method.
    setting: Setting,
    /// Course and pitch at the begin.
    launch: [Radians; 2],
    /// Estimator of the roll by phase lock.
    pub spin: Spin,
    /// Attitude by integration of the gyros, with the roll of the estimator.
    pub attitude: Attitude,
    /// Duration of the tracking; [`None`] for ever.
    seconds: Option<Seconds>,
    /// Time of the first sample.
    begun: Option<Instant>,
    /// Time of the latest sample.
    now: Instant,
    /// Number of samples, modulo 2³².
    samples: u32,
    /// Condition of the latest sample, and since when it is none in which the roll is known.
    condition: Condition,
    troubled: Option<Instant>,
    /// Whether the tracking has ended.
    is_over: bool,
}

impl Flight {
    /// A flight that begins with the given course and pitch, and is tracked for `seconds`, or
    /// for ever.
    #[must_use]
    pub fn new(setting: &Setting, [course, pitch]: [Radians; 2], seconds: Option<Seconds>) -> Self {
        Self {
            setting: *setting,
            launch: [course, pitch],
            spin: Spin::new(setting),
            attitude: Attitude::begin(course, pitch),
            seconds,
            begun: None,
            now: Instant::default(),
            samples: 0,
            condition: Condition::default(),
            troubled: None,
            is_over: false,
        }
    }

    /// Takes a sample.
    fn push(&mut self, sample: &SpinSample, listener: Listener) -> Request {
        self.spin.push(sample);
        self.attitude.push(sample, &self.spin);
        let begun = *self.begun.get_or_insert(sample.time);
        let before = core::mem::replace(&mut self.now, sample.time);
        self.samples = self.samples.wrapping_add(1);
        self.report_condition(before, listener);
        if self.samples % TRACKED_SAMPLES == 1 {
            self.report(listener);
        }
        let has_lasted = |seconds: Seconds| self.now.seconds() - begun.seconds() >= seconds.0;
        if self.seconds.is_some_and(has_lasted) {
            return self.end(None, listener);
        }
        Request::Continue
    }

    /// Reports a change of the condition by the latest sample, of which the one before came at this time.
    #[inline]
    fn report_condition(&mut self, before: Instant, listener: Listener) {
        let condition = core::mem::replace(&mut self.condition, self.spin.condition());
        let troubled = core::mem::replace(&mut self.troubled, self.spin.troubled());
        match [condition, self.condition] {
            [before, now] if before == now => {}
            [Condition::Holding, Condition::Locked] => {
                listener(Progress::LiftBack(lasted(troubled, before)).into());
            }
            _ => listener(Progress::Changed(self.spin.state()).into()),
        }
    }

    /// Reports the roll at present.
    fn report(&self, listener: Listener) {
        let condition = self.spin.condition();
        let roll = self.spin.roll().rad();
        listener(Progress::Tracked(Radians(roll), self.spin.sigma(), condition).into());
    }

    /// Ends the tracking, with the reason for which a sensor was given up.
    fn end(&mut self, reason: Option<Progress>, listener: Listener) -> Request {
        self.is_over = true;
        self.report(listener);
        let flown = Progress::Flown(Radians(self.spin.roll().rad()), self.spin.sigma());
        listener(reason.unwrap_or(flown).into());
        Request::Done
    }
}

impl Method<SpinSample> for Flight {
    fn begin(&mut self, listener: Listener) -> Request {
        *self = Self::new(&self.setting, self.launch, self.seconds);
        listener(Progress::Begun.into());
        Request::Continue
    }

    fn take(&mut self, input: Input<'_, SpinSample>, listener: Listener) -> Request {
        match input {
            _ if self.is_over => Request::Done,
            Input::Sample(sample) => self.push(sample, listener),
            Input::Sway(_) | Input::Displaced(_) => Request::Continue,
            Input::End => self.end(None, listener),
            Input::Failed(reason) => self.end(Some(Progress::Ended(*reason)), listener),
        }
    }

    fn compute(&mut self, _: Listener) -> Request {
        Request::Continue
    }

    fn verdict(&self) -> Option<Verdict> {
        None
    }
}
