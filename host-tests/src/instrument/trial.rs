//! A run of any carrier on simulated chips: what goes wrong in it, and what surrounds the board.

use firmware::ports::{NoRecorder, Observer, Recorder, Store};
use simulated::fault::Fault;

use super::RunError;
use super::wire::Traffic;

/// A scenario by which the simulated board of a carrier is run.
pub trait Carrier: Sized {
    /// What its method takes.
    type Sample;
    /// What goes wrong, and when.
    type Plan;
    /// A finished run.
    type Run;

    /// The plan in which one fault happens in the middle of the alignment, or none.
    fn plan(&self, fault: Option<Fault>) -> Self::Plan;

    /// Runs the board to its end.
    ///
    /// # Errors
    /// As [`Trial::run`].
    fn run<R: Recorder<Self::Sample>, T: Store>(
        trial: Trial<'_, Self, R, T>,
    ) -> Result<Self::Run, RunError>;
}

/// Setup of a run; without a fault, an observer, a recorder or a store unless they are set.
#[must_use]
pub struct Trial<'t, C: Carrier, R = NoRecorder, T = ()> {
    pub(super) carrier: &'t C,
    pub(super) plan: C::Plan,
    pub(super) watch: &'t dyn Observer,
    pub(super) traffic: Option<&'t dyn Traffic>,
    pub(super) recorder: R,
    pub(super) store: T,
}

impl<'t, C: Carrier> Trial<'t, C> {
    /// The run of a scenario.
    pub fn of(carrier: &'t C) -> Self {
        let plan = carrier.plan(None);
        Self { carrier, plan, watch: &(), traffic: None, recorder: NoRecorder, store: () }
    }
}

impl<'t, C: Carrier, R, T> Trial<'t, C, R, T> {
    /// With a fault in the middle of the alignment, or none.
    pub fn fault(self, fault: Option<Fault>) -> Self {
        Self { plan: self.carrier.plan(fault), ..self }
    }

    /// With all that goes wrong.
    pub fn plan(self, plan: C::Plan) -> Self {
        Self { plan, ..self }
    }

    /// With an observer of the board's events.
    pub fn watch(self, watch: &'t dyn Observer) -> Self {
        Self { watch, ..self }
    }

    /// With what comes over its link, to which a console listens.
    pub fn traffic(self, traffic: &'t dyn Traffic) -> Self {
        Self { traffic: Some(traffic), ..self }
    }

    /// With a recorder of the samples.
    pub fn record<S: Recorder<C::Sample>>(self, recorder: S) -> Trial<'t, C, S, T> {
        let Self { carrier, plan, watch, traffic, store, .. } = self;
        Trial { carrier, plan, watch, traffic, recorder, store }
    }

    /// With a store that outlasts a loss of supply.
    pub fn store<U: Store>(self, store: U) -> Trial<'t, C, R, U> {
        let Self { carrier, plan, watch, traffic, recorder, .. } = self;
        Trial { carrier, plan, watch, traffic, recorder, store }
    }
}

impl<C: Carrier, R: Recorder<C::Sample>, T: Store> Trial<'_, C, R, T> {
    /// Runs it in virtual time on this thread.
    ///
    /// # Errors
    /// What keeps the alignment from beginning, and a deadlock. A refusal is a result.
    pub fn run(self) -> Result<C::Run, RunError> {
        C::run(self)
    }
}
