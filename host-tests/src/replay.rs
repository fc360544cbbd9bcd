//! Drives the session of the pure crate with a recording, as the board drives it with sensors.
//!
//! A recording has gone where it went: the positions at which its stage stood become the session's
//! schedule, its travel has no limit, and nothing can be repeated. The types that come in here hold
//! no truth.

use std::fmt;

use orientation::align::CAPACITY;
use orientation::align::criterion::Criterion;
use orientation::align::mount::TWO_FRAMES;
use orientation::align::setting::{Half, Setting};
use orientation::earth::Latitude;
use orientation::planner::order::Order;
use orientation::session::procedure::{Procedure, ProcedureError, STILL};
use orientation::session::schedule::{Position, Schedule};
use orientation::session::{Event, Session};
use orientation::signal::Sample;
use orientation::signal::dwell::Dwell;
use orientation::units::{Angle, AngularRate, Instant, SpecificForce, TURN, Temperature};

use crate::late::{self, Late};
use crate::median::median;
use crate::methods::asked::Asked;
use crate::recording::period::period_s;
use crate::recording::{Body, DwellRow, Given, Header, Kind, Short, StageRow};
use crate::setting::{Described, describe};
use crate::stops::samples::{dead_accelerometer, is_cut};
use crate::stops::way::Slip;
use crate::untold;

/// By which of its names an alignment in positions is called; the fit is the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Stepwise gyrocompassing.
    #[default]
    Stepwise,
    /// Autocompensated positions, in passes.
    Positions,
}

impl Method {
    /// Of a session that ran by itself: a planned schedule goes through positions.
    #[must_use]
    pub fn of(session: &Session) -> Self {
        match session.procedure().schedule {
            Schedule::Planned(_) => Self::Positions,
            Schedule::Listed(_) | Schedule::TowardMaximum { .. } => Self::Stepwise,
        }
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Stepwise => "stepwise",
            Self::Positions => "positions",
        }
    }
}

/// What an answer rests on where the half of the circle was stated.
pub const HALF: &str = "the half of the circle as stated: two positions give its mirror image else";

/// What the user asked for.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The method.
    pub method: Method,
    /// The half of the circle in which the azimuth lies, where that is known.
    pub half: Option<Half>,
    /// Latitude instead of the header's.
    pub latitude: Option<Latitude>,
    /// How the azimuth is found.
    pub criterion: Criterion,
    /// Greatest accepted standard deviation, rad; `None` for the default.
    pub required_sigma: Option<f64>,
}

impl From<&Asked> for Options {
    fn from(asked: &Asked) -> Self {
        let Asked { latitude, criterion, half, required_sigma, .. } = *asked;
        Self { method: Method::default(), half, latitude, criterion, required_sigma }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::default(),
            half: None,
            latitude: None,
            criterion: Criterion::MaximumLikelihood,
            required_sigma: None,
        }
    }
}

impl Options {
    /// Puts what the user states in the place of what a run's session was given.
    pub(crate) fn change(&self, given: &mut Setting) {
        given.latitude = self.latitude.unwrap_or(given.latitude);
        given.half = self.half.or(given.half);
        given.required_sigma = self.required_sigma.unwrap_or(given.required_sigma);
    }
}

/// What a replay of a run rests on.
pub(crate) const GIVEN: &str = "what the board was told of place and instrument";

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// The method.
    pub method: Method,
    /// The session, with its conclusion.
    pub session: Session,
    /// The setting it ran in.
    pub setting: Setting,
    /// What had to be assumed.
    pub assumed: Vec<String>,
}

impl Replay {
    /// The criterion as the command line names it.
    #[must_use]
    pub fn criterion_name(&self) -> String {
        crate::criterion::name(self.session.procedure().criterion)
    }

    /// Whether the gyro's white noise was stated rather than estimated.
    #[must_use]
    pub fn noise_is_known(&self) -> bool {
        self.setting.white_known
            || self.session.dwells().iter().all(|dwell| dwell.stated_variance.get().is_some())
    }
}

