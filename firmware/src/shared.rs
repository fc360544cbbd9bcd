//! Communication between the parts of the instrument: bounded queues of samples, signals and values.

use core::future::pending;

use embassy_sync::channel::Channel;
use embassy_sync::signal::Signal;
use embassy_time::{Duration, Instant, Timer};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::{Azimuth, Progress, Request};
use orientation::attitude::restart::Remembered;
use orientation::device::{Device, Trouble};
use orientation::earth::Latitude;
use orientation::navigation::navigator::Attitude;
use orientation::navigation::{Motion, Order};
use orientation::roll;
use orientation::signal::Sample;
use orientation::signal::sway::SwayNoise;
use orientation::timebase::{Clock, Timebase};
use orientation::units::{self, Angle, Radians};
use protocol::report::Devices;

use crate::check_ins::{CheckIns, Checked, Part};
use crate::crossing::{AnyObserver, Common, Lock};
use crate::event::Event;
use crate::health::Health;
use crate::not_begun::NotBegun;
use crate::ports::Frames;
use crate::retry_budget::{RETRY, Symptom};
use crate::settings::{Output, SettingsError};
use crate::status::Status;
use crate::storage::LogRecord;

/// Capacity of the queues: 16 ms at 2 kHz, 2 ms at 14.4 kHz.
pub const QUEUE: usize = 32;
/// Events that wait for the link: more than one alignment ends with.
const NOTICES: usize = 4;
/// How many of a queue may wait while its receiver rests: with as many that come until it looks again, and some
/// more where it is late, none is lost.
pub(crate) const WAITING: usize = QUEUE / 3;

/// The queue of samples from acquisition to the aligner.
pub type Queue<S> = Channel<Lock, S, QUEUE>;

/// All channels of an instrument whose samples are of the type `S`. Only acquisition and the
/// aligner depend on that type.
pub struct Channels<'a, S = Sample> {
    /// The samples from acquisition to the aligner.
    pub samples: Queue<S>,
    /// All other signals and values.
    pub shared: Shared<'a>,
}

impl<'a, S> Channels<'a, S> {
    /// Channels without any message; events go to the observer.
    pub fn new(observer: &'a AnyObserver<'a>) -> Self {
        Self { samples: Queue::new(), shared: Shared::new(observer) }
    }
}

/// Discards samples without end, while another part finishes.
pub async fn discard<S>(channels: &Channels<'_, S>) {
    loop {
        channels.samples.receive().await;
    }
}

/// The latest corrected angle of an axis' encoder and the time of its reading.
pub type LatestAngle = Common<(Angle, Instant)>;

/// How far the alignments are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alignments {
    /// The first alignment runs.
    First,
    /// The latest alignment is over, and no other has begun.
    Idle,
    /// A later alignment runs.
    Again,
}

/// Observation of the base's sway, of which an alignment is told before it takes samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Observation {
    /// Nothing observes it.
    #[default]
    Without,
    /// It was observed.
    Made,
    /// It is to be observed anew, for another alignment.
    Wanted,
}

/// What the navigator has kept for the next start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Saving {
    /// The heading of a body at rest.
    Heading(Remembered),
    /// The body has set off: no heading is valid.
    Nothing,
}

/// The order that waits for the aligner, which parts of any priority may give.
#[derive(Default)]
pub(crate) struct Orders {
    waiting: Common<Option<Order>>,
    given: Signal<Lock, ()>,
}

impl Orders {
    /// Gives an order, unless one goes first that waits already. One to begin an alignment goes before all that wait,
    /// which are to the one that is over.
    fn give(&self, order: Order) {
        let is_failure = |order: &Order| matches!(order, Order::Fail(_));
        self.waiting.change(|waiting| {
            let goes_first = |first: &Order| is_failure(first) || !is_failure(&order);
            let first = waiting.filter(|first| order != Order::Restart && goes_first(first));
            *waiting = Some(first.unwrap_or(order));
        });
        self.given.signal(());
    }

    /// The order that waits, which is taken.
    pub(crate) fn try_take(&self) -> Option<Order> {
        let mut taken = None;
        self.waiting.change(|waiting| taken = waiting.take());
        taken
    }

