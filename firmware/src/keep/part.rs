//! The keeper at work, a part of the instrument.

use core::future::pending;

use embassy_futures::select::select;
use embassy_time::{Duration, Instant, Timer};
use orientation::error::Refusal;
use orientation::keep::{self, Handover, Keeper, Realigned, Report, State};
use orientation::units::{self, DEGREE_PER_HOUR, DEGREES_PER_RADIAN as DEGREES};

use super::memory::Memory;
use super::{Kept, Motion, VerticalGyro};
use crate::configuration::{Alignment, KeepConfiguration, Realignment};
use crate::event::Event;
use crate::ports::{Aiding, HeadingStore, Observer};
use crate::shared::Shared;

/// How long motions may wait: half of what the channel holds at 2 kHz.
const REST: Duration = Duration::from_millis(4);
/// Time between two looks at the state.
const LOOK: Duration = Duration::from_millis(100);
/// Looks in a second, after which the outside is asked, the link told and the flash looked after.
const LOOKS: u8 = 10;
/// Time without any motion after which there is none.
const SILENCE: Duration = Duration::from_secs(1);
/// 1σ of the bias of a coarse gyro that was compared with a precise one over some ten seconds at least:
/// its own flicker, and scale errors of what was turned meanwhile, rad/s.
const COMPARED_SIGMA: f64 = 30.0 * DEGREE_PER_HOUR;
/// How long a body may not rest, though it did before, until its alignment is of no use: a slammed door is
/// over by then.
const RESTLESS: Duration = Duration::from_secs(5);
/// How long it must have rested for that. Biases that were learnt in less may be off by what noise makes of one
/// run in two hundred, and show a motion where there is none, until rates that stay even for as long deny it.
const LEARNING: Duration = Duration::from_secs(20);
/// How long it must go on, s, that a vehicle speeds up until it is told.
const TOLD_SECONDS: f64 = 3.0;

/// Something that keeps beside a session, or does not.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Keep {
    /// Keeps until the time is over; never ends where nothing is kept.
    async fn run<O: Observer>(&mut self, shared: &Shared<'_, O>);
}

/// Nothing is kept.
impl Keep for () {
    async fn run<O: Observer>(&mut self, _: &Shared<'_, O>) {
        pending::<()>().await;
    }
}

/// A keeper with what it needs from the outside.
pub struct Keeping<'k, H, M> {
    keeper: &'k mut Keeper,
    configuration: KeepConfiguration,
    outside: H,
    memory: Memory<M>,
    told: Told,
}

/// What was told, and what is to be done.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own; all combine")]
struct Told {
    state: Option<State>,
    /// The clock when the latest motion came.
    moved: Instant,
    looks: u8,
    /// An azimuth that waits for the sample that it belongs to.
    found: Option<(units::Instant, Handover)>,
    is_recalled: bool,
    has_azimuth: bool,
    is_bias_beyond_stated: bool,
    /// Since when the body has rested, and since when not any more; whether it was realigned there.
    rests: Option<Instant>,
    moves: Option<Instant>,
    /// How long it may move until it has set off.
    retry_budget: Duration,
    is_realigned: bool,
    /// Whether there was no session at the last look.
    is_idle: bool,
    /// When keeping began: the first session's end.
    since: Option<Instant>,
}

