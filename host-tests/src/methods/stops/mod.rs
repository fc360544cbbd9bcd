//! Recordings of vehicles: replay through the session that finds the azimuth from stops.
//!
//! The recording has driven where it drove: its stops are stated, or found by the stop criteria, and it
//! is only followed. The types that come in here hold no truth.

pub mod averaging;
pub mod floor;
pub mod grade;
pub mod noise;
pub mod outcome;
pub mod samples;
pub mod way;

use firmware::ports::Recorder;
use heapless::Vec as Few;
use orientation::alignment::site::Site;
use orientation::alignment::stops::Setting;
use orientation::alignment::stops::session::{Procedure, Session};
use orientation::alignment::stops::stop::{STOPS, Stop};
use orientation::alignment::stops::stop_detector::Rests;
use orientation::alignment::{Input, Method as _};
use orientation::earth::EARTH_RATE;
use orientation::signal::InertialSample;
use orientation::signal::rest::{Criteria, Limits};
use orientation::units::{
    DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, DEGREES_PER_RADIAN, ForceNoise, Metres, Radians,
    RadiansPerRootSecond, RadiansPerSecond, Seconds,
};

use self::noise::White;
use self::way::{Driven, Leg, Slip};
use crate::assumptions;
use crate::median::{extremes, median};
use crate::methods::asked::{Asked, Question};
use crate::methods::error::ReplayError;
use crate::methods::is_answered;
use crate::output::significant;
use crate::recording::period::{Steps, period_s};
use crate::recording::{Body, GIVEN, Given, Header, ImuRow, Kind};

/// Name on the command line of an alignment from two stops and more: static initial azimuth update (Szymanowski 2003).
pub const SIAP: &str = "siap";
/// Name on the command line of one at rest all the time, sway allowed.
pub const STATIC: &str = "static";

/// The method of a recording for which none was asked; none of a kind without three gyros and three accelerometers.
pub(crate) fn usual_method(header: &Header, body: &Body) -> Option<&'static str> {
    let rows = samples::rows(body)?;
    Some(usual(header, &rows, period_s(header.rate_hz, &rows, |row| row.time_s)))
}

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// Name of the method.
    pub method: &'static str,
    /// The session, with its conclusion.
    pub session: Session,
    /// What the recording's clock showed at the session's zero, s.
    pub zero_s: f64,
    /// The stop criteria and what they are held to over the time, s from the session's zero.
    pub criteria: Vec<(f64, Criteria, Limits)>,
    /// Seconds of stops that were left out, from … to, s from the session's zero.
    pub left_out: Vec<[f64; 2]>,
    /// What had to be assumed.
    pub assumed: Vec<String>,
}

impl Replay {
    /// A replay of a session that begins.
    #[must_use]
    pub fn of(method: &'static str, session: Session, zero_s: f64, assumed: Vec<String>) -> Self {
        let (criteria, left_out) = Default::default();
        Self { method, session, zero_s, criteria, left_out, assumed }
    }

    /// Feeds a sample to the session, and keeps the stop criteria where they are new, and what it leaves out of a stop.
    pub(crate) fn push(&mut self, sample: &InertialSample) {
        let before = self.session.stops().last().map(|stop| (stop.from, stop.to, stop.left_out));
        self.session.feed(Input::Sample(sample));
        if let Some(stop) = self.session.stops().last() {
            let same = before.filter(|(from, ..)| *from == stop.from);
            let (to, left_out) = same.map_or((stop.from, 0), |(_, to, left_out)| (to, left_out));
            if stop.left_out > left_out {
                self.left_out.push([to.0, stop.to.0]);
            }
        }
        if let Some((criteria, limits)) = self.session.criteria()
            && self.criteria.last().is_none_or(|(_, last, _)| *last != criteria)
        {
            self.criteria.push((sample.time.seconds(), criteria, limits));
        }
    }

