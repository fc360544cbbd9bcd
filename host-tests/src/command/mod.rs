//! The commands of the program, one file each: options in, [`Answer`] out.

pub mod allan;
pub mod campaign;
pub mod doctor;
pub mod emulate;
pub mod examples;
pub mod faults;
pub mod files;
pub mod link;
pub mod log;
pub mod mistyped;
pub mod plan;
pub mod replay;
pub mod run;
pub mod send;
pub mod settings;
pub mod shell;
mod source;
pub mod stated;

use std::io::{self, IsTerminal as _, Write};
use std::path::{Path, PathBuf};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use host::angle::Quantity;
use host::new_file::NewFile;
use host::outcome::{self, Finished, Outcome};
use host::output::manner::Manner;
use host::recording::{Body, Truth};
use host::refused;
use host::report::{Look, Report, Verbosity};
use orientation::alignment::stepwise::setting::Half;
use orientation::earth::Latitude;
use serde::Serialize;
use serde_json::{Value, json};

/// Heading of the options that say where results go, and how much is told.
pub const OUTPUT: &str = "Output";

/// What came of a command, ready to print.
pub struct Answer {
    /// For standard output.
    pub output: Output,
    /// Why there was no result, where there was none.
    pub refusal: Option<String>,
    /// Whether the output itself says why.
    pub is_told: bool,
    /// What there is to be said beside that: a line each.
    pub warnings: Vec<String>,
    /// Why a number may be wrong, where the output does not say it: a quiet command says it, too.
    pub doubts: Vec<String>,
}

/// What goes to standard output.
pub enum Output {
    /// For people.
    Text(String),
    /// One object, with `--json`.
    Object(Value),
}

impl Output {
    /// Whether it says so, in lines of whatever width; an object has every reason.
    fn says(&self, reason: &str) -> bool {
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        match self {
            Self::Text(text) => words(text).contains(&words(reason)),
            Self::Object(_) => true,
        }
    }
}

/// Why a command came to nothing.
#[derive(Debug)]
pub struct Failure {
    /// The reason.
    pub reason: String,
    /// The warnings that came before it.
    pub warnings: Vec<String>,
    /// Whether the options are to blame.
    pub is_misuse: bool,
}

impl Failure {
    /// A failure because the options do not suit what was read.
    pub fn misuse(reason: String) -> Self {
        Self { reason, warnings: Vec::new(), is_misuse: true }
    }

    /// The failure, which leaves nothing of this recording that a page could show, where one was asked for.
    fn without_page(mut self, report: Option<&PathBuf>, recording: &str) -> Self {
        let no_page = report.map(|_| format!("{recording}: there is no page for --report"));
        self.warnings.extend(no_page);
        self
    }
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self { reason, warnings: Vec::new(), is_misuse: false }
    }
}

impl Answer {
    /// The object, or the text, of a result, or of what came instead of one.
    fn of(
        refusal: Option<String>,
        manner: Manner,
        object: &impl Serialize,
        text: impl FnOnce() -> String,
    ) -> Result<Self, String> {
        let output = if manner.as_json {
            Output::Object(serde_json::to_value(object).map_err(|error| error.to_string())?)
        } else {
            Output::Text(text())
        };
        let answer = Self {
            output,
            refusal: None,
            is_told: false,
            warnings: Vec::new(),
            doubts: Vec::new(),
        };
        Ok(match refusal {
            Some(reason) => answer.refused(reason),
            None => answer,
        })
    }

    /// This answer without a result, and why there is none.
    fn refused(self, reason: String) -> Self {
        Self { is_told: self.output.says(&reason), refusal: Some(reason), ..self }
    }

    /// The object, or so much of a report as is asked for.
    fn reported(
        refusal: Option<String>,
        manner: Manner,
        object: &impl Serialize,
        report: impl FnOnce() -> Report,
    ) -> Result<Self, String> {
        Self::of(refusal, manner, object, || as_text(&report(), manner.verbosity))
    }

    /// What goes to standard output: an object says `ok` where there was a result, and nowhere else.
    pub fn printed(&self) -> String {
        match &self.output {
            Output::Text(text) => text.clone(),
            Output::Object(_) => format!("{:#}", self.object()),
        }
    }

    /// The object, of which status and exit code agree; null where there is none.
    pub fn object(&self) -> Value {
        match &self.output {
            Output::Text(_) => Value::Null,
            Output::Object(object) => self.agreeing(object.clone()),
        }
    }

    /// The object with its version, a status that is that of the exit code, its reason, and the warnings.
    fn agreeing(&self, mut object: Value) -> Value {
        let says_ok = object["status"] == "ok";
        if !object.is_object() {
            return object;
        }
        if object.get("schema").is_none() {
            object["schema"] = outcome::SCHEMA.into();
        }
        if self.refusal.is_none() {
            object["status"] = "ok".into();
        } else if says_ok || object.get("status").is_none() {
            object["status"] = "failed".into();
        }
        if let Some(reason) = self.refusal.as_ref().filter(|_| object.get("reason").is_none()) {
            object["reason"] = reason.as_str().into();
        }
        if !self.warnings.is_empty() {
            object["warnings"] = json!(self.warnings);
        }
        object
    }

