//! Rows of a vehicle's recording as the samples that the session takes.

use std::borrow::Cow;

use orientation::signal::InertialSample;
use orientation::units::{AngleIncrement, Instant, SpecificForce};

use crate::methods::limits;
use crate::recording::repeated::alone;
use crate::recording::{Body, GREATEST_BODY_RATE, ImuRow, ImuSample, StaticRow};

/// The rows of three gyros and three accelerometers, of whatever kind; none where one of them is missing.
#[must_use]
pub fn rows(body: &Body) -> Option<Cow<'_, [ImuRow]>> {
    match body {
        Body::Imu(rows) => Some(Cow::Borrowed(rows)),
        Body::Static(rows) => rows.iter().map(row).collect::<Option<Vec<_>>>().map(Cow::Owned),
        Body::Stage(_) | Body::Rotating(_) | Body::Dwells(_) | Body::Spin(_) => None,
    }
}

fn row(row: &StaticRow) -> Option<ImuRow> {
    Some(ImuRow { line: row.line, time_s: row.time_s, sample: row.imu?, force_is_new: true })
}

/// Equal values in a row that are no chance where there is noise.
const STUCK: usize = 64;
/// The gyros' columns.
const GYROS: [&str; 3] = ["gx_rad_s", "gy_rad_s", "gz_rad_s"];

/// A gyro that shows one value for far longer than any other: its column, the row where that begins,
/// and of how many rows.
pub(crate) fn stuck(rows: &[ImuRow]) -> Option<(&'static str, &ImuRow, usize)> {
    GYROS.iter().enumerate().find_map(|(axis, column)| {
        let run = alone(rows, STUCK, |row| row.sample.rates_rad_s[axis])?;
        Some((*column, &run[0], run.len()))
    })
}

/// Which of two accelerometers across the vertical, 0 or 1, shows one value all the time although the upright one has
/// noise: it is dead, or its steps hide everything.
pub(crate) fn dead_accelerometer<R>(rows: &[R], force_m_s2: fn(&R) -> [f64; 3]) -> Option<usize> {
    let is_constant = |axis: usize| {
        rows.windows(2).all(|pair| force_m_s2(&pair[0])[axis] == force_m_s2(&pair[1])[axis])
    };
    let is_asked = rows.len() >= STUCK && !is_constant(2);
    [0, 1].into_iter().find(|axis| is_asked && is_constant(*axis))
}

/// Makes samples of what three gyros turned and three accelerometers felt; what rounding leaves over of a
/// rotation goes to the next sample.
#[derive(Clone, Copy, Debug, Default)]
pub struct Converter {
    carried: [f64; 3],
}

impl Converter {
    /// The sample that ended at a time, s.
    #[must_use]
    pub fn sample(
        &mut self,
        time_s: f64,
        turned_rad: [f64; 3],
        force_m_s2: [f64; 3],
    ) -> InertialSample {
        let mut turned = [AngleIncrement::default(); 3];
        for (axis, angle) in turned_rad.into_iter().enumerate() {
            turned[axis] = AngleIncrement::from_rad(angle, &mut self.carried[axis]);
        }
        let force = Some(force_m_s2.map(SpecificForce::from_m_per_s2));
        InertialSample { time: Instant::from_seconds(time_s), turned, force }
    }
}

/// The samples of rows; their time counts from when the first one began.
pub fn samples(rows: &[ImuRow], period_s: f64) -> impl Iterator<Item = InertialSample> + '_ {
    since(begin(rows, period_s), rows, period_s)
}

/// The samples of rows; their time counts from a time on the recording's clock, s.
pub(crate) fn since(
    begin: f64,
    rows: &[ImuRow],
    period_s: f64,
) -> impl Iterator<Item = InertialSample> + '_ {
    within(limits::of_channels(rows, channels), begin, rows, period_s)
}

/// The samples of a run, as its board had them.
pub fn given(rows: &[ImuRow], period_s: f64) -> impl Iterator<Item = InertialSample> + '_ {
    let (rate, none) = (GREATEST_BODY_RATE, f64::INFINITY);
    within([rate, rate, rate, none, none, none], 0.0, rows, period_s)
}

/// The samples of rows whose channels are cut at these limits; their time counts from a time, s.
fn within(
    limits: [f64; 6],
    begin: f64,
    rows: &[ImuRow],
    period_s: f64,
) -> impl Iterator<Item = InertialSample> + '_ {
    let mut converter = Converter::default();
    rows.iter().map(move |row| {
        let ImuSample { rates_rad_s, force_m_s2 } = row.sample;
        let turned_rad = rates_rad_s.map(|rate| rate * period_s);
        let mut sample = converter.sample(row.time_s - begin, turned_rad, force_m_s2);
        let mut cut =
            channels(row).into_iter().zip(limits).map(|(value, limit)| value.abs() >= limit);
        for turned in &mut sample.turned {
            if cut.next() == Some(true) {
                *turned = AngleIncrement(i32::MAX);
            }
        }
        if cut.any(|is_cut| is_cut) || !row.force_is_new {
            sample.force = None;
        }
        sample
    })
}

/// When the first sample began, s on the recorder's clock.
pub(crate) fn begin(rows: &[ImuRow], period_s: f64) -> f64 {
    rows.first().map_or(0.0, |row| row.time_s) - period_s
}

/// The three rates, then the three forces.
fn channels(row: &ImuRow) -> [f64; 6] {
    let ([x, y, z], [fx, fy, fz]) = (row.sample.rates_rad_s, row.sample.force_m_s2);
    [x, y, z, fx, fy, fz]
}
