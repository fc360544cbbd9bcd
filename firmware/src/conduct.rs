//! Conducts the session: samples in, commands to the stage, and what comes of it told.

use core::future::pending;

use embassy_futures::select::{Either, select};
use embassy_time::{Duration, Instant};
use orientation::align::conclusion::Conclusion;
use orientation::error::Refusal;
use orientation::noise::fit::NoiseFit;
use orientation::session::schedule::Schedule;
use orientation::session::{Command, Event as SessionEvent, Phase, Session};
use orientation::signal::Sample;
use orientation::units::{DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES};

use crate::event::Event;
use crate::link::Status;
use crate::ports::{Observer, Recorder};
use crate::shared::Shared;

/// Longest time until the stage is homed: six searches over the whole travel, with their rests.
const HOMING: Duration = Duration::from_secs(900);
/// Part of a dwell's time that is as good as all of it.
const WHOLE: f64 = 0.99;

/// The session at work.
pub struct Conductor<'a, R, O> {
    session: &'a mut Session,
    recorder: &'a mut R,
    shared: &'a Shared<'a, O>,
    told: Told,
}

/// What has been told of the session.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    dwells: usize,
    repetitions: usize,
    is_level: bool,
    is_planned: bool,
}

impl<'a, R: Recorder, O: Observer> Conductor<'a, R, O> {
    /// Takes a session that has not begun.
    pub fn new(session: &'a mut Session, recorder: &'a mut R, shared: &'a Shared<'a, O>) -> Self {
        Self { session, recorder, shared, told: Told::default() }
    }

    /// Conducts the session to its conclusion, then waits for the link to tell of it.
    pub async fn run(&mut self) {
        self.begin();
        if let Err(reason) = self.conduct().await {
            self.session.handle(SessionEvent::Failed(reason));
        }
        self.conclude();
        self.shared.concluded.signal(());
        // The link ends the run once it has told the last status.
        pending::<()>().await;
    }

    fn begin(&self) {
        let of = self.session.planned();
        self.shared.status.set(Status::Homing);
        let dwell = self.session.procedure().schedule.shortest();
        let latitude = self.session.setting().latitude.rad() * DEGREES;
        self.shared.tell(Event::Begun { positions: of, dwell, latitude });
    }

    async fn conduct(&mut self) -> Result<(), Refusal> {
        self.check_place()?;
        self.wait_for_home().await?;
        self.session.allow_for(self.shared.sway.get());
        loop {
            let sample = self.sample().await?;
            self.recorder.record(&sample).await;
            let command = self.session.handle(SessionEvent::Sample(&sample));
            self.follow();
            match command {
                Command::Wait => {}
                Command::Rotate(angle) => self.shared.target.signal(angle),
                Command::Finished => return Ok(()),
            }
        }
    }

    /// Refuses a place where nothing could be found, before anything turns.
    fn check_place(&self) -> Result<(), Refusal> {
        let latitude = self.session.setting().latitude;
        if latitude.has_north() {
            return Ok(());
        }
        Err(Refusal::LatitudeTooHigh { latitude: latitude.rad() * DEGREES })
    }

    /// Lets samples go by until angles mean something.
    async fn wait_for_home(&self) -> Result<(), Refusal> {
        let deadline = Instant::now() + HOMING;
        while !self.shared.homed.signaled() {
            self.sample().await?;
            if Instant::now() > deadline {
                return Err(Refusal::TimeExhausted);
            }
        }
        Ok(())
    }

    /// The next sample, or why there will be none.
    async fn sample(&self) -> Result<Sample, Refusal> {
        match select(self.shared.failure.wait(), self.shared.samples.receive()).await {
            Either::First(reason) => Err(reason),
            Either::Second(sample) => Ok(sample),
        }
    }

    /// Tells what the last sample changed.
    fn follow(&mut self) {
        if !self.told.is_level && self.session.phase() != Phase::Level {
            self.told.is_level = true;
            self.tell_level();
        }
        if !self.told.is_planned && self.session.surveyed().is_some() {
            self.told.is_planned = true;
            self.tell_plan();
        }
        if self.session.repetitions().len() > self.told.repetitions {
            self.told.repetitions = self.session.repetitions().len();
            self.tell_repetition();
        }
        if self.session.dwells().len() > self.told.dwells {
            self.told.dwells = self.session.dwells().len();
            self.tell_dwell();
        }
    }

    fn tell_level(&self) {
        if let Some([along, across, down]) = self.session.force() {
            let [along, across] = [along, across].map(|f| libm::atan2(f, -down) * DEGREES);
            self.shared.tell(Event::Levelled(along, across));
        }
        if let Some(survey) = &self.session.procedure().survey {
            self.shared.tell(Event::Surveying(survey.seconds));
        }
        self.tell_status();
    }

    /// What the survey found and what follows from it.
    fn tell_plan(&self) {
        let found = self.session.surveyed().map(NoiseFit::in_field_units);
        for (coefficient, estimate) in found.into_iter().flatten() {
            self.shared.tell(Event::Noise(coefficient, estimate));
        }
        // Where the survey ended in a refusal, the schedule is still the one before it.
        if self.session.phase() == Phase::Done {
            return;
        }
        if let Schedule::Planned(plan) = &self.session.procedure().schedule {
            self.shared.tell(Event::Planned {
                positions: plan.positions(),
                dwell: plan.dwell,
                seconds: plan.seconds,
                sigma: plan.sigma(self.session.setting().latitude) * DEGREES,
            });
        }
    }

    fn tell_repetition(&self) {
        if let Some(repetition) = self.session.repetitions().last() {
            self.shared.tell(Event::Repeated(repetition.position + 1, repetition.why));
        }
    }

    fn tell_dwell(&self) {
        if let Some(dwell) = self.session.dwells().last() {
            let rate = dwell.rate / DEGREE_PER_HOUR;
            self.shared.tell(Event::Dwelled(self.told.dwells, self.session.planned(), rate));
            if dwell.seconds < WHOLE * self.session.procedure().schedule.shortest() {
                self.shared.tell(Event::CutShort(dwell.seconds));
            }
        }
        self.shared.observer().progress(self.session);
        self.tell_status();
    }

    fn tell_status(&self) {
        if self.session.phase() == Phase::Survey {
            self.shared.status.set(Status::Surveying);
            return;
        }
        let (done, of) = (self.told.dwells as u16, self.session.planned() as u16);
        self.shared.status.set(Status::Measuring { done, of });
    }

    fn conclude(&self) {
        let Some(conclusion) = self.session.conclusion() else { return };
        self.tell_left_out(conclusion);
        match conclusion.verdict {
            Ok(azimuth) => {
                let limit = conclusion.fit.as_ref().map_or(0.0, |fit| fit.limit);
                let [angle, sigma, limit] =
                    [azimuth.angle, azimuth.sigma, limit].map(|angle| angle * DEGREES);
                self.shared.tell(Event::Concluded(angle, sigma, limit));
                self.shared.status.set(Status::concluded(angle, sigma));
            }
            Err(reason) => {
                self.shared.tell(Event::Refused(reason));
                self.shared.status.set(Status::Refused);
            }
        }
    }

    fn tell_left_out(&self, conclusion: &Conclusion) {
        for (number, why) in (1..).zip(&conclusion.disturbances) {
            if let Some(why) = why {
                self.shared.tell(Event::LeftOut(number, *why));
            }
        }
    }
}
