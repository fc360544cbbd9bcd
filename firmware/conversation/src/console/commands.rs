//! What a command does, whatever its form.

use core::fmt::{self, Display};

use firmware::not_begun::NotBegun;
use firmware::settings::{EditError, Editable, Output};
use firmware::shared::Shared;
use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::units::{Radians, wrapped};

use super::{Console, Requester};

/// Greatest standard deviation of an azimuth that is stated from outside, 1σ: beyond it, it says nothing.
const LEAST_KNOWN: Radians = Radians::from_degrees(30.0);

/// Why a command is not done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refused {
    /// Nothing begins, for this reason.
    NotBegun(NotBegun),
    /// An alignment runs.
    Runs,
    /// No alignment runs.
    NothingRuns,
    /// Settings were changed that count from the next start on.
    Changed,
    /// The instrument has ended.
    Over,
    /// No attitude is kept to which an azimuth could be given.
    NotKept,
    /// The azimuth is none, or its σ.
    Azimuth,
    /// The azimuth that was stated before has not been taken yet.
    Taking,
    /// A setting is not given a value.
    Setting(EditError),
    /// The settings are being kept.
    Busy,
}

impl Display for Refused {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::NotBegun(reason) => return reason.fmt(formatter),
            Self::Runs => "an alignment runs",
            Self::NothingRuns => "no alignment runs",
            Self::Changed => "settings were changed: save and reboot",
            Self::Over => "it has ended: reboot",
            Self::NotKept => "no attitude is kept",
            Self::Taking => "the one before is being taken",
            Self::Azimuth => "not an azimuth, or not a sigma up to 30",
            Self::Setting(error) => return error.fmt(formatter),
            Self::Busy => "the store is busy",
        })
    }
}

impl Console {
    /// Begins an alignment.
    ///
    /// # Errors
    /// Why not.
    pub(super) fn start(
        &self,
        settings: &dyn Editable,
        shared: &Shared<'_>,
    ) -> Result<(), Refused> {
        if shared.is_waiting() {
            if settings.start().lacks_latitude(shared.latitude.get()) {
                return Err(Refused::NotBegun(NotBegun::NoLatitude));
            }
            shared.begin.signal(());
            return Ok(());
        }
        self.check_again(settings, shared)?;
        if !(shared.has_none() || shared.is_ending()) {
            return Err(Refused::Runs);
        }
        shared.begin_again();
        Ok(())
    }

    /// Begins an alignment, anew where one runs.
    ///
    /// # Errors
    /// Why not.
    pub(super) fn realign(
        &self,
        settings: &dyn Editable,
        shared: &Shared<'_>,
    ) -> Result<(), Refused> {
        if shared.is_waiting() {
            return self.start(settings, shared);
        }
        self.check_again(settings, shared)?;
        shared.fail(Refusal::Stopped);
        shared.begin_again();
        Ok(())
    }

    /// Whether an alignment may begin once more.
    fn check_again(&self, settings: &dyn Editable, shared: &Shared<'_>) -> Result<(), Refused> {
        if let Some(reason) = shared.not_begun.get() {
            return Err(Refused::NotBegun(reason));
        }
        if shared.is_over() {
            return Err(Refused::Over);
        }
        let is_changed = self.begun.is_some_and(|begun| begun != settings.checksum());
        if is_changed { Err(Refused::Changed) } else { Ok(()) }
    }

    /// Gives a setting a value in its user's unit. What the link sends changes at once, all else counts from the next start
    /// on.
    ///
    /// # Errors
    /// [`Refused::Setting`] and [`Refused::Busy`].
    pub(super) fn set(
        &mut self,
        name: &str,
        value: f64,
        settings: &mut dyn Editable,
        shared: &Shared<'_>,
    ) -> Result<(), Refused> {
        self.check_changeable(settings, shared)?;
        settings.set(name, value).map_err(Refused::Setting)?;
        show(settings.output(), shared);
        Ok(())
    }

    /// Takes the factory settings.
    ///
    /// # Errors
    /// [`Refused::Busy`].
    pub(super) fn restore(
        &mut self,
        settings: &mut dyn Editable,
        shared: &Shared<'_>,
    ) -> Result<(), Refused> {
        self.check_changeable(settings, shared)?;
        settings.restore();
        show(settings.output(), shared);
        Ok(())
    }

    /// Whether the settings may be changed. Those that the instrument has begun with are remembered before they are.
    fn check_changeable(
        &mut self,
        settings: &dyn Editable,
        shared: &Shared<'_>,
    ) -> Result<(), Refused> {
        self.check_saved()?;
        if !shared.is_waiting() {
            self.begun.get_or_insert_with(|| settings.checksum());
        }
        Ok(())
    }

    /// Whether the settings are not being kept: they stay as they are meanwhile.
    fn check_saved(&self) -> Result<(), Refused> {
        if self.saving.is_some() { Err(Refused::Busy) } else { Ok(()) }
    }

    /// Has the store keep the settings; it is answered once that is done.
    ///
    /// # Errors
    /// [`Refused::Busy`].
    pub(super) fn save(
        &mut self,
        requester: Requester,
        shared: &Shared<'_>,
    ) -> Result<(), Refused> {
        self.check_saved()?;
        self.saving = Some(requester);
        shared.kept.reset();
        shared.keep.signal(());
        Ok(())
    }
}

/// Ends the alignment that runs or is about to begin. None begins but by an order.
///
/// # Errors
/// [`Refused::NothingRuns`].
pub(super) fn stop(shared: &Shared<'_>) -> Result<(), Refused> {
    if shared.is_waiting() || shared.has_none() {
        return Err(Refused::NothingRuns);
    }
    shared.stop();
    Ok(())
}

/// Has the link send what is stated from now on, as far as its port carries that: another baud counts from the next start on.
fn show(stated: Output, shared: &Shared<'_>) {
    let output = Output { baud: shared.output.get().baud, ..stated };
    if output.check().is_ok() {
        shared.output.set(output);
    }
}

/// Gives the navigator an azimuth from outside with its 1σ, °.
///
/// # Errors
/// [`Refused::Azimuth`], [`Refused::NotKept`] and [`Refused::Taking`].
pub(super) fn state_azimuth([angle, sigma]: [f64; 2], shared: &Shared<'_>) -> Result<(), Refused> {
    let [angle, sigma] = [angle, sigma].map(Radians::from_degrees);
    let is_one = (0.0..=LEAST_KNOWN.0).contains(&sigma.0)
        && sigma.0 > 0.0
        && angle.0.abs() <= Radians::from_degrees(360.0).0;
    if !is_one {
        return Err(Refused::Azimuth);
    }
    if !shared.is_kept.get() || shared.attitude.get().is_none() {
        return Err(Refused::NotKept);
    }
    if shared.stated.signaled() {
        return Err(Refused::Taking);
    }
    shared.stated.signal(Azimuth { angle: Radians(wrapped(angle.0)), sigma });
    Ok(())
}