impl<'k, H: Aiding, M: HeadingStore> Keeping<'k, H, M> {
    /// Takes a keeper that has taken nothing.
    pub fn new(
        keeper: &'k mut Keeper,
        configuration: &KeepConfiguration,
        outside: H,
        store: M,
    ) -> Self {
        let told = Told {
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
        Self { keeper, configuration: *configuration, outside, memory, told }
    }

    /// What is kept now.
    #[must_use]
    pub fn report(&self) -> Report {
        self.keeper.report()
    }

    /// What the heading is kept in over a loss of supply.
    #[must_use]
    pub fn store(&self) -> &M {
        self.memory.store()
    }

    /// Takes the motions that the session has had the chance to take.
    fn take<O: Observer>(&mut self, shared: &Shared<'_, O>) {
        if shared.keep.is_behind.get() {
            return;
        }
        if let Some(found) = shared.keep.found.try_take() {
            self.told.found = Some(found);
        }
        while let Ok(motion) = shared.keep.motions.try_receive() {
            self.push(motion, shared);
        }
        // The azimuth belongs to this sample, or to one that made no motion.
        self.take_azimuth(units::Instant(u64::MAX), shared);
    }

    fn push<O: Observer>(&mut self, motion: Motion, shared: &Shared<'_, O>) {
        match motion {
            Motion::Moved(sample) => {
                self.take_azimuth(sample.time, shared);
                self.keeper.push(&sample);
                self.told.moved = Instant::now();
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
                shared.tell(Event::DownGyro(down));
            }
        }
    }

    /// Hands a found azimuth over before a motion of this time, if it belongs to one before.
    fn take_azimuth<O: Observer>(&mut self, before: units::Instant, shared: &Shared<'_, O>) {
        let Some((_, handover)) = self.told.found.take_if(|(at, _)| *at < before) else { return };
        if self.has_set_off() {
            shared.tell(Event::Refused(Refusal::MovedDuringAlignment));
        } else {
            self.align(handover, shared);
        }
    }

    /// Whether a base that rested has been on its way for so long that its alignment is of no use. In a
    /// vehicle the session itself knows stops from drives.
    fn has_set_off(&self) -> bool {
        !self.configuration.knows_stops
            && self.told.moves.is_some_and(|since| since.elapsed() >= self.told.retry_budget)
    }

    /// Takes an azimuth, beside one that is known already.
    #[inline(never)]
    fn align<O: Observer>(&mut self, handover: Handover, shared: &Shared<'_, O>) {
        self.memory.drop_found();
        let outcome = if self.keeper.report().azimuth.is_none() {
            self.keeper.hand_over(handover);
            Realigned::Taken
        } else {
            self.keeper.realign(handover)
        };
        if !matches!(outcome, Realigned::Disagrees { .. }) {
            self.told.is_recalled = false;
        }
        shared.tell(Event::handed_over(&handover, outcome));
        self.told.has_azimuth = true;
    }

    /// Looks about: the state, and once a second everything else.
    async fn look<O: Observer>(&mut self, shared: &Shared<'_, O>) {
        let report = self.keeper.report();
        let is_silent = self.told.moved.elapsed() >= SILENCE;
        let is_at_rest = report.is_at_rest && !is_silent;
        shared.keep.is_at_rest.set(is_at_rest);
        self.tell_state((!is_silent).then_some(report.state), shared);
        self.tell_loss(&report, shared);
        self.tell_biases(&report, shared);
        self.rest(is_at_rest);
        self.told.looks += 1;
        if self.told.looks >= LOOKS {
            self.told.looks = 0;
            self.second(shared).await;
        }
    }

    /// Tells a state that is new. Speeding up is told only where it lasts.
    fn tell_state<O: Observer>(&mut self, state: Option<State>, shared: &Shared<'_, O>) {
        let is_told = match (state, self.told.state) {
            (Some(now), Some(then)) => {
                core::mem::discriminant(&now) == core::mem::discriminant(&then)
            }
            (now, then) => now.is_none() && then.is_none(),
        };
        let passes = matches!(state, Some(State::Coasting { seconds }) if seconds < TOLD_SECONDS);
        if is_told || passes {
            return;
        }
        self.told.state = state;
        match state {
            Some(State::Starting) => {}
            Some(state) => shared.tell(Event::Keeping(state)),
            None if self.told.moved == Instant::MIN => {}
            None => shared.tell(Event::NoMotion),
        }
    }

    /// Tells that what was stated of the biases is not believed any more.
    fn tell_biases<O: Observer>(&mut self, report: &Report, shared: &Shared<'_, O>) {
        let is_beyond = report.is_bias_beyond_stated;
        if is_beyond && !core::mem::replace(&mut self.told.is_bias_beyond_stated, true) {
            shared.tell(Event::BiasBeyondStated);
        }
    }

    /// Tells that the azimuth was known and is not any more.
    fn tell_loss<O: Observer>(&mut self, report: &Report, shared: &Shared<'_, O>) {
        let had = core::mem::replace(&mut self.told.has_azimuth, report.azimuth.is_some());
        if had && report.azimuth.is_none() {
            self.told.is_recalled = false;
            shared.tell(Event::AzimuthLost);
        }
    }

    /// Notes since when the body rests. What is shorter than a slammed door is no motion.
    fn rest(&mut self, is_at_rest: bool) {
        let told = &mut self.told;
        if is_at_rest {
            told.moves = None;
            told.rests.get_or_insert(Instant::now());
        } else if let Some(rests) = told.rests {
            let moves = *told.moves.get_or_insert(Instant::now());
            told.retry_budget = RESTLESS + LEARNING - (moves - rests).min(LEARNING);
            if moves.elapsed() >= told.retry_budget {
                told.rests = None;
                told.is_realigned = false;
            }
        }
    }

    async fn second<O: Observer>(&mut self, shared: &Shared<'_, O>) {
        self.keeper.move_at(self.outside.velocity());
        if let Some(handover) = self.outside.azimuth() {
            self.align(handover, shared);
            self.spare(shared);
        }
        if self.memory.recall(self.keeper, shared) {
            self.told.is_recalled = true;
            self.told.has_azimuth = true;
            if let Some(keep::Azimuth { angle, sigma }) = self.keeper.report().azimuth {
                let [angle, sigma] = [angle, sigma].map(|angle| angle * DEGREES);
                shared.tell(Event::HeadingRecalled(angle, sigma));
            }
            self.spare(shared);
        }
        let is_at_rest = shared.keep.is_at_rest.get();
        self.memory.keep(self.keeper, is_at_rest, shared).await;
        self.realign(shared);
        self.tell(shared);
    }

    /// The azimuth is known: the session may be spared.
    fn spare<O: Observer>(&self, shared: &Shared<'_, O>) {
        if self.configuration.alignment == Alignment::UnlessKnown && !shared.keep.is_idle.get() {
            shared.keep.spare.signal(());
        }
    }

    /// Has a session begin, or end, as the body stands or moves.
    fn realign<O: Observer>(&mut self, shared: &Shared<'_, O>) {
        let is_idle = shared.keep.is_idle.get();
        let was_idle = core::mem::replace(&mut self.told.is_idle, is_idle);
        if is_idle && !was_idle {
            self.told.since.get_or_insert(Instant::now());
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

    /// Has a session begin where the body has stood for so long, once at each stop.
    fn begin_at_stop<O: Observer>(&mut self, after: Duration, shared: &Shared<'_, O>) {
        let stood = self.told.rests.map_or(Duration::MIN, |since| since.elapsed());
        if !self.told.is_realigned && stood >= after {
            self.told.is_realigned = true;
            shared.tell(Event::Realigning);
            shared.wanted.signal(0.0);
            shared.keep.again.signal(());
        }
    }

    /// Gives the link what it tells: the session's own status until something is kept.
    fn tell<O: Observer>(&self, shared: &Shared<'_, O>) {
        let report = self.keeper.report();
        shared.observer().kept(&report);
        if self.told.since.is_none() && report.azimuth.is_none() {
            return;
        }
        let mut kept = Kept::of(&report, self.told.is_recalled);
        if self.told.moved.elapsed() >= SILENCE {
            kept = Kept { azimuth: None, state: None, ..kept };
        }
        shared.keep.told.set(Some(kept));
    }

    /// Whether the time is over.
    fn is_over(&self) -> bool {
        self.told.since.is_some_and(|since| since.elapsed() >= self.configuration.hold)
    }
}

impl<H: Aiding, M: HeadingStore> Keep for Keeping<'_, H, M> {
    async fn run<O: Observer>(&mut self, shared: &Shared<'_, O>) {
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