/// Why a recording that could be read cannot be replayed.
#[derive(Clone, Debug, PartialEq)]
pub enum ReplayError {
    /// Neither the header nor the user gives a latitude to a recording of this kind.
    NoLatitude(Kind),
    /// A kind without positions.
    Kind(Kind),
    /// A kind whose stage does not turn all the time.
    Stops(Kind),
    /// The stage never stood still long enough.
    NoDwell,
    /// More positions than a session holds.
    TooManyPositions(usize),
    /// A kind without three gyros and three accelerometers.
    NoVehicle(Kind),
    /// A kind without a body in fast rotation.
    NoSpin(Kind),
    /// Fewer samples than a rate has.
    TooFewSamples(usize),
    /// A recording of kind `static` with one gyro.
    OneGyro,
    /// More stops than a session holds, and how many that is.
    TooManyStops(usize, usize),
    /// Displacements are not one for each stop.
    Displacements {
        /// How many were stated.
        stated: usize,
        /// How many stops there are.
        stops: usize,
    },
    /// A sensor stood still.
    Stuck {
        /// Its column.
        column: &'static str,
        /// The line where that begins.
        line: u64,
        /// For how long, s.
        seconds: f64,
    },
    /// A column is not of the same moment as the others.
    Late(Late),
    /// The header's rate is not that of the times.
    Rate {
        /// As stated, Hz.
        stated_hz: f64,
        /// As the times have it, Hz.
        found_hz: f64,
    },
    /// The gyros' rate at rest is so many times the Earth's: that of a degree in radians.
    DegreesPerSecond {
        /// How many times.
        times: f64,
    },
    /// No displacement lies far from the first stop, but a thousand times as far there is an azimuth.
    Kilometres {
        /// The greatest part of one, as stated.
        greatest: f64,
    },
    /// The forces on the way to a stop contradict its displacement.
    Way {
        /// The stop before, from one.
        stop: usize,
        /// How far the next one lies from it as stated, north and east, m.
        stated_m: [f64; 2],
        /// How far by the forces.
        driven_m: [f64; 2],
        /// What the displacements are likely to be.
        slip: Slip,
    },
    /// The gyros' noise is not stated, and there are too few samples at rest to estimate it from.
    NoiseUnknown,
    /// The session cannot follow the recording.
    Procedure(ProcedureError),
    /// What the header says of a run's session cannot be read, and why.
    Session(String),
}