    /// Drops the order that waits unless it is such a one.
    fn retain(&self, is_kept: impl Fn(&Order) -> bool) {
        self.waiting.change(|waiting| *waiting = waiting.filter(|order| is_kept(order)));
    }

    /// Whether an order to begin an alignment waits.
    fn restarts(&self) -> bool {
        self.waiting.get() == Some(Order::Restart)
    }

    /// Waits for an order, and takes it.
    pub(crate) async fn take(&self) -> Order {
        loop {
            if let Some(order) = self.try_take() {
                return order;
            }
            self.given.wait().await;
        }
    }
}

/// Signals and values between the parts, which may run at different priorities.
pub struct Shared<'a> {
    /// From the aligner and the navigator to the mechanism: the request to obey. A new request
    /// replaces the one before.
    pub wanted: Signal<Lock, Request>,
    /// From any part to the aligner: what it is to do with its alignment.
    pub(crate) orders: Orders,
    /// From acquisition to the mechanism: the sensors give data.
    pub sensing: Signal<Lock, ()>,
    /// From the mechanism to the aligner: the angles are valid. Without a mechanism they are valid
    /// from the begin.
    pub homed: Signal<Lock, ()>,
    /// From acquisition to the navigator: the inertial samples, in the order of time.
    pub motions: Channel<Lock, Motion, QUEUE>,
    /// From the aligner to the navigator: time of the latest sample of an alignment whose azimuth is being
    /// computed.
    pub concluding: Signal<Lock, units::Instant>,
    /// Whether the aligner computes, and needs no samples.
    pub is_computing: Common<bool>,
    /// From the aligner to the navigator: an azimuth, and the time of the sample to which it
    /// belongs.
    pub found: Signal<Lock, (units::Instant, Azimuth)>,
    /// From the aligner to the navigator: all samples of the queue have been taken, or none is needed.
    pub caught_up: Signal<Lock, ()>,
    /// Whether there are samples that the aligner has not taken yet.
    pub is_behind: Common<bool>,
    /// From the store to the navigator: the heading that was saved before the restart.
    pub remembered: Signal<Lock, Option<Remembered>>,
    /// From the navigator to the store: what is to be kept for the next start. The latest replaces others.
    pub saving: Signal<Lock, Saving>,
    /// From the link to the mechanism: nothing more will happen.
    pub over: Signal<Lock, ()>,
    /// From the mechanism to the board: the motors rest, and are to be given their current, or one cannot be brought
    /// to rest, and it is to be taken away. They have none at the start.
    pub current: Signal<Lock, bool>,
    /// From the aligner to the link: an alignment is over.
    pub concluded: Signal<Lock, ()>,
    /// How far the alignments are.
    alignments: Common<Alignments>,
    /// Whether a navigator keeps the attitude.
    pub is_kept: Common<bool>,
    /// Whether the body is at rest, by the navigator's detection.
    pub is_at_rest: Common<bool>,
    /// The reason for which every alignment that begins is refused: the mechanism was given up.
    pub(crate) without_mechanism: Common<Option<Refusal>>,
    /// The same while sensors that were given up rest until they may be tried again: no angle is read meanwhile.
    pub(crate) without_sensors: Common<Option<Refusal>>,
    /// Whether the sensors are fixed to the body, so that no mechanism turns them.
    pub(crate) is_strapdown: Common<bool>,
    /// Sampling period; one second until acquisition has stated it.
    pub period: Common<Duration>,
    /// Time between two motions; one second until acquisition has stated it.
    pub motion_period: Common<Duration>,
    /// Clocks of the instrument, which a board states before its parts begin. Samples have true times;
    /// all else goes by the controller's clock as it is.
    pub clocks: Timebase,
    /// The latest angles of the encoders; the one axis of a stage is the outer one.
    pub angles: Frames<LatestAngle>,
    /// Noise that the compensated sway leaves in the samples of an alignment, known before it takes any.
    pub sway: Common<SwayNoise>,
    /// Whether that is known.
    pub(crate) observation: Common<Observation>,
    /// Counters of faults.
    pub health: Common<Health>,
    /// How far the instrument is.
    pub status: Common<Status>,
    /// From the navigator to the link: the attitude, ten times a second.
    pub attitude: Common<Option<Attitude>>,
    /// From the navigator to the link: there is a new one.
    pub looked: Signal<Lock, ()>,
    /// From any part to the link: events that it is to tell. What does not find room is not told.
    pub notices: Channel<Lock, Event, NOTICES>,
    /// Devices that were given up and not started again since.
    pub failed: Common<Devices>,
    /// Standard deviation of the azimuth that is required; [`None`] where none is determined.
    pub required: Common<Option<Radians>>,
    /// What the link sends.
    pub output: Common<Output>,
    /// Devices that have passed their self-tests since the power-on, and were not given up since.
    pub passed: Common<Devices>,
    /// From the console to the instrument: the first alignment is to begin.
    pub begin: Signal<Lock, ()>,
    /// The latitude of a satellite receiver, which holds where the settings state none.
    pub latitude: Common<Option<Latitude>>,
    /// Why nothing begins.
    pub not_begun: Common<Option<NotBegun>>,
    /// Whether alignments begin by an order from outside alone, since one was ordered to end.
    is_stopped: Common<bool>,
    /// Whether one that was ordered from outside has not begun yet.
    begins_again: Common<bool>,
    /// From the console to the navigator: an azimuth from outside.
    pub stated: Signal<Lock, Azimuth>,
    /// From the console to the store: the settings are to be kept.
    pub keep: Signal<Lock, ()>,
    /// From the store to the console: what came of that.
    pub kept: Signal<Lock, Result<(), SettingsError>>,
    /// From the console to the store: the number of a record of the log after which the next one is wanted.
    pub wanted_line: Signal<Lock, u32>,
    /// From the store to the console: that record, or nothing where there is none.
    pub line: Signal<Lock, Option<LogRecord>>,
    /// Whether the world is a simulated one, which the link says. Stated before the parts begin.
    pub is_simulated: bool,
    /// Receiver of events.
    pub observer: &'a AnyObserver<'a>,
    /// Where the parts check in.
    check_ins: Option<&'a CheckIns>,
}

