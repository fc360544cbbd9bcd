//! Stop rule by accuracy: the session ends when the standard deviation that noise predicts and the
//! dwells confirm is the required one, continues while it is not, and gives up as soon as the time
//! allowed cannot suffice.

use super::{Session, Task};
use crate::alignment::budget::Source;
use crate::alignment::stepwise::Refusal;
use crate::alignment::stepwise::quality::ExpectedScatter;
use crate::alignment::{self, Listener, Method, Passed, Request};
use crate::noise::GyroNoise;
use crate::planner::POSITIONS;
use crate::planner::prediction::{Visit, rate_sigma};
use crate::signal::Dwell;
use crate::units::{Angle, Degrees, Instant, Radians, RadiansPerRootSecond, Seconds};

impl Session {
    /// Sends the stage to the next position, or concludes: with an azimuth, or because the time
    /// allowed, `seconds`, is over or cannot suffice.
    pub(super) fn go_on_until(&mut self, seconds: Seconds, now: Instant) -> Request {
        if self.procedure.schedule.is_balanced(self.dwells().len()) {
            return self.compute_later(Task::Weigh(seconds, now));
        }
        self.go_on_for(self.left(seconds, now), now)
    }

    /// Time left, s.
    fn left(&self, seconds: Seconds, now: Instant) -> f64 {
        let begun = self.begun.map_or(0.0, Instant::seconds);
        seconds.0 - (now.seconds() - begun)
    }

    /// Sends the stage to the next position while there is time left, s, or else concludes.
    fn go_on_for(&mut self, left: f64, now: Instant) -> Request {
        let next = self.procedure.schedule.position(self.dwells().len());
        match next {
            Some(next) if next.seconds.0 <= left && self.dwells().len() < POSITIONS => {
                self.go_to(next, now)
            }
            _ => self.conclude(None),
        }
    }

    /// Concludes where the accuracy is reached or out of reach, and goes on otherwise.
    #[inline(never)]
    pub(super) fn weigh(&mut self, seconds: Seconds, now: Instant, listener: Listener) -> Request {
        let left = self.left(seconds, now);
        let is_final = match self.judge(seconds, left) {
            Some(Ok(())) => self.try_to_conclude(left),
            Some(Err(reason)) => {
                self.draw(Some(reason));
                true
            }
            None => false,
        };
        if is_final {
            return self.finish(listener);
        }
        match self.go_on_for(left, now) {
            Request::Compute => self.compute(listener),
            request => request,
        }
    }

    /// Whether the accuracy that noise predicts is reached, or out of reach in the time left, s, of
    /// that allowed; [`None`] where the time left may suffice, and without a prediction.
    fn judge(&self, seconds: Seconds, left: f64) -> Option<Passed> {
        let rate = self.setting.site.latitude.horizontal_rate().0;
        let noise = self.noise();
        let required = self.setting.site.required_sigma;
        let visits = self.dwells().iter().map(Visit::from);
        if rate_sigma(&noise, self.shortest(), visits)? / rate <= required.0 {
            return Some(Ok(()));
        }
        let least = Radians(self.least_rate_sigma(&noise, left)? / rate);
        (least > required).then(|| Err(self.out_of_reach(least, seconds).into()))
    }

    /// Refusal of the required σ, where this one is the least that the time allowed gives.
    pub(super) fn out_of_reach(&self, sigma: Radians, seconds: Seconds) -> Refusal {
        let [sigma, required] = [sigma, self.setting.site.required_sigma].map(Degrees::from);
        Refusal::OutOfReach { sigma, required, seconds }
    }

    /// Draws the conclusion; false where noise alone still makes the complete fit too uncertain and
    /// there is time left, s.
    fn try_to_conclude(&mut self, left: f64) -> bool {
        self.draw(None);
        let verdict = self.conclusion.as_ref().map(|conclusion| conclusion.verdict);
        let noise = [Source::Noise, Source::Drift, Source::Temperature, Source::Scatter];
        match verdict {
            Some(Err(alignment::Refusal::BudgetNotMet { source, .. }))
                if noise.contains(&source) && self.procedure.schedule.shortest().0 <= left =>
            {
                self.conclusion = None;
                false
            }
            _ => true,
        }
    }

    /// Noise model of the gyro, with N as configured or, where that is greater, as the dwells show
    /// it.
    fn noise(&self) -> GyroNoise {
        let norm = ExpectedScatter::of(&self.setting, self.dwells());
        let white = norm.white.max(norm.observed_white(self.dwells()));
        let angle_random_walk = RadiansPerRootSecond(libm::sqrt(white));
        GyroNoise { angle_random_walk, ..*self.setting.site.noise.model() }
    }

    /// Rate uncertainty after all positions that still fit into the time left, 1σ, rad/s.
    fn least_rate_sigma(&self, noise: &GyroNoise, left: f64) -> Option<f64> {
        let (schedule, done) = (&self.procedure.schedule, self.dwells().len());
        let seconds = schedule.shortest();
        let period = self.period().max(seconds.0);
        let begin = self.dwells().last().map_or(0.0, |dwell| dwell.end().0);
        let more = ((left / period) as usize).min(POSITIONS - done);
        let to_come = (0..more).filter_map(|index| {
            let stage = Angle::from_rad(schedule.position(done + index)?.angle.0);
            let middle = Seconds(begin + (index + 1) as f64 * period - 0.5 * seconds.0);
            Some(Visit::from(&Dwell { stage, middle, seconds, ..Dwell::default() }))
        });
        rate_sigma(noise, self.shortest(), self.dwells().iter().map(Visit::from).chain(to_come))
    }

    /// Length of the shortest dwell, s.
    fn shortest(&self) -> f64 {
        self.dwells().iter().map(|dwell| dwell.seconds.0).fold(f64::INFINITY, f64::min)
    }

    /// Mean time from one dwell to the next so far, s.
    fn period(&self) -> f64 {
        let [first, .., last] = self.dwells() else { return 0.0 };
        (last.middle.0 - first.middle.0) / (self.dwells().len() - 1) as f64
    }
}
