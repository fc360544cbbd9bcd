//! Sample period: how far time stamps may contradict the configured one.

use super::refusal::Refusal;

/// Default tolerance of the time stamps' mean step against the period, relative: a recorder's clock
/// is far better, a converter's own oscillator is not.
pub(crate) const PERIOD_TOLERANCE: f64 = 0.01;
/// Tolerance of the ADS1262's internal oscillator, 2 % (data sheet SBAS661C, §7.5, internal
/// oscillator accuracy), which holds for a board's samples.
pub const CONVERTER_TOLERANCE: f64 = 0.02;

/// Refuses samples whose time stamps show a period of `found` s where `stated` s is configured,
/// beyond a relative tolerance.
pub(crate) fn contradiction(stated: f64, found: f64, tolerance: f64) -> Option<Refusal> {
    let is_off = (found / stated - 1.0).abs() > tolerance;
    is_off.then_some(Refusal::PeriodContradicted { stated: 1e3 * stated, found: 1e3 * found })
}
