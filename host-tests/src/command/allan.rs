//! `meridian allan`: the noise of a gyro at rest.

use std::path::{Path, PathBuf};

use clap::Args;
use host::allan::analysis::Analysis;
use host::allan::rest::{Rest, RestError};
use host::interrupt;
use host::new_file::NewFile;
use host::output::allan::Shown;
use host::output::manner::Manner;
use host::output::printable;
use host::output::progress::Progress;
use host::planning::suggestion;
use host::recording::{self, RestRows, Warning};
use host::report::Verbosity;
use orientation::noise::fit::FitError;

use super::files::Written;
use super::source::Source;
use super::{Answer, Failure, OUTPUT, files};

/// The recording, and which of its columns is analysed.
#[derive(Args)]
pub struct AllanOptions {
    /// The recording of kind `static`, CSV, also gzip-compressed; `-` is standard input.
    file: PathBuf,
    /// The column with the rate, rad/s, whatever its name; the default is `g_rad_s`, else `gx_rad_s`. Beside it only the
    /// time, `t_s`, must be there.
    #[arg(long, value_name = "NAME")]
    column: Option<String>,
    /// Writes the curve, its fit and all numbers as a page for a browser.
    #[arg(long, value_name = "FILE.html", help_heading = OUTPUT)]
    report: Option<PathBuf>,
}

/// Analyses a recording.
pub fn run(options: &AllanOptions, manner: Manner) -> Result<Answer, Failure> {
    let page = Written::page(options.report.as_ref());
    let source = Source::of(&options.file);
    files::check(source.path(), &[page]).map_err(Failure::misuse)?;
    let page = files::opened("the report", options.report.as_ref())?;
    let (name, shown) = (source.name(), source.shown());
    let mut warnings = Vec::new();
    let progress = Progress::of_reading(manner);
    interrupt::end_input();
    let rest = read(&source, options.column.as_deref(), &progress, &mut warnings);
    progress.finish();
    let warnings = recording::warning_lines(&warnings, Path::new(&name));
    rest.and_then(|rest| analyse(&name, &rest, page, manner))
        .map_err(|reason| {
            let failure = Failure { warnings: warnings.clone(), ..reason.into() };
            failure.without_page(options.report.as_ref(), &shown)
        })
        .map(|answer| answer.with_warnings(warnings))
}

/// Reads a column of the record, and tells how far it is.
fn read(
    source: &Source,
    column: Option<&str>,
    progress: &Progress,
    warnings: &mut Vec<Warning>,
) -> Result<Rest, String> {
    let name = source.name();
    let unread = |error| recording::unread(&name, &error).message();
    let (reader, _) = source.open(Some(progress)).map_err(unread)?;
    let opened = RestRows::open(&name, reader, column).map_err(|error| error.message())?;
    Rest::read(opened, warnings).map_err(|error| match error {
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
    let refusal = rest.interruption().or(refusal);
    // Else the text holds all notes, or the object does.
    let is_short = manner.verbosity == Verbosity::Quiet && !manner.as_json;
    let doubts = if is_short && found.is_some() { shown.doubts() } else { Vec::new() };
    let answer = Answer::reported(refusal, manner, &shown.object(), || shown.report())?;
    let answer = Answer { doubts, ..answer };
    Ok(answer.with_page(page, || shown.report()))
}

/// Why there is no noise, with what is to be known of the record.
fn refusal(name: &str, rest: &Rest, reason: &FitError) -> String {
    let reasons = [vec![reason.to_string()], rest.notes()].concat().join("; ");
    printable(&format!("{name}: column {}: {reasons}", rest.column))
}
