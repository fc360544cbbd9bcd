//! `meridian allan`: the noise of a gyro at rest.

use std::path::PathBuf;

use clap::Args;
use host::allan::analysis::{Analysis, Rest};
use host::allan::speed;
use host::new_file::NewFile;
use host::output::allan::Shown;
use host::output::manner::Manner;
use host::planning::suggestion;
use host::recording::{self, Recording};
use orientation::noise::fit::FitError;

use super::files::Written;
use super::{Answer, Failure, OUTPUT, files};

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
    let recording = recording::read(&options.file).map_err(|error| error.message())?;
    let warnings = recording.warning_lines(&options.file);
    analyse(options, recording, page, manner)
        .map_err(|reason| Failure { warnings: warnings.clone(), ..reason.into() })
        .map(|answer| answer.with_warnings(warnings))
}

/// Analyses what was read.
fn analyse(
    options: &AllanOptions,
    recording: Recording,
    page: Option<NewFile>,
    manner: Manner,
) -> Result<Answer, String> {
    let name = options.file.display().to_string();
    let (header, body, _) = recording.into_parts();
    let rest = Rest::take(&header, &body, options.column.as_deref())
        .map_err(|error| format!("{name}: {error}"))?;
    let analysis = Analysis::of(&rest);
    let found = analysis.as_ref().ok();
    let shown = Shown {
        name: &name,
        rest: &rest,
        analysis: &analysis,
        comparison: found.map(|_| speed::compare(&rest)),
        schedule: found.and_then(|analysis| suggestion(analysis.fit.noise())),
    };
    let refusal = analysis.as_ref().err().map(|reason| refusal(&name, &rest, reason));
    let answer = Answer::reported(refusal, manner, &shown.object(), || shown.report())?;
    Ok(answer.with_page(page, || shown.report()))
}

/// Why there is no noise, with what is to be known of the record.
fn refusal(name: &str, rest: &Rest, reason: &FitError) -> String {
    let reasons = [vec![reason.to_string()], rest.notes()].concat().join("; ");
    format!("{name}: column {}: {reasons}", rest.column)
}
