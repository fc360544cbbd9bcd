//! Drives the session of the pure crate with a recording, as the board drives it with sensors.
//!
//! A recording has gone where it went: the positions at which its stage stood become the session's
//! schedule, its travel has no limit, and nothing can be repeated. The types that come in here hold
//! no truth.

pub mod late;
pub mod outcome;
pub mod positions;

use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::Session;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::mount::TWO_FRAMES;
use orientation::alignment::stepwise::session::procedure::{Procedure, STILL};
use orientation::alignment::stepwise::session::schedule::{Position, Schedule};
use orientation::alignment::stepwise::setting::{Half, Setting};
use orientation::alignment::{Input, Method};
use orientation::planner::order::Order;
use orientation::signal::Sample;
use orientation::signal::dwell::Dwell;
use orientation::units::{
    Angle, AngularRate, Instant, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds,
    SpecificForce, TURN, Temperature,
};

use super::asked::{Asked, Question};
use super::error::ReplayError;
use super::limits::{limits, saturated};
use super::stops::samples::dead_accelerometer;
use crate::assumptions;
use crate::median::median;
use crate::recording::period::period_s;
use crate::recording::{self, Body, DwellRow, GIVEN, Given, Header, Kind, StageRow};

/// Name on the command line of an alignment in positions.
pub const STEPWISE: &str = "stepwise";
/// Name on the command line of one that goes through them in passes; the fit is the same.
pub const POSITIONS: &str = "positions";

/// The name of a session that ran by itself: a planned schedule goes through positions in passes.
pub(crate) fn name_of(session: &Session) -> &'static str {
    match session.procedure.schedule {
        Schedule::Planned(_) => POSITIONS,
        Schedule::Listed(_) | Schedule::TowardMaximum { .. } => STEPWISE,
    }
}

/// What an answer rests on where the half of the circle was stated.
const HALF: &str = "the half of the circle as stated: two positions give its mirror image else";

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Name of the method.
    pub method: &'static str,
    /// The session, with its conclusion.
    pub session: Session,
    /// What had to be assumed.
    pub assumed: Vec<String>,
}

impl Replay {
    /// The criterion as the command line names it.
    pub(crate) fn criterion_name(&self) -> String {
        crate::criterion::name(self.session.procedure.criterion)
    }

    /// Whether the gyro's white noise was stated rather than estimated.
    pub(crate) fn noise_is_known(&self) -> bool {
        self.session.setting.site.noise.is_white_known() || self.has_stated_dwells()
    }

    /// Whether the 1σ of every dwell was stated, so that no N weighs them.
    pub(crate) fn has_stated_dwells(&self) -> bool {
        let mut dwells = self.session.dwells().iter().peekable();
        dwells.peek().is_some() && dwells.all(|dwell| dwell.stated_variance.get().is_some())
    }
}

/// Whether the sway of the base is subtracted from what a session is given.
#[must_use]
pub fn subtracts_sway(session: &Session) -> bool {
    session.setting.sway.mean_variance(1.0) > 0.0
}

/// Replays a recording; `progress` sees the session after each dwell.
///
/// # Errors
/// What keeps the session from beginning. A refusal is not an error but the session's conclusion.
pub fn replay(
    header: &Header,
    body: &Body,
    asked: &Asked,
    progress: impl FnMut(&Session),
) -> Result<Replay, ReplayError> {
    let of = &Question { header, body, asked };
    match body {
        Body::Stage(rows) => match Given::of(header).map_err(ReplayError::Session)? {
            Some(given) => again(given, rows, asked, progress),
            None if is_mounted(rows) => Err(ReplayError::Mounted),
            None => {
                followed(of, |setting, criterion| stage(header, rows, setting, criterion, progress))
            }
        },
        Body::Dwells(rows) => {
            followed(of, |setting, criterion| dwells(rows, setting, criterion, progress))
        }
        other => Err(ReplayError::Kind(other.kind())),
    }
}

/// Replays a recording with what its header and the user state, by a session that follows its rows.
fn followed(
    of: &Question,
    session: impl FnOnce(Setting, Criterion) -> Result<Session, ReplayError>,
) -> Result<Replay, ReplayError> {
    let (asked, mut assumed) = (of.asked, Vec::new());
    let site = of.site(&mut assumed)?;
    let setting = Setting { half: asked.half, ..Setting::new(site) };
    assumed.extend(asked.half.map(|_| HALF.to_owned()));
    let session = session(setting, asked.criterion.unwrap_or_default())?;
    late::check_stage(&session)?;
    assumed.extend(assumptions::of_stage(&session));
    assumed.extend(late::assumption(&session).filter(|_| of.body.kind() == Kind::Stage));
    Ok(Replay { method: asked.method.unwrap_or(STEPWISE), session, assumed })
}

/// Whether elevations show a mount of two frames.
fn is_mounted(rows: &[StageRow]) -> bool {
    rows.iter().any(|row| row.elevation_rad.is_some())
}

/// Replays a run by giving its session what the board's was given. Elevations show a mount of two frames.
fn again(
    given: Given<Setting, Procedure>,
    rows: &[StageRow],
    asked: &Asked,
    progress: impl FnMut(&Session),
) -> Result<Replay, ReplayError> {
    let Given { mut setting, mut procedure, ended } = given;
    asked.change(&mut setting.site);
    setting.half = asked.half.or(setting.half);
    procedure.criterion = asked.criterion.unwrap_or(procedure.criterion);
    let is_mounted = is_mounted(rows);
    let mut session = mounted(is_mounted, (setting, procedure))?;
    let end = ended.as_ref().map_or(Input::End, Input::Failed);
    let given =
        |row: &StageRow| Sample { rate: recording::rate(row.rate_rad_s), ..sample(row, 0.0) };
    drive(&mut session, rows.iter().map(given), end, progress);
    let shown = if is_mounted { POSITIONS } else { name_of(&session) };
    let method = asked.method.unwrap_or(shown);
    let assumed = given_with(session.setting.half);
    Ok(Replay { method, session, assumed })
}

