//! The navigator: holds the azimuth beside and after the alignment, judges azimuths from elsewhere
//! and from before a restart, and orders new alignments.

use super::Order;
use super::policy::{Policy, Realignment};
use super::progress::{Progress, VerticalGyro};
use super::rates::Rates;
use crate::alignment::{Azimuth, Refusal, Request};
use crate::attitude::restart::{RecallRefusal, Remembered};
use crate::attitude::{Gyro, Keeper, Realigned, Report, State, Trust};
use crate::signal::InertialSample;
use crate::units::{
    DEGREE, DEGREE_PER_HOUR, Instant, MetresPerSecond, MetresPerSecondSquared, Radians,
    RadiansPerSecond, Seconds,
};

/// Period of the checks of the keeper's state, µs.
const LOOK: u64 = 100_000;
/// Number of checks in one second, after which everything else is done.
const LOOKS: u8 = 10;
/// Time after the latest sample of an alignment within which its azimuth, or its computation, must be announced, µs: what
/// turns in a few samples is less than any σ, and the course of before is not kept.
const LATE: u64 = 15_000;
/// Time without any inertial sample after which the motion counts as unmeasured, µs.
const SILENCE: u64 = 1_000_000;
/// 1σ of the bias of a coarse gyro after a comparison with the precise one over ten seconds or
/// more, rad/s: its own bias instability, and scale-factor errors during the comparison.
const COMPARED_SIGMA: f64 = 30.0 * DEGREE_PER_HOUR;
/// Longest motion after a rest that does not end an alignment, µs: a slammed door shakes a vehicle
/// for less than this.
const RESTLESS: u64 = 5_000_000;
/// Duration of the rest from which on that limit holds, µs; after a shorter rest, the limit is
/// longer by the missing time. Biases estimated during a shorter rest may have an error that noise
/// produces in one run of two hundred; they then indicate a motion that does not exist, until rates
/// that stay constant for as long disprove it.
const LEARNING: u64 = 20_000_000;
/// Duration of an acceleration below which it is not reported.
const REPORTED_SECONDS: Seconds = Seconds(3.0);
/// Least time between two saved headings of the same stop, µs.
const SAVING: u64 = 60_000_000;
/// Change of azimuth or σ that is worth saving, rad.
const CHANGE: f64 = 0.01 * DEGREE;

/// Attitude as it is reported to users, ten times a second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// Time of the latest inertial sample.
    pub time: Instant,
    /// Azimuth of body x; [`None`] if it is unknown, or if no inertial samples arrive.
    pub azimuth: Option<Azimuth>,
    /// Whether the azimuth is that saved before the loss of supply.
    pub is_recalled: bool,
    /// Whether the azimuth was given from outside, and no alignment has confirmed it since.
    pub is_from_outside: bool,
    /// Time since an azimuth was taken or confirmed; [`None`] without an azimuth, and with one that was recalled.
    pub since_aligned: Option<Seconds>,
    /// How often the azimuth was set anew rather than carried on or confirmed; it begins anew after 255.
    pub resets: u8,
    /// Pitch, nose up positive.
    pub pitch: Radians,
    /// Roll, right side down positive.
    pub roll: Radians,
    /// Standard deviation of pitch and of roll, 1σ.
    pub level_sigma: Radians,
    /// Rates of the body about its axes forward, right, down, in the mean of a tenth of a second; [`None`] where a gyro was at
    /// the limit of its range, or gives no samples.
    pub rates: Option<[RadiansPerSecond; 3]>,
    /// Rate of the azimuth, clockwise positive, in the mean of a second; [`None`] as the rates, where body x is upright, and
    /// until the gyros' biases are known to half a degree a minute.
    pub rate_of_turn: Option<RadiansPerSecond>,
    /// The keeper's state; [`None`] if no inertial samples arrive.
    pub state: Option<State>,
}

