//! Rows: what each kind of recording has in one.
//!
//! Another kind is a row type with its table of columns here, and the arms that
//! [`super::parse`] names.

use super::columns::{Column, Layout, MAX_COLUMNS, Need, Values};
use super::error::Fault;
use super::header::check_late;
use super::lines::{Lines, MAX_ROWS};
use super::problem::{SourceProblem, TimeProblem, ValueProblem};
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
/// Whether a row brings a force that was not there before: one that is read less often is repeated.
const NEW_FORCE: Column = sometimes("force_is_new", FLAG);

/// A column that need not be there, and whose fields may be empty.
const fn sometimes(name: &'static str, range: Range) -> Column {
    Column { name, need: Need::Sometimes, range }
}

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuSample {
    /// Rates, rad/s, ±100; at rest ±2.147483647.
    pub rates_rad_s: [f64; 3],
    /// Specific force, m/s², ±2147.483647.
    pub force_m_s2: [f64; 3],
}

/// A kind's row.
pub(super) trait Row: Sized {
    /// The columns that the kind knows; [`Values`] has their numbers at the same places.
    const COLUMNS: &'static [Column];
    /// The place of the column whose numbers must increase.
    const TIME: usize = 0;

    /// The row that has these numbers.
    fn from_values(values: &Values) -> Self;
}

impl Row for StageRow {
    const COLUMNS: &'static [Column] = &[
        Column::always("t_s", TIME),
        Column::always("stage_rad", STAGE),
        Column::always("g_rad_s", RATE),
        Column::always("fx_m_s2", FORCE),
        Column::always("fy_m_s2", FORCE),
        Column::always("fz_m_s2", FORCE),
        sometimes("temperature_c", TEMPERATURE),
        NEW_FORCE,
        sometimes("elevation_rad", ELEVATION),
        sometimes(BASE[0], RATE),
        sometimes(BASE[1], RATE),
        sometimes(BASE[2], RATE),
        sometimes(BASE[3], FORCE),
        sometimes(BASE[4], FORCE),
        sometimes(BASE[5], FORCE),
    ];

    fn from_values(values: &Values) -> Self {
        Self {
            line: values.line,
            time_s: values.needed(0),
            stage_rad: values.needed(1),
            rate_rad_s: values.needed(2),
            force_m_s2: [3, 4, 5].map(|column| values.needed(column)),
            temperature_c: values.optional(6),
            force_is_new: has_new_force(values, 7),
            elevation_rad: values.optional(8),
            base: values.optional(9).map(|_| imu_sample(values, 9)),
        }
    }
}

/// Whether a row brings a force, by the column at this place; always without it.
fn has_new_force(values: &Values, place: usize) -> bool {
    values.optional(place).is_none_or(|is_new| is_new > 0.0)
}

impl Row for RotatingRow {
    const COLUMNS: &'static [Column] = &[
        Column::always("t_s", TIME),
        Column::always("stage_rad", STAGE),
        Column::always("stage_rate_rad_s", STAGE_RATE),
        Column::always("g_rad_s", RATE),
        Column::always("a_m_s2", FORCE),
        Column { name: "a_across_m_s2", need: Need::Optional, range: FORCE },
        NEW_FORCE,
    ];

    fn from_values(values: &Values) -> Self {
        Self {
            line: values.line,
            time_s: values.needed(0),
            stage_rad: values.needed(1),
            stage_rate_rad_s: values.needed(2),
            rate_rad_s: values.needed(3),
            force_m_s2: values.needed(4),
            across_m_s2: values.optional(5),
            force_is_new: has_new_force(values, 6),
        }
    }
}

impl Row for DwellRow {
    const COLUMNS: &'static [Column] = &[
        Column::always("stage_rad", STAGE),
        Column::always("rate_rad_s", RATE),
        Column::always("sigma_rad_s", Range::above_zero(2.147_483_647, " rad/s")),
        Column::always("seconds", Range::above_zero(1e10, " s")),
        Column { name: "mid_s", need: Need::Optional, range: TIME },
        Column { name: "fx_m_s2", need: Need::AnyOf(&FORCES), range: FORCE },
        Column { name: "fy_m_s2", need: Need::AnyOf(&FORCES), range: FORCE },
        Column { name: "fz_m_s2", need: Need::AnyOf(&FORCES), range: FORCE },
    ];
    const TIME: usize = 4;

    fn from_values(values: &Values) -> Self {
        let force = [5, 6, 7].map(|column| values.needed(column));
        Self {
            stage_rad: values.needed(0),
            rate_rad_s: values.needed(1),
            sigma_rad_s: values.needed(2),
            seconds: values.needed(3),
            mid_s: values.optional(4),
            force_m_s2: values.optional(5).map(|_| force),
        }
    }
}

/// Forward, right, down to north, east, down; what has no length is no attitude.
type TrueAttitude = Option<[f64; 4]>;