    /// This answer with warnings before its own.
    fn with_warnings(mut self, before: Vec<String>) -> Self {
        self.warnings.splice(..0, before);
        self
    }

    /// This answer with what became of a file that was written beside it: where that failed, the command did, but the
    /// rest is not lost with it, nor is why there was no result.
    fn with_written(mut self, written: Result<(), String>) -> Self {
        let Err(reason) = written else { return self };
        if self.refusal.is_none() {
            return self.refused(reason);
        }
        self.warnings.push(reason);
        self
    }

    /// This answer with a page for `--report`, where one was asked for. A page that cannot be written is a
    /// failure, but the rest is not lost with it.
    fn with_page(self, place: Option<NewFile>, page: impl FnOnce() -> Report) -> Self {
        self.with_written(place.map_or(Ok(()), |place| place.write(|path| page().write(path))))
    }
}

/// So much of a report as is asked for, in colours on a terminal.
fn as_text(report: &Report, verbosity: Verbosity) -> String {
    report.text(Look { verbosity, is_coloured: is_coloured() })
}

/// Whether standard output is a terminal that shows colours, and `NO_COLOR` (no-color.org) is not set.
fn is_coloured() -> bool {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let is_plain = std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    io::stdout().is_terminal() && !is_set("NO_COLOR") && !is_plain
}

/// A finished analysis, ready to be shown.
pub struct Shown<'a> {
    /// What texts and pages call it.
    pub name: &'a str,
    /// The analysis.
    pub finished: Box<dyn Finished>,
    /// The truth, for errors alone.
    pub truth: Truth,
    /// The rows that were analysed, or that figures show, where there are any.
    pub body: Option<Body>,
}

impl Shown<'_> {
    /// What was found, as one object or as text, and as a page where `--report` asks for one.
    ///
    /// # Errors
    /// An object that cannot be serialised.
    pub fn answer(
        &self,
        outcome: &Outcome,
        report: Option<NewFile>,
        manner: Manner,
    ) -> Result<Answer, String> {
        let Self { name, finished, truth, body } = self;
        let made = |figures| outcome::report(name, outcome, &**finished, figures);
        let text = || made(Vec::new());
        let answer = Answer::reported(outcome.reason.clone(), manner, &outcome.noted(), text)?;
        Ok(answer.with_page(report, || made(finished.figures(outcome, truth, body.as_ref()))))
    }
}

/// The halves of the circle in which an azimuth may lie.
static HALVES: [(Half, [&str; 2]); 2] =
    [(Half::East, ["east", "0° to 180°"]), (Half::West, ["west", "180° to 360°"])];

/// Takes the names of values, and shows them with their meanings.
fn named<T: Copy + Send + Sync + 'static>(
    values: &'static [(T, [&'static str; 2])],
) -> impl TypedValueParser<Value = T> {
    registered(values, |(_, name)| *name).map(|(value, _)| *value)
}

/// Takes the names of a registry's entries, and shows them with their meanings.
fn registered<T: Sync>(
    entries: &'static [T],
    named: fn(&T) -> [&'static str; 2],
) -> impl TypedValueParser<Value = &'static T> {
    let values = entries.iter().map(named);
    let values = values.map(|[name, meaning]| PossibleValue::new(name).help(meaning));
    PossibleValuesParser::new(values).try_map(move |name| {
        entries.iter().find(|entry| named(entry)[0] == name).ok_or("there is none of this name")
    })
}

/// An angle in degrees, of whatever size.
fn angle(text: &str, of: Quantity) -> Result<f64, String> {
    host::angle::degrees(text, of).map_err(|error| error.to_string())
}

/// A latitude in degrees.
fn latitude(text: &str) -> Result<Latitude, String> {
    let degrees = angle(text, Quantity::Latitude)?;
    Latitude::from_degrees(degrees).ok_or_else(|| "outside ±90°".to_owned())
}

/// A whole number from `LEAST` to `MOST`.
fn whole<const LEAST: u64, const MOST: u64>(text: &str) -> Result<u64, String> {
    let number = text.parse::<u64>().ok().filter(|number| (LEAST..=MOST).contains(number));
    number.ok_or_else(|| format!("not a whole number from {LEAST} to {MOST}"))
}

/// A seed: any that 64 bits hold.
fn seed(text: &str) -> Result<u64, String> {
    whole::<0, { u64::MAX }>(text)
}

/// A standard deviation in degrees, as radians.
fn sigma(text: &str) -> Result<f64, String> {
    match angle(text, Quantity::Other) {
        Ok(degrees) if degrees > 0.0 && degrees <= 180.0 => Ok(degrees.to_radians()),
        _ => Err("not a number of degrees above 0, at most 180".to_owned()),
    }
}

/// Writes to standard output, where there is anything to write; a closed pipe is no error of ours.
pub fn print(output: &str) -> Result<(), String> {
    if output.is_empty() {
        return Ok(());
    }
    taken(writeln!(io::stdout(), "{output}"))
}

/// Whether standard output took all that was written to it; one that is closed by what reads it wants no more.
pub fn taken(written: io::Result<()>) -> Result<(), String> {
    match written {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(refused::unwritten("the result", Path::new("standard output"), &error))
        }
        _ => Ok(()),
    }
}
