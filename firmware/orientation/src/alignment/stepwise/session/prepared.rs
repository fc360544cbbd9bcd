//! Prerequisites of a session: a procedure that was checked, with its filter.

use heapless::Vec;

use super::procedure::Procedure;
use super::survey::Store;
use super::timing::{SECTIONS, Target, Timing, designed};
use super::{Phase, Session};
use crate::alignment::setup::SetupError;
use crate::alignment::stepwise::setting::Setting;
use crate::filter::Coefficients;
use crate::math::Table;
use crate::units::RadiansPerSecond;

/// Prerequisites of a session. They are small, so that the session itself can be built at its final
/// place in memory.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// Site, instrument and requirements.
    setting: Setting,
    /// Procedure that was checked.
    procedure: Procedure,
    /// Coefficients of its filter.
    coefficients: Coefficients<SECTIONS>,
    /// First position.
    target: Target,
}

impl Prepared {
    /// Checks a procedure and designs its filter.
    ///
    /// # Errors
    /// [`SetupError`] for a damaged reference table, or a procedure that the filter or the
    /// stage cannot follow.
    pub fn new(setting: Setting, procedure: Procedure) -> Result<Self, SetupError> {
        Table::built_in().verify().map_err(|_| SetupError::TableCorrupt)?;
        setting.check()?;
        procedure.check()?;
        let (coefficients, target) = designed(&procedure)?;
        Ok(Self { setting, procedure, coefficients, target })
    }
}

impl From<Prepared> for Session {
    fn from(prepared: Prepared) -> Self {
        let Prepared { setting, procedure, coefficients, target } = prepared;
        Self {
            setting,
            target,
            timing: Timing::of(&procedure),
            store: Store::Dwells(Vec::new()),
            surveyed: None,
            procedure,
            coefficients,
            phase: Phase::Level,
            begun: None,
            average: None,
            repetitions: Vec::new(),
            tries: 0,
            conclusion: None,
        }
    }
}

impl Session {
    /// Resets the session in place for another alignment with the noise and the schedule that it
    /// has: what a survey showed is in them already.
    #[inline(never)]
    pub(super) fn restart(&mut self) {
        if self.surveyed.take().is_some() {
            self.procedure.survey = None;
        }
        self.timing = Timing::of(&self.procedure);
        if let Some(first) = self.procedure.schedule.next(&[], RadiansPerSecond(0.0)) {
            self.target = Target::new(first, self.procedure.sample_seconds);
        }
        self.store.begin_dwells();
        self.phase = Phase::Level;
        self.begun = None;
        self.average = None;
        self.repetitions.clear();
        self.tries = 0;
        self.conclusion = None;
    }
}
