//! Recordings of vehicles: replay through the session that finds the azimuth from stops.
//!
//! The recording has driven where it drove: its stops are stated, or found by the stop criteria, and it
//! is only followed. The types that come in here hold no truth.

pub mod averaging;
pub mod core;
pub mod noise;
pub mod samples;

use heapless::Vec as Few;
use orientation::align::setting::Setting as Common;
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::units::{DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR};

use self::core::{Conclusion, Criteria, Event, Procedure, STOPS, Session, Setting, Stops};
use crate::recording::{Body, Header, ImuRow, Kind};
use crate::replay::{self, ReplayError};
use crate::setting::{Described, describe};

/// How a vehicle's azimuth is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// From two stops and more: static initial azimuth update (Szymanowski 2003).
    Siap,
    /// At rest all the time, sway allowed.
    Static,
}

impl Method {
    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Siap => "siap",
            Self::Static => "static",
        }
    }
}

/// What the user asked for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The method; else as the recording shows.
    pub method: Option<Method>,
    /// Latitude instead of the header's.
    pub latitude: Option<Latitude>,
    /// Displacements of the stops, north and east, m, instead of the header's.
    pub displacements_m: Option<Vec<[f64; 2]>>,
    /// Greatest accepted standard deviation, rad; `None` for the default.
    pub required_sigma: Option<f64>,
}

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// The method.
    pub method: Method,
    /// The session, with its conclusion.
    pub session: Session,
    /// What the recording's clock showed at the session's zero, s.
    pub zero_s: f64,
    /// The stop criteria over the time, s from the session's zero.
    pub criteria: Vec<(f64, Criteria)>,
    /// What had to be assumed.
    pub assumed: Vec<String>,
}

impl Replay {
    /// The conclusion; of a session that was given its end there is one.
    #[must_use]
    pub fn conclusion(&self) -> Option<&Conclusion> {
        self.session.conclusion()
    }

    /// Whether the gyros' white noise was stated rather than estimated.
    #[must_use]
    pub fn noise_is_known(&self) -> bool {
        self.session.setting().common.white_known
    }
}

/// Replays the rows of a recording.
///
/// # Errors
/// What keeps the session from beginning. A refusal is not an error but the session's conclusion.
pub fn replay(header: &Header, body: &Body, options: &Options) -> Result<Replay, ReplayError> {
    let rows = samples::rows(body).ok_or_else(|| missing(body))?;
    let latitude = replay::latitude(header, options.latitude)?;
    let period_s = samples::period(header.rate_hz, &rows);
    let zero_s = samples::begin(&rows, period_s);
    let method = options.method.unwrap_or_else(|| usual(header, &rows, period_s));
    let stops = stops(header, method, zero_s)?;
    let displacements_m = displacements(header, options)?;
    let Described { setting: mut common, mut assumed } = describe(header, body, latitude);
    if let Some(sigma) = options.required_sigma {
        common.required_sigma = sigma;
    }
    let setting = setting(header, common, &rows, period_s, method, &mut assumed);
    let mut follower = Follower::new(setting, Procedure::new(stops, period_s), displacements_m)?;
    samples::samples(&rows, period_s).for_each(|sample| follower.push(&sample));
    let (session, criteria) = follower.end()?;
    Ok(Replay { method, session, zero_s, criteria, assumed })
}

/// Why a recording has no rows for these methods.
fn missing(body: &Body) -> ReplayError {
    match body.kind() {
        Kind::Static => ReplayError::OneGyro,
        kind => ReplayError::NoVehicle(kind),
    }
}

/// Turn about the vertical by which a vehicle that drives differs from one that sways, rad: 5°.
const DROVE: f64 = 5.0 / 360.0 * std::f64::consts::TAU;

/// The method of a recording for which none was asked: where no stop is stated and it never turned about
/// its vertical, it stood.
fn usual(header: &Header, rows: &[ImuRow], period_s: f64) -> Method {
    if header.stops_s.is_some() {
        return Method::Siap;
    }
    let (mut heading, mut least, mut most) = (0.0_f64, 0.0_f64, 0.0_f64);
    for row in rows {
        heading += row.sample.rates_rad_s[2] * period_s;
        (least, most) = (least.min(heading), most.max(heading));
    }
    if most - least > DROVE { Method::Siap } else { Method::Static }
}

