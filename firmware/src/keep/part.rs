//! The attitude keeper as a part of the running instrument: takes inertial samples, azimuths and
//! aiding, and reports attitude and events.

use core::future::pending;

use embassy_futures::select::select;
use embassy_time::{Duration, Instant, Timer};
use orientation::alignment::refusal::Refusal;
use orientation::attitude as keep;
use orientation::attitude::{Handover, Keeper, Realigned, Report, State, Trust};
use orientation::units::{self, DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES};

use super::memory::Memory;
use super::{AttitudeReport, Motion, VerticalGyro};
use crate::configuration::{Alignment, KeepConfiguration, Realignment};
use crate::event::Event;
use crate::ports::{Aiding, Store};
use crate::shared::Shared;

/// Longest time for which inertial samples wait in the queue: half of the queue's capacity at 2
/// kHz.
const REST: Duration = Duration::from_millis(4);
/// Period of the checks of the keeper's state.
const LOOK: Duration = Duration::from_millis(100);
/// Number of state checks in one second. Once a second the keeper also reads the aiding, updates
/// the link and maintains the flash.
const LOOKS: u8 = 10;
/// Time without any inertial sample after which the motion counts as unmeasured.
const SILENCE: Duration = Duration::from_secs(1);
/// 1σ of the bias of a coarse gyro after a comparison with the precise one over ten seconds or
/// more, rad/s: its own bias instability, and scale-factor errors during the comparison.
const COMPARED_SIGMA: f64 = 30.0 * DEGREE_PER_HOUR;
/// Longest motion after a rest that does not end an alignment: a slammed door shakes a vehicle for
/// less than this.
const RESTLESS: Duration = Duration::from_secs(5);
/// Duration of the rest from which on that limit holds; after a shorter rest, the limit is longer
/// by the missing time. Biases estimated during a shorter rest may have an error that noise
/// produces in one run of two hundred; they then indicate a motion that does not exist, until rates
/// that stay constant for as long disprove it.
const LEARNING: Duration = Duration::from_secs(20);
/// Duration of an acceleration below which it is not reported as an event, s.
const REPORTED_SECONDS: f64 = 3.0;

/// The part of the instrument that keeps the attitude beside a session; the unit type keeps
/// nothing.
pub trait Keep {
    /// Runs until the configured duration of keeping is over. Never returns if nothing is kept.
    async fn run(&mut self, shared: &Shared<'_>);
}

/// An instrument without attitude keeping.
impl Keep for () {
    async fn run(&mut self, _: &Shared<'_>) {
        pending::<()>().await;
    }
}

/// The attitude keeper with its configuration, its aiding from outside, and its memory over a loss
/// of supply.
pub struct Keeping<'k, H, M> {
    /// The estimator of the attitude.
    keeper: &'k mut Keeper,
    /// Duration, policy at stops and stated errors of the gyros.
    configuration: KeepConfiguration,
    /// Source of azimuths and velocities from outside.
    aiding: H,
    /// The stored heading.
    memory: Memory<M>,
    /// The state of reports and pending actions.
    reported: Reported,
}

/// The state of reports, so that each change is reported once, and pending actions.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own; all combine")]
struct Reported {
    /// The state that was reported last.
    state: Option<State>,
    /// Time at which the latest inertial sample came, by the clock.
    moved: Instant,
    /// State checks since the latest action of every second.
    looks: u8,
    /// An azimuth that waits for the inertial sample of its time.
    found: Option<(units::Instant, Handover)>,
    /// Whether the azimuth is that from before the restart.
    is_recalled: bool,
    /// Whether the azimuth was known at the latest check.
    has_azimuth: bool,
    /// Whether a bias beyond its stated σ has been reported.
    is_bias_beyond_stated: bool,
    /// Since when the body has been at rest; [`None`] once it has set off.
    rests: Option<Instant>,
    /// Since when the body has been in motion after that rest.
    moves: Option<Instant>,
    /// Duration of motion after which the body counts as having set off.
    retry_budget: Duration,
    /// Whether this stop has had its alignment.
    is_realigned: bool,
    /// Whether no session ran at the latest check.
    is_idle: bool,
    /// Begin of the keeping, the end of the first session.
    since: Option<Instant>,
}

impl<'k, H: Aiding, M: Store> Keeping<'k, H, M> {
    /// Takes an estimator that has had no sample.
    pub fn new(
        keeper: &'k mut Keeper,
        configuration: &KeepConfiguration,
        aiding: H,
        store: M,
    ) -> Self {
        let reported = Reported {
            state: None,
            moved: Instant::MIN,
            looks: 0,
            found: None,
            is_recalled: false,
            has_azimuth: false,
            is_bias_beyond_stated: false,
            rests: None,
            moves: None,
            retry_budget: RESTLESS,
            is_realigned: true,
            is_idle: false,
            since: None,
        };
        let memory = Memory::new(store);
        Self { keeper, configuration: *configuration, aiding, memory, reported }
    }