/// Motion of the body, as its inertial sensors show it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Motion {
    /// An increment of rotation and velocity.
    Moved(InertialSample),
    /// From the next increment on, another gyro measures about the down axis.
    Exchanged(VerticalGyro),
    /// From the next increment on, the forces are those of other accelerometers, or of calibrated
    /// ones, whose biases have this 1σ.
    ForcesExchanged(MetresPerSecondSquared),
}

/// Input of the navigator. What it does follows from its inputs and their order alone.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Input {
    /// The heading that was saved before the restart; before all others.
    Remembered(Remembered),
    /// Whether no alignment runs.
    Idle(bool),
    /// The latest sample that an alignment uses is of this time, and its azimuth is being computed.
    Concluding(Instant),
    /// The azimuth of an alignment, which belongs to a sample of this time.
    Found(Instant, Azimuth),
    /// Motion of the body.
    Motion(Motion),
    /// There is no increment of a later time yet: an azimuth that was found, or is being computed, belongs to
    /// the latest one.
    Settled,
    /// Aiding from outside: velocity over ground north and east, and an azimuth of body x at this
    /// moment, where they are known.
    Aided(Option<[MetresPerSecond; 2]>, Option<Azimuth>),
    /// Time has passed in which no increment came.
    Passed(Instant),
}

/// What follows from an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Output {
    /// Progress for the log.
    Progress(Progress),
    /// An order to the aligner.
    Order(Order),
    /// A request to the mechanism.
    Request(Request),
    /// The heading of a body at rest is to be saved against a loss of supply.
    Save(Remembered),
    /// The body has set off: the saved heading is not valid any more.
    Forget,
    /// Once a second: the keeper's report.
    Report(Report),
    /// Ten times a second: the attitude for users, from the first inertial sample on.
    Attitude(Attitude),
}

/// Receiver of outputs.
pub(crate) type Outlet<'a> = &'a mut dyn FnMut(Output);

/// The attitude keeper with its policy.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own; all combine")]
pub struct Navigator<'k> {
    /// The estimator of the attitude.
    keeper: &'k mut Keeper,
    /// Duration, policy at stops and stated errors of the gyros.
    policy: Policy,
    /// The heading from before the restart, until it has been accepted or rejected.
    remembered: Option<Remembered>,
    /// Whether the azimuth was given from outside; time at which it was taken or confirmed, and how often it was set anew.
    is_from_outside: bool,
    aligned: Option<Instant>,
    resets: u8,
    /// Rates of the body.
    rates: Rates,
    /// Azimuth that this run has saved, and the time.
    saved: Option<(Azimuth, Instant)>,
    /// Whether a heading is saved, by this run or before it.
    is_saved: bool,
    /// Time of the latest event, and of the first and the latest inertial sample.
    now: Instant,
    started: Option<Instant>,
    moved: Option<Instant>,
    /// Time of the next check, and checks since the latest full second.
    due: Option<Instant>,
    looks: u8,
    /// Time of an azimuth that is being computed, and an azimuth, that wait for the inertial sample of their
    /// time.
    concluding: Option<Instant>,
    found: Option<(Instant, Azimuth)>,
    /// The state that was reported last.
    state: Option<State>,
    /// Whether the azimuth is that from before the restart, whether it was known at the latest
    /// check, and whether a bias beyond its stated σ has been reported.
    is_recalled: bool,
    has_azimuth: bool,
    is_bias_beyond_stated: bool,
    /// Whether what was given from outside latest could not be used.
    is_aiding_unusable: bool,
    /// Whether the body is at rest, since when it has been, and since when it has been in motion
    /// after that.
    pub is_at_rest: bool,
    rests: Option<Instant>,
    moves: Option<Instant>,
    /// Duration of motion after which the body counts as having set off, µs.
    patience: u64,
    /// Whether this stop has had its alignment.
    is_realigned: bool,
    /// Whether no alignment runs, now and at the latest full second.
    is_idle: bool,
    was_idle: bool,
    /// Begin of the hold, the end of the first alignment.
    since: Option<Instant>,
}

