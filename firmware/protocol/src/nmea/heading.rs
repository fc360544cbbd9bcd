//! Heading and rate of turn.

use orientation::units::{DEGREES_PER_RADIAN, Radians};

use super::Sentence;
use super::fixed::Fixed;
use super::writer::Writer;
use crate::report::{Origin, Report, State};

/// Seconds of a minute.
const MINUTE: f64 = 60.0;
/// The greatest rate of turn that is stated, °/min: a turn in a tenth of a second.
const FASTEST: f64 = 216_000.0;

/// A heading in degrees.
fn heading(angle: Radians) -> Fixed<3> {
    Fixed::turn(angle)
}

/// `$HEHDT,213.702,T*hh`: heading, degrees true. The sentence has no sign of its validity: the field is empty unless the
/// state is [`State::Ready`].
#[must_use]
pub fn hdt(report: &Report) -> Option<Sentence> {
    let angle = report.valid_azimuth().map(|azimuth| heading(azimuth.angle));
    Writer::new("HEHDT").fixed(angle).letter('T').finish()
}

/// Mode of a heading: the one-letter indicator of THS.
fn mode(report: &Report) -> char {
    match (report.usable_azimuth(), report.origin, report.state) {
        (None, ..) => 'V',
        (Some(_), Origin::Simulation, _) => 'S',
        (Some(_), _, State::Degraded(_)) => 'E',
        (Some(_), Origin::Outside, _) => 'M',
        (Some(_), Origin::Gyros, _) => 'A',
    }
}

/// `$HETHS,213.702,A*hh`: heading, degrees true, with its mode: A of the gyros, E estimated (the state is
/// [`State::Degraded`]), M set from outside, S simulated, V not valid. With V the field is empty, since some receivers do
/// not look at the mode.
#[must_use]
pub fn ths(report: &Report) -> Option<Sentence> {
    let angle = report.usable_azimuth().map(|azimuth| heading(azimuth.angle));
    Writer::new("HETHS").fixed(angle).letter(mode(report)).finish()
}

/// `$HEROT,-12.3,A*hh`: rate of turn, degrees a minute, negative where the bow turns to port, with its status: A valid,
/// V not, where the field is empty.
#[must_use]
pub fn rot(report: &Report) -> Option<Sentence> {
    let rate = report.rate_of_turn.map(|rate| rate.0 * DEGREES_PER_RADIAN * MINUTE);
    let rate = rate.filter(|rate| rate.abs() <= FASTEST).map(Fixed::<1>::nearest);
    let status = if rate.is_some() { 'A' } else { 'V' };
    Writer::new("HEROT").fixed(rate).letter(status).finish()
}
