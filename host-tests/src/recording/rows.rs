//! Rows: what each kind of recording has in one.
//!
//! Another kind is a row type here that names its columns as it reads them, and the arms that
//! [`super::parse`] names.

use std::marker::PhantomData;

use super::columns::{Column, Layout, Need, TRUE_ATTITUDE, Values};
use super::error::Fault;
use super::header::check_late;
use super::lines::{Line, Lines};
use super::problem::Problem;
use super::range::Range;
use super::warning::Warning;

/// Times, in seconds, that a double resolves to 2 µs.
pub(super) const TIME: Range = Range::symmetric(1e10, " s");
/// Stage angles that [`orientation::units::Angle`] takes exactly: 10⁶ turns.
const STAGE: Range = Range::symmetric(6.283_185e6, " rad");
/// Elevations of an axis over a plane, a whole turn at most.
const ELEVATION: Range = Range::symmetric(6.283_186, " rad");
/// The range of [`orientation::units::AngularRate`].
const RATE: Range = Range::symmetric(2.147_483_647, " rad/s");
/// Greatest rate of a vehicle's gyros, rad/s: 5 700 °/s, beyond what any of them measures. In the recording of a run it
/// stands for a gyro at a limit of its range.
pub const GREATEST_BODY_RATE: f64 = 100.0;
const BODY_RATE: Range = Range::symmetric(GREATEST_BODY_RATE, " rad/s");
/// Rates at which a stage can turn: 160 turns a second.
const STAGE_RATE: Range = Range::symmetric(1e3, " rad/s");
/// The range of [`orientation::units::SpecificForce`].
const FORCE: Range = Range::symmetric(2_147.483_647, " m/s²");
/// The range of [`orientation::units::Temperature`].
const TEMPERATURE: Range = Range::symmetric(2_147_483.647, " °C");
/// Greatest rate about the axes of a body in fast rotation, rad/s: 1 600 turns a second. In the recording of a run it
/// stands for a gyro at a limit of its range.
pub const GREATEST_SPIN_RATE: f64 = 1e4;
const SPIN_RATE: Range = Range::symmetric(GREATEST_SPIN_RATE, " rad/s");
/// The range of [`orientation::units::SpinForce`].
const SPIN_FORCE: Range = Range::symmetric(21_474.836_47, " m/s²");
/// Rolls in which a double resolves 1 nrad: 10⁶ turns.
const ROLL: Range = Range::symmetric(6.283_185e6, " rad");
/// The parts of a quaternion of length one, which rounding may exceed.
const QUATERNION: Range = Range::symmetric(1.001, "");
/// Square of its length below which it is none.
const LEAST_SQUARE: f64 = 0.9;
/// Standard deviations of a mean rate.
const SIGMA: Range = Range::above_zero(2.147_483_647, " rad/s");
/// Lengths of dwells.
const SECONDS: Range = Range::above_zero(1e10, " s");
/// Whether something holds: 0 or 1.
const FLAG: Range = Range::from_zero(1.0, "");
/// The force columns of a dwell come together or not at all.
const FORCES: [&str; 3] = ["fx_m_s2", "fy_m_s2", "fz_m_s2"];
/// The columns of an inertial measurement unit come together or not at all.
const IMU: [&str; 6] = ["gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2"];

/// The rates across the long axis of a spinning body come together or not at all.
const ACROSS: [&str; 2] = ["gy_rad_s", "gz_rad_s"];
/// A coarse one of them, on the base of a stage.
const BASE: [&str; 6] = ["bgx_rad_s", "bgy_rad_s", "bgz_rad_s", "bax_m_s2", "bay_m_s2", "baz_m_s2"];

/// One sample of a `stage` recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageRow {
    /// The line of the file, from 1, for messages about this sample.
    pub line: u64,
    /// Time, s, later than in the row before; its zero is the recorder's and it may be negative.
    pub time_s: f64,
    /// Stage angle, rad, clockwise from above, ±10⁶ turns.
    pub stage_rad: f64,
    /// Rate along the gyro's sensitive axis, rad/s, ±2.147483647.
    pub rate_rad_s: f64,
    /// Specific force on the platform, m/s², ±2147.483647: along the sensitive axis, 90° clockwise
    /// from it, down.
    pub force_m_s2: [f64; 3],
    /// Temperature of the gyro, °C, when recorded.
    pub temperature_c: Option<f64>,
    /// Whether the force was read with this sample; always where the recording does not say.
    pub force_is_new: bool,
    /// Elevation of the sensitive axis over the base's plane, rad, where a mount moves it and a force came.
    pub elevation_rad: Option<f64>,
    /// What a coarse inertial measurement unit on the base showed anew.
    pub base: Option<ImuSample>,
}

