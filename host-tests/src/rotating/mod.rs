//! Recordings of a platform that turns all the time: replay through the session, and what figures need.

pub mod part;
pub mod recorder;
pub mod turns;

use orientation::align::rotating::conclusion::Conclusion;
use orientation::align::rotating::turn::Stretch;
use orientation::align::rotating::{Sensor, Setting};
use orientation::session::procedure::ProcedureError;
use orientation::session::rotating::{Event, Procedure, Session};
use orientation::signal::Sample;
use orientation::units::{Angle, AngularRate, Instant, SpecificForce};

use self::part::Part;
use crate::recording::{self, Body, Header, RotatingRow};
use crate::replay::{Options, ReplayError, latitude};
use crate::setting::{Described, describe};

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// The session, with its conclusion.
    pub session: Session,
    /// What the recording's clock showed at the session's zero, s.
    pub zero_s: f64,
    /// What had to be assumed.
    pub assumed: Vec<String>,
}

impl Replay {
    /// The conclusion; of a session that was given its end there is one.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.session.conclusion()
    }

    /// Whether the sensor's white noise was stated rather than estimated.
    #[must_use]
    pub fn noise_is_known(&self) -> bool {
        self.session.setting().common.white_known
    }

    /// The parts of the recording that the session made of it: what came before the first even turn, then
    /// each stretch of even turns, in the order of time.
    #[must_use]
    pub fn parts<'a>(&self, rows: &'a [RotatingRow]) -> Vec<Part<'a>> {
        let mut spans: Vec<(f64, f64)> =
            self.session.follower().stretches().iter().filter_map(span).collect();
        spans.sort_by(|a, b| a.0.total_cmp(&b.0));
        let begin = spans.first().map_or(f64::INFINITY, |span| span.0);
        let between = |from: f64, to: f64, is_even| {
            Part::between(rows, self.zero_s + from, self.zero_s + to, is_even)
        };
        let uneven = between(0.0, begin, false);
        let even = spans.iter().map(|(from, to)| between(*from, *to, true));
        [uneven].into_iter().chain(even).filter(|part| turns::whole_turns(part.rows) > 0).collect()
    }
}

/// When a stretch's first turn began and its last one ended, s.
fn span(stretch: &Stretch) -> Option<(f64, f64)> {
    let [first, last] = [stretch.turns().first()?, stretch.turns().last()?];
    let since = stretch.since() as f64 * 1e-6;
    let begin = f64::from(first.middle) - 0.5 * f64::from(first.seconds);
    let end = f64::from(last.middle) + 0.5 * f64::from(last.seconds);
    Some((since + begin, since + end))
}

/// Replays the rows of a recording.
///
/// # Errors
/// What keeps the session from beginning. A refusal is not an error but the session's conclusion.
pub fn replay(header: &Header, body: &Body, options: &Options) -> Result<Replay, ReplayError> {
    let Body::Rotating(rows) = body else { return Err(ReplayError::Stops(body.kind())) };
    let latitude = latitude(header, options.latitude)?;
    let Described { setting: mut common, mut assumed } = describe(header, body, latitude);
    if let Some(sigma) = options.required_sigma {
        common.required_sigma = sigma;
    }
    let sensor = sensor(header, &mut assumed);
    let rate = header.rate_hz.unwrap_or_else(|| turns::rate_hz(rows));
    let session = follow(Setting::new(common, sensor), rows, 1.0 / rate.max(f64::MIN_POSITIVE));
    let zero_s = rows.first().map_or(0.0, |row| row.time_s);
    Ok(Replay { session: session.map_err(ReplayError::Procedure)?, zero_s, assumed })
}

/// The kind of sensor that the header names.
fn sensor(header: &Header, assumed: &mut Vec<String>) -> Sensor {
    match header.sensor {
        Some(recording::Sensor::Met) => Sensor::MOLECULAR,
        Some(recording::Sensor::Gyro) => Sensor::GYRO,
        None => {
            assumed.push("a gyro, not a molecular-electronic sensor".to_owned());
            Sensor::GYRO
        }
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
) -> Result<Session, ProcedureError> {
    let mut session = Session::new(setting, Procedure::recorded(sample_seconds))?;
    let begin = rows.first().map_or(0.0, |row| row.time_s);
    for row in rows {
        session.handle(Event::Recorded(&sample(row, begin), row.stage_rate_rad_s as f32));
    }
    session.handle(Event::End);
    Ok(session)
}

/// A row in the stage path's units, its time from `begin` on; rounding as in
/// [`orientation::units`]. The force across the axis is not recorded, and nobody asks for it.
fn sample(row: &RotatingRow, begin: f64) -> Sample {
    let along = SpecificForce::from_m_per_s2(row.force_m_s2);
    Sample {
        time: Instant::from_seconds(row.time_s - begin),
        stage: Angle::from_rad(row.stage_rad),
        rate: AngularRate::from_rad_per_s(row.rate_rad_s),
        force: Some([along, SpecificForce::default(), SpecificForce::default()]),
        ..Sample::default()
    }
}