    /// The drives from stop to stop, from the azimuth at the first one.
    pub(crate) fn drives(&self, rows: &[ImuRow], azimuth: Radians) -> Vec<Driven> {
        let period_s = self.session.procedure.sample_seconds.0;
        let (stops, site) = (self.session.stops(), &self.session.setting.site);
        way::drives(rows, self.zero_s, period_s, stops, site, azimuth.0)
    }

    /// The session once more, from its first stop until a time since its zero, with the stops that it has found until then.
    pub(crate) fn until(&self, rows: &[ImuRow], end: Seconds) -> Option<Session> {
        let (setting, procedure) = (self.session.setting, self.session.procedure.clone());
        let stops = self.session.stops().iter().filter(|stop| stop.from.0 < end.0);
        let until = |stop: &Stop| [stop.from, Seconds(stop.to.0.min(end.0))];
        let rests = match procedure.rests {
            Rests::Whole => Rests::Whole,
            _ => Rests::Stated(stops.clone().map(until).collect()),
        };
        let displacements = stops.map_while(|stop| stop.displacement).collect();
        let period_s = procedure.sample_seconds;
        let procedure = Procedure { displacements, ..Procedure::recorded(rests, period_s) };
        let mut session = Session::new(setting, procedure).ok()?;
        let before = |time: Seconds| rows.partition_point(|row| row.time_s <= self.zero_s + time.0);
        let from = before(self.session.stops().first()?.from);
        let samples = samples::since(self.zero_s, &rows[from..before(end).max(from)], period_s.0);
        samples.for_each(|sample| _ = session.feed(Input::Sample(&sample)));
        session.feed(Input::End);
        Some(session)
    }

    /// The replay after all samples and their end.
    fn fed(
        mut self,
        samples: impl Iterator<Item = InertialSample>,
        end: Input<'_, InertialSample>,
    ) -> Self {
        samples.for_each(|sample| self.push(&sample));
        self.session.feed(end);
        self
    }
}

impl Recorder<InertialSample> for &mut Replay {
    async fn record(&mut self, sample: &InertialSample) {
        self.push(sample);
    }
}

/// Replays the rows of a recording.
///
/// # Errors
/// What keeps the session from beginning, or makes it refuse: displacements in kilometres. Another refusal is
/// not an error but the session's conclusion.
pub fn replay(header: &Header, body: &Body, asked: &Asked) -> Result<Replay, ReplayError> {
    let of = &Question { header, body, asked };
    let replay = run(of)?;
    // What a board was given it went by; what a user states has to agree with the forces.
    let is_run = header.session.is_some() && replay.method == SIAP;
    if is_run && asked.displacements_m.is_none() {
        return Ok(replay);
    }
    check_kilometres(of, &replay)?;
    check_way(of, replay)
}

/// Replays the rows, as a run where they come from one.
fn run(of: &Question) -> Result<Replay, ReplayError> {
    let rows = samples::rows(of.body).ok_or_else(|| missing(of.body))?;
    let given = Given::of(of.header).map_err(ReplayError::Session)?;
    match given.filter(|_| of.asked.method != Some(STATIC)) {
        Some(given) => again(given, of, &rows),
        None => follow(of, &rows),
    }
}

/// Replays a run by giving its session what the board's was given.
fn again(
    given: Given<Setting, Procedure>,
    of: &Question,
    rows: &[ImuRow],
) -> Result<Replay, ReplayError> {
    let Given { mut setting, mut procedure, ended } = given;
    of.asked.change(&mut setting.site);
    procedure.displacements = displacements(of)?;
    let period_s = procedure.sample_seconds;
    let session = Session::new(setting, procedure)?;
    let replay = Replay::of(SIAP, session, 0.0, vec![GIVEN.to_owned()]);
    let end = ended.as_ref().map_or(Input::End, Input::Failed);
    Ok(replay.fed(samples::given(rows, period_s.0), end))
}

