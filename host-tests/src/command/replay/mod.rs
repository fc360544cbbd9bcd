//! `meridian replay`: the alignment on recordings, or whole runs by their inputs.

mod many;
mod one;

use std::path::PathBuf;

use clap::Args;
use host::interrupt;
use host::methods::{METHODS, Method};
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::recording;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::setting::Half;
use orientation::earth::Latitude;

use self::many::Folders;
use self::one::One;
use super::files::{self, Written};
use super::source::Source;
use super::stated::{Stated, long};
use super::{Answer, Failure, HALVES, OUTPUT, latitude, named, registered, sigma};

/// Which recordings, and how they are taken.
#[derive(Args)]
pub struct ReplayOptions {
    /// The recordings: CSV, or inputs of a run as JSON lines (FILE.jsonl, which also tells what was kept); also
    /// gzip-compressed. Of a folder all that are in it, but not in folders of it; `-` is standard input. Several are
    /// replayed side by side, and give a table.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Method; the default follows from the kind.
    #[arg(long, value_parser = registered(&METHODS, |of| [of.name, of.meaning]))]
    method: Option<&'static Method>,
    /// Latitude instead of the recording's, north positive: 47.58, 47°35′, 47:34:48, or 47°35′N.
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
    /// `t_s,qw,qx,qy,qz,sigma_tilt_rad`, the last 1σ of either tilt; of several recordings into a folder.
    #[arg(long, value_name = "FILE.csv", help_heading = OUTPUT)]
    attitude_out: Option<PathBuf>,
    /// Writes figures and tables as a page for a browser; of several recordings into a folder.
    #[arg(long, value_name = "FILE.html", help_heading = OUTPUT)]
    report: Option<PathBuf>,
}

/// One displacement for each stop, north and east, m; a list to the parser of the command line.
#[derive(Clone, Debug)]
struct Displacements(Vec<[f64; 2]>);

fn displacements(text: &str) -> Result<Displacements, String> {
    recording::displacements(text).map(Displacements).map_err(|problem| problem.to_string())
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
const ALWAYS: [&str; 2] = ["files", "report"];

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

/// Refuses options beside the inputs of a run, which hold everything else.
///
/// # Errors
/// The option, and why.
fn beside_inputs(stated: &Stated) -> Result<(), String> {
    stated.beside(&ALWAYS).map_or(Ok(()), |option| {
        let option = long(option);
        Err(format!("{option}: inputs of a run replay as its board took them; leave it out"))
    })
}

/// Replays recordings.
pub fn run(options: &ReplayOptions, stated: &Stated, manner: Manner) -> Result<Answer, Failure> {
    options.method.map_or(Ok(()), |method| check(stated, method)).map_err(Failure::misuse)?;
    let sources = Source::all(&options.files).map_err(Failure::misuse)?;
    let one = One { options, stated, progress: None };
    if let ([source], [path]) = (&sources[..], &options.files[..])
        && !path.is_dir()
    {
        return run_one(&one, source, manner);
    }
    let written = [options.report.as_ref(), options.attitude_out.as_ref()];
    let folders = Folders::make(written, &sources)?;
    many::replay(&one, sources, &folders, manner)
}

/// Replays a single recording.
fn run_one(one: &One<'_>, source: &Source, manner: Manner) -> Result<Answer, Failure> {
    let options = one.options;
    if source.is_named_inputs() {
        beside_inputs(one.stated).map_err(Failure::misuse)?;
    }
    let written =
        [Written::attitude(options.attitude_out.as_ref()), Written::page(options.report.as_ref())];
    files::check(source.path(), &written).map_err(Failure::misuse)?;
    let page = files::opened("the report", options.report.as_ref())?;
    let attitude = files::opened("the attitude", options.attitude_out.as_ref())?;
    let progress = Progress::of_reading(manner);
    interrupt::end_input();
    let done = One { progress: Some(&progress), ..*one }.replay(source);
    progress.finish();
    let done =
        done.map_err(|failure| failure.without_page(options.report.as_ref(), &source.shown()))?;
    Ok(done.answer([page, attitude], manner)?)
}
