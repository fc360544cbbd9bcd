//! The replay of many recordings side by side, and their table.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use host::interrupt;
use host::new_file::NewFile;
use host::outcome::{Outcome, SCHEMA};
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::output::{azimuth as in_circle, printable, signed};
use host::refused;
use host::report::{Columns, Grade, Lines, Look, Report, Verbosity};
use host::work::side_by_side;
use serde_json::{Value, json};

use super::one::One;
use crate::command::source::Source;
use crate::command::{Answer, Failure, Output, files};

/// How the name of a page ends.
const PAGE: &str = ".html";
/// How the name of an attitude ends.
const ATTITUDE: &str = ".csv";

/// A row of the table, and its object.
struct Row {
    /// What the table calls the recording.
    shown: String,
    method: &'static str,
    found: String,
    limit_deg: Option<f64>,
    seconds: Option<f64>,
    error: String,
    reason: String,
    object: Value,
    warnings: Vec<String>,
    is_ok: bool,
}

/// The folders of what is written for each recording: pages, and attitudes.
pub struct Folders([Option<PathBuf>; 2]);

impl Folders {
    /// Makes the folders.
    ///
    /// # Errors
    /// A file is named; it cannot be made; two recordings would have one file in it, or one of them has the name of such
    /// a file.
    pub fn make(
        [pages, attitudes]: [Option<&PathBuf>; 2],
        sources: &[Source],
    ) -> Result<Self, Failure> {
        let named = [
            ("--report", "the pages", PAGE, pages),
            ("--attitude-out", "the attitudes", ATTITUDE, attitudes),
        ];
        for (option, what, end, folder) in named {
            let Some(folder) = folder else { continue };
            check(option, folder, sources).map_err(Failure::misuse)?;
            spare(option, end, folder, sources).map_err(Failure::misuse)?;
            fs::create_dir_all(folder)
                .map_err(|error| refused::unwritten(what, &folder.join("."), &error))?;
        }
        Ok(Self([pages, attitudes].map(Option::<&PathBuf>::cloned)))
    }

    /// The folder of the pages, where there is one.
    fn pages(&self) -> Option<&PathBuf> {
        self.0[0].as_ref()
    }

    /// The files that are written for a recording.
    fn files(&self, source: &Source) -> Result<[Option<NewFile>; 2], String> {
        let [pages, attitudes] = &self.0;
        let file = |folder: &Option<PathBuf>, what, end: &str| {
            let path = folder.as_ref().map(|folder| folder.join(stem(source) + end));
            path.map(|path| NewFile::open(what, &path)).transpose()
        };
        Ok([file(pages, "the report", PAGE)?, file(attitudes, "the attitude", ATTITUDE)?])
    }
}

/// Refuses what is no folder, and names that two recordings would share in it.
fn check(option: &str, folder: &Path, sources: &[Source]) -> Result<(), String> {
    let is_file = folder.is_file() || folder.extension().is_some();
    if folder.as_os_str().is_empty() || is_file && !folder.is_dir() {
        let shown = folder.display();
        return Err(format!(
            "{option}: {shown}: each of several recordings has a file of its own; name a folder"
        ));
    }
    let mut stems = BTreeSet::new();
    match sources.iter().map(stem).find(|stem| !stems.insert(stem.clone())) {
        Some(twice) => Err(format!(
            "{option}: two recordings would have the file {twice} in the folder; replay them apart"
        )),
        None => Ok(()),
    }
}

/// Refuses a folder in which one of the recordings has the name of what is written, which ends so.
fn spare(option: &str, end: &str, folder: &Path, sources: &[Source]) -> Result<(), String> {
    let mut written = sources.iter().map(|source| folder.join(stem(source) + end));
    let is_read = |path: &PathBuf| {
        sources.iter().filter_map(Source::path).any(|read| files::are_one(path, read))
    };
    written.find(is_read).map_or(Ok(()), |path| {
        let shown = path.display();
        Err(format!("{option}: {shown} is one of the recordings itself; name another folder"))
    })
}

