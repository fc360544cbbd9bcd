//! `meridian replay`: the alignment on a recording.

use std::path::{Path, PathBuf};

use bench::output::progress::Progress;
use bench::output::{
    json, page, rotating as of_rotating, spin as of_spin, stops as of_stops, text,
    vertical as vertical_told,
};
use bench::recording::{self, Body, Kind, Recording};
use bench::replay::{self, Options, replay};
use bench::vertical::errors::Errors;
use bench::{rotating, spin, stops, vertical as of_vertical};
use clap::{Args, ValueEnum};
use orientation::align::criterion::Criterion;
use orientation::earth::Latitude;

use super::{Half, Told, latitude, sigma};

/// Which recording, and how it is taken.
#[derive(Args)]
pub struct ReplayOptions {
    /// The recording, CSV, also gzip-compressed.
    file: PathBuf,
    /// Method; the default follows from the kind.
    #[arg(long, value_enum)]
    method: Option<Method>,
    /// Latitude in degrees, north positive, instead of the recording's.
    #[arg(long, value_name = "DEGREES", value_parser = latitude, allow_negative_numbers = true)]
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
    #[arg(long, value_name = "N,E;N,E", value_parser = displacements, allow_hyphen_values = true)]
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
    /// Of a recording for which none was asked; a vehicle's shows which of both it needs.
    fn of(body: &Body) -> Self {
        match body.kind() {
            Kind::Rotating => Self::Rotating,
            Kind::Spin => Self::Spin,
            _ if stops::samples::rows(body).is_some() => Self::Siap,
            _ => Self::Stepwise,
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
    pub fn check(&self) -> Result<(), &'static str> {
        self.method.map_or(Ok(()), |method| self.check_method(method))
    }

    /// What would be written over what is read, or over what was just written.
    fn check_files(&self) -> Result<(), String> {
        let [attitude, report] =
            [&self.attitude_out, &self.report].map(|path| path.as_deref().map(place));
        let recording = place(&self.file);
        for (option, path) in [("--attitude-out", &attitude), ("--report", &report)] {
            if path.as_ref() == Some(&recording) {
                return Err(format!("{option}: {} is the recording itself", recording.display()));
            }
        }
        match attitude.filter(|path| report.as_ref() == Some(path)) {
            Some(path) => Err(format!("--report: {} takes the attitude already", path.display())),
            None => Ok(()),
        }
    }

    /// What a method does not take.
    fn check_method(&self, method: Method) -> Result<(), &'static str> {
        let has_criterion = self.criterion != Criterion::MaximumLikelihood;
        let is_displaced = self.displacements.is_some();
        let has_attitude = self.attitude_out.is_some();
        match method {
            _ if has_attitude && !matches!(method, Method::Vertical) => {
                Err("--attitude-out: only method vertical keeps an attitude")
            }
            Method::Rotating if has_criterion => {
                Err("--criterion: a platform that turns all the time has the one criterion")
            }
            Method::Rotating if self.half.is_some() => {
                Err("--half: a platform that turns all the time shows both halves")
            }
            Method::Siap | Method::Static if has_criterion => {
                Err("--criterion: a vehicle's stops have the one criterion")
            }
            Method::Siap | Method::Static if self.half.is_some() => {
                Err("--half: a vehicle's gyros show both halves")
            }
            Method::Vertical if has_criterion || self.half.is_some() => {
                Err("--criterion, --half: method vertical finds no azimuth")
            }
            Method::Spin if has_criterion => Err("--criterion: a spinning body's roll has none"),
            Method::Spin if self.half.is_some() => Err("--half: a spinning body has no azimuth"),
            Method::Spin if self.latitude.is_some() => {
                Err("--latitude: a spinning body's roll does not depend on it")
            }
            Method::Siap => Ok(()),
            _ if is_displaced => Err("--displacements: only the stops of method siap have them"),
            _ => Ok(()),
        }
    }
}

/// Where a file is, whatever it is called; its name where it is not there yet.
fn place(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// Replays a recording.
pub fn run(options: &ReplayOptions, as_json: bool) -> Result<Told, String> {
    options.check_files()?;
    let recording = recording::read(&options.file).map_err(|error| error.to_string())?;
    let name = options.file.display().to_string();
    let method = options.method.unwrap_or_else(|| Method::of(&recording.body));
    options.check_method(method)?;
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
    let refusal = conclusion.verdict.as_ref().err().map(|reason| format!("{name}: {reason}"));
    let page = || page::stops::report(name, &replay, conclusion);
    Ok(Told { refusal, ..told }.with_page(options.report.as_deref(), page))
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
    if let Some(path) = &options.attitude_out {
        of_vertical::write_attitude(path, &replay.moments)
            .map_err(|error| format!("{}: cannot be written: {error}", path.display()))?;
    }
    let refusal = replay.refusal.as_ref().map(|reason| format!("{name}: {reason}"));
    let page = || page::vertical::report(name, &replay, errors.as_ref(), &object);
    Ok(Told { refusal, ..told }.with_page(options.report.as_deref(), page))
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
    let refusal = conclusion.verdict.as_ref().err().map(|reason| format!("{name}: {reason}"));
    let page = || page::rotating::report(name, &replay, conclusion, body.rotating());
    Ok(Told { refusal, ..told }.with_page(options.report.as_deref(), page))
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
    let refusal = conclusion.verdict.as_ref().err().map(|reason| format!("{name}: {reason}"));
    let page = || page::alignment::report(name, &replay, conclusion);
    Ok(Told { refusal, ..told }.with_page(options.report.as_deref(), page))
}
