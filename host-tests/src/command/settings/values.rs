//! `meridian settings get` and `set`: settings one by one.

use std::collections::BTreeMap;

use host::link::conversation::{Conversation, Reply, in_words, refusal};
use host::link::words::Words;
use host::output::manner::Manner;
use host::report::Report;
use host::settings::{Snapshot, read, value};

use super::super::link::worded;
use super::super::{Answer, Failure};
use super::{GetOptions, SetOptions, SettingsOptions, in_lines, in_object};

/// What an instrument answered to several commands, up to the first that it refuses or does not answer.
#[derive(Default)]
struct Asked {
    values: Vec<(String, String)>,
    warnings: Vec<String>,
    /// Why one was not done, and whether the instrument says so.
    failed: Option<(String, bool)>,
}

impl Asked {
    /// Sends the commands one after the other; none is sent twice.
    fn of(instrument: &mut Conversation, commands: &[Words]) -> Self {
        let mut asked = Self::default();
        for command in commands {
            match instrument.ask(command) {
                Ok(reply) => asked.take(command, reply),
                Err(why) => asked.failed = Some((why, false)),
            }
            if asked.failed.is_some() {
                break;
            }
        }
        asked
    }

    /// Takes the reply to a command.
    fn take(&mut self, command: &Words, reply: Reply) {
        self.warnings.extend(damaged(&reply.damaged));
        self.failed = reply.refused.map(|reason| (refusal(&command.line(), &reason), true));
        if let ["set", _, wanted] = command.words()[..] {
            let differing = reply.values.iter().filter(|(_, kept)| !value::are_same(kept, wanted));
            let told =
                |(name, kept): &(String, String)| format!("{name} = {wanted} is kept as {kept}");
            self.warnings.extend(differing.map(told));
        }
        self.values.extend(reply.values);
    }

    /// The status of an object: that the instrument refuses, or what the exit code says.
    fn status(&self) -> &'static str {
        if matches!(self.failed, Some((_, true))) { "refused" } else { "ok" }
    }

    /// Why not all was done, and what was before.
    fn refusal(&self, of: usize) -> Option<String> {
        let (why, _) = self.failed.as_ref()?;
        let names =
            self.values.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", ");
        Some(match self.values.len() {
            0 => why.clone(),
            count => format!("{why}; {count} of {of} were done before: {names}"),
        })
    }
}

/// Shows settings.
pub(super) fn get(
    of: &SettingsOptions,
    options: &GetOptions,
    manner: Manner,
) -> Result<Answer, Failure> {
    let commands = options.names.iter().map(|name| worded(["get", name.as_str()]));
    let commands: Vec<Words> = commands.collect::<Result<_, _>>()?;
    let mut instrument = of.open()?;
    let asked = Asked::of(&mut instrument, &commands);
    let refusal = asked.refusal(commands.len());
    let status = asked.status();
    let snapshot = match commands.as_slice() {
        [] => read::all(&mut instrument)?,
        _ => Snapshot::of(asked.values),
    };
    let Snapshot { identity, settings } = &snapshot;
    let object = of
        .keys()
        .with("status", status)
        .with("identity", in_object(identity))
        .with("settings", in_object(settings));
    let report = || {
        let parts = [in_lines("", identity), in_lines("", settings)];
        Report::new(of.title("Settings"), parts.map(Into::into))
    };
    let answer = Answer::reported(refusal, manner, &object, report)?;
    Ok(answer.with_warnings(asked.warnings))
}

/// That answers came damaged, where some did.
fn damaged(lines: &[String]) -> Option<String> {
    (!lines.is_empty()).then(|| format!("answers of the instrument {}", in_words(lines)))
}

/// The commands for names and their values.
fn changes(words: &[String]) -> Result<Vec<Words>, Failure> {
    let (mut words, mut commands) = (words.iter(), Vec::new());
    while let Some(word) = words.next() {
        let pair = word.split_once('=').or_else(|| Some((word, words.next()?)));
        let missing = || Failure::misuse(format!("NAME VALUE: {word} has no value"));
        let (name, value) = pair.ok_or_else(missing)?;
        commands.push(worded(["set", name, value])?);
    }
    Ok(commands)
}

/// Changes settings, one after the other, up to the first that is refused.
pub(super) fn set(
    of: &SettingsOptions,
    options: &SetOptions,
    manner: Manner,
) -> Result<Answer, Failure> {
    let commands = changes(&options.pairs)?;
    let asked = Asked::of(&mut of.open()?, &commands);
    let (refusal, status) = (asked.refusal(commands.len()), asked.status());
    let kept: BTreeMap<_, _> = asked.values.into_iter().collect();
    let object =
        of.keys().with("status", status).with("settings", in_object(&kept)).with("saved", false);
    let report = || {
        let until = format!("it is switched off; `meridian send {} save` keeps them", of.port);
        let lines = in_lines("", &kept).with("until", until);
        Report::new(of.title("Changed settings"), [lines.into()])
    };
    let answer = if kept.is_empty() {
        Answer::of(refusal, manner, &object, String::new)?
    } else {
        Answer::reported(refusal, manner, &object, report)?
    };
    Ok(answer.with_warnings(asked.warnings))
}
