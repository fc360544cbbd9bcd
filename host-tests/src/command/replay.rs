//! `meridian replay`: the alignment on a recording.

use std::path::PathBuf;

use bench::output::progress::Progress;
use bench::output::{json, page, rotating as of_rotating, text};
use bench::recording::{self, Kind, Recording};
use bench::replay::{self, Options, replay};
use bench::rotating;
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
    /// Greatest standard deviation that is accepted, in degrees (1σ).
    #[arg(long, value_name = "DEGREES", default_value = "10", value_parser = sigma)]
    require_sigma: f64,
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
}

impl From<&ReplayOptions> for Options {
    fn from(options: &ReplayOptions) -> Self {
        let method = match options.method {
            Some(Method::Positions) => replay::Method::Positions,
            Some(Method::Stepwise | Method::Rotating) | None => replay::Method::Stepwise,
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

impl ReplayOptions {
    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    pub fn check(&self) -> Result<(), &'static str> {
        let is_rotating = matches!(self.method, Some(Method::Rotating));
        if is_rotating { self.check_rotating() } else { Ok(()) }
    }

    /// The same for a platform that turns all the time.
    fn check_rotating(&self) -> Result<(), &'static str> {
        if self.criterion != Criterion::MaximumLikelihood {
            return Err("--criterion: a platform that turns all the time has the one criterion");
        }
        match self.half {
            Some(_) => Err("--half: a platform that turns all the time shows both halves"),
            None => Ok(()),
        }
    }
}

/// Replays a recording.
pub fn run(options: &ReplayOptions, as_json: bool) -> Result<Told, String> {
    let recording = recording::read(&options.file).map_err(|error| error.to_string())?;
    let name = options.file.display().to_string();
    let is_rotating = match options.method {
        Some(method) => matches!(method, Method::Rotating),
        None => recording.body.kind() == Kind::Rotating,
    };
    let of = if is_rotating { turning } else { stopping };
    of(&name, recording, options, as_json)
}

/// Replays the recording of a platform that turns all the time.
fn turning(
    name: &str,
    recording: Recording,
    options: &ReplayOptions,
    as_json: bool,
) -> Result<Told, String> {
    options.check_rotating()?;
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
