//! `meridian allan`: the noise of a gyro at rest.

use std::path::PathBuf;

use clap::Args;
use host::allan::analysis::Analysis;
use host::allan::rest::{Rest, RestError};
use host::new_file::NewFile;
use host::output::allan::Shown;
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::planning::suggestion;
use host::recording::{self, Metered, RestRows, Warning};
use orientation::noise::fit::FitError;

use super::files::Written;
use super::{Answer, Failure, OUTPUT, files};

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
    #[arg(long, value_name = "FILE.html", help_heading = OUTPUT)]
    report: Option<PathBuf>,
}

/// Analyses a recording.
pub fn run(options: &AllanOptions, manner: Manner) -> Result<Answer, Failure> {
    let page = Written::page(options.report.as_ref());
    files::check(Some(&options.file), &[page]).map_err(Failure::misuse)?;
    let page = files::opened("the report", options.report.as_ref())?;
    let name = options.file.display().to_string();
    let mut warnings = Vec::new();
    let rest = read(options, manner, &name, &mut warnings);
    let warnings = recording::warning_lines(&warnings, &options.file);
    rest.and_then(|rest| analyse(&name, &rest, page, manner))
        .map_err(|reason| Failure { warnings: warnings.clone(), ..reason.into() })
        .map(|answer| answer.with_warnings(warnings))
}

/// Reads the record, and tells how far it is where that takes its time.
fn read(
    options: &AllanOptions,
    manner: Manner,
    name: &str,
    warnings: &mut Vec<Warning>,
) -> Result<Rest, String> {
    let file = recording::open(&options.file).map_err(|error| error.message())?;
    let size = file.metadata().map_or(0, |about| about.len() >> 20);
    let progress = (size >= LARGE).then(|| Progress::new(manner, size, "MiB read"));
    let told = |done| {
        if let Some(progress) = &progress {
            progress.reached((done, size), &format!("{done}/{size} MiB read"));
        }
    };
    let opened = RestRows::open(name, Metered::new(file, told));
    let opened = opened.map_err(|error| error.message())?;
    let rest = Rest::read(opened, options.column.as_deref(), warnings);
    progress.iter().for_each(Progress::finish);
    rest.map_err(|error| match error {
        RestError::Read(error) => error.message(),
        error => format!("{name}: {error}"),
    })
}

/// Analyses what was read.
fn analyse(
    name: &str,
    rest: &Rest,
    page: Option<NewFile>,
    manner: Manner,
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
    let answer = Answer::reported(refusal, manner, &shown.object(), || shown.report())?;
    Ok(answer.with_page(page, || shown.report()))
}

/// Why there is no noise, with what is to be known of the record.
fn refusal(name: &str, rest: &Rest, reason: &FitError) -> String {
    let reasons = [vec![reason.to_string()], rest.notes()].concat().join("; ");
    format!("{name}: column {}: {reasons}", rest.column)
}
