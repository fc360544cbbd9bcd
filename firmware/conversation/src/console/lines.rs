//! Commands as lines of text, answered by sentences.

use firmware::settings::{EditError, Editable};
use firmware::shared::Shared;
use protocol::answer;
use protocol::command::{self, Command, NoCommand};
use protocol::nmea::Sentence;

use super::commands::{state_azimuth, stop};
use super::listing::Listing;
use super::{Console, Outbox, Refused, Requester};

/// Most characters of a command's first word.
const WORD: usize = 8;

/// The first word of a line that is no command, as its answer repeats it.
fn first_word(line: &str) -> &str {
    let words = line.strip_prefix("$PMRDC,").unwrap_or(line);
    let word = words.split([' ', ',', '*']).next().unwrap_or_default();
    if answer::is_value(word) && word.len() <= WORD { word } else { "?" }
}

impl Console {
    /// Takes a line, and answers it where it is meant for this instrument.
    pub(super) fn take_line(
        &mut self,
        line: &str,
        settings: &mut dyn Editable,
        outbox: &mut Outbox,
        shared: &Shared<'_>,
    ) {
        let sentence = match command::parse(line) {
            None => None,
            Some(Err(NoCommand::Unknown)) if line.is_empty() => None,
            Some(Err(error)) => answer::refused(first_word(line), error),
            Some(Ok(command)) => match self.obey(&command, settings, shared) {
                Ok(sentence) => sentence,
                Err(reason) => answer::refused(command.word(), reason),
            },
        };
        outbox.put(sentence.as_ref());
    }

    /// Obeys a command; the answer that goes at once.
    fn obey(
        &mut self,
        command: &Command<'_>,
        settings: &mut dyn Editable,
        shared: &Shared<'_>,
    ) -> Result<Option<Sentence>, Refused> {
        match *command {
            Command::Start => self.start(settings, shared)?,
            Command::Stop => stop(shared)?,
            Command::Realign => self.realign(settings, shared)?,
            Command::Azimuth(angle, sigma) => state_azimuth([angle, sigma], shared)?,
            Command::Get(None) => return Ok(self.begin(Listing::Identity(0))),
            Command::Get(Some(name)) => {
                let identity = self.identity(name, settings);
                return identity.map_or_else(|| value_of("get", name, settings), |it| Ok(Some(it)));
            }
            Command::Set(name, text) => {
                let value = settings.parse(name, text).map_err(Refused::Setting)?;
                self.set(name, value, settings, shared)?;
                return value_of("set", name, settings);
            }
            Command::Save => {
                self.save(Requester::Line, shared)?;
                return Ok(None);
            }
            Command::Restore => self.restore(settings, shared)?,
            Command::Test => return Ok(self.begin(Listing::Devices(0))),
            Command::Log => return Ok(self.begin(Listing::log())),
            Command::Reboot => self.reboots = true,
        }
        Ok(answer::done(command.word()))
    }

    /// Begins an answer of many parts; the end of the one whose place it takes, where it has not ended.
    pub(super) fn begin(&mut self, listing: Listing) -> Option<Sentence> {
        let before = self.listing.replace(listing).and_then(|before| before.word());
        before.and_then(|word| answer::refused(word, "another answer was asked for"))
    }
}

/// The value of a setting.
fn value_of(
    command: &str,
    name: &str,
    settings: &mut dyn Editable,
) -> Result<Option<Sentence>, Refused> {
    let stated = settings.get(name).ok_or(Refused::Setting(EditError::Unknown))?;
    Ok(answer::value(command, name, stated))
}