/// A sample, and the true attitude where the recording has that column; none within where it does not count.
impl Row for (ImuRow, Option<TrueAttitude>) {
    const COLUMNS: &'static [Column] = &[
        Column::always("t_s", TIME),
        Column::always(IMU[0], BODY_RATE),
        Column::always(IMU[1], BODY_RATE),
        Column::always(IMU[2], BODY_RATE),
        Column::always(IMU[3], FORCE),
        Column::always(IMU[4], FORCE),
        Column::always(IMU[5], FORCE),
        Column { name: "truth_qw", need: Need::Optional, range: QUATERNION },
        Column { name: "truth_qx", need: Need::Optional, range: QUATERNION },
        Column { name: "truth_qy", need: Need::Optional, range: QUATERNION },
        Column { name: "truth_qz", need: Need::Optional, range: QUATERNION },
        Column { name: "moving", need: Need::Optional, range: FLAG },
        NEW_FORCE,
    ];

    fn from_values(values: &Values) -> Self {
        let row = ImuRow {
            line: values.line,
            time_s: values.needed(0),
            sample: imu_sample(values, 1),
            force_is_new: has_new_force(values, 12),
        };
        (row, true_attitude(values))
    }
}

/// The quaternion in columns 7 to 10, where all of it is there.
fn true_attitude(values: &Values) -> Option<TrueAttitude> {
    let [w, x, y, z] = [7, 8, 9, 10].map(|column| values.optional(column));
    let parts = [w?, x?, y?, z?];
    let square: f64 = parts.iter().map(|part| part * part).sum();
    let counts = values.optional(11).is_none_or(|moving| moving > 0.0);
    Some((counts && square > LEAST_SQUARE).then_some(parts))
}

/// The sample whose columns begin at this place.
fn imu_sample(values: &Values, first: usize) -> ImuSample {
    let three = |first: usize| [0, 1, 2].map(|axis| values.needed(first + axis));
    ImuSample { rates_rad_s: three(first), force_m_s2: three(first + 3) }
}

/// A sample, and the true roll, rad, where the recording has it.
impl Row for (SpinRow, Option<f64>) {
    const COLUMNS: &'static [Column] = &[
        Column::always("t_s", TIME),
        Column::always("gx_rad_s", SPIN_RATE),
        Column::always("ay_m_s2", SPIN_FORCE),
        Column::always("az_m_s2", SPIN_FORCE),
        Column { name: "truth_roll_rad", need: Need::Optional, range: ROLL },
        Column { name: ACROSS[0], need: Need::AnyOf(&ACROSS), range: SPIN_RATE },
        Column { name: ACROSS[1], need: Need::AnyOf(&ACROSS), range: SPIN_RATE },
    ];

    fn from_values(values: &Values) -> Self {
        let row = SpinRow {
            line: values.line,
            time_s: values.needed(0),
            rate_rad_s: values.needed(1),
            force_m_s2: [2, 3].map(|column| values.needed(column)),
            across_rad_s: values.optional(5).map(|_| [5, 6].map(|column| values.needed(column))),
        };
        (row, values.optional(4))
    }
}

impl Row for StaticRow {
    const COLUMNS: &'static [Column] = &[
        Column::always("t_s", TIME),
        Column { name: "g_rad_s", need: Need::NoneOf(&IMU), range: RATE },
        Column { name: IMU[0], need: Need::AnyOf(&IMU), range: RATE },
        Column { name: IMU[1], need: Need::AnyOf(&IMU), range: RATE },
        Column { name: IMU[2], need: Need::AnyOf(&IMU), range: RATE },
        Column { name: IMU[3], need: Need::AnyOf(&IMU), range: FORCE },
        Column { name: IMU[4], need: Need::AnyOf(&IMU), range: FORCE },
        Column { name: IMU[5], need: Need::AnyOf(&IMU), range: FORCE },
    ];

    fn from_values(values: &Values) -> Self {
        Self {
            line: values.line,
            time_s: values.needed(0),
            rate_rad_s: values.optional(1),
            imu: values.optional(2).map(|_| imu_sample(values, 2)),
        }
    }
}

/// Reads all rows below the column names, which stand in line `line`.
pub(super) fn read<T: Row>(
    lines: &mut Lines<'_>,
    line: u64,
    names: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<T>, Fault> {
    const { assert!(T::COLUMNS.len() <= MAX_COLUMNS && T::TIME < T::COLUMNS.len()) };
    let mut layout = Layout::new(T::COLUMNS, line, names)?;
    layout.warn(line, names, warnings);
    let mut rows = Vec::new();
    let mut before = None;
    while let Some(line) = lines.next()? {
        if line.text.starts_with('#') {
            check_late(line.number, line.text)?;
            continue;
        }
        if rows.len() as u64 == MAX_ROWS {
            return Err(Fault::line(line.number, SourceProblem::TooMany(MAX_ROWS, "rows")));
        }
        let values = layout.values(&line)?;
        before = later::<T>(before, &values)?;
        rows.push(T::from_values(&values));
        layout.warn_of_truth(&line, warnings);
    }
    if rows.is_empty() { Err(Fault::line(line, ValueProblem::NoRows)) } else { Ok(rows) }
}

/// The row's line and time, when it has a time; refuses one that is not later than the one before.
fn later<T: Row>(before: Option<(u64, f64)>, values: &Values) -> Result<Option<(u64, f64)>, Fault> {
    let time = values.optional(T::TIME);
    match (before, time) {
        (Some((before_line, before_s)), Some(time_s)) if time_s <= before_s => {
            let problem = TimeProblem::NotLater { time_s, before_s, before_line };
            Err(Fault::column(values.line, T::COLUMNS[T::TIME].name, problem))
        }
        _ => Ok(time.map(|time| (values.line, time))),
    }
}
