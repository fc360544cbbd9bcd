//! Wires one simulated board to the instrument and runs it.

use std::cell::RefCell;

use embassy_time::Instant;
use embedded_io_async::{ErrorType, Write};
use firmware::event::Event;
use firmware::ports::{NoBase, Observer, Recorder};
use firmware::run::{acquire, run};
use firmware::shared::Shared;
use firmware::simulated;
use firmware::simulated::base;
use firmware::simulated::fault::{Fault, FaultyRecorder, Plan};
use firmware::simulated::scenario::Scenario;
use firmware::steady::Base;
use orientation::session::Session;

use super::{Run, RunError};
use crate::replay::{HALF, Method, Replay};
use crate::virtual_time;

/// What the board was not told but takes as known.
pub(super) const ASSUMED: &str = "latitude exact, calibrations as stated";

/// Keeps what the board tells and passes it on.
pub(super) struct Log<'a, W> {
    pub(super) events: RefCell<Vec<(Instant, Event)>>,
    watch: &'a W,
}

impl<'a, W> Log<'a, W> {
    /// An empty one.
    pub(super) fn new(watch: &'a W) -> Self {
        Self { events: RefCell::default(), watch }
    }
}

impl<W: Observer> Observer for Log<'_, W> {
    fn event(&self, at: Instant, event: &Event) {
        self.events.borrow_mut().push((at, *event));
        self.watch.event(at, event);
    }

    fn progress(&self, session: &Session) {
        self.watch.progress(session);
    }
}

/// The wire of the link: it takes everything.
pub(super) struct Wire<'a>(pub(super) &'a RefCell<Vec<u8>>);

impl ErrorType for Wire<'_> {
    type Error = core::convert::Infallible;
}

impl Write for Wire<'_> {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Runs a scenario in virtual time on this thread.
///
/// # Errors
/// What keeps the session from beginning, and a deadlock. A refusal is the session's conclusion.
pub fn align<R: Recorder, W: Observer>(
    scenario: &Scenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<Run, RunError> {
    if !scenario.has_base_imu {
        return align_on(NoBase, scenario, fault, recorder, watch);
    }
    let rig = RefCell::new(base::rig(scenario));
    let mut run = align_on(base::imu(&rig, scenario), scenario, fault, recorder, watch)?;
    let rig = rig.borrow();
    run.violations
        .extend(base::violations(&rig).iter().map(|violation| format!("Base: {violation}")));
    Ok(run)
}

/// The same with these sensors on the base.
///
/// # Errors
/// Those of [`align`].
pub fn align_on<B: Base, R: Recorder, W: Observer>(
    base: B,
    scenario: &Scenario,
    fault: Option<Fault>,
    recorder: R,
    watch: &W,
) -> Result<Run, RunError> {
    let setting = scenario.setting().ok_or(RunError::Latitude(scenario.latitude_deg))?;
    let mut session = Session::new(setting, scenario.procedure()).map_err(RunError::Procedure)?;
    let plan = Plan::of(fault);
    let board = RefCell::new(simulated::board(scenario, &plan));
    let log = Log::new(watch);
    let bytes = RefCell::default();
    let shared = Shared::new(&log);
    let configuration = scenario.configuration();
    let mut sensors = simulated::sensors(&board, scenario, &plan).with_base(base);
    let recorder = FaultyRecorder::new(recorder, plan.hang);
    let mut ports = simulated::ports(&board, &plan, Wire(&bytes), recorder);
    let acquisition = acquire(&mut sensors, &configuration, &shared);
    let instrument = async {
        let health = run(&mut ports, &configuration, &mut session, &shared).await;
        (health, Instant::now())
    };
    let (health, ended) =
        virtual_time::run_beside(acquisition, instrument).map_err(|_| RunError::Deadlock)?;
    let violations = simulated::violations(&board.borrow())
        .map(|(select, violation)| format!("{select:?}: {violation}"))
        .collect();
    Ok(Run {
        replay: Replay {
            method: Method::of(&session),
            setting: *session.setting(),
            session,
            assumed: [ASSUMED]
                .into_iter()
                .chain(scenario.half.map(|_| HALF))
                .map(str::to_owned)
                .collect(),
        },
        events: log.events.into_inner(),
        lines: String::from_utf8_lossy(&bytes.into_inner()).into_owned(),
        seconds: ended.as_micros() as f64 * 1e-6,
        health,
        violations,
    })
}
