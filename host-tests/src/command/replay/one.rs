//! The replay of one recording.

use std::path::Path;

use host::instrument::replay::{Done as Ended, Replayed, replay_lines};
use host::interrupt;
use host::methods::asked::{Asked, Question};
use host::methods::vertical::write_attitude;
use host::methods::{self, Method};
use host::new_file::NewFile;
use host::outcome::run::RunDetails;
use host::outcome::{Finished, Outcome, Source as Named};
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::recording::inputs::Reader;
use host::recording::{self, Body, Truth};
use orientation::alignment::stepwise::session::Session;

use super::{ReplayOptions, beside_inputs, check};
use crate::command::source::Source;
use crate::command::stated::Stated;
use crate::command::{Answer, Failure, Shown};

/// What is asked of a recording.
pub struct One<'o> {
    /// The options of the command.
    pub options: &'o ReplayOptions,
    /// Those that stand on the command line.
    pub stated: &'o Stated,
    /// Where reading and computing are shown; nowhere for one recording of many.
    pub progress: Option<&'o Progress>,
}

/// What came of a recording.
pub struct Done {
    /// What texts call the recording.
    pub name: String,
    /// What was found.
    pub outcome: Outcome,
    /// What there is to be said beside that.
    pub warnings: Vec<String>,
    finished: Box<dyn Finished>,
    truth: Truth,
    body: Option<Body>,
}

impl One<'_> {
    /// Replays a recording.
    ///
    /// # Errors
    /// It cannot be read, or the options do not suit it.
    pub fn replay(&self, source: &Source) -> Result<Done, Failure> {
        let name = source.shown();
        let unread = |error| recording::unread(&name, &error).message();
        let (reader, is_inputs) = source.open(self.progress).map_err(unread)?;
        if is_inputs {
            beside_inputs(self.stated).map_err(Failure::misuse)?;
            let (header, mut lines) =
                Reader::new(&name, reader).map_err(|error| error.to_string())?;
            let replayed = replay_lines(&header.given, &mut lines);
            return Ok(again(source, replayed.map_err(|error| error.to_string())?));
        }
        let recording = recording::read_from(&name, reader).map_err(|error| error.message())?;
        let method = self.options.method.unwrap_or_else(|| methods::usual(&recording));
        // Without a method stated, that the options do not suit shows only now.
        check(self.stated, method).map_err(Failure::misuse)?;
        let warnings = recording.warning_lines(Path::new(&name));
        let failed = |reason: String| Failure { warnings: warnings.clone(), ..reason.into() };
        let done = self.solve(source, method, recording).map_err(failed)?;
        Ok(Done { warnings, ..done })
    }

    /// Replays what was read.
    fn solve(
        &self,
        source: &Source,
        method: &Method,
        recording: recording::Recording,
    ) -> Result<Done, String> {
        let name = source.shown();
        let (header, body, truth) = recording.into_parts();
        let asked = self.options.asked();
        self.progress.iter().for_each(|progress| progress.begin("computing"));
        let watch = |session: &Session| {
            self.progress.iter().for_each(|progress| progress.session(session));
        };
        let finished = (method.replay)(&header, &body, &asked, &watch)
            .map_err(|error| format!("{name}: {error}"))?;
        let outcome = finished.outcome(&truth);
        // A run gives its own reason.
        let interruption = interrupt::ended();
        let is_caused =
            outcome.reason.is_some() && header.session.is_none() && interruption.is_none();
        let question = Question { header: &header, body: &body, asked: &asked };
        let cause = is_caused.then(|| finished.cause(&question)).flatten();
        let reason = outcome.reason.map(|reason| match cause {
            Some(cause) => cause.explaining(&reason, outcome.remedy),
            None => reason,
        });
        let mut outcome = Outcome { source: Some(Named::File(source.name())), reason, ..outcome };
        outcome.degradations.extend(question.other_latitude());
        let outcome = match interruption {
            Some(why) => outcome.cut_short(why),
            None => outcome,
        };
        Ok(Done { name, outcome, warnings: Vec::new(), finished, truth, body: Some(body) })
    }
}

/// What came of the inputs of a run.
fn again(source: &Source, replayed: Replayed) -> Done {
    let Replayed { finished, body, done } = replayed;
    let details = RunDetails::of_inputs(&done);
    let Ended { truth, warning, .. } = done;
    let outcome = finished.outcome(&truth).of_run(Named::File(source.name()), details);
    Done { name: source.shown(), outcome, warnings: Vec::from_iter(warning), finished, truth, body }
}

impl Done {
    /// What is printed, and what is written beside it.
    ///
    /// # Errors
    /// An object that cannot be serialised.
    pub fn answer(
        self,
        [page, attitude]: [Option<NewFile>; 2],
        manner: Manner,
    ) -> Result<Answer, String> {
        let Self { name, outcome, warnings, finished, truth, body } = self;
        let shown = Shown { name: &name, finished, truth, body };
        let answer = shown.answer(&outcome, page, manner)?;
        let refusal = answer.refusal.as_ref().map(|reason| format!("{name}: {reason}"));
        let attitude = attitude.zip(shown.finished.attitude());
        let written = attitude.map_or(Ok(()), |(file, moments)| {
            write_attitude(file.path(), moments).map_err(|error| file.unwritten(&error))?;
            file.keep()
        });
        Ok(Answer { refusal, ..answer }.with_warnings(warnings).with_written(written))
    }
}

/// What the user asks, whatever the recording.
impl ReplayOptions {
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
}