/// One sample of a `rotating` recording: a stage that turns all the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotatingRow {
    /// The line of the file, from 1, for messages about this sample.
    pub line: u64,
    /// Time, s, later than in the row before; its zero is the recorder's and it may be negative.
    pub time_s: f64,
    /// Stage angle, rad, clockwise from above, ±10⁶ turns; whole turns are counted.
    pub stage_rad: f64,
    /// Rate of the stage, rad/s, clockwise positive, ±1000.
    pub stage_rate_rad_s: f64,
    /// Rate along the gyro's sensitive axis, rad/s, ±2.147483647.
    pub rate_rad_s: f64,
    /// Specific force along the sensitive axis, in the platform's plane, m/s², ±2147.483647.
    pub force_m_s2: f64,
    /// Specific force 90° clockwise of the sensitive axis, m/s², when recorded.
    pub across_m_s2: Option<f64>,
    /// Whether the force was read with this sample; always where the recording does not say.
    pub force_is_new: bool,
}

/// One position of a `dwells` recording, already averaged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DwellRow {
    /// Stage angle, rad, clockwise from above, ±10⁶ turns.
    pub stage_rad: f64,
    /// Mean rate along the gyro's sensitive axis, rad/s, ±2.147483647.
    pub rate_rad_s: f64,
    /// 1σ of that mean, rad/s, above 0.
    pub sigma_rad_s: f64,
    /// Length of the dwell, s, above 0.
    pub seconds: f64,
    /// Time of its middle, s, later than in the row before, when recorded.
    pub mid_s: Option<f64>,
    /// Mean specific force on the platform, m/s², as in [`StageRow`], when recorded.
    pub force_m_s2: Option<[f64; 3]>,
}

/// One sample of a `static` recording: of one gyro, of an inertial measurement unit, or of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticRow {
    /// The line of the file, from 1, for messages about this sample.
    pub line: u64,
    /// Time, s, later than in the row before; its zero is the recorder's and it may be negative.
    pub time_s: f64,
    /// Rate along the gyro's sensitive axis, rad/s, ±2.147483647, when recorded.
    pub rate_rad_s: Option<f64>,
    /// Rates and forces along body x, y and z, when recorded.
    pub imu: Option<ImuSample>,
}

/// One sample of an `imu` recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuRow {
    /// The line of the file, from 1, for messages about this sample.
    pub line: u64,
    /// When the sample ended, s, later than in the row before; its zero is the recorder's and it may be
    /// negative.
    pub time_s: f64,
    /// Means over the sample.
    pub sample: ImuSample,
    /// Whether the force was read with this sample; always where the recording does not say.
    pub force_is_new: bool,
}

/// One sample of a `spin` recording: what a body in fast rotation shows at that moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinRow {
    /// The line of the file, from 1, for messages about this sample.
    pub line: u64,
    /// Time, s, later than in the row before; its zero is the recorder's and it may be negative.
    pub time_s: f64,
    /// Rate about the long axis, rad/s, ±10000.
    pub rate_rad_s: f64,
    /// Specific force along body y (up at roll zero) and z (right there), m/s², ±21474.83647.
    pub force_m_s2: [f64; 2],
    /// Rates about these axes, rad/s, ±10000, when recorded.
    pub across_rad_s: Option<[f64; 2]>,
}

/// What an inertial measurement unit gives at a time, along body x (forward), y (right), z (down).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuSample {
    /// Rates, rad/s, ±100; at rest ±2.147483647.
    pub rates_rad_s: [f64; 3],
    /// Specific force, m/s², ±2147.483647.
    pub force_m_s2: [f64; 3],
}

/// A kind's row.
pub(super) trait Row: Sized {
    /// The column whose numbers must increase.
    const TIME: &'static str = "t_s";

    /// The row, read column by column: always the same ones in the same order.
    fn read(from: &mut Fields<impl Next>) -> Self;
}

/// What a row is read from: the columns that its kind knows, one after the other, and their numbers.
pub(super) struct Fields<F> {
    line: u64,
    next: F,
}

/// Gives the number in the next column, where it is there.
pub(super) trait Next: FnMut(Column) -> Option<f64> {}

impl<F: FnMut(Column) -> Option<f64>> Next for F {}

impl<F: Next> Fields<F> {
    /// A column that need not be there, and whose fields may be empty.
    fn sometimes(&mut self, name: &'static str, range: &'static Range) -> Option<f64> {
        (self.next)(Column { name, need: Need::Sometimes, range })
    }