/// The stops as the session counts them.
fn stops(header: &Header, method: Method, zero_s: f64) -> Result<Stops, ReplayError> {
    match (method, &header.stops_s) {
        (Method::Static, _) => Ok(Stops::Whole),
        (Method::Siap, None) => Ok(Stops::Found(0)),
        (Method::Siap, Some(stated)) => {
            let counted = stated.iter().map(|stop| stop.map(|time| time - zero_s));
            let all = Few::<_, STOPS>::from_slice(&counted.collect::<Vec<_>>());
            all.map(Stops::Stated).map_err(|_| ReplayError::TooManyStops(stated.len(), STOPS))
        }
    }
}

/// The user's displacements, or the header's; one for each stop where stops are stated.
fn displacements(header: &Header, options: &Options) -> Result<Vec<[f64; 2]>, ReplayError> {
    let list = options.displacements_m.as_ref().or(header.displacements_m.as_ref());
    let list = list.cloned().unwrap_or_default();
    match &header.stops_s {
        Some(stops) if !list.is_empty() && stops.len() != list.len() => {
            Err(ReplayError::Displacements { stated: list.len(), stops: stops.len() })
        }
        _ => Ok(list),
    }
}

/// What is known of the vehicle's sensors; noise that nobody stated is estimated.
fn setting(
    header: &Header,
    mut common: Common,
    rows: &[ImuRow],
    period_s: f64,
    method: Method,
    assumed: &mut Vec<String>,
) -> Setting {
    let stood = header.stops_s.as_deref().filter(|_| method == Method::Siap);
    let white = noise::estimate(rows, stood, period_s);
    if !common.white_known {
        let walk = white.angle_random_walk / DEGREE_PER_SQRT_HOUR;
        assumed.push(format!("gyro noise N {walk:.2e} °/√h as the recording shows it"));
        common.noise = GyroNoise { angle_random_walk: white.angle_random_walk, ..common.noise };
    }
    let noise = white.force;
    assumed.push(format!("accelerometer noise {noise:.2e} m/s²/√Hz as the recording shows it"));
    let bias_sigma = header.gyro_bias_deg_h.map(|bias| bias * DEGREE_PER_HOUR);
    if bias_sigma.is_none() {
        assumed.push("gyro biases unknown".to_owned());
    }
    Setting { bias_sigma, force_noise: Some(white.force), ..Setting::new(common) }
}

/// Feeds a session, and keeps what a report shows of it.
#[derive(Debug)]
pub struct Follower {
    session: Session,
    displacements_m: Vec<[f64; 2]>,
    told: usize,
    criteria: Vec<(f64, Criteria)>,
}

impl Follower {
    /// Of a session with this setting and procedure; displacements of the stops where they are known.
    ///
    /// # Errors
    /// What keeps the session from beginning.
    pub fn new(
        setting: Setting,
        procedure: Procedure,
        displacements_m: Vec<[f64; 2]>,
    ) -> Result<Self, ReplayError> {
        let session = Session::new(setting, procedure).map_err(ReplayError::Procedure)?;
        Ok(Self { session, displacements_m, told: 0, criteria: Vec::new() })
    }

    /// One more sample.
    pub fn push(&mut self, sample: &orientation::signal::InertialSample) {
        self.session.handle(Event::Sample(sample));
        if let Some(criteria) = self.session.criteria()
            && self.criteria.last().is_none_or(|(_, last)| *last != criteria)
        {
            self.criteria.push((sample.time.0 as f64 * 1e-6, criteria));
        }
        self.tell();
    }

    /// Tells the session how far a stop lies from the first as soon as it knows of that stop.
    fn tell(&mut self) {
        while self.told < self.session.stops().len().min(self.displacements_m.len()) {
            self.session.handle(Event::Displaced(self.displacements_m[self.told]));
            self.told += 1;
        }
    }

    /// The session with its conclusion, and the stop criteria over time.
    ///
    /// # Errors
    /// There were not as many stops as displacements.
    pub fn end(mut self) -> Result<(Session, Vec<(f64, Criteria)>), ReplayError> {
        self.session.handle(Event::End);
        let (stated, stops) = (self.displacements_m.len(), self.session.stops().len());
        if stated > 0 && stated != stops {
            return Err(ReplayError::Displacements { stated, stops });
        }
        Ok((self.session, self.criteria))
    }
}
