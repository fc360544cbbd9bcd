//! Recordings of a platform that turns all the time: replay through the session, and what figures need.

pub mod outcome;
pub mod part;
pub mod turns;

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use orientation::alignment::rotating::session::{Procedure, Session};
use orientation::alignment::rotating::turn::{Stretch, Turn};
use orientation::alignment::rotating::{Sensor, Setting};
use orientation::alignment::setup::SetupError;
use orientation::alignment::site::Site;
use orientation::alignment::{Input, Method};
use orientation::signal::Sample;
use orientation::units::{
    Angle, AngularRate, Instant, Radians, RadiansPerRootSecond, RadiansPerSecond, Seconds,
    SpecificForce,
};

use self::part::Part;
use crate::assumptions;
use crate::assumptions::or_assumed;
use crate::median::median;
use crate::methods::asked::{Asked, Question};
use crate::methods::error::ReplayError;
use crate::methods::limits::{limits, saturated};
use crate::recording::period::period_s;
use crate::recording::{self, Body, GIVEN, Given, Header, RotatingRow};

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// The session, with its conclusion.
    pub session: Session,
    /// What the recording's clock showed at the session's zero, s.
    pub zero_s: f64,
    /// What had to be assumed.
    pub assumed: Vec<String>,
    /// Whether the session followed a recording; else it commanded the platform.
    pub is_followed: bool,
}

impl Replay {
    /// The replay of a session that its run, or another replay, has given its samples.
    #[must_use]
    pub fn of_run(session: Session) -> Self {
        let assumed = vec![GIVEN.to_owned()];
        Self { session, zero_s: 0.0, assumed, is_followed: false }
    }

    /// The parts of the recording that the session made of it: what came before the first even turn, then
    /// each stretch of even turns, in the order of time.
    #[must_use]
    pub fn parts<'a>(&self, rows: &'a [RotatingRow]) -> Vec<Part<'a>> {
        let mut spans: Vec<(f64, f64)> =
            self.session.turn_accumulator.stretches.iter().filter_map(of_stretch).collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let begin = spans.first().map_or(f64::INFINITY, |span| span.0);
        let between = |from: f64, to: f64, is_even| {
            Part::between(rows, self.zero_s + from, self.zero_s + to, is_even)
        };
        let first = between(0.0, begin, false);
        let even = spans.iter().map(|(from, to)| between(*from, *to, true));
        [first].into_iter().chain(even).filter(|part| turns::whole_turns(part.rows) > 0).collect()
    }
}

/// When a stretch's first turn began and its last one ended, s.
pub(crate) fn of_stretch(stretch: &Stretch) -> Option<(f64, f64)> {
    span(&stretch.turns, stretch.since)
}

/// When the first of these turns began and the last one ended, s; their stretch began at `since` µs.
pub(crate) fn span(turns: &[Turn], since: u64) -> Option<(f64, f64)> {
    let [first, last] = [turns.first()?, turns.last()?];
    let since = since as f64 * 1e-6;
    let begin = f64::from(first.middle) - 0.5 * f64::from(first.seconds);
    let end = f64::from(last.middle) + 0.5 * f64::from(last.seconds);
    Some((since + begin, since + end))
}

/// Replays the rows of a recording.
///
/// # Errors
/// What keeps the session from beginning. A refusal is not an error but the session's conclusion.
pub fn replay(header: &Header, body: &Body, asked: &Asked) -> Result<Replay, ReplayError> {
    let Body::Rotating(rows) = body else { return Err(ReplayError::Stops(body.kind())) };
    if let Some(given) = Given::of(header).map_err(ReplayError::Session)? {
        return again(given, rows, asked);
    }
    let mut assumed = Vec::new();
    let mut site = Question { header, body, asked }.site(&mut assumed)?;
    let sensor = sensor(header, &mut assumed);
    // A stated rate is not replaced by that of the times: the session compares both, and refuses what is contradicted.
    let of_times = || 1.0 / period_s(None, rows, |row| row.time_s);
    let rate = header.rate_hz.unwrap_or_else(of_times);
    let rate_step = RadiansPerSecond(rounded(&mut site, sensor.is_flat, rows, rate));
    let encoder_zero_sigma = encoder_zero(header, &mut assumed);
    let setting = Setting::new(site, sensor);
    let setting = Setting { encoder_zero_sigma, harmonics_known: false, rate_step, ..setting };
    let session = follow(setting, rows, 1.0 / rate)?;
    assumed.extend(assumptions::of_platform(&session));
    let zero_s = rows.first().map_or(0.0, |row| row.time_s);
    Ok(Replay { session, zero_s, assumed, is_followed: true })
}

/// Replays a run by giving its session what the board's was given.
///
/// # Errors
/// As [`replay`].
fn again(
    given: Given<Setting, Procedure>,
    rows: &[RotatingRow],
    asked: &Asked,
) -> Result<Replay, ReplayError> {
    let Given { mut setting, procedure, ended } = given;
    asked.change(&mut setting.site);
    let mut session = Session::new(setting, procedure)?;
    feed(&mut session, rows);
    session.feed(ended.as_ref().map_or(Input::End, Input::Failed));
    Ok(Replay::of_run(session))
}

