//! `meridian replay`: the alignment on a recording.

use std::path::PathBuf;

use bench::output::progress::Progress;
use bench::output::{
    json, page, rotating as of_rotating, spin as of_spin, stops as of_stops, text,
    vertical as vertical_told,
};
use bench::recording::{self, Kind, Recording};
use bench::replay::{self, Options, replay};
use bench::vertical::errors::Errors;
use bench::{cause, rotating, spin, stops, unwritten, vertical as of_vertical};
use clap::{Args, ValueEnum};
use orientation::align::criterion::Criterion;
use orientation::earth::Latitude;

use super::suits::{self, Given, method};
use super::{Failure, Half, Told, files, latitude, sigma};

/// Which recording, and how it is taken.
#[derive(Args)]
pub struct ReplayOptions {
    /// The recording, CSV, also gzip-compressed.
    file: PathBuf,
    /// Method; the default follows from the kind.
    #[arg(long, value_enum)]
    method: Option<Method>,
    /// Latitude in degrees, north positive, instead of the recording's.
    #[arg(long, value_name = "DEGREES", value_parser = latitude)]
    latitude: Option<Latitude>,
    /// How the azimuth is found: ml, table (ml over the etalon table), least-squares, least-absolute, within-squares=A1 in (°/h)²,
    /// within-absolute=A in °/h.
    #[arg(long, default_value = "ml", value_parser = bench::criterion::parse)]
    criterion: Criterion,
    /// The half of the circle in which the azimuth is known to lie: two positions need it.
    #[arg(long, value_enum)]
    half: Option<Half>,
    /// How far each stop of a vehicle lies from the first, north and east, in metres: `0,0;n,e;…`
    /// instead of the recording's.
    #[arg(long, value_name = "N,E;N,E", value_parser = displacements)]
    displacements: Option<Displacements>,
    /// Greatest standard deviation that is accepted, in degrees (1σ).
    #[arg(long, value_name = "DEGREES", default_value = "10", value_parser = sigma)]
    require_sigma: f64,
    /// Writes the attitude after each sample, body to north, east, down up to a constant heading:
    /// `t_s,qw,qx,qy,qz,sigma_tilt_rad`, the last 1σ of either tilt.
    #[arg(long, value_name = "FILE.csv")]
    attitude_out: Option<PathBuf>,
    /// Writes figures and tables as a page for a browser.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Method {
    /// Stepwise gyrocompassing.
    Stepwise,
    /// Autocompensated positions, in passes.
    Positions,
    /// A platform that turns all the time.
    Rotating,
    /// A vehicle: the azimuth from two stops and more.
    Siap,
    /// A vehicle at rest all the time, sway allowed.
    Static,
    /// Pitch and roll, and the turn about the vertical, kept from the beginning to the end.
    Vertical,
    /// The roll of a body in fast rotation, from the extrema of its accelerometers and by phase lock.
    Spin,
}

impl Method {
    /// As it is asked for.
    fn named(self) -> suits::Named {
        match self {
            Self::Stepwise => method::STEPWISE,
            Self::Positions => method::POSITIONS,
            Self::Rotating => method::ROTATING,
            Self::Siap => method::SIAP,
            Self::Static => method::STATIC,
            Self::Vertical => method::VERTICAL,
            Self::Spin => method::SPIN,
        }
    }

    /// Of a recording for which none was asked; a vehicle's shows which of both it needs.
    fn of(Recording { header, body, .. }: &Recording) -> Self {
        match body.kind() {
            Kind::Rotating => Self::Rotating,
            Kind::Spin => Self::Spin,
            _ => match stops::Method::of(header, body) {
                Some(stops::Method::Siap) => Self::Siap,
                Some(stops::Method::Static) => Self::Static,
                None => Self::Stepwise,
            },
        }
    }
}

/// One displacement for each stop, north and east, m; a list to the parser of the command line.
#[derive(Clone, Debug)]
struct Displacements(Vec<[f64; 2]>);

fn displacements(text: &str) -> Result<Displacements, String> {
    recording::displacements(text).map(Displacements).map_err(|problem| problem.to_string())
}