impl<'a> Shared<'a> {
    /// Signals and values without any message.
    pub fn new(observer: &'a AnyObserver<'a>) -> Self {
        let unread = || Common::new((Angle(0), Instant::MIN));
        Self {
            wanted: Signal::new(),
            orders: Orders::default(),
            sensing: Signal::new(),
            homed: Signal::new(),
            motions: Channel::new(),
            concluding: Signal::new(),
            is_computing: Common::new(false),
            found: Signal::new(),
            caught_up: Signal::new(),
            is_behind: Common::new(false),
            remembered: Signal::new(),
            saving: Signal::new(),
            over: Signal::new(),
            current: Signal::new(),
            concluded: Signal::new(),
            alignments: Common::new(Alignments::First),
            is_kept: Common::new(false),
            is_at_rest: Common::new(false),
            without_mechanism: Common::default(),
            without_sensors: Common::default(),
            is_strapdown: Common::new(false),
            period: Common::new(Duration::from_secs(1)),
            motion_period: Common::new(Duration::from_secs(1)),
            clocks: Timebase::nominal(Clock::Converter, Clock::Crystal),
            angles: Frames { outer: unread(), inner: unread() },
            sway: Common::new(SwayNoise::NONE),
            observation: Common::default(),
            health: Common::default(),
            status: Common::new(Status::Starting),
            attitude: Common::default(),
            looked: Signal::new(),
            notices: Channel::new(),
            failed: Common::default(),
            required: Common::default(),
            output: Common::default(),
            passed: Common::default(),
            begin: Signal::new(),
            latitude: Common::default(),
            not_begun: Common::default(),
            is_stopped: Common::new(false),
            begins_again: Common::new(false),
            stated: Signal::new(),
            keep: Signal::new(),
            kept: Signal::new(),
            wanted_line: Signal::new(),
            line: Signal::new(),
            is_simulated: false,
            observer,
            check_ins: observer.check_ins(),
        }
    }

