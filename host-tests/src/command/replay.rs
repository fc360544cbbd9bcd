//! `meridian replay`: the alignment on a recording, or a whole run by its inputs.

use std::path::PathBuf;

use clap::Args;
use host::instrument::replay::{Done, Replayed, replay as replay_inputs};
use host::methods::asked::{Asked, Question};
use host::methods::vertical::write_attitude;
use host::methods::{self, METHODS, Method};
use host::outcome::run::RunDetails;
use host::outcome::{Outcome, Source};
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::recording::{self, Recording, inputs};
use host::unwritten;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::setting::Half;
use orientation::earth::Latitude;

use super::stated::{Stated, long};
use super::{Answer, Failure, HALVES, Shown, explained, files, latitude, named, registered, sigma};

/// Which recording, and how it is taken.
#[derive(Args)]
pub struct ReplayOptions {
    /// The recording: CSV, or inputs of a run as JSON lines (FILE.jsonl, which also tells what was kept); also
    /// gzip-compressed.
    file: PathBuf,
    /// Method; the default follows from the kind.
    #[arg(long, value_parser = registered(&METHODS, |of| [of.name, of.meaning]))]
    method: Option<&'static Method>,
    /// Latitude in degrees, north positive, instead of the recording's.
    #[arg(long, value_name = "DEGREES", value_parser = latitude)]
    latitude: Option<Latitude>,
    /// How the azimuth is found: ml, table (ml over the etalon table), least-squares, least-absolute, within-squares=A1 in (°/h)²,
    /// within-absolute=A in °/h (ml, or as the run had it).
    #[arg(long, value_parser = host::criterion::parse)]
    criterion: Option<Criterion>,
    /// The half of the circle in which the azimuth is known to lie: two positions need it.
    #[arg(long, value_parser = named(&HALVES))]
    half: Option<Half>,
    /// How far each stop of a vehicle lies from the first, north and east, in metres: `0,0;n,e;…`
    /// instead of the recording's.
    #[arg(long, value_name = "N,E;N,E", value_parser = displacements)]
    displacements: Option<Displacements>,
    /// Greatest standard deviation that is accepted, in degrees (1σ) (10, or what the run asked for).
    #[arg(long, value_name = "DEGREES", value_parser = sigma)]
    require_sigma: Option<f64>,
    /// Writes the attitude after each sample, body to north, east, down up to a constant heading:
    /// `t_s,qw,qx,qy,qz,sigma_tilt_rad`, the last 1σ of either tilt.
    #[arg(long, value_name = "FILE.csv")]
    attitude_out: Option<PathBuf>,
    /// Writes figures and tables as a page for a browser.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// One displacement for each stop, north and east, m; a list to the parser of the command line.
#[derive(Clone, Debug)]
struct Displacements(Vec<[f64; 2]>);

fn displacements(text: &str) -> Result<Displacements, String> {
    recording::displacements(text).map(Displacements).map_err(|problem| problem.to_string())
}

impl ReplayOptions {
    /// What the user asks.
    fn asked(&self) -> Asked {
        Asked {
            method: self.method.map(|method| method.name),
            latitude: self.latitude,
            criterion: self.criterion,
            half: self.half,
            displacements_m: self.displacements.as_ref().map(|list| list.0.clone()),
            required_sigma: self.require_sigma,
        }
    }

    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    fn check(&self, stated: &Stated) -> Result<(), String> {
        if let Some(option) = stated.beside(&ALWAYS).filter(|_| inputs::is_named(&self.file)) {
            let option = long(option);
            return Err(format!(
                "{option}: inputs of a run replay as its board took them; leave it out"
            ));
        }
        self.method.map_or(Ok(()), |method| check(stated, method))?;
        let attitude = ("--attitude-out", "the attitude", self.attitude_out.clone());
        let report = ("--report", "the page", self.report.clone());
        files::check(Some(&self.file), &[attitude, report])
    }
}

/// The options that not every method takes, and why others do not.
const SPECIAL: [(&str, &str); 5] = [
    ("latitude", "the roll of a spinning body does not depend on it"),
    ("criterion", "only a stage that stops has another criterion than the one"),
    ("half", "only two positions of a stage leave the half of the circle open"),
    ("displacements", "only the stops of method siap have them"),
    ("attitude_out", "only method vertical keeps an attitude"),
];

/// What may be asked for with inputs of a run, too: they hold everything else.
const ALWAYS: [&str; 2] = ["file", "report"];

/// Refuses the first option that a method does not take.
///
/// # Errors
/// The option, the method, and why.
fn check(stated: &Stated, method: &Method) -> Result<(), String> {
    let is_ignored =
        |(option, _): &&(&str, &str)| stated.has(option) && !method.takes.contains(option);
    SPECIAL.iter().find(is_ignored).map_or(Ok(()), |(option, why)| {
        Err(format!("{}: --method {} does not take it: {why}", long(option), method.name))
    })
}

/// Replays a recording.
pub fn run(options: &ReplayOptions, stated: &Stated, manner: Manner) -> Result<Answer, Failure> {
    options.check(stated).map_err(Failure::misuse)?;
    if inputs::is_named(&options.file) {
        return Ok(again(options, manner)?);
    }
    let recording = recording::read(&options.file).map_err(|error| error.message())?;
    let method = options.method.unwrap_or_else(|| methods::usual(&recording));
    // Without a method stated, that the options do not suit shows only now.
    check(stated, method).map_err(Failure::misuse)?;
    let warnings = recording.warning_lines(&options.file);
    replay(options, method, recording, manner)
        .map_err(|reason| Failure { warnings: warnings.clone(), ..reason.into() })
        .map(|answer| answer.with_warnings(warnings))
}

/// Replays a whole run by its inputs.
fn again(options: &ReplayOptions, manner: Manner) -> Result<Answer, String> {
    let replayed = replay_inputs(&options.file);
    let Replayed { finished, body, done: Done { kept, realignments, truth, warning } } =
        replayed.map_err(|error| error.to_string())?;
    let name = options.file.display().to_string();
    let details = RunDetails::of_kept(&kept, realignments);
    let outcome = finished.outcome(&truth).of_run(Source::File(name.clone()), details);
    let shown = Shown { name: &name, finished, truth, body };
    let answer = shown.answer(&outcome, options.report.as_deref(), manner)?;
    let refusal = answer.refusal.as_ref().map(|reason| format!("{name}: {reason}"));
    Ok(Answer { refusal, ..answer }.with_warnings(Vec::from_iter(warning)))
}

/// Replays what was read.
fn replay(
    options: &ReplayOptions,
    method: &Method,
    recording: Recording,
    manner: Manner,
) -> Result<Answer, String> {
    let name = options.file.display().to_string();
    let (header, body, truth) = recording.into_parts();
    let (asked, progress) = (options.asked(), Progress::new(manner, 0, "positions"));
    let finished = (method.replay)(&header, &body, &asked, &|session| progress.session(session))
        .map_err(|error| format!("{name}: {error}"))?;
    progress.finish();
    let outcome = finished.outcome(&truth);
    // A run gives its own reason.
    let is_caused = outcome.reason.is_some() && header.session.is_none();
    let cause = is_caused
        .then(|| finished.cause(&Question { header: &header, body: &body, asked: &asked }))
        .flatten();
    let reason = outcome.reason.map(|reason| match cause {
        Some(cause) => explained(&reason, outcome.remedy, &cause),
        None => reason,
    });
    let outcome = Outcome { source: Some(Source::File(name.clone())), reason, ..outcome };
    let shown = Shown { name: &name, finished, truth, body: Some(body) };
    let answer = shown.answer(&outcome, options.report.as_deref(), manner)?;
    let refusal = answer.refusal.as_ref().map(|reason| format!("{name}: {reason}"));
    let attitude = options.attitude_out.as_ref().zip(shown.finished.attitude());
    let written = attitude.map_or(Ok(()), |(path, moments)| {
        write_attitude(path, moments)
            .map_err(|error| unwritten::message("the attitude", path, &error))
    });
    Ok(Answer { refusal, ..answer }.with_written(written))
}