/// A session with what text does not hold of it, on a stage or on a mount of two frames.
///
/// # Errors
/// The procedure is impossible.
pub(crate) fn mounted(
    is_mounted: bool,
    (mut setting, mut procedure): (Setting, Procedure),
) -> Result<Session, SetupError> {
    if is_mounted {
        setting.mount = TWO_FRAMES;
    }
    if let Some(survey) = &mut procedure.survey {
        survey.orders = if is_mounted { &Order::QUARTERS } else { &Order::COMPARED };
    }
    Session::new(setting, procedure)
}

/// What an azimuth rests on where the board was given what it needs, and this half of the circle.
pub(crate) fn given_with(half: Option<Half>) -> Vec<String> {
    [GIVEN].into_iter().chain(half.map(|_| HALF)).map(str::to_owned).collect()
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
    let ends = [&positions[0], &positions[positions.len() - 1]].map(|position| position.seconds.0);
    late::check_gyro(rows, sample_seconds, ends)?;
    let following = following(&positions, sample_seconds, criterion)?;
    let procedure = Procedure { still: Radians(still), ..following };
    let mut session = Session::new(setting, procedure)?;
    let begin = rows.first().map_or(0.0, |row| row.time_s);
    let limits = limits(&rows.iter().map(|row| row.rate_rad_s), 0.0);
    let shown = |row: &StageRow| saturated(limits, row.rate_rad_s, sample(row, begin));
    drive(&mut session, rows.iter().map(shown), Input::End, progress);
    Ok(session)
}

/// The procedure that goes where a recording went.
fn following(
    positions: &[Position],
    sample_seconds: f64,
    criterion: Criterion,
) -> Result<Procedure, ReplayError> {
    let schedule =
        Schedule::listed(positions).ok_or(ReplayError::TooManyPositions(positions.len()))?;
    Ok(Procedure {
        criterion,
        retries: 0,
        travel: [Radians(f64::NEG_INFINITY), Radians(f64::INFINITY)],
        longest_seconds: Seconds(f64::INFINITY),
        longest_rotation: Seconds(f64::INFINITY),
        ..Procedure::new(schedule, Seconds(sample_seconds))
    })
}

/// Feeds samples to a session until it has finished or they end, as this event states it.
pub fn drive(
    session: &mut Session,
    samples: impl Iterator<Item = Sample>,
    end: Input<'_, Sample>,
    mut progress: impl FnMut(&Session),
) {
    let mut seen = 0;
    for sample in samples {
        session.feed(Input::Sample(&sample));
        if session.dwells().len() != seen {
            seen = session.dwells().len();
            progress(session);
        }
    }
    session.feed(end);
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
/// Tolerance of a standstill in medians of the encoder's change from sample to sample: six standard deviations of a
/// difference of two readings.
const STILL_MEDIANS: f64 = 9.0;
/// A standstill shorter than this part of the usual one is a pause in a rotation, not a dwell.
const PAUSE: f64 = 0.3;
/// Fewest samples of a dwell.
const FEWEST_SAMPLES: u32 = 10;
/// Shortest dwell, s: a stage that creeps at the ends of a rotation seems to stand for less.
const SHORTEST_SECONDS: f64 = 0.1;

/// How far the encoder may move in a standstill, rad: most samples of a recording stand still.
fn still(rows: &[StageRow]) -> f64 {
    let changes = rows.windows(2).map(|pair| turned(pair[0].stage_rad, pair[1].stage_rad).abs());
    (STILL_MEDIANS * median(changes)).clamp(STILL.0, STILL_NOISY)
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
    let length = |count| Seconds(f64::from(count) * sample_seconds);
    let position = |(angle, count)| Position { angle: Radians(angle), seconds: length(count) };
    Ok(runs.into_iter().map(position).collect())
}

fn dwells(
    rows: &[DwellRow],
    setting: Setting,
    criterion: Criterion,
    mut progress: impl FnMut(&Session),
) -> Result<Session, ReplayError> {
    let position =
        |row: &DwellRow| Position { angle: Radians(row.stage_rad), seconds: Seconds(row.seconds) };
    let positions: Vec<Position> = rows.iter().map(position).collect();
    // No sample passes the filter; any rate at which the shortest dwell lets it settle will do.
    let shortest = positions.iter().map(|p| p.seconds.0).fold(f64::INFINITY, f64::min);
    let procedure = following(&positions, shortest / 100.0, criterion)?;
    let mut session = Session::new(setting, procedure)?;
    let mut end = 0.0;
    for row in rows {
        let middle = row.mid_s.unwrap_or(end + 0.5 * row.seconds);
        end = middle + 0.5 * row.seconds;
        session.take_dwell(&averaged(row, middle));
        progress(&session);
    }
    session.feed(Input::End);
    Ok(session)
}

/// A row as a dwell whose variance is stated; without times the rows follow each other directly.
fn averaged(row: &DwellRow, middle: f64) -> Dwell {
    Dwell {
        stage: Angle::from_rad(row.stage_rad),
        middle: Seconds(middle),
        seconds: Seconds(row.seconds),
        rate: RadiansPerSecond(row.rate_rad_s),
        taper: 1.0,
        stated_variance: Some(row.sigma_rad_s * row.sigma_rad_s).into(),
        force: row.force_m_s2.map(|force| force.map(MetresPerSecondSquared)),
        ..Dwell::default()
    }
}