/// Refuses displacements that the forces on the way contradict, and states where they cannot.
fn check_way(of: &Question, mut replay: Replay) -> Result<Replay, ReplayError> {
    let found = replay.session.conclusion().filter(|it| it.verdict.is_ok()).and_then(|it| it.found);
    let (Some(rows), Some(found)) = (samples::rows(of.body), found) else { return Ok(replay) };
    let drives = replay.drives(&rows, found.start.angle);
    let legs: Vec<Leg> = drives.iter().map(|driven| driven.leg).collect();
    if let Some(leg) = legs.iter().position(|leg| !leg.is_as_stated()) {
        let (Leg { stated_m, driven_m, .. }, slip) = (legs[leg], Slip::of(&legs));
        return Err(ReplayError::Way { stop: leg + 1, stated_m, driven_m, slip });
    }
    if legs.iter().any(Leg::tells_nothing) {
        replay.assumed.push(assumptions::WAY_OF_A_VEHICLE.to_owned());
    }
    Ok(replay)
}

/// Displacements whose greatest part is below this may be kilometres, m.
const KILOMETRES: f64 = 100.0;
/// Metres of a kilometre.
const KILOMETRE: f64 = 1e3;

/// Refuses displacements with which there is no azimuth, but with a thousand times as much.
fn check_kilometres(of: &Question, replay: &Replay) -> Result<(), ReplayError> {
    let stated = of.displacements_m();
    let greatest =
        stated.iter().flat_map(|list| list.as_flattened()).fold(0.0, |a: f64, b| a.max(b.abs()));
    let (Some(list), false) = (stated, is_answered(&replay.session)) else { return Ok(()) };
    if greatest <= 0.0 || greatest >= KILOMETRES {
        return Ok(());
    }
    let displacements_m =
        Some(list.iter().map(|place| place.map(|part| KILOMETRE * part)).collect());
    let asked = &Asked { displacements_m, ..of.asked.clone() };
    let farther = run(&Question { asked, ..*of })?;
    if is_answered(&farther.session) { Err(ReplayError::Kilometres { greatest }) } else { Ok(()) }
}

/// Drives the session with the rows.
fn follow(of: &Question, rows: &[ImuRow]) -> Result<Replay, ReplayError> {
    let header = of.header;
    of.latitude()?;
    let period_s = period_s(header.rate_hz, rows, |row| row.time_s);
    check_rate(header.rate_hz, rows)?;
    check_stuck(rows, period_s)?;
    check_unit(header, rows, period_s)?;
    let zero_s = samples::begin(rows, period_s);
    let method = of.asked.method.unwrap_or_else(|| usual(header, rows, period_s));
    let rests = rests(header, method, zero_s)?;
    let displacements = displacements(of)?;
    let mut substituted = Vec::new();
    let header = &grade::filled(header, &mut substituted);
    let mut assumed = Vec::new();
    let mut site = Question { header, ..*of }.site(&mut assumed)?;
    assumed.append(&mut substituted);
    assumed.push(assumptions::AXES_OF_A_VEHICLE.to_owned());
    // Within what is accepted, the difference of a stated rate from the times is a scale error of every rotation.
    let rate_error = header.rate_hz.map_or(0.0, |rate| rate * period_s - 1.0);
    site.scale_sigma = site.scale_sigma.hypot(rate_error);
    let setting = setting(header, site, rows, period_s, method, &mut assumed)?;
    let procedure = Procedure { displacements, ..Procedure::recorded(rests, Seconds(period_s)) };
    let replay = Replay::of(method, Session::new(setting, procedure)?, zero_s, assumed);
    let replay = replay.fed(samples::samples(rows, period_s), Input::End);
    check_displacements(&replay.session)?;
    Ok(replay)
}

/// N below which rates have no noise but rounding, rad/√s: 10⁻⁶ °/√h.
const NO_WALK: f64 = 1e-3 * LEAST_WALK;

