//! What stands around every simulated board: its log, the wire of its link, and the clock.

use std::cell::{Cell, RefCell};
use std::future::poll_fn;
use std::pin::pin;
use std::task::Poll;

use conversation::{Conversation, Listening};
use embassy_sync::mutex::Mutex;
use embassy_time::Instant;
use firmware::event::Event;
use firmware::health::Health;
use firmware::keep::Keep;
use firmware::mechanism::Mechanism;
use firmware::ports::{Aiding, BaseReading, Observer, Recorder, Store};
use firmware::run::{navigate, store};
use firmware::settings::{BoardSettings, CarrierSchedule, Serial, Settings};
use firmware::shared::Channels;
use hal_mock::assembly::{Board, Chips};
use orientation::alignment::{Azimuth, Method, Progress};
use orientation::attitude::Report;
use orientation::navigation::{self, aligner};
use orientation::signal::Timed;
use orientation::units;

use super::kept::Kept;
use super::latest::Latest;
use super::wire::{Traffic, Wire};
use super::{Run, RunError};
use crate::methods::Course;
use crate::output::seconds;
use crate::report::Stretch;
use crate::{interrupt, virtual_time};

/// A harness on which a board is put: it keeps what the board reports and passes it on.
pub(super) struct Harness<'w> {
    events: RefCell<Vec<(Instant, Event)>>,
    reports: RefCell<Vec<Report>>,
    base: RefCell<Vec<(Instant, BaseReading)>>,
    bytes: RefCell<Vec<u8>>,
    found: RefCell<Vec<(units::Instant, Azimuth)>>,
    earlier: RefCell<Vec<Stretch>>,
    /// Whether the run was interrupted.
    is_interrupted: Cell<bool>,
    watch: &'w dyn Observer,
    traffic: Option<&'w dyn Traffic>,
}

impl Observer for Harness<'_> {
    fn event(&self, at: Instant, event: &Event) {
        self.events.borrow_mut().push((at, *event));
        self.watch.event(at, event);
    }

    fn kept(&self, report: &Report) {
        self.reports.borrow_mut().push(*report);
        self.watch.kept(report);
    }

    fn aligns(&self, input: &aligner::Input) {
        self.watch.aligns(input);
    }

    fn navigates(&self, input: &navigation::Input) {
        if let navigation::Input::Found(at, azimuth) = input {
            self.found.borrow_mut().push((*at, *azimuth));
        }
        self.watch.navigates(input);
    }

    fn sensed(&self, at: Instant, reading: &BaseReading) {
        let is_end = |event: &Event| {
            matches!(event, Event::Alignment(Progress::Concluded(_) | Progress::Refused(_)))
        };
        if !self.events.borrow().iter().any(|(_, event)| is_end(event)) {
            self.base.borrow_mut().push((at, *reading));
        }
        self.watch.sensed(at, reading);
    }
}

impl<'w> Harness<'w> {
    /// An empty one; what a board reports goes on to `watch`.
    pub(super) fn new(watch: &'w dyn Observer, traffic: Option<&'w dyn Traffic>) -> Self {
        let (events, reports, base, bytes, found, earlier, is_interrupted) = Default::default();
        Self { events, reports, base, bytes, found, earlier, is_interrupted, watch, traffic }
    }

    /// The channels of the board's parts, whose world is a simulated one.
    pub(super) fn channels<S>(&self) -> Channels<'_, S> {
        let mut channels = Channels::new(self);
        channels.shared.is_simulated = true;
        channels
    }

    /// Runs an instrument to its end in virtual time on this thread, beside the acquisition of its
    /// samples; what it ends with, and when. Where the program is interrupted, it ends there. Commands over the link are
    /// about these settings, or those of the factory.
    ///
    /// # Errors
    /// Everything waits and nothing would come.
    pub(super) fn run<S: Timed>(
        &self,
        acquisition: impl Future<Output = ()>,
        mechanism: &mut impl Mechanism,
        (method, keeping): (&mut dyn Method<S>, impl Keep),
        (aiding, mut recorder, memory): (&dyn Aiding, impl Recorder<S>, impl Store),
        (settings, channels): (Option<Settings<impl CarrierSchedule + 'static>>, &Channels<'_, S>),
    ) -> Result<(Health, Instant), RunError> {
        let instrument = async {
            let shared = &channels.shared;
            let settings = Mutex::new(settings.unwrap_or_default());
            let kept = BoardSettings { settings: &settings, serial: Serial([0; 12]) };
            let listener = self.traffic.map(|_| Listening::new(kept, || ()));
            let link = Wire::new(&self.bytes, self.traffic);
            let mut conversation = Conversation::new(link, listener, shared);
            let beside = (store(memory, Some(kept), shared), conversation.until_over());
            let run = navigate(mechanism, method, keeping, aiding, &mut recorder, beside, channels);
            let health = self.until_interrupted(run).await;
            (health.unwrap_or_else(|| channels.shared.health.get()), Instant::now())
        };
        virtual_time::run_beside(acquisition, instrument).map_err(|_| RunError::Deadlock)
    }

    /// Drives what runs to its end, or until the program is interrupted: then there is nothing that it ends with.
    async fn until_interrupted<T>(&self, run: impl Future<Output = T>) -> Option<T> {
        let mut run = pin!(run);
        poll_fn(|context| {
            self.is_interrupted.set(interrupt::ends_input());
            if self.is_interrupted.get() {
                return Poll::Ready(None);
            }
            run.as_mut().poll(context).map(Some)
        })
        .await
    }

    /// The session of a run, and whether it was concluded before its own end: where the run was interrupted while no azimuth
    /// was known. What earlier alignments did is kept beside it.
    pub(super) fn concluded<S, M: Method<S> + Course>(&self, session: Latest<M>) -> (M, bool) {
        self.earlier.replace(session.earlier::<S>());
        let is_known = self.reports.borrow().iter().any(|report| report.azimuth.is_some());
        session.into_session(self.is_interrupted.get() && !is_known)
    }

    /// What is left of a run on a board, with what was true.
    pub(super) fn clear<R, T, P, C: Chips<P>>(
        self,
        (health, at): (Health, Instant),
        board: &RefCell<Board<'_, P, C>>,
        (replay, is_cut_short): (R, bool),
        truth: T,
    ) -> Run<R, T> {
        let mut board = board.borrow_mut();
        let violations = board.recorded();
        Run {
            replay,
            is_cut_short,
            earlier: self.earlier.into_inner(),
            truth,
            events: self.events.into_inner(),
            reports: self.reports.into_inner(),
            base: self.base.into_inner(),
            lines: String::from_utf8_lossy(&self.bytes.into_inner()).into_owned(),
            seconds: seconds(at),
            found: self.found.into_inner(),
            found_rad: None,
            kept: Kept::default(),
            health,
            violations: violations
                .map(|(chip, violation)| format!("{chip:?}: {violation}"))
                .collect(),
        }
    }
}