impl From<serde_json::Error> for ReplayError {
    fn from(error: serde_json::Error) -> Self {
        Self::Session(error.to_string())
    }
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoLatitude(kind) => {
                f.write_str("key latitude_deg is missing: add it or give --latitude")?;
                match kind {
                    Kind::Imu | Kind::Static => {
                        f.write_str("; --method vertical gives pitch and roll without it")
                    }
                    _ => Ok(()),
                }
            }
            Self::Kind(Kind::Static) => f.write_str(
                "kind `static` has no positions to align from: `meridian allan` finds the gyro's noise in it",
            ),
            Self::Kind(kind) => write!(f, "kind `{kind}` has no positions to align from"),
            Self::Stops(kind) => {
                write!(
                    f,
                    "kind `{kind}` has no platform that turns all the time: no method rotating"
                )
            }
            Self::NoDwell => f.write_str(
                "column stage_rad: the stage stands still nowhere long enough for a dwell",
            ),
            Self::TooManyPositions(found) => {
                write!(
                    f,
                    "column stage_rad: {found} positions are more than the {CAPACITY} that a \
                     session holds: split the recording, or average neighbours into kind dwells"
                )
            }
            Self::NoVehicle(kind) => {
                write!(f, "kind `{kind}` is no vehicle: no method siap, static or vertical")
            }
            Self::NoSpin(kind) => write!(f, "kind `{kind}` has no spinning body: no method spin"),
            Self::TooFewSamples(count) => {
                write!(f, "column t_s: {count} sample(s) have no rate: record for longer")
            }
            Self::OneGyro => f.write_str(
                "columns gx_rad_s to az_m_s2 are missing: this method needs three gyros and three \
                 accelerometers; `meridian allan` finds the noise of the one",
            ),
            Self::TooManyStops(stops, most) => {
                write!(
                    f,
                    "key stops_s: {stops} stops are more than the {most} that a session holds"
                )
            }
            Self::Displacements { stated, stops } => {
                write!(f, "{stated} displacements for {stops} stops: state one for each stop")
            }
            Self::Stuck { column, line, seconds } => write!(
                f,
                "column {column}: the same value for {seconds:.1} s from line {line} on: the sensor is stuck; \
                 check its supply and cable, then record again or cut the recording off before"
            ),
            Self::Rate { stated_hz, found_hz } => write!(
                f,
                "key rate_hz: {} Hz, but the times of column t_s make it {found_hz:.3} Hz, {:.1} % apart: \
                 correct the one that is wrong",
                Short(*stated_hz),
                100.0 * (stated_hz / found_hz - 1.0).abs()
            ),
            Self::DegreesPerSecond { times } => write!(
                f,
                "columns gx_rad_s to gz_rad_s: at rest they show {times:.1} times the Earth rate, which is 1 in \
                 rad/s and 57.3 in °/s: convert them to rad/s"
            ),
            Self::Kilometres { greatest } => write!(
                f,
                "key displacements_north_east_m: with {greatest} m at the most there is no azimuth, with as many \
                 kilometres there is: state them in metres"
            ),
            Self::Way { stop, stated_m, driven_m, slip } => {
                let [[north, east], [driven_north, driven_east]] = [stated_m, driven_m];
                write!(
                    f,
                    "key displacements_north_east_m: from stop {stop} to the next it says {north:.1} m north and \
                     {east:.1} m east, the forces on the way say {driven_north:.0} m and {driven_east:.0} m: {slip}"
                )
            }
            Self::NoiseUnknown => f.write_str(
                "key gyro_N_deg_sqrt_h is missing, and the samples at rest are too few to estimate it from: \
                 state it, or stand for longer",
            ),
            Self::Session(why) => {
                write!(f, "key session: {why}: leave the line as the run wrote it, or take it out")
            }
            Self::Late(late) => late.fmt(f),
            Self::Procedure(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReplayError {}

/// Replays a recording; `progress` sees the session after each dwell.
///
/// # Errors
/// What keeps the session from beginning. A refusal is not an error but the session's conclusion.
pub fn replay(
    header: &Header,
    body: &Body,
    options: &Options,
    progress: impl FnMut(&Session),
) -> Result<Replay, ReplayError> {
    let stops = Stops::of(body)?;
    if let (Stops::Samples(rows), Some(given)) = (&stops, Given::of(header)?) {
        return again(given, rows, options, progress);
    }
    let latitude = latitude(header, body, options.latitude)?;
    let Described { mut setting, mut assumed } = describe(header, body, latitude);
    setting.half = options.half;
    assumed.extend(options.half.map(|_| HALF.to_owned()));
    if let Some(sigma) = options.required_sigma {
        setting.required_sigma = sigma;
    }
    let session = match stops {
        Stops::Samples(rows) => stage(header, rows, setting, options.criterion, progress),
        Stops::Averages(rows) => dwells(rows, setting, options.criterion, progress),
    }?;
    late::check_stage(&session).map_err(ReplayError::Late)?;
    assumed.extend(untold::of_stage(&session));
    assumed.extend(late::untold(&session).filter(|_| body.kind() == Kind::Stage));
    Ok(Replay { method: options.method, session, setting, assumed })
}

/// Replays a run by giving its session what the board's was given. Elevations show a mount of two frames.
fn again(
    given: Given<Setting, Procedure>,
    rows: &[StageRow],
    options: &Options,
    progress: impl FnMut(&Session),
) -> Result<Replay, ReplayError> {
    let Given { mut setting, mut procedure, ended } = given;
    options.change(&mut setting);
    procedure.criterion = options.criterion;
    let is_mounted = rows.iter().any(|row| row.elevation_rad.is_some());
    if is_mounted {
        setting.mount = TWO_FRAMES;
    }
    if let Some(survey) = &mut procedure.survey {
        survey.orders = if is_mounted { &Order::QUARTERS } else { &Order::COMPARED };
    }
    let mut session = Session::new(setting, procedure).map_err(ReplayError::Procedure)?;
    let end = ended.map_or(Event::End, Event::Failed);
    drive(&mut session, rows.iter().map(|row| sample(row, 0.0)), end, progress);
    let method = if is_mounted { Method::Positions } else { Method::of(&session) };
    Ok(Replay { method, setting: *session.setting(), session, assumed: vec![GIVEN.to_owned()] })
}

/// The rows of a recording whose stage stops.
enum Stops<'a> {
    Samples(&'a [StageRow]),
    Averages(&'a [DwellRow]),
}

impl<'a> Stops<'a> {
    fn of(body: &'a Body) -> Result<Self, ReplayError> {
        match body {
            Body::Stage(rows) => Ok(Self::Samples(rows)),
            Body::Dwells(rows) => Ok(Self::Averages(rows)),
            other => Err(ReplayError::Kind(other.kind())),
        }
    }
}

/// The user's latitude, or the header's.
///
/// # Errors
/// Neither gives one.
pub(crate) fn latitude(
    header: &Header,
    body: &Body,
    stated: Option<Latitude>,
) -> Result<Latitude, ReplayError> {
    stated
        .or_else(|| header.latitude_deg.and_then(Latitude::from_degrees))
        .ok_or(ReplayError::NoLatitude(body.kind()))
}

fn stage(
    header: &Header,
    rows: &[StageRow],
    setting: Setting,
    criterion: Criterion,
    progress: impl FnMut(&Session),
) -> Result<Session, ReplayError> {
    let sample_seconds = period_s(header.rate_hz, rows, |row| row.time_s);
    if let Some(axis) = dead_accelerometer(rows, |row| row.force_m_s2) {
        let column = ["fx_m_s2", "fy_m_s2"][axis];
        let seconds = rows.len() as f64 * sample_seconds;
        return Err(ReplayError::Stuck { column, line: rows[0].line, seconds });
    }
    let still = still(rows);
    let positions = standstills(rows, sample_seconds, still)?;
    let ends = [&positions[0], &positions[positions.len() - 1]].map(|position| position.seconds);
    late::check_gyro(rows, sample_seconds, ends).map_err(ReplayError::Late)?;
    let followed = followed(&positions, sample_seconds, criterion)?;
    let procedure = Procedure { still, ..followed };
    let mut session = Session::new(setting, procedure).map_err(ReplayError::Procedure)?;
    let begin = rows.first().map_or(0.0, |row| row.time_s);
    let limits = limits(rows);
    let shown = |row: &StageRow| {
        let mut sample = sample(row, begin);
        if row.rate_rad_s <= limits[0] || row.rate_rad_s >= limits[1] {
            sample.rate = AngularRate(i32::MAX);
        }
        sample
    };
    drive(&mut session, rows.iter().map(shown), Event::End, progress);
    Ok(session)
}

/// Between which rates a gyro's column is not cut, rad/s: a recording does not say what its gyro can measure, but
/// one at its limit shows the same greatest rate, or least, again and again.
fn limits(rows: &[StageRow]) -> [f64; 2] {
    let rates = || rows.iter().map(|row| row.rate_rad_s);
    let (least, greatest) =
        (rates().fold(f64::INFINITY, f64::min), rates().fold(f64::NEG_INFINITY, f64::max));
    [
        if is_cut(rates(), least) { least } else { f64::NEG_INFINITY },
        if is_cut(rates(), greatest) { greatest } else { f64::INFINITY },
    ]
}

/// The procedure that goes where a recording went.
fn followed(
    positions: &[Position],
    sample_seconds: f64,
    criterion: Criterion,
) -> Result<Procedure, ReplayError> {
    let schedule =
        Schedule::listed(positions).ok_or(ReplayError::TooManyPositions(positions.len()))?;
    Ok(Procedure {
        criterion,
        retries: 0,
        travel: [f64::NEG_INFINITY, f64::INFINITY],
        longest_seconds: f64::INFINITY,
        longest_rotation: f64::INFINITY,
        ..Procedure::new(schedule, sample_seconds)
    })
}

/// Feeds samples to a session until it has finished or they end, as this event tells it.
pub fn drive(
    session: &mut Session,
    samples: impl Iterator<Item = Sample>,
    end: Event<'_>,
    mut progress: impl FnMut(&Session),
) {
    let mut seen = 0;
    for sample in samples {
        session.handle(Event::Sample(&sample));
        if session.dwells().len() != seen {
            seen = session.dwells().len();
            progress(session);
        }
    }
    session.handle(end);
}

/// A row in the stage path's units, its time from `begin` on; rounding as in
/// [`orientation::units`].
fn sample(row: &StageRow, begin: f64) -> Sample {
    Sample {
        time: Instant::from_seconds(row.time_s - begin),
        stage: Angle::from_rad(row.stage_rad),
        rate: AngularRate::from_rad_per_s(row.rate_rad_s),
        force: row.force_is_new.then(|| row.force_m_s2.map(SpecificForce::from_m_per_s2)),
        temperature: row.temperature_c.map(Temperature::from_celsius),
        elevation: row.elevation_rad.map(Angle::from_rad),
    }
}

/// Greatest change of a noisy encoder's angle that counts as standing, rad.
const STILL_NOISY: f64 = 300e-6;
/// The same in medians of the encoder's change from sample to sample: six standard deviations of a
/// difference of two readings.
const STILL_MEDIANS: f64 = 9.0;
/// A standstill shorter than this part of the usual one is a pause in a rotation, not a dwell.
const PAUSE: f64 = 0.3;
/// Fewest samples of a dwell.
const FEWEST_SAMPLES: u32 = 10;
/// Shortest dwell, s: a stage that creeps at the ends of a rotation seems to stand for less.
const SHORTEST_SECONDS: f64 = 0.1;

/// How far the encoder may stray in a standstill, rad: most samples of a recording stand still.
fn still(rows: &[StageRow]) -> f64 {
    let mut changes: Vec<f64> =
        rows.windows(2).map(|pair| turned(pair[0].stage_rad, pair[1].stage_rad).abs()).collect();
    let usual = median(&mut changes);
    (STILL_MEDIANS * usual).clamp(STILL, STILL_NOISY)
}

/// The angle from one reading to the next, rad; a wrap of the encoder is none.
fn turned(from: f64, to: f64) -> f64 {
    let turns = (to - from) / TURN;
    (turns - turns.round()) * TURN
}

/// The length of the standstills in which half of all standing samples lie: a stage that rings at
/// every arrival leaves many short ones, but few samples in them.
fn usual_length(mut lengths: Vec<u32>) -> u32 {
    lengths.sort_unstable();
    let half = lengths.iter().map(|length| u64::from(*length)).sum::<u64>() / 2;
    let mut below = 0;
    let reaches_half = |length: &u32| {
        below += u64::from(*length);
        below > half
    };
    lengths.into_iter().find(reaches_half).unwrap_or(0)
}

/// Where the stage stood still, and for how long.
fn standstills(
    rows: &[StageRow],
    sample_seconds: f64,
    still: f64,
) -> Result<Vec<Position>, ReplayError> {
    let mut runs: Vec<(f64, u32)> = Vec::new();
    for row in rows {
        match runs.last_mut() {
            Some((anchor, count)) if turned(*anchor, row.stage_rad).abs() <= still => *count += 1,
            _ => runs.push((row.stage_rad, 1)),
        }
    }
    let fewest = FEWEST_SAMPLES.max((SHORTEST_SECONDS / sample_seconds) as u32);
    runs.retain(|run| run.1 >= fewest);
    let usual = f64::from(usual_length(runs.iter().map(|run| run.1).collect()));
    runs.retain(|run| f64::from(run.1) >= PAUSE * usual);
    if runs.is_empty() {
        return Err(ReplayError::NoDwell);
    }
    let position = |(angle, count)| Position { angle, seconds: f64::from(count) * sample_seconds };
    Ok(runs.into_iter().map(position).collect())
}

fn dwells(
    rows: &[DwellRow],
    setting: Setting,
    criterion: Criterion,
    mut progress: impl FnMut(&Session),
) -> Result<Session, ReplayError> {
    let position = |row: &DwellRow| Position { angle: row.stage_rad, seconds: row.seconds };
    let positions: Vec<Position> = rows.iter().map(position).collect();
    // No sample passes the filter; any rate at which the shortest dwell lets it settle will do.
    let shortest = positions.iter().map(|p| p.seconds).fold(f64::INFINITY, f64::min);
    let procedure = followed(&positions, shortest / 100.0, criterion)?;
    let mut session = Session::new(setting, procedure).map_err(ReplayError::Procedure)?;
    let mut end = 0.0;
    for row in rows {
        let middle = row.mid_s.unwrap_or(end + 0.5 * row.seconds);
        end = middle + 0.5 * row.seconds;
        session.handle(Event::Averaged(&averaged(row, middle)));
        progress(&session);
    }
    session.handle(Event::End);
    Ok(session)
}

/// A row as a dwell whose variance is stated; without times the rows follow each other directly.
fn averaged(row: &DwellRow, middle: f64) -> Dwell {
    Dwell {
        stage: Angle::from_rad(row.stage_rad),
        middle,
        seconds: row.seconds,
        rate: row.rate_rad_s,
        taper: 1.0,
        stated_variance: Some(row.sigma_rad_s * row.sigma_rad_s).into(),
        force: row.force_m_s2,
        ..Dwell::default()
    }
}