    /// The attitude and azimuth now.
    #[must_use]
    pub fn report(&self) -> Report {
        self.keeper.report()
    }

    /// Takes the inertial samples that the session has had the chance to take, and the session's
    /// azimuth in its place among them.
    fn take(&mut self, shared: &Shared<'_>) {
        if shared.keep.is_behind.get() {
            return;
        }
        if let Some(found) = shared.keep.found.try_take() {
            self.reported.found = Some(found);
        }
        while let Ok(motion) = shared.keep.motions.try_receive() {
            self.push(motion, shared);
        }
        // The azimuth belongs to the latest sample, or to a sample without an increment.
        self.take_azimuth(units::Instant(u64::MAX), shared);
    }

    /// Takes an increment, or a change of the gyro about the down axis.
    fn push(&mut self, motion: Motion, shared: &Shared<'_>) {
        match motion {
            Motion::Moved(sample) => {
                self.take_azimuth(sample.time, shared);
                self.keeper.push(&sample);
                self.reported.moved = Instant::now();
            }
            Motion::Exchanged(down) => {
                let KeepConfiguration { beside, precise, .. } = self.configuration;
                self.keeper.exchange_down(match down {
                    VerticalGyro::Coarse => beside,
                    VerticalGyro::Calibrated => {
                        let bias_sigma = COMPARED_SIGMA.min(beside.bias_sigma);
                        keep::Gyro { bias_sigma, ..beside }
                    }
                    VerticalGyro::Precise => precise,
                });
                shared.report(Event::DownGyro(down));
            }
        }
    }

    /// Takes a found azimuth before an increment of the time `before`, if it belongs to an earlier
    /// sample. It is refused if the body has set off meanwhile.
    fn take_azimuth(&mut self, before: units::Instant, shared: &Shared<'_>) {
        let Some((_, handover)) = self.reported.found.take_if(|(at, _)| *at < before) else {
            return;
        };
        if self.has_set_off() {
            shared.report(Event::Refused(Refusal::MovedDuringAlignment));
        } else {
            self.align(handover, shared);
        }
    }

    /// Whether a body that was at rest has been in motion for so long that an alignment of that
    /// rest is invalid. In a vehicle with stops the session itself distinguishes rest from motion.
    fn has_set_off(&self) -> bool {
        !self.configuration.knows_stops
            && self
                .reported
                .moves
                .is_some_and(|since| since.elapsed() >= self.reported.retry_budget)
    }

    /// Takes an azimuth: as the first one, or fused with the kept one by an innovation test.
    #[inline(never)]
    fn align(&mut self, handover: Handover, shared: &Shared<'_>) {
        self.memory.found = None;
        let outcome = if self.keeper.report().azimuth.is_none() {
            self.keeper.hand_over(handover);
            Realigned::Taken
        } else {
            self.keeper.realign(handover)
        };
        if !matches!(outcome, Realigned::Disagrees { .. }) {
            self.reported.is_recalled = false;
        }
        shared.report(Event::handed_over(&handover, outcome));
        self.reported.has_azimuth = true;
    }

    /// Checks the state and reports its changes; once a second also does everything else.
    async fn look(&mut self, shared: &Shared<'_>) {
        let report = self.keeper.report();
        let is_silent = self.reported.moved.elapsed() >= SILENCE;
        let is_at_rest = report.is_at_rest && !is_silent;
        shared.keep.is_at_rest.set(is_at_rest);
        self.report_state((!is_silent).then_some(report.state), shared);
        self.report_loss(&report, shared);
        self.report_biases(&report, shared);
        self.rest(is_at_rest);
        self.reported.looks += 1;
        if self.reported.looks >= LOOKS {
            self.reported.looks = 0;
            self.second(shared).await;
        }
    }

    /// Reports a state that has changed. An acceleration is reported only if it lasts.
    fn report_state(&mut self, state: Option<State>, shared: &Shared<'_>) {
        let trust = |state: Option<State>| state.map(|state| state.trust);
        let is_reported = trust(state) == trust(self.reported.state);
        let passes =
            state.is_some_and(|now| now.trust == Trust::Coasting && now.seconds < REPORTED_SECONDS);
        if is_reported || passes {
            return;
        }
        self.reported.state = state;
        match state {
            Some(State { trust: Trust::Starting, .. }) => {}
            Some(state) => shared.report(Event::Keeping(state)),
            None if self.reported.moved == Instant::MIN => {}
            None => shared.report(Event::NoMotion),
        }
    }

    /// Reports once that the stated biases are not used any more.
    fn report_biases(&mut self, report: &Report, shared: &Shared<'_>) {
        let is_beyond = report.is_bias_beyond_stated;
        if is_beyond && !core::mem::replace(&mut self.reported.is_bias_beyond_stated, true) {
            shared.report(Event::BiasBeyondStated);
        }
    }