/// The name of a recording without its endings.
fn stem(source: &Source) -> String {
    let name = source.path().and_then(Path::file_name).and_then(OsStr::to_str);
    let name = name.unwrap_or("standard-input");
    let name = name.strip_suffix(".gz").unwrap_or(name);
    Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// Replays recordings side by side.
pub fn replay(
    one: &One<'_>,
    sources: Vec<Source>,
    folders: &Folders,
    manner: Manner,
) -> Result<Answer, Failure> {
    let progress = Progress::of_steps(manner, sources.len() as u64, "recordings");
    interrupt::heed();
    let shown = shown(&sources);
    let named = sources.into_iter().zip(shown);
    let rows = side_by_side(named, &progress, |(source, shown)| Row {
        shown,
        ..row(one, &source, folders)
    });
    progress.finish();
    let refusal = refusal(&rows);
    let object = object(&rows, refusal.as_deref());
    let warnings = rows.iter().flat_map(|row| row.warnings.iter().cloned()).collect();
    let answer = Answer::of(refusal, manner, &object, || match manner.verbosity {
        Verbosity::Quiet => lines(&rows),
        _ => table(&rows),
    })?;
    // Each object has its own.
    let is_object = matches!(answer.output, Output::Object(_));
    Ok(if is_object { answer } else { answer.with_warnings(warnings) })
}

/// What the table calls recordings: the name of the file where no other file has it, else its path.
fn shown(sources: &[Source]) -> Vec<String> {
    let name = |source: &Source| match source.path().and_then(Path::file_name) {
        Some(name) => printable(&name.to_string_lossy()),
        None => source.shown(),
    };
    let mut times = BTreeMap::new();
    for source in sources {
        *times.entry(name(source)).or_insert(0) += 1;
    }
    let is_alone = |name: &String| times.get(name) == Some(&1);
    let shown =
        |source: &Source| Some(name(source)).filter(is_alone).unwrap_or_else(|| source.shown());
    sources.iter().map(shown).collect()
}

/// Why not every recording has a result.
fn refusal(rows: &[Row]) -> Option<String> {
    if interrupt::is_asked() {
        let reason = interrupt::reason();
        return Some(format!("{reason}: the table holds the recordings that were done"));
    }
    let (all, none) = (rows.len(), rows.iter().filter(|row| !row.is_ok).count());
    match none {
        0 => None,
        1 if all == 1 => Some("the recording gave no result".to_owned()),
        _ if none == all => Some(format!("none of {all} recordings gave a result")),
        _ => Some(format!("{none} of {all} recordings gave no result")),
    }
}

/// All objects in one.
fn object(rows: &[Row], refusal: Option<&str>) -> Value {
    let results: Vec<_> = rows.iter().map(|row| &row.object).collect();
    let grade = match refusal {
        None => Grade::Found,
        Some(_) if interrupt::is_asked() => Grade::Interrupted,
        Some(_) => Grade::Refused,
    };
    let status = grade.status();
    json!({ "schema": SCHEMA, "status": status, "results": results })
}

/// What came of a recording.
fn row(one: &One<'_>, source: &Source, folders: &Folders) -> Row {
    let replayed = one.replay(source).and_then(|done| {
        let row = Row::of(&done.outcome);
        let as_json = Manner { as_json: true, ..Manner::default() };
        let answer = done.answer(folders.files(source)?, as_json)?;
        Ok((row, answer))
    });
    match replayed {
        Ok((row, answer)) => row.answered(&source.shown(), answer),
        Err(failure) => Row::failed(source, failure.without_page(folders.pages(), &source.shown())),
    }
}

impl Row {
    /// What was found.
    fn of(outcome: &Outcome) -> Self {
        let error = outcome.error_deg.map(|error| signed(error, 4));
        Self {
            shown: String::new(),
            method: outcome.method,
            found: found(outcome),
            limit_deg: outcome.limit_deg,
            seconds: Some(outcome.seconds),
            error: error.unwrap_or_default(),
            reason: String::new(),
            object: Value::Null,
            warnings: Vec::new(),
            is_ok: false,
        }
    }

    /// The row with its object.
    fn answered(self, file: &str, answer: Answer) -> Self {
        let prefix = format!("{file}: ");
        let reason = answer.refusal.clone().unwrap_or_default();
        let reason = reason.strip_prefix(&prefix).unwrap_or(&reason).to_owned();
        let (is_ok, object) = (answer.refusal.is_none(), answer.object());
        Self { reason, is_ok, object, warnings: answer.warnings, ..self }
    }

    /// The row of a recording that could not be replayed.
    fn failed(source: &Source, Failure { reason, warnings, .. }: Failure) -> Self {
        let nothing = Self::of(&Outcome::default());
        let object = Output::Object(json!({ "file": source.name() }));
        let answer = Answer {
            output: object,
            refusal: Some(reason),
            is_told: false,
            warnings,
            doubts: Vec::new(),
        };
        Self {
            found: "failed".to_owned(),
            seconds: None,
            ..nothing.answered(&source.shown(), answer)
        }
    }
}

/// What was found, in words: an azimuth, a level, or a roll.
fn found(outcome: &Outcome) -> String {
    let Some(sigma) = outcome.sigma_deg else { return outcome.status.status().to_owned() };
    match (outcome.azimuth_deg, outcome.pitch_deg.zip(outcome.roll_deg)) {
        (Some(azimuth), _) => format!("{}° ± {sigma:.4}°", in_circle(azimuth, 4)),
        (None, Some((pitch, roll))) => {
            format!("pitch {pitch:.3}°, roll {roll:.3}° ± {sigma:.3}°")
        }
        (None, None) => match outcome.roll_end_deg() {
            Some(roll) => format!("roll {roll:.4}° ± {sigma:.4}°"),
            None => format!("± {sigma:.4}°"),
        },
    }
}

/// A limit, which is never nothing.
fn limit(degrees: f64) -> String {
    if degrees < 5e-5 { "<0.0001".to_owned() } else { format!("{degrees:.4}") }
}

/// The table of all recordings, and below it why some have no result.
fn table(rows: &[Row]) -> String {
    let title = "Recordings: what was found, 1σ, Cramér–Rao limit, found less true";
    let columns = Columns::of("", rows)
        .column("file", |row| &row.shown)
        .column("method", |row| row.method)
        .column("found", |row| &row.found)
        .column("limit, °", |row| row.limit_deg.map_or("-".to_owned(), limit))
        .found("seconds", 0, |row| row.seconds)
        .column("error, °", |row| &row.error);
    let without = rows.iter().filter(|row| !row.reason.is_empty());
    let reasons = without.fold(Lines::new("Why there is no result"), |lines, row| {
        lines.with(&row.shown, row.reason.as_str())
    });
    let parts = [columns.into(), reasons.into()];
    Report::new(title, parts).text(Look::plain(Verbosity::Usual))
}

/// What was found, or why nothing was, a line for each recording.
fn lines(rows: &[Row]) -> String {
    let line = |row: &Row| {
        let what = if row.reason.is_empty() { &row.found } else { &row.reason };
        format!("{}: {what}", row.shown)
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}
