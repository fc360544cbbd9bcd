//! `meridian allan`: the noise of a gyro at rest.

use std::path::PathBuf;

use bench::allan::analysis::{Analysis, Rest};
use bench::allan::speed;
use bench::output::allan::Shown;
use bench::planning::Suggestion;
use bench::recording;
use clap::Args;
use orientation::noise::fit::FitError;

use super::Told;

/// Which recording, and what of it.
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
pub fn run(options: &AllanOptions, as_json: bool) -> Result<Told, String> {
    let recording = recording::read(&options.file).map_err(|error| error.to_string())?;
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
        schedule: found.and_then(|analysis| Suggestion::of(analysis.fit.noise())),
    };
    let report = |path: &PathBuf| shown.report().write(path).map_err(|error| error.to_string());
    let written = options.report.as_ref().map_or(Ok(()), report);
    let mut object = shown.object();
    if let Err(reason) = &written {
        object["status"] = "failed".into();
        object["reason"] = reason.as_str().into();
    }
    let told = Told::of(true, as_json, &object, |out| shown.text(out))?;
    // A page that failed is a failure, but the numbers are not lost with it.
    let refusal = analysis.as_ref().err().map(|reason| refusal(&name, &rest, reason));
    let refusal = refusal.or(written.err());
    Ok(Told { found: refusal.is_none(), refusal, ..told })
}

/// Why there is no noise, with what is to be known of the record.
fn refusal(name: &str, rest: &Rest, reason: &FitError) -> String {
    let told = [vec![reason.to_string()], rest.notes()].concat().join("; ");
    format!("{name}: column {}: {told}", rest.column)
}