    /// A column that need not be there.
    fn optional(&mut self, name: &'static str, range: &'static Range) -> Option<f64> {
        (self.next)(Column { name, need: Need::Optional, range })
    }

    /// A column that must be there.
    fn always(&mut self, name: &'static str, range: &'static Range) -> f64 {
        (self.next)(Column { name, need: Need::Always, range }).unwrap_or_default()
    }

    /// Columns that are there where the first one is.
    fn group<const N: usize>(
        &mut self,
        names: &[&'static str; N],
        need: Need,
        range: &'static Range,
    ) -> Option<[f64; N]> {
        let numbers = names.map(|name| (self.next)(Column { name, need, range }));
        numbers[0].map(|_| numbers.map(Option::unwrap_or_default))
    }

    /// The columns of an inertial measurement unit.
    fn imu(
        &mut self,
        [x, y, z, forces @ ..]: &[&'static str; 6],
        need: Need,
        rate: &'static Range,
    ) -> Option<ImuSample> {
        let rates_rad_s = self.group(&[x, y, z], need, rate);
        let force_m_s2 = self.group(forces, need, &FORCE);
        rates_rad_s.map(|rates_rad_s| ImuSample {
            rates_rad_s,
            force_m_s2: force_m_s2.unwrap_or_default(),
        })
    }

    /// Whether a row brings a force that was not there before: one that is read less often is repeated. Always where the
    /// recording does not say.
    fn has_new_force(&mut self) -> bool {
        self.sometimes("force_is_new", &FLAG).is_none_or(|is_new| is_new > 0.0)
    }
}

impl Row for StageRow {
    fn read(from: &mut Fields<impl Next>) -> Self {
        Self {
            line: from.line,
            time_s: from.always("t_s", &TIME),
            stage_rad: from.always("stage_rad", &STAGE),
            rate_rad_s: from.always("g_rad_s", &RATE),
            force_m_s2: FORCES.map(|name| from.always(name, &FORCE)),
            temperature_c: from.sometimes("temperature_c", &TEMPERATURE),
            force_is_new: from.has_new_force(),
            elevation_rad: from.sometimes("elevation_rad", &ELEVATION),
            base: from.imu(&BASE, Need::Sometimes, &RATE),
        }
    }
}

impl Row for RotatingRow {
    fn read(from: &mut Fields<impl Next>) -> Self {
        Self {
            line: from.line,
            time_s: from.always("t_s", &TIME),
            stage_rad: from.always("stage_rad", &STAGE),
            stage_rate_rad_s: from.always("stage_rate_rad_s", &STAGE_RATE),
            rate_rad_s: from.always("g_rad_s", &RATE),
            force_m_s2: from.always("a_m_s2", &FORCE),
            across_m_s2: from.optional("a_across_m_s2", &FORCE),
            force_is_new: from.has_new_force(),
        }
    }
}

impl Row for DwellRow {
    const TIME: &'static str = "mid_s";

    fn read(from: &mut Fields<impl Next>) -> Self {
        Self {
            stage_rad: from.always("stage_rad", &STAGE),
            rate_rad_s: from.always("rate_rad_s", &RATE),
            sigma_rad_s: from.always("sigma_rad_s", &SIGMA),
            seconds: from.always("seconds", &SECONDS),
            mid_s: from.optional("mid_s", &TIME),
            force_m_s2: from.group(&FORCES, Need::AnyOf(&FORCES), &FORCE),
        }
    }
}

/// Forward, right, down to north, east, down; what has no length is no attitude.
type TrueAttitude = Option<[f64; 4]>;

/// A sample, and the true attitude where the recording has that column; none within where it does not count.
impl Row for (ImuRow, Option<TrueAttitude>) {
    fn read(from: &mut Fields<impl Next>) -> Self {
        let (line, time_s) = (from.line, from.always("t_s", &TIME));
        let sample = from.imu(&IMU, Need::Always, &BODY_RATE).unwrap_or_default();
        let attitude = true_attitude(from);
        (ImuRow { line, time_s, sample, force_is_new: from.has_new_force() }, attitude)
    }
}

/// The quaternion, where all of it is there.
fn true_attitude(from: &mut Fields<impl Next>) -> Option<TrueAttitude> {
    let [w, x, y, z] = TRUE_ATTITUDE.map(|name| from.optional(name, &QUATERNION));
    let counts = from.optional("moving", &FLAG).is_none_or(|moving| moving > 0.0);
    let parts = [w?, x?, y?, z?];
    let square: f64 = parts.iter().map(|part| part * part).sum();
    Some((counts && square > LEAST_SQUARE).then_some(parts))
}

/// A sample, and the true roll, rad, where the recording has it.
impl Row for (SpinRow, Option<f64>) {
    fn read(from: &mut Fields<impl Next>) -> Self {
        let (line, time_s) = (from.line, from.always("t_s", &TIME));
        let rate_rad_s = from.always("gx_rad_s", &SPIN_RATE);
        let force_m_s2 = ["ay_m_s2", "az_m_s2"].map(|name| from.always(name, &SPIN_FORCE));
        let roll_rad = from.optional("truth_roll_rad", &ROLL);
        let across_rad_s = from.group(&ACROSS, Need::AnyOf(&ACROSS), &SPIN_RATE);
        (SpinRow { line, time_s, rate_rad_s, force_m_s2, across_rad_s }, roll_rad)
    }
}

impl Row for StaticRow {
    fn read(from: &mut Fields<impl Next>) -> Self {
        Self {
            line: from.line,
            time_s: from.always("t_s", &TIME),
            rate_rad_s: from.group(&["g_rad_s"], Need::NoneOf(&IMU), &RATE).map(|[rate]| rate),
            imu: from.imu(&IMU, Need::AnyOf(&IMU), &RATE),
        }
    }
}

/// The columns that a kind knows.
fn columns<T: Row>() -> Vec<Column> {
    let mut columns = Vec::new();
    let next = |column| {
        columns.push(column);
        None
    };
    T::read(&mut Fields { line: 0, next });
    columns
}

/// The row that has these numbers.
fn row<T: Row>(values: &Values) -> T {
    let mut places = 0..;
    T::read(&mut Fields { line: values.line, next: |_| values.optional(places.next()?) })
}

/// The rows of a kind, read one after the other.
pub(super) struct Rows<T> {
    layout: Layout,
    /// Place of the column whose numbers must increase.
    time: Option<usize>,
    before: Stamp,
    /// The numbers of the latest row.
    values: Values,
    /// How many were read.
    count: u64,
    row: PhantomData<T>,
}

impl<T: Row> Rows<T> {
    /// Begins below the column names, which stand in line `line`.
    pub fn new(line: u64, names: &str, warnings: &mut Vec<Warning>) -> Result<Self, Fault> {
        let layout = Layout::new(columns::<T>(), line, names)?;
        let time = layout.place(T::TIME);
        layout.warn(line, names, warnings);
        Ok(Self {
            layout,
            time,
            before: None,
            values: Values::default(),
            count: 0,
            row: PhantomData,
        })
    }

    /// The next row; none at the end.
    pub fn next(
        &mut self,
        lines: &mut Lines<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Option<T>, Fault> {
        let most = lines.most_rows();
        while let Some(line) = lines.next()? {
            if line.text.starts_with('#') {
                check_late(line.number, line.text)?;
                continue;
            }
            if self.count == most {
                return Err(Fault::line(line.number, Problem::TooMany(most, "rows")));
            }
            return self.read(&line, warnings).map(Some);
        }
        Ok(None)
    }

    /// Whether none was read.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The row of a line.
    fn read(&mut self, line: &Line<'_>, warnings: &mut Vec<Warning>) -> Result<T, Fault> {
        self.layout.read(line, &mut self.values)?;
        let stamp = self.time.and_then(|place| self.values.optional(place));
        let stamp = stamp.map(|time| (line.number, time));
        check_later(T::TIME, self.before, stamp)?;
        self.before = stamp;
        self.count += 1;
        self.layout.warn_of_truth(line, warnings);
        Ok(row(&self.values))
    }
}

/// Reads all rows below the column names, which stand in line `line`.
pub(super) fn read<T: Row>(
    lines: &mut Lines<'_>,
    line: u64,
    names: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<T>, Fault> {
    let mut reading = Rows::new(line, names, warnings)?;
    let mut rows = Vec::new();
    while let Some(row) = reading.next(lines, warnings)? {
        rows.push(row);
    }
    if reading.is_empty() { Err(Fault::line(line, Problem::NoRows)) } else { Ok(rows) }
}

/// The line and time of a row, s.
type Stamp = Option<(u64, f64)>;

/// Refuses a time that is not later than the one before, where both rows have one.
fn check_later(column: &str, before: Stamp, stamp: Stamp) -> Result<(), Fault> {
    match (before, stamp) {
        (Some((before_line, before_s)), Some((line, time_s))) if time_s <= before_s => {
            let problem = Problem::NotLater { time_s, before_s, before_line };
            Err(Fault::column(line, column, problem))
        }
        _ => Ok(()),
    }
}
