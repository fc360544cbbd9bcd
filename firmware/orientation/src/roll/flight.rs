//! A flight of a spinning body, whose roll is tracked with course and pitch.

use super::attitude::Attitude;
use super::progress::Progress;
use super::setting::Setting;
use super::spin::Spin;
use super::state::{Condition, lasted};
use crate::alignment::period::contradiction;
use crate::alignment::{Input, Listener, Method, Refusal, Request, Verdict};
use crate::signal::SpinSample;
use crate::units::{Instant, Radians, Seconds};

/// Samples between two reports of the roll: they cost arithmetic in software floating point.
const TRACKED_SAMPLES: u32 = 1024;
/// Time over which the samples' period is measured, s: 0.2 % of it is 2 ms, later than any stamp.
const TIMED_SECONDS: f64 = 1.0;

/// A moment from which the samples' period is measured.
#[derive(Clone, Copy, Debug)]
struct Timed {
    /// Time of its sample.
    at: Instant,
    /// Number of samples until then, and of gaps, each modulo 2³².
    samples: u32,
    gaps: u32,
}

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
    /// Since when the samples' period is measured.
    timed: Option<Timed>,
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
            timed: None,
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
            if let Some(reason) = self.contradiction() {
                return self.end(Some(Progress::Ended(reason)), listener);
            }
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

    /// Refusal of samples whose time stamps contradict the configured period, over a time without gaps.
    fn contradiction(&mut self) -> Option<Refusal> {
        let now = Timed { at: self.now, samples: self.samples, gaps: self.spin.gaps };
        let since = *self.timed.get_or_insert(now);
        let elapsed = now.at.seconds() - since.at.seconds();
        if since.gaps == now.gaps && elapsed < TIMED_SECONDS {
            return None;
        }
        self.timed = Some(now);
        let found = elapsed / f64::from(now.samples.wrapping_sub(since.samples));
        let Setting { sample_seconds, period_tolerance, .. } = self.setting;
        contradiction(sample_seconds, Seconds(found), period_tolerance)
            .filter(|_| since.gaps == now.gaps)
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
