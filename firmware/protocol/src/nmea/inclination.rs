//! Pitch and roll as fibre-optic gyrocompasses send them.

use orientation::units::Radians;

use super::Sentence;
use super::fixed::Fixed;
use super::writer::Writer;
use crate::report::{Level, Report};

/// A magnitude, and the letter of its sense: the first from zero on, the second below.
fn sensed(angle: Radians, [positive, negative]: [char; 2]) -> (Fixed<2>, char) {
    let angle = Fixed::nearest(angle.degrees());
    (angle.magnitude(), if angle.is_negative() { negative } else { positive })
}

/// `$PHTRO,1.20,M,0.31,B*hh`: pitch, M bow up and P bow down, then roll, T port up and B port down; magnitudes in degrees.
/// [`None`] while they are unknown: the sentence has no sign of its validity, and an empty field is a zero to some
/// receivers.
#[must_use]
pub fn phtro(report: &Report) -> Option<Sentence> {
    let Level { pitch, roll, .. } = report.usable_level()?;
    let ((pitch, bow), (roll, port)) = (sensed(pitch, ['M', 'P']), sensed(roll, ['T', 'B']));
    let mut writer = Writer::new("PHTRO");
    writer.fixed(Some(pitch)).letter(bow).fixed(Some(roll)).letter(port).finish()
}