impl<'k> Navigator<'k> {
    /// Takes an estimator that has had no sample.
    pub fn new(keeper: &'k mut Keeper, policy: &Policy) -> Self {
        Self {
            keeper,
            policy: *policy,
            remembered: None,
            is_from_outside: false,
            aligned: None,
            resets: 0,
            rates: Rates::default(),
            saved: None,
            is_saved: false,
            now: Instant::default(),
            started: None,
            moved: None,
            due: None,
            looks: 0,
            concluding: None,
            found: None,
            state: None,
            is_recalled: false,
            is_aiding_unusable: false,
            has_azimuth: false,
            is_bias_beyond_stated: false,
            is_at_rest: false,
            rests: None,
            moves: None,
            patience: RESTLESS,
            is_realigned: true,
            is_idle: false,
            was_idle: false,
            since: None,
        }
    }

    /// Whether the duration of the hold is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        let held = |since: Instant| self.now.0.saturating_sub(since.0) as f64 * 1e-6;
        self.since.is_some_and(|since| held(since) >= self.policy.hold_seconds.0)
    }

    /// Whether aiding is to be given before an event of this time: once a second.
    #[must_use]
    pub fn wants_aiding(&self, now: Instant) -> bool {
        self.is_due(now) && self.looks + 1 >= LOOKS
    }

    /// Takes an input, within bounded time.
    pub fn take(&mut self, input: &Input, outlet: Outlet) {
        match input {
            Input::Remembered(heading) => {
                self.remembered = Some(*heading);
                self.is_saved = true;
            }
            Input::Idle(is_idle) => self.is_idle = *is_idle,
            Input::Concluding(at) => self.concluding = Some(*at),
            Input::Found(at, azimuth) => self.found = Some((*at, *azimuth)),
            Input::Motion(Motion::Moved(sample)) => self.push(sample, outlet),
            Input::Motion(Motion::Exchanged(down)) => self.exchange(*down, outlet),
            Input::Motion(Motion::ForcesExchanged(bias_sigma)) => {
                self.keeper.exchange_forces(*bias_sigma);
            }
            Input::Settled => self.settle(Instant(u64::MAX), outlet),
            Input::Aided(velocity, azimuth) => self.aid(*velocity, *azimuth, outlet),
            Input::Passed(now) => self.tick(*now, outlet),
        }
    }

    /// Takes an increment of rotation and velocity.
    fn push(&mut self, sample: &InertialSample, outlet: Outlet) {
        self.settle(sample.time, outlet);
        self.keeper.push(sample);
        self.started.get_or_insert(sample.time);
        self.moved = Some(sample.time);
        self.tick(sample.time, outlet);
    }

    /// From the next increment on, another gyro measures about the down axis.
    fn exchange(&mut self, down: VerticalGyro, outlet: Outlet) {
        let Policy { beside, precise, .. } = self.policy;
        self.keeper.exchange_down(match down {
            VerticalGyro::Coarse => beside,
            VerticalGyro::Calibrated => {
                let sigma = RadiansPerSecond(COMPARED_SIGMA.min(beside.bias_sigma.0));
                Gyro { bias_sigma: sigma, ..beside }
            }
            VerticalGyro::Precise => precise,
        });
        outlet(Output::Progress(Progress::DownGyro(down)));
    }

    /// Takes velocity and azimuth from outside. What is not finite, an azimuth whose σ is not above zero, and one of an
    /// upright body x are reported, once in a row, and ignored.
    fn aid(
        &mut self,
        velocity: Option<[MetresPerSecond; 2]>,
        azimuth: Option<Azimuth>,
        outlet: Outlet,
    ) {
        let speed = velocity.filter(|speeds| speeds.iter().all(|speed| speed.0.is_finite()));
        let is_upright = self.keeper.is_upright();
        let direction = azimuth.filter(|azimuth| azimuth.is_possible() && !is_upright);
        let is_unusable = (speed, direction) != (velocity, azimuth);
        let was_unusable = core::mem::replace(&mut self.is_aiding_unusable, is_unusable);
        if is_unusable && !was_unusable {
            outlet(Output::Progress(Progress::AidingUnusable));
        }
        self.keeper.move_at(speed);
        if let Some(azimuth) = direction {
            let outcome = self.align(azimuth, outlet);
            self.is_from_outside |= outcome == Realigned::Taken;
            self.spare(outlet);
        }
    }

    /// Lets time pass: checks the state ten times a second and reports its changes; once a second
    /// also does everything else.
    fn tick(&mut self, now: Instant, outlet: Outlet) {
        self.now = now;
        let due = self.due.get_or_insert(Instant(now.0 + LOOK));
        if now < *due {
            return;
        }
        // Increments of any period keep the pace; after a time without any it begins anew.
        let next = due.0 + LOOK;
        *due = Instant(if next > now.0 { next } else { now.0 + LOOK });
        self.look(outlet);
        self.looks += 1;
        if self.looks >= LOOKS {
            self.looks = 0;
            self.second(outlet);
        }
        self.show(outlet);
    }

    /// Whether a check of the state is due.
    fn is_due(&self, now: Instant) -> bool {
        self.due.is_some_and(|due| now >= due)
    }

    /// Does what belongs to samples before an increment of the time `before`: marks the course for an azimuth
    /// that is being computed, and takes one that was found. It is refused if the body has set off meanwhile, or if the
    /// course was not marked before increments of later times were taken.
    fn settle(&mut self, before: Instant, outlet: Outlet) {
        if let Some(at) = self.concluding.take_if(|at| *at < before)
            && !self.is_behind(at)
        {
            self.keeper.mark(at, self.remembered.is_some());
        }
        let Some((at, azimuth)) = self.found.take_if(|(at, _)| *at < before) else { return };
        if self.has_set_off() {
            let reason = Refusal::MovedDuringAlignment;
            return outlet(Output::Progress(Progress::Refused(reason)));
        }
        if !self.policy.knows_stops {
            self.keeper.learn_from_sway();
        }
        let carried = self.keeper.carried(at, azimuth);
        if carried.is_none() && self.is_behind(at) {
            return outlet(Output::Progress(Progress::TooLate));
        }
        self.align(carried.unwrap_or(azimuth), outlet);
        self.is_from_outside = false;
    }

    /// Whether increments of so much later times than this one were taken that the course at it is not known any more.
    fn is_behind(&self, at: Instant) -> bool {
        self.moved.is_some_and(|moved| moved.0 > at.0 + LATE)
    }

    /// Whether a body that was at rest has been in motion for so long that an alignment of that
    /// rest is invalid. In a vehicle with stops the method itself distinguishes rest from motion.
    fn has_set_off(&self) -> bool {
        let moved = |since: Instant| self.now.0.saturating_sub(since.0) >= self.patience;
        !self.policy.knows_stops && self.moves.is_some_and(moved)
    }

    /// Takes an azimuth: as the first one, or fused with the held one by an innovation test.
    #[inline(never)]
    fn align(&mut self, azimuth: Azimuth, outlet: Outlet) -> Realigned {
        self.remembered = None;
        let outcome = self.keeper.realign(azimuth);
        if !matches!(outcome, Realigned::Disagrees { .. }) {
            self.is_recalled = false;
            self.aligned = Some(self.now);
        }
        // One that is fused with that which is held is carried on.
        if outcome == Realigned::Taken {
            self.resets = self.resets.wrapping_add(1);
        }
        outlet(Output::Progress(Progress::HandedOver(azimuth, outcome)));
        if matches!(outcome, Realigned::Disagrees { .. }) {
            self.forget(outlet);
        }
        self.has_azimuth = true;
        outcome
    }

    /// Checks the state and reports its changes.
    fn look(&mut self, outlet: Outlet) {
        let is_silent = self.is_silent();
        self.is_at_rest = self.keeper.is_at_rest() && !is_silent;
        self.report_state((!is_silent).then(|| self.keeper.state()), outlet);
        let has_azimuth = self.keeper.has_azimuth();
        if core::mem::replace(&mut self.has_azimuth, has_azimuth) && !has_azimuth {
            (self.is_recalled, self.is_from_outside, self.aligned) = (false, false, None);
            outlet(Output::Progress(Progress::AzimuthLost));
            self.forget(outlet);
        }
        let is_beyond = self.keeper.is_bias_beyond_stated();
        if is_beyond && !core::mem::replace(&mut self.is_bias_beyond_stated, true) {
            outlet(Output::Progress(Progress::BiasBeyondStated));
        }
        self.rest();
    }

    /// Whether no inertial sample has come for a second.
    fn is_silent(&self) -> bool {
        self.moved.is_none_or(|moved| self.now.0.saturating_sub(moved.0) >= SILENCE)
    }

    /// Reports a state that has changed. An acceleration is reported only if it lasts.
    fn report_state(&mut self, state: Option<State>, outlet: Outlet) {
        let trust = |state: Option<State>| state.map(|state| state.trust);
        let is_reported = trust(state) == trust(self.state);
        let passes =
            state.is_some_and(|now| now.trust == Trust::Coasting && now.seconds < REPORTED_SECONDS);
        if is_reported || passes {
            return;
        }
        self.state = state;
        match state {
            Some(State { trust: Trust::Starting, .. }) => {}
            Some(state) => outlet(Output::Progress(Progress::Keeping(state))),
            None if self.moved.is_none() => {}
            None => outlet(Output::Progress(Progress::NoMotion)),
        }
    }

    /// Tracks since when the body has been at rest. A motion as short as that of a slammed door
    /// does not end the rest, and while nothing is measured none begins.
    fn rest(&mut self) {
        if self.is_at_rest {
            self.moves = None;
            self.rests.get_or_insert(self.now);
        } else if let Some(rests) = self.rests.filter(|_| self.moves.is_some() || !self.is_silent())
        {
            let moves = *self.moves.get_or_insert(self.now);
            self.patience = RESTLESS + LEARNING - moves.0.saturating_sub(rests.0).min(LEARNING);
            if self.now.0.saturating_sub(moves.0) >= self.patience {
                self.rests = None;
                self.is_realigned = false;
            }
        }
    }

    /// Decides on the remembered heading, has the heading saved, orders a new alignment, and
    /// reports.
    fn second(&mut self, outlet: Outlet) {
        self.recall(outlet);
        self.save(outlet);
        self.realign(outlet);
        outlet(Output::Report(self.keeper.report()));
    }

    /// Decides on the heading from before the restart once the vehicle has rested long enough.
    fn recall(&mut self, outlet: Outlet) {
        let Some(remembered) = &self.remembered else { return };
        let outcome = match self.keeper.recall(remembered) {
            Err(RecallRefusal::NotAtRest { .. }) if self.has_left() => Err(RecallRefusal::SetOff),
            Err(RecallRefusal::NotAtRest { .. }) => return,
            outcome => outcome,
        };
        self.remembered = None;
        if let Err(reason) = outcome {
            self.forget(outlet);
            return outlet(Output::Progress(Progress::RecallRefused(reason)));
        }
        (self.is_recalled, self.has_azimuth) = (true, true);
        self.resets = self.resets.wrapping_add(1);
        if let Some(azimuth) = self.keeper.azimuth() {
            outlet(Output::Progress(Progress::HeadingRecalled(azimuth)));
        }
        self.spare(outlet);
    }

    /// Whether the body has moved for too long before the remembered heading could be decided on: since its first
    /// rest, or since the start where it has not rested.
    fn has_left(&self) -> bool {
        let since = match self.rests {
            Some(_) => self.moves,
            None => self.started,
        };
        since.is_some_and(|since| self.now.0.saturating_sub(since.0) >= RESTLESS)
    }

    /// Has the heading that is saved declared void, where there is one.
    fn forget(&mut self, outlet: Outlet) {
        self.saved = None;
        if core::mem::take(&mut self.is_saved) {
            outlet(Output::Forget);
        }
    }

    /// Has the heading of a body at rest saved, at most once a minute, and declares it void when
    /// the body sets off. The remembered one stays until it has been decided on.
    fn save(&mut self, outlet: Outlet) {
        if self.remembered.is_some() {
            return;
        }
        if !self.is_at_rest {
            return self.forget(outlet);
        }
        let Some(azimuth) = self.keeper.azimuth().filter(|azimuth| self.is_new(*azimuth)) else {
            return;
        };
        if let Some(remembered) = self.keeper.remember() {
            self.saved = Some((azimuth, self.now));
            self.is_saved = true;
            outlet(Output::Save(remembered));
        }
    }

    /// Whether azimuth or σ have changed enough, and the heading was saved long enough ago.
    fn is_new(&self, now: Azimuth) -> bool {
        let Some((then, since)) = self.saved else { return true };
        let is_other = |now: Radians, then: Radians| (now.0 - then.0).abs() > CHANGE;
        let has_changed = is_other(now.angle, then.angle) || is_other(now.sigma, then.sigma);
        has_changed && self.now.0.saturating_sub(since.0) >= SAVING
    }

    /// Skips the alignment in progress where the azimuth is known and the policy permits it.
    fn spare(&self, outlet: Outlet) {
        if self.policy.skips_known && !self.is_idle {
            outlet(Output::Order(Order::Skip));
        }
    }

    /// Orders a new alignment, or ends the one in progress, according to the rest and motion of the
    /// body.
    fn realign(&mut self, outlet: Outlet) {
        if self.is_idle && !core::mem::replace(&mut self.was_idle, self.is_idle) {
            self.since.get_or_insert(self.now);
            outlet(Output::Request(Request::Vertical));
        }
        self.was_idle = self.is_idle;
        match self.policy.realignment {
            Realignment::BetweenStops if self.is_idle => outlet(Output::Order(Order::Restart)),
            Realignment::AtStops(seconds) if self.is_idle => self.begin_at_stop(seconds, outlet),
            _ => {}
        }
        if !self.is_idle && self.has_set_off() {
            outlet(Output::Order(Order::Fail(Refusal::MovedDuringAlignment)));
        }
    }

    /// Orders a new alignment where the body has been at rest for so long, once at each
    /// stop.
    fn begin_at_stop(&mut self, seconds: Seconds, outlet: Outlet) {
        let rested = |since: Instant| self.now.0.saturating_sub(since.0) as f64 * 1e-6;
        let stood = self.rests.map_or(0.0, rested);
        if !self.is_realigned && stood >= seconds.0 {
            self.is_realigned = true;
            outlet(Output::Progress(Progress::Realigning));
            outlet(Output::Request(Request::Point(Radians(0.0))));
            outlet(Output::Order(Order::Restart));
        }
    }

    /// Shows the attitude to users.
    #[inline(never)]
    fn show(&mut self, outlet: Outlet) {
        if self.moved.is_none() {
            return;
        }
        let (shown, is_silent) = (self.keeper.show(), self.is_silent());
        let rates = self.rates.look(self.keeper);
        let azimuth = shown.azimuth.filter(|_| !is_silent);
        let since = self.aligned.filter(|_| azimuth.is_some());
        let [pitch, roll] = shown.level;
        outlet(Output::Attitude(Attitude {
            time: shown.time,
            azimuth,
            is_recalled: self.is_recalled,
            is_from_outside: self.is_from_outside,
            since_aligned: since.map(|at| Seconds(self.now.0.saturating_sub(at.0) as f64 * 1e-6)),
            resets: self.resets,
            pitch,
            roll,
            level_sigma: shown.level_sigma,
            rates: rates.body.filter(|_| !is_silent),
            rate_of_turn: rates.turn.filter(|_| !is_silent),
            state: (!is_silent).then_some(shown.state),
        }));
    }
}