/// Refuses a recording in which a sensor stands still while the others have noise: a part of the rotation is
/// lost, and nothing else shows it.
pub(crate) fn check_stuck(rows: &[ImuRow], period_s: f64) -> Result<(), ReplayError> {
    let dead = samples::dead_accelerometer(rows, |row| row.sample.force_m_s2);
    let dead = dead.map(|axis| (["ax_m_s2", "ay_m_s2"][axis], &rows[0], rows.len()));
    let white = noise::at_rest(rows, None, period_s).unwrap_or_default();
    let has_noise = white.angle_random_walk > NO_WALK && white.force > 0.0;
    let stuck = || has_noise.then(|| samples::stuck(rows)).flatten();
    let Some((column, row, count)) = dead.or_else(stuck) else { return Ok(()) };
    Err(ReplayError::Stuck { column, line: row.line, seconds: count as f64 * period_s })
}

/// Why a recording has no rows for these methods.
pub(crate) fn missing(body: &Body) -> ReplayError {
    match body.kind() {
        Kind::Static => ReplayError::OneGyro,
        kind => ReplayError::NoVehicle(kind),
    }
}

/// Turn about its vertical by which a vehicle that drives differs from one that sways, rad: 5°.
const DROVE: f64 = 5.0 / 360.0 * std::f64::consts::TAU;
/// Time whose median turn a sway or a slammed door does not move, s.
const MEDIAN_S: f64 = 30.0;

/// The method of a recording for which none was asked: where no stop is stated and it never turned about
/// its vertical, it stood.
fn usual(header: &Header, rows: &[ImuRow], period_s: f64) -> &'static str {
    if header.stops_s.is_some() || header.session.is_some() {
        return SIAP;
    }
    let turned = rows.iter().scan(0.0, |turned, row| {
        *turned += row.sample.rates_rad_s[2] * period_s;
        Some(*turned)
    });
    let turned: Vec<f64> = turned.collect();
    let size = ((MEDIAN_S / period_s) as usize).max(1);
    let headings = turned.chunks(size).map(|headings| median(headings.iter().copied()));
    let [least, most] = extremes(headings);
    if most - least > DROVE { SIAP } else { STATIC }
}

/// The stops as the session counts them.
fn rests(header: &Header, method: &str, zero_s: f64) -> Result<Rests, ReplayError> {
    match &header.stops_s {
        _ if method == STATIC => Ok(Rests::Whole),
        None => Ok(Rests::Found),
        Some(stated) => {
            let counted = stated.iter().map(|stop| stop.map(|time| Seconds(time - zero_s)));
            let all = Few::<_, STOPS>::from_slice(&counted.collect::<Vec<_>>());
            all.map(Rests::Stated).map_err(|_| ReplayError::TooManyStops(stated.len(), STOPS))
        }
    }
}

/// The user's displacements, or the header's; one for each stop where stops are stated.
fn displacements(of: &Question) -> Result<Few<[Metres; 2], STOPS>, ReplayError> {
    let list = of.displacements_m().unwrap_or_default();
    let wrong = |stops| ReplayError::Displacements { stated: list.len(), stops };
    match &of.header.stops_s {
        Some(stops) if !list.is_empty() && stops.len() != list.len() => Err(wrong(stops.len())),
        _ if list.len() > STOPS => Err(wrong(STOPS)),
        _ => Ok(list.iter().map(|place| place.map(Metres)).collect()),
    }
}

/// Refuses displacements that are not one for each stop that was found.
fn check_displacements(session: &Session) -> Result<(), ReplayError> {
    let procedure = &session.procedure;
    let (stated, stops) = (procedure.displacements.len(), session.stops().len());
    if stated == 0 || stated == stops || procedure.rests != Rests::Found {
        Ok(())
    } else {
        Err(ReplayError::Displacements { stated, stops })
    }
}

/// Refuses a stated rate that the times contradict: one of both is wrong, and every rotation with it.
fn check_rate(rate_hz: Option<f64>, rows: &[ImuRow]) -> Result<(), ReplayError> {
    let steps = Steps::of(rows, |row| row.time_s);
    let (Some(stated_hz), Some(steps)) = (rate_hz, steps) else { return Ok(()) };
    let contradiction = |found_hz| Err(ReplayError::Rate { stated_hz, found_hz });
    steps.contradicted(stated_hz).map_or(Ok(()), contradiction)
}