impl From<&ReplayOptions> for Options {
    fn from(options: &ReplayOptions) -> Self {
        let method = match options.method {
            Some(Method::Positions) => replay::Method::Positions,
            _ => replay::Method::Stepwise,
        };
        Self {
            method,
            half: options.half.map(Into::into),
            latitude: options.latitude,
            criterion: options.criterion,
            required_sigma: Some(options.require_sigma),
        }
    }
}

impl From<&ReplayOptions> for stops::Options {
    fn from(options: &ReplayOptions) -> Self {
        let method = match options.method {
            Some(Method::Siap) => Some(stops::Method::Siap),
            Some(Method::Static) => Some(stops::Method::Static),
            _ => None,
        };
        let displacements_m = options.displacements.as_ref().map(|list| list.0.clone());
        let required_sigma = Some(options.require_sigma);
        Self { method, latitude: options.latitude, displacements_m, required_sigma }
    }
}

impl From<&ReplayOptions> for of_vertical::Options {
    fn from(options: &ReplayOptions) -> Self {
        Self { latitude: options.latitude, required_sigma: Some(options.require_sigma) }
    }
}

impl ReplayOptions {
    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    pub fn check(&self, given: &Given) -> Result<(), String> {
        if let Some(method) = self.method {
            suits::check(suits::REPLAY, given, &method.named())?;
        }
        let attitude = files::written("--attitude-out", "the attitude", self.attitude_out.as_ref());
        let report = files::written("--report", "the page", self.report.as_ref());
        files::check(Some(&self.file), &[attitude, report])
    }
}

/// Replays a recording.
pub fn run(options: &ReplayOptions, given: &Given, as_json: bool) -> Result<Told, Failure> {
    let recording = recording::read(&options.file).map_err(|error| error.told())?;
    let method = options.method.unwrap_or_else(|| Method::of(&recording));
    // Without a method stated, that the options do not suit shows only now.
    suits::check(suits::REPLAY, given, &method.named()).map_err(Failure::misuse)?;
    let warnings = recording.told_warnings(&options.file);
    replay_read(options, method, recording, as_json)
        .map_err(|reason| Failure { warnings: warnings.clone(), ..reason.into() })
        .map(|told| told.with_warnings(warnings))
}

/// Replays what was read.
fn replay_read(
    options: &ReplayOptions,
    method: Method,
    recording: Recording,
    as_json: bool,
) -> Result<Told, String> {
    let name = options.file.display().to_string();
    let of = match method {
        Method::Rotating => turning,
        Method::Siap | Method::Static => vehicle,
        Method::Vertical => vertical,
        Method::Spin => spinning,
        Method::Stepwise | Method::Positions => stopping,
    };
    of(&name, recording, options, as_json)
}

/// Replays the recording of a vehicle.
fn vehicle(
    name: &str,
    recording: Recording,
    options: &ReplayOptions,
    as_json: bool,
) -> Result<Told, String> {
    let (header, body, truth) = recording.into_parts();
    let replay = stops::replay(&header, &body, &options.into())
        .map_err(|error| format!("{name}: {error}"))?;
    let conclusion = replay.conclusion().ok_or("the session did not end")?;
    let object = of_stops::json::object(&replay, conclusion, &truth);
    let told = Told::of(conclusion.verdict.is_ok(), as_json, &object, |block| {
        of_stops::text::block(block, name, &replay, conclusion, &truth)
    })?;
    let refused = conclusion.verdict.as_ref().err();
    let refusal = refused.map(|reason| format!("{name}: {reason}"));
    let cause = refused.and_then(|why| cause::of_vehicle(&header, &body, &options.into(), why));
    let page = || page::stops::report(name, &replay, conclusion);
    Ok(Told { refusal, ..told }.because(cause).with_page(options.report.as_deref(), page))
}

