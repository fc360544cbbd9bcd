//! `meridian allan`: the noise of a gyro at rest.

use std::path::PathBuf;

use clap::Args;
use host::allan::analysis::Analysis;
use host::allan::rest::{Rest, RestError};
use host::output::allan::Shown;
use host::output::progress::Progress;
use host::planning::suggestion;
use host::recording::{self, Metered, RestRows};
use orientation::noise::fit::FitError;

use super::{Answer, Failure, LOOK, files};

/// Size of a file, MiB, from which it is told how far it is read.
const LARGE: u64 = 64;

/// The recording, and which of its columns is analysed.
#[derive(Args)]
pub struct AllanOptions {
    /// The recording of kind `static`, CSV, also gzip-compressed.
    file: PathBuf,
    /// The column with the rate; the default is `g_rad_s`, else `gx_rad_s`.
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
    /// Writes the curve, its fit and all numbers as a page for a browser.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
}

/// Analyses a recording.
pub fn run(options: &AllanOptions, as_json: bool) -> Result<Answer, Failure> {
    let report = ("--report", "the page", options.report.clone());
    files::check(Some(&options.file), &[report]).map_err(Failure::misuse)?;
    let name = options.file.display().to_string();
    let file = recording::open(&options.file).map_err(|error| error.message())?;
    let size = file.metadata().map_or(0, |about| about.len() >> 20);
    let progress = (size >= LARGE).then(|| Progress::new(size, "MiB read"));
    let told = |done| progress.iter().for_each(|progress| progress.steps((done, size)));
    let opened = RestRows::open(&name, Metered::new(file, told));
    let opened = opened.map_err(|error| error.message())?;
    let mut warnings = Vec::new();
    let rest = Rest::read(opened, options.column.as_deref(), &mut warnings);
    progress.iter().for_each(Progress::finish);
    let warnings = recording::warning_lines(&warnings, &options.file);
    let rest = match rest {
        Err(RestError::Read(error)) => return Err(error.message().into()),
        rest => rest.map_err(|error| format!("{name}: {error}")),
    };
    rest.and_then(|rest| analyse(options, &name, &rest, as_json))
        .map_err(|reason| Failure { warnings: warnings.clone(), ..reason.into() })
        .map(|answer| answer.with_warnings(warnings))
}

/// Analyses what was read.
fn analyse(
    options: &AllanOptions,
    name: &str,
    rest: &Rest,
    as_json: bool,
) -> Result<Answer, String> {
    let analysis = Analysis::of(rest);
    let found = analysis.as_ref().ok();
    let shown = Shown {
        name,
        rest,
        analysis: &analysis,
        schedule: found.and_then(|analysis| suggestion(analysis.fit.noise())),
    };
    let refusal = analysis.as_ref().err().map(|reason| refusal(name, rest, reason));
    let answer = Answer::of(refusal, as_json, &shown.object(), || shown.report().text(LOOK))?;
    Ok(answer.with_page(options.report.as_deref(), || shown.report()))
}

/// Why there is no noise, with what is to be known of the record.
fn refusal(name: &str, rest: &Rest, reason: &FitError) -> String {
    let reasons = [vec![reason.to_string()], rest.notes()].concat().join("; ");
    format!("{name}: column {}: {reasons}", rest.column)
}
