//! Commands to an instrument, one after the other, and its answers.

use std::time::{Duration, Instant};

use protocol::answer::{Answer, Content, parse};

use super::hearing::{Hearing, Line};
use super::port::Port;
use super::words::Words;
use crate::output::counted;

/// Bytes that are read at once.
const CHUNK: usize = 4096;
/// Damaged lines that are told of, one answer.
const TOLD: usize = 3;

/// A conversation with an instrument.
pub struct Conversation {
    port: Port,
    hearing: Hearing,
    /// How long it may be silent before it is taken not to answer.
    silence: Duration,
}

/// A part of a record of the log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Number of the record.
    pub record: u32,
    /// Number of the part in it.
    pub number: u32,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// What an instrument answered to a command.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Reply {
    /// Names and values of settings, in the order in which they came.
    pub values: Vec<(String, String)>,
    /// Parts of records of the log.
    pub parts: Vec<Part>,
    /// Why it does not do it, in its words, where it does not.
    pub refused: Option<String>,
    /// Answers that came cut or damaged.
    pub damaged: Vec<String>,
}

/// What ends an answer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End<'w> {
    /// That the command was done.
    Done,
    /// The value of the setting of this name.
    Value(&'w str),
}

impl Reply {
    /// The reply itself; or why the command was not done.
    ///
    /// # Errors
    /// The instrument refuses it.
    pub fn done(self, command: &str) -> Result<Self, String> {
        match &self.refused {
            Some(reason) => Err(refusal(command, reason)),
            None => Ok(self),
        }
    }

    /// Hears a line while a command waits for its answer: whether it is the last of that; none where it is none of it.
    fn hear(&mut self, line: Line, command: &str, end: End) -> Option<bool> {
        let line = match line {
            Line::Whole(line) => line,
            Line::Damaged(line) => {
                self.damaged.push(line);
                return None;
            }
        };
        let Ok(answer) = parse(&line)? else {
            self.damaged.push(line);
            return None;
        };
        // Others may be for another one.
        (answer.command == command).then(|| self.take(&answer, end))
    }

    /// Takes an answer; whether it is the last.
    fn take(&mut self, answer: &Answer, end: End) -> bool {
        match answer.content {
            Content::Refused(reason) => {
                self.refused = Some(reason.to_owned());
                return true;
            }
            // The end of what another one has asked for is not that of a single value.
            Content::Done => return end == End::Done || answer.command == "set",
            Content::Value(name, value) if end == End::Done || end == End::Value(name) => {
                self.values.push((name.to_owned(), value.to_owned()));
            }
            Content::Value(..) => return false,
            Content::Part(part) => {
                let bytes = part.bytes().collect();
                self.parts.push(Part { record: part.record, number: part.number, bytes });
            }
        }
        end != End::Done
    }
}

/// That an instrument refuses a command, and why.
#[must_use]
pub fn refusal(command: &str, reason: &str) -> String {
    let reason = if reason.is_empty() { "it does not say why" } else { reason };
    format!("the instrument refuses `{command}`: {reason}")
}

/// Lines that came cut or damaged, in words.
#[must_use]
pub fn in_words(damaged: &[String]) -> String {
    let shown: Vec<_> = damaged.iter().take(TOLD).map(|line| format!("`{line}`")).collect();
    let more = damaged.len().saturating_sub(TOLD);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    format!("came damaged: {}{more}", shown.join(", "))
}

impl Conversation {
    /// A conversation over a port; an instrument that is silent for so long is taken not to answer.
    #[must_use]
    pub fn over(port: Port, silence: Duration) -> Self {
        Self { port, hearing: Hearing::default(), silence }
    }

    /// Where the instrument is.
    #[must_use]
    pub fn place(&self) -> String {
        self.port.address().to_string()
    }

    /// Sends a command and waits for its answer.
    ///
    /// # Errors
    /// The port is gone, or nothing was answered; what was heard instead, and what to do.
    pub fn ask(&mut self, command: &Words) -> Result<Reply, String> {
        self.hearing.forget();
        let sent = self.port.send(command.sentence().as_bytes());
        sent.map_err(|why| {
            format!("{}: `{}` cannot be sent: {why}", self.place(), command.line())
        })?;
        let words = command.words();
        let end = match words[..] {
            ["get" | "set", name, ..] => End::Value(name),
            _ => End::Done,
        };
        self.listen(words[0], end).map_err(|why| format!("{}: {why}", self.place()))
    }

    /// Asks with the words of a command that is known to be one.
    ///
    /// # Errors
    /// As [`Self::ask`], or a word that cannot be sent.
    pub fn say(&mut self, words: &[&str]) -> Result<Reply, String> {
        let command = Words::of(words.iter().copied()).map_err(|wrong| wrong.to_string())?;
        self.ask(&command)
    }

    /// Waits for the answer to a command.
    fn listen(&mut self, command: &str, end: End) -> Result<Reply, String> {
        let (mut reply, mut last) = (Reply::default(), Instant::now());
        while last.elapsed() < self.silence {
            let lines = match self.receive() {
                Ok(lines) => lines,
                Err(why) => return Err(self.broken_off(command, reply, &why)),
            };
            for line in lines {
                match reply.hear(line, command, end) {
                    Some(true) => return Ok(reply),
                    Some(false) => last = Instant::now(),
                    None => {}
                }
            }
        }
        Err(self.unanswered(command, reply))
    }

    /// The answers in what comes next, to whomever; none where nothing comes for a while.
    fn receive(&mut self) -> Result<Vec<Line>, String> {
        let mut chunk = [0; CHUNK];
        Ok(match self.port.receive(&mut chunk)? {
            0 => self.hearing.pause(),
            count => self.hearing.take(&chunk[..count]),
        })
    }

    /// Why an answer has ended before its end.
    fn broken_off(&self, command: &str, reply: Reply, why: &str) -> String {
        let count = reply.values.len() + reply.parts.len();
        let damaged = self.damaged(reply);
        let after = match count {
            0 => "before its answer".to_owned(),
            count => format!("after {} of its answer", counted(count, "sentence")),
        };
        format!("`{command}` was sent, and {after} the port was lost: {why}{damaged}")
    }

    /// Why there is no answer.
    fn unanswered(&self, command: &str, reply: Reply) -> String {
        let silence = self.silence.as_secs_f64();
        let count = reply.values.len() + reply.parts.len();
        let damaged = self.damaged(reply);
        if count > 0 {
            return format!(
                "the answer to `{command}` ends after {}, and {silence} s of silence follow; send it once more{damaged}",
                counted(count, "sentence")
            );
        }
        if !damaged.is_empty() {
            return format!(
                "no whole answer to `{command}` in {silence} s{damaged}; send it once more, and close other programs that \
                 read the port"
            );
        }
        let instead = self.hearing.heard().instead(self.port.baud());
        format!("no answer to `{command}` in {silence} s; {instead}")
    }

    /// The lines of a reply that came cut or damaged, the one that is under way too, where there are any.
    fn damaged(&self, reply: Reply) -> String {
        let damaged = [reply.damaged, self.hearing.unfinished().into_iter().collect()].concat();
        if damaged.is_empty() { String::new() } else { format!("; answers {}", in_words(&damaged)) }
    }
}