/// Replays the recording of a spinning body.
fn spinning(
    name: &str,
    recording: Recording,
    options: &ReplayOptions,
    as_json: bool,
) -> Result<Told, String> {
    let (header, body, truth) = recording.into_parts();
    let wanted = spin::Options { required_sigma: Some(options.require_sigma) };
    let replay =
        spin::replay(&header, &body, &wanted).map_err(|error| format!("{name}: {error}"))?;
    let object = of_spin::json::object(&replay, &truth);
    let told = Told::of(object.reason.is_none(), as_json, &object, |block| {
        of_spin::text::block(block, name, &replay, &truth)
    })?;
    let refusal = object.reason.as_ref().map(|reason| format!("{name}: {reason}"));
    let page = || page::spin::report(name, &replay, &truth);
    Ok(Told { refusal, ..told }.with_page(options.report.as_deref(), page))
}

/// Replays a recording through the gyrovertical.
fn vertical(
    name: &str,
    recording: Recording,
    options: &ReplayOptions,
    as_json: bool,
) -> Result<Told, String> {
    let (header, body, truth) = recording.into_parts();
    let replay = of_vertical::replay(&header, &body, &options.into())
        .map_err(|error| format!("{name}: {error}"))?;
    let errors = Errors::of(&replay.moments, &truth.attitude);
    let object = vertical_told::json::object(&replay, errors.as_ref());
    let told = Told::of(replay.refusal.is_none(), as_json, &object, |block| {
        vertical_told::text::block(block, name, &object)
    })?;
    let written = options.attitude_out.as_ref().map_or(Ok(()), |path| {
        of_vertical::write_attitude(path, &replay.moments)
            .map_err(|error| unwritten::told("the attitude", path, &error))
    });
    let refusal = replay.refusal.as_ref().map(|reason| format!("{name}: {reason}"));
    let page = || page::vertical::report(name, &replay, errors.as_ref(), &object);
    let cause = refusal.as_ref().and_then(|_| cause::of_level(&body));
    let told = Told { refusal, ..told }.because(cause).with_written(written);
    Ok(told.with_page(options.report.as_deref(), page))
}

/// Replays the recording of a platform that turns all the time.
fn turning(
    name: &str,
    recording: Recording,
    options: &ReplayOptions,
    as_json: bool,
) -> Result<Told, String> {
    let (header, body, truth) = recording.into_parts();
    let replay = rotating::replay(&header, &body, &options.into())
        .map_err(|error| format!("{name}: {error}"))?;
    let conclusion = replay.conclusion().ok_or("the session did not end")?;
    let object = of_rotating::json::object(&replay, conclusion, truth.azimuth_deg);
    let told = Told::of(conclusion.verdict.is_ok(), as_json, &object, |block| {
        of_rotating::text::block(block, name, &replay, conclusion, truth.azimuth_deg)
    })?;
    let refused = conclusion.verdict.as_ref().err();
    let refusal = refused.map(|reason| format!("{name}: {reason}"));
    let cause = refused.and_then(|why| cause::of_turning(&header, &body, &options.into(), why));
    let page = || page::rotating::report(name, &replay, conclusion, body.rotating());
    Ok(Told { refusal, ..told }.because(cause).with_page(options.report.as_deref(), page))
}

/// Replays a recording whose stage stops.
fn stopping(
    name: &str,
    recording: Recording,
    options: &ReplayOptions,
    as_json: bool,
) -> Result<Told, String> {
    let (header, body, truth) = recording.into_parts();
    let progress = Progress::new(0, "positions");
    let replay = replay(&header, &body, &options.into(), |session| progress.session(session))
        .map_err(|error| format!("{name}: {error}"))?;
    progress.finish();
    let conclusion = replay.session.conclusion().ok_or("the session did not end")?;
    let object = json::azimuth(&replay, conclusion, truth.azimuth_deg);
    let told = Told::of(conclusion.verdict.is_ok(), as_json, &object, |block| {
        text::block(block, name, &replay, conclusion, truth.azimuth_deg)
    })?;
    let refused = conclusion.verdict.as_ref().err();
    let refusal = refused.map(|reason| format!("{name}: {reason}"));
    let session = &replay.session;
    let cause =
        refused.and_then(|why| cause::of_stopping(&header, &body, &options.into(), session, why));
    let page = || page::alignment::report(name, &replay, conclusion);
    Ok(Told { refusal, ..told }.because(cause).with_page(options.report.as_deref(), page))
}