/// Gives a session the rows of a run as its board had them.
fn feed(session: &mut Session, rows: &[RotatingRow]) {
    for row in rows {
        let rate = recording::rate(row.rate_rad_s);
        session.feed(Input::Sample(&Sample { rate, ..sample(row, 0.0) }));
    }
}

/// The session of a replay once more, of its first rows alone; none where it cannot begin.
pub(crate) fn again_until(replay: &Replay, rows: &[RotatingRow]) -> Option<Session> {
    let Session { setting, procedure, .. } = &replay.session;
    if replay.is_followed {
        return follow(*setting, rows, procedure.sample_seconds.0).ok();
    }
    let mut session = Session::new(*setting, procedure.clone()).ok()?;
    feed(&mut session, rows);
    session.feed(Input::End);
    Some(session)
}

/// Part of the power of what rounding adds that is the first harmonic of its staircase, 6/π².
const FIRST_HARMONIC: f64 = 6.0 / (PI * PI);

/// Takes the steps of a gyro's column into its noise, and gives what of them its noise does not hide, rad/s: it smooths
/// the staircase by e^(−2π²(σ/step)²). That part goes with the platform's turn and is no noise. What is stated of it is the
/// sensor's input, of which one that is not flat passes less.
fn rounded(site: &mut Site, is_flat: bool, rows: &[RotatingRow], rate_hz: f64) -> f64 {
    let mut rates: Vec<f64> = rows.iter().map(|row| row.rate_rad_s).collect();
    rates.sort_unstable_by(f64::total_cmp);
    let steps = rates.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0);
    let step = steps.reduce(f64::min).unwrap_or_default();
    if step <= 0.0 {
        return 0.0;
    }
    let walk = site.noise.model().angle_random_walk;
    let is_stated = site.noise.is_white_known() && is_flat;
    let sigma = if is_stated { walk.0 * rate_hz.sqrt() } else { of_neighbours(rows) };
    let smoothed = (-0.5 * (TAU * sigma / step).powi(2)).exp();
    let scattered = 1.0 - FIRST_HARMONIC * smoothed * smoothed;
    site.noise.model_mut().angle_random_walk =
        RadiansPerRootSecond(walk.0.hypot(step * (scattered / (12.0 * rate_hz)).sqrt()));
    step * smoothed
}

/// 1σ of a rate's noise, rad/s, from the differences of neighbours: their median is 0.674 of their σ.
fn of_neighbours(rows: &[RotatingRow]) -> f64 {
    let differences = rows.windows(2).map(|pair| (pair[1].rate_rad_s - pair[0].rate_rad_s).abs());
    median(differences) / 0.674 * FRAC_1_SQRT_2
}

/// 1σ of the zero of an encoder of which nothing is known, °: where one without an index is set by hand.
const ZERO_SIGMA_DEG: f64 = 0.15;

/// 1σ of the encoder's zero; no key states its harmonics.
fn encoder_zero(header: &Header, assumed: &mut Vec<String>) -> Radians {
    let words = || "encoder zero to 0.15° (encoder_zero_sigma_deg)".to_owned();
    let sigma = or_assumed(header.encoder_zero_sigma_deg, ZERO_SIGMA_DEG, assumed, words);
    Radians::from_degrees(sigma)
}

/// The kind of sensor that the header names.
fn sensor(header: &Header, assumed: &mut Vec<String>) -> Sensor {
    let words = || "a gyro, not a molecular-electronic sensor".to_owned();
    match or_assumed(header.sensor, recording::Sensor::Gyro, assumed, words) {
        recording::Sensor::Met => Sensor::MOLECULAR,
        recording::Sensor::Gyro => Sensor::GYRO,
    }
}

/// Follows rows to their end.
///
/// # Errors
/// What keeps the session from beginning.
pub fn follow(
    setting: Setting,
    rows: &[RotatingRow],
    sample_seconds: f64,
) -> Result<Session, SetupError> {
    let mut session = Session::new(setting, Procedure::recorded(Seconds(sample_seconds)))?;
    let begin = rows.first().map_or(0.0, |row| row.time_s);
    let limits = limits(&rows.iter().map(|row| row.rate_rad_s), FEW_CUT);
    for row in rows {
        let sample = saturated(limits, row.rate_rad_s, sample(row, begin));
        session.take_recorded(&sample, row.stage_rate_rad_s as f32);
    }
    session.feed(Input::End);
    Ok(session)
}

/// Part of a turn's samples that may stand at a limit: what so few peaks of the noise lack is nothing.
const FEW_CUT: f64 = 0.003;

/// A row in the stage path's units, its time from `begin` on; rounding as in
/// [`orientation::units`]. A force across the axis that is not recorded is none.
fn sample(row: &RotatingRow, begin: f64) -> Sample {
    let along = SpecificForce::from_m_per_s2(row.force_m_s2);
    let across = row.across_m_s2.map_or(SpecificForce::default(), SpecificForce::from_m_per_s2);
    Sample {
        time: Instant::from_seconds(row.time_s - begin),
        stage: Angle::from_rad(row.stage_rad),
        rate: AngularRate::from_rad_per_s(row.rate_rad_s),
        force: row.force_is_new.then_some([along, across, SpecificForce::default()]),
        ..Sample::default()
    }
}
