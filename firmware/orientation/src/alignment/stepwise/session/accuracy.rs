//! Stop rule by accuracy: the session ends when the standard deviation that noise predicts and the
//! dwells confirm is the required one, continues while it is not, and gives up as soon as the time
//! allowed cannot suffice.

use super::{Command, Session};
use crate::alignment::budget::Source;
use crate::alignment::refusal::Refusal;
use crate::alignment::stepwise::quality::ExpectedScatter;
use crate::noise::model::GyroNoise;
use crate::planner::POSITIONS;
use crate::planner::prediction::{Visit, rate_sigma};
use crate::signal::dwell::Dwell;
use crate::units::{Angle, DEGREES_PER_RADIAN, Instant};

impl Session {
    /// Sends the stage to the next position, or concludes: with an azimuth, or because the time
    /// allowed, `seconds`, is over or cannot suffice.
    pub(super) fn go_on_until(&mut self, seconds: f64, now: Instant) -> Command {
        let begun = self.begun.map_or(0.0, Instant::seconds);
        let left = seconds - (now.seconds() - begun);
        if self.procedure.schedule.is_balanced(self.dwells().len())
            && let Some(command) = self.weigh(seconds, left)
        {
            return command;
        }
        let next = self.procedure.schedule.position(self.dwells().len());
        match next {
            Some(next) if next.seconds <= left && self.dwells().len() < POSITIONS => {
                self.go_to(next, now)
            }
            _ => self.conclude(None),
        }
    }

    /// Concludes where the accuracy is reached or out of reach; `None` to continue.
    #[inline(never)]
    fn weigh(&mut self, seconds: f64, left: f64) -> Option<Command> {
        let rate = self.setting.site.latitude.horizontal_rate();
        let noise = self.noise();
        let required = self.setting.site.required_sigma;
        let sigma =
            rate_sigma(&noise, self.shortest(), self.dwells().iter().map(Visit::from))? / rate;
        if sigma <= required {
            return self.try_to_conclude(left);
        }
        let least = self.least_rate_sigma(&noise, left)? / rate;
        let is_hopeless = least > required;
        let [sigma, required] = [least, required].map(|angle| angle * DEGREES_PER_RADIAN);
        is_hopeless.then(|| self.conclude(Some(Refusal::OutOfReach { sigma, required, seconds })))
    }

    /// Concludes, unless noise alone still makes the complete fit too uncertain and there is time
    /// left.
    fn try_to_conclude(&mut self, left: f64) -> Option<Command> {
        let command = self.conclude(None);
        let verdict = self.conclusion.as_ref().map(|conclusion| conclusion.verdict);
        let noise = [Source::Noise, Source::Drift, Source::Temperature];
        match verdict {
            Some(Err(Refusal::BudgetNotMet { source, .. }))
                if noise.contains(&source) && self.procedure.schedule.shortest() <= left =>
            {
                self.resume();
                None
            }
            _ => Some(command),
        }
    }

    /// Noise model of the gyro, with N as configured or, where that is greater, as the dwells show
    /// it.
    fn noise(&self) -> GyroNoise {
        let norm = ExpectedScatter::of(&self.setting, self.dwells());
        let white = norm.white.max(norm.observed_white(self.dwells()));
        GyroNoise { angle_random_walk: libm::sqrt(white), ..*self.setting.site.noise.model() }
    }

    /// Rate uncertainty after all positions that still fit into the time left, 1σ, rad/s.
    fn least_rate_sigma(&self, noise: &GyroNoise, left: f64) -> Option<f64> {
        let (schedule, done) = (&self.procedure.schedule, self.dwells().len());
        let seconds = schedule.shortest();
        let period = self.period().max(seconds);
        let begin = self.dwells().last().map_or(0.0, Dwell::end);
        let more = ((left / period) as usize).min(POSITIONS - done);
        let to_come = (0..more).filter_map(|index| {
            let stage = Angle::from_rad(schedule.position(done + index)?.angle);
            let middle = begin + (index + 1) as f64 * period - 0.5 * seconds;
            Some(Visit::from(&Dwell { stage, middle, seconds, ..Dwell::default() }))
        });
        rate_sigma(noise, self.shortest(), self.dwells().iter().map(Visit::from).chain(to_come))
    }

    /// Length of the shortest dwell, s.
    fn shortest(&self) -> f64 {
        self.dwells().iter().map(|dwell| dwell.seconds).fold(f64::INFINITY, f64::min)
    }

    /// Mean time from one dwell to the next so far, s.
    fn period(&self) -> f64 {
        let [first, .., last] = self.dwells() else { return 0.0 };
        (last.middle - first.middle) / (self.dwells().len() - 1) as f64
    }
}