/// Part by which the rate at rest may miss the Earth's in a unit that is wrong: biases.
const UNIT_TOLERANCE: f64 = 0.15;

/// Refuses gyros that show the Earth rate in °/s.
fn check_unit(header: &Header, rows: &[ImuRow], period_s: f64) -> Result<(), ReplayError> {
    let rates = noise::rest_rates(rows, header.stops_s.as_deref(), period_s);
    let times = rates.map(|rate| rate / EARTH_RATE);
    let is_off = |times: &f64| (times / DEGREES_PER_RADIAN - 1.0).abs() <= UNIT_TOLERANCE;
    if times.iter().all(is_off) {
        return Err(ReplayError::DegreesPerSecond { times: times[0] });
    }
    Ok(())
}

/// How much more noise than was stated a recording must show, in 1σ of what it shows and in all, to be believed.
const MORE_SIGMAS: f64 = 3.0;
const MORE: f64 = 1.1;

/// Least N that is believed of a recording, rad/√s: 0.001 °/√h, a laser gyro's; who has a better one states it.
const LEAST_WALK: f64 = 1e-3 * DEGREE_PER_SQRT_HOUR;

/// What is known of the vehicle's sensors; noise that is not stated is estimated, and noise that was stated too
/// small is taken as the recording shows it.
fn setting(
    header: &Header,
    mut site: Site,
    rows: &[ImuRow],
    period_s: f64,
    method: &str,
    assumed: &mut Vec<String>,
) -> Result<Setting, ReplayError> {
    let stood = header.stops_s.as_deref().filter(|_| method == SIAP);
    let whole = [[f64::NEG_INFINITY, f64::INFINITY]];
    let stood = if method == STATIC { Some(&whole[..]) } else { stood };
    let white = noise::at_rest(rows, stood, period_s);
    site.noise.model_mut().angle_random_walk =
        RadiansPerRootSecond(walk(&site, white.as_ref(), assumed)?);
    let force_noise = white.unwrap_or_default().force;
    let shown = significant(force_noise, 3);
    assumed.push(format!("accelerometer noise {shown} m/s²/√Hz as the recording shows it"));
    let kappa = grade::g_sensitivity(header);
    let bias = header.gyro_bias_deg_h.map(|bias| (bias * DEGREE_PER_HOUR).hypot(kappa));
    let bias_sigma = bias.map(RadiansPerSecond);
    if bias_sigma.is_none() {
        assumed.push("gyro biases unknown".to_owned());
    }
    Ok(Setting { bias_sigma, force_noise: ForceNoise(force_noise), ..Setting::new(site) })
}

/// The gyros' N, rad/√s: as stated, or as the recording shows it.
fn walk(site: &Site, white: Option<&White>, assumed: &mut Vec<String>) -> Result<f64, ReplayError> {
    let stated = site.noise.model().angle_random_walk;
    let Some(White { angle_random_walk: shown, relative_sigma, .. }) = white.copied() else {
        return if site.noise.is_white_known() {
            Ok(stated.0)
        } else {
            Err(ReplayError::NoiseUnknown)
        };
    };
    let walk = significant(shown / DEGREE_PER_SQRT_HOUR, 3);
    if !site.noise.is_white_known() {
        assumed.push(format!("gyro noise N {walk} °/√h as the recording shows it"));
        return Ok((shown * (1.0 + relative_sigma)).max(LEAST_WALK));
    }
    if shown * (1.0 - MORE_SIGMAS * relative_sigma) <= MORE * stated.0 {
        return Ok(stated.0);
    }
    let stated = significant(stated.0 / DEGREE_PER_SQRT_HOUR, 3);
    assumed.push(format!(
        "gyro noise N {walk} °/√h as the recording shows it, which is more than the stated {stated}"
    ));
    Ok(shown)
}
