//! Sample period: how far time stamps may contradict the configured one.

use super::refusal::Refusal;
use crate::units::{Milliseconds, Seconds};

/// Default tolerance of the time stamps' mean step against the period, relative: a recorder's clock
/// is far better. Boards state that of their clocks ([`crate::timebase`]).
pub(crate) const PERIOD_TOLERANCE: f64 = 0.01;

/// Refuses samples whose time stamps show a period of `found` where `stated` is configured,
/// beyond a relative tolerance.
pub(crate) fn contradiction(stated: Seconds, found: Seconds, tolerance: f64) -> Option<Refusal> {
    let is_off = (found.0 / stated.0 - 1.0).abs() > tolerance;
    let (stated, found) = (Milliseconds(1e3 * stated.0), Milliseconds(1e3 * found.0));
    is_off.then_some(Refusal::PeriodContradicted { stated, found })
}