    /// Reports that the azimuth has become unknown.
    fn report_loss(&mut self, report: &Report, shared: &Shared<'_>) {
        let had = core::mem::replace(&mut self.reported.has_azimuth, report.azimuth.is_some());
        if had && report.azimuth.is_none() {
            self.reported.is_recalled = false;
            shared.report(Event::AzimuthLost);
        }
    }

    /// Tracks since when the body has been at rest. A motion as short as that of a slammed door
    /// does not end the rest.
    fn rest(&mut self, is_at_rest: bool) {
        let reported = &mut self.reported;
        if is_at_rest {
            reported.moves = None;
            reported.rests.get_or_insert(Instant::now());
        } else if let Some(rests) = reported.rests {
            let moves = *reported.moves.get_or_insert(Instant::now());
            reported.retry_budget = RESTLESS + LEARNING - (moves - rests).min(LEARNING);
            if moves.elapsed() >= reported.retry_budget {
                reported.rests = None;
                reported.is_realigned = false;
            }
        }
    }

    /// The actions of every second: reads velocity and azimuth from outside, decides on the stored
    /// heading, stores the heading, starts a new alignment, and reports.
    async fn second(&mut self, shared: &Shared<'_>) {
        self.keeper.move_at(self.aiding.velocity());
        if let Some(handover) = self.aiding.azimuth() {
            self.align(handover, shared);
            self.spare(shared);
        }
        if self.memory.recall(self.keeper, shared) {
            self.reported.is_recalled = true;
            self.reported.has_azimuth = true;
            if let Some(keep::Azimuth { angle, sigma }) = self.keeper.report().azimuth {
                let [angle, sigma] = [angle, sigma].map(|angle| angle * DEGREES);
                shared.report(Event::HeadingRecalled(angle, sigma));
            }
            self.spare(shared);
        }
        let is_at_rest = shared.keep.is_at_rest.get();
        self.memory.keep(self.keeper, is_at_rest, shared).await;
        self.realign(shared);
        self.update_link(shared);
    }

    /// Skips the running session where the azimuth is known and the configuration permits it.
    fn spare(&self, shared: &Shared<'_>) {
        if self.configuration.alignment == Alignment::UnlessKnown && !shared.keep.is_idle.get() {
            shared.keep.spare.signal(());
        }
    }

    /// Begins a new session, or aborts the running one, according to the rest and motion of the
    /// body.
    fn realign(&mut self, shared: &Shared<'_>) {
        let is_idle = shared.keep.is_idle.get();
        let was_idle = core::mem::replace(&mut self.reported.is_idle, is_idle);
        if is_idle && !was_idle {
            self.reported.since.get_or_insert(Instant::now());
            shared.keep.store.signal(());
        }
        match self.configuration.realignment {
            Realignment::BetweenStops if is_idle => shared.keep.again.signal(()),
            Realignment::AtStops { after } if is_idle => self.begin_at_stop(after, shared),
            _ => {}
        }
        if !is_idle && self.has_set_off() {
            shared.fail(Refusal::MovedDuringAlignment);
        }
    }

    /// Begins a new session where the body has been at rest for `after`, once at each stop.
    fn begin_at_stop(&mut self, after: Duration, shared: &Shared<'_>) {
        let stood = self.reported.rests.map_or(Duration::MIN, |since| since.elapsed());
        if !self.reported.is_realigned && stood >= after {
            self.reported.is_realigned = true;
            shared.report(Event::Realigning);
            shared.wanted.signal(0.0);
            shared.keep.again.signal(());
        }
    }

    /// Gives the link the attitude. Before the first session has ended, and without an azimuth, the
    /// link reports the session's status.
    fn update_link(&self, shared: &Shared<'_>) {
        let report = self.keeper.report();
        shared.observer.kept(&report);
        if self.reported.since.is_none() && report.azimuth.is_none() {
            return;
        }
        let mut kept = AttitudeReport::of(&report, self.reported.is_recalled);
        // Without inertial samples the azimuth is not valid any more.
        if self.reported.moved.elapsed() >= SILENCE {
            kept = AttitudeReport { azimuth: None, state: None, ..kept };
        }
        shared.keep.attitude.set(Some(kept));
    }

    /// Whether the configured duration of keeping is over.
    fn is_over(&self) -> bool {
        self.reported.since.is_some_and(|since| since.elapsed() >= self.configuration.hold)
    }
}

impl<H: Aiding, M: Store> Keep for Keeping<'_, H, M> {
    async fn run(&mut self, shared: &Shared<'_>) {
        if self.configuration.hold == Duration::MIN {
            pending::<()>().await;
        }
        shared.keep.is_wanted.set(true);
        self.memory.load(shared).await;
        let mut due = Instant::now() + LOOK;
        while !self.is_over() {
            select(shared.keep.caught_up.wait(), Timer::after(REST)).await;
            self.take(shared);
            if Instant::now() >= due {
                due = Instant::now() + LOOK;
                self.look(shared).await;
            }
        }
    }
}