    /// A part that checks in with every poll.
    pub fn checked<F: Future + Unpin>(&self, part: Part, future: F) -> Checked<'a, F> {
        Checked::new(self.check_ins, part, future)
    }

    /// Gives the aligner an order. One that it has not obeyed yet goes first, unless it is replaced
    /// by a failure.
    pub fn order(&self, order: Order) {
        self.orders.give(order);
    }

    /// Ends the alignment that runs, with a reason. One that is ordered meanwhile begins all the same.
    pub fn fail(&self, reason: Refusal) {
        if !self.is_idle() {
            self.order(Order::Fail(reason));
        }
    }

    /// Notes that the first alignment is to wait for an order.
    pub fn wait_to_begin(&self) {
        self.status.set(Status::Waiting);
    }

    /// Whether the first alignment waits for an order.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        self.status.get() == Status::Waiting
    }

    /// Notes that nothing begins, for this reason: what was to be determined is not.
    pub fn refuse_to_begin(&self, reason: NotBegun) {
        self.not_begun.set(Some(reason));
        self.status.set(Status::Refused);
        self.alignments.set(Alignments::Idle);
    }

    /// Ends the alignment that runs or is about to begin by an order from outside. The navigator begins none until there is
    /// one to begin.
    pub fn stop(&self) {
        self.is_stopped.set(true);
        self.begins_again.set(false);
        self.orders.retain(|order| *order != Order::Restart);
        self.fail(Refusal::Stopped);
    }

    /// Has another alignment begin by an order from outside, once that which runs has ended.
    pub fn begin_again(&self) {
        self.begins_again.set(true);
        self.go_on();
    }

    /// Orders the alignment that waited for the end of another, where that has come.
    pub fn go_on(&self) {
        if self.begins_again.get() && self.is_idle() {
            self.is_stopped.set(false);
            self.order(Order::Restart);
        }
    }

    /// Whether an alignment is about to begin: one was ordered, and the aligner has not obeyed yet.
    fn is_beginning(&self) -> bool {
        self.begins_again.get() || self.orders.restarts()
    }

    /// Whether no alignment runs or is about to begin.
    #[must_use]
    pub fn has_none(&self) -> bool {
        self.is_idle() && !self.is_beginning()
    }

    /// Whether the alignment that runs was ordered to end, and none is to follow it.
    #[must_use]
    pub fn is_ending(&self) -> bool {
        !self.is_idle() && self.is_stopped.get() && !self.is_beginning()
    }

    /// Takes an order of the navigator. None to begin an alignment is obeyed after one from outside to end.
    pub(crate) fn order_of_navigator(&self, order: Order) {
        if order != Order::Restart || !self.is_stopped.get() {
            self.order(order);
        }
    }

    /// Notes that the aligner has taken an order; whether it is to obey: not one to begin an alignment that was ordered to
    /// end meanwhile. For an alignment that begins the base's sway is observed anew. One that begins without its devices is
    /// ended for the reason for which they were given up.
    pub(crate) fn obey(&self, order: &Order) -> bool {
        if *order != Order::Restart || !self.is_idle() {
            return true;
        }
        if self.is_stopped.get() {
            return false;
        }
        self.begins_again.set(false);
        self.alignments.set(Alignments::Again);
        if self.observation.get() == Observation::Made {
            self.observation.set(Observation::Wanted);
        }
        let reason = self.without_sensors.get().or(self.without_mechanism.get());
        if let Some(reason) = reason {
            self.fail(reason);
        }
        true
    }

    /// Ends an alignment: hands an azimuth over to the navigator, and wakes the link.
    pub(crate) fn conclude(&self, found: Option<(units::Instant, Azimuth)>) {
        self.alignments.set(Alignments::Idle);
        // Other orders were to the alignment that is over.
        self.orders.retain(|order| *order == Order::Restart);
        if let Some(found) = found {
            self.found.signal(found);
        }
        self.concluded.signal(());
    }

    /// Whether the latest alignment is over, and no other has begun.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.alignments.get() == Alignments::Idle
    }

    /// Whether an attitude is kept, and the first alignment is over, with an azimuth or without. From then on, a sensor
    /// that is given up is tried again after a pause.
    #[must_use]
    pub fn is_holding(&self) -> bool {
        self.is_kept.get() && !self.is_first()
    }

    /// The noise that the compensated sway leaves in the samples of an alignment that is to begin; [`None`] while the base
    /// is observed.
    pub(crate) fn observed_sway(&self) -> Option<SwayNoise> {
        (!self.wants_sway()).then(|| self.sway.get())
    }

    /// Whether the base's sway is to be observed anew.
    pub(crate) fn wants_sway(&self) -> bool {
        self.observation.get() == Observation::Wanted
    }

    /// States that noise.
    pub(crate) fn observe_sway(&self, noise: SwayNoise) {
        self.sway.set(noise);
        self.observation.set(Observation::Made);
    }

    /// Whether the first alignment runs.
    pub(crate) fn is_first(&self) -> bool {
        self.alignments.get() == Alignments::First
    }

    /// Whether nothing more will happen.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.is_idle() && !self.is_kept.get()
    }

    /// Counts a sample that the aligner does not need, since it computes.
    pub(crate) fn pass_by(&self) {
        self.count(|health| health.passed_by = health.passed_by.saturating_add(1));
    }

    /// Whether the navigator may take the motions that were queued: the aligner has had their samples, or needs none, or is
    /// so far behind that motions would be lost. An azimuth of a sample before is none any more, then, for the navigator.
    pub(crate) fn may_move(&self) -> bool {
        let is_filling = self.motions.len() >= WAITING;
        !self.is_behind.get() || self.is_computing.get() || is_filling
    }

    /// Signals the navigator that the aligner has taken all samples of the queue.
    pub(crate) fn catch_up(&self) {
        self.is_behind.set(false);
        self.caught_up.signal(());
    }

    /// Waits before sensors that were given up are tried again: 10 s while a navigator runs,
    /// otherwise for ever.
    pub(crate) async fn rest(&self) {
        if self.is_kept.get() {
            Timer::after(RETRY).await;
        } else {
            pending::<()>().await;
        }
    }

    /// Queues an increment for the navigator, if one runs. If the queue is full, the increment is
    /// discarded and counted; the navigator sees the gap in the time stamps.
    pub(crate) fn move_on(&self, motion: Motion) {
        if self.is_kept.get() && self.motions.try_send(motion).is_err() {
            self.count(|health| health.unkept = health.unkept.saturating_add(1));
        }
    }

    /// Reports an event with the present time. Not inlined, since every part calls it and it
    /// contains the clock and the log.
    #[inline(never)]
    pub fn report(&self, event: Event) {
        match event {
            Event::GivenUp(device, _) => self.failed.change(|failed| failed.insert(device)),
            Event::Started(device) => {
                self.failed.change(|failed| failed.remove(device));
                self.passed.change(|passed| passed.insert(device));
            }
            _ => {}
        }
        if event.is_told() {
            // The log has what finds no room.
            let _ = self.notices.try_send(event);
        }
        self.observer.event(Instant::now(), &event);
    }

    /// How far the instrument is, as it is shown: as long as the mechanism's angles are not valid, they are being sought.
    pub fn shown_status(&self) -> Status {
        let status = self.status.get();
        if self.homed.signaled() { status } else { status.before_homing() }
    }

    /// Reports an alignment's progress, and updates the status that the link sends.
    pub fn progress(&self, progress: Progress) {
        let now = Instant::now();
        self.status.change(|status| *status = status.after(&progress, now));
        if !matches!(progress, Progress::Roll(roll::Progress::Tracked(..))) {
            self.report(Event::Alignment(progress));
        }
    }

    /// Changes the counters of faults.
    pub fn count(&self, change: impl FnOnce(&mut Health)) {
        self.health.change(change);
    }

    /// Counts and reports a lost reading of a device.
    pub fn lose(&self, device: Device, symptom: Symptom) {
        self.count(|health| health.lose(device));
        self.report(Event::Lost(device, symptom));
    }

    /// Counts and reports the restart of a device.
    pub fn restart(&self, device: Device, symptom: Symptom) {
        self.count(|health| health.restart(device));
        self.report(Event::Restarting(device, symptom));
    }

    /// Reports that a device is given up, and returns the refusal that ends the alignment.
    pub fn give_up(&self, device: Device, trouble: Trouble) -> Refusal {
        self.report(Event::GivenUp(device, trouble));
        Refusal::Device { device, trouble }
    }
}
