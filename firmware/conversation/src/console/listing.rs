//! Answers of many parts, which go as the link has room for them.

use core::fmt::Write as _;

use firmware::settings::Editable;
use firmware::shared::Shared;
use firmware::storage::LogRecord;
use heapless::String;
use orientation::device::Device;
use protocol::answer;

use super::frames::put_parameter;
use super::{Console, Outbox};

/// An answer of many parts, and how far it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Listing {
    /// What the instrument is, of which the name of this number is next, and then all settings.
    Identity(usize),
    /// All settings, of which the one of this number is next.
    Settings(usize),
    /// The same as parameters of MAVLink.
    Parameters(usize),
    /// What came of the self-tests of the devices, of which the one of this number is next.
    Devices(usize),
    /// The records of the log, after the one of this number.
    Log {
        /// Number of the record that was sent last.
        after: u32,
        /// Whether the store was asked for the next one.
        is_asked: bool,
    },
    /// A record of the log, of which the part of this number is next.
    Record {
        /// Its number, and its content.
        record: LogRecord,
        /// The part.
        part: u8,
    },
}

impl Listing {
    /// The whole log.
    pub(super) const fn log() -> Self {
        Self::Log { after: 0, is_asked: false }
    }

    /// The first word of the command that it answers, where that is a line.
    pub(super) const fn word(&self) -> Option<&'static str> {
        match self {
            Self::Identity(_) | Self::Settings(_) => Some("get"),
            Self::Parameters(_) => None,
            Self::Devices(_) => Some("test"),
            Self::Log { .. } | Self::Record { .. } => Some("log"),
        }
    }
}

impl Console {
    /// Puts the next part of an answer; whether there was one.
    pub(super) fn list_on(
        &mut self,
        settings: &mut dyn Editable,
        outbox: &mut Outbox,
        shared: &Shared<'_>,
    ) -> bool {
        let Some(listing) = self.listing else { return false };
        let before = outbox.len();
        self.listing = match listing {
            Listing::Identity(number) => {
                let sentence = self.nth_identity(number, settings);
                outbox.put(sentence.as_ref());
                let next = sentence.map(|_| Listing::Identity(number + 1));
                Some(next.unwrap_or(Listing::Settings(0)))
            }
            Listing::Settings(number) => {
                let stated = settings.nth(number);
                outbox.put(
                    match stated {
                        Some(stated) => answer::value("get", stated.name, stated),
                        None => answer::done("get"),
                    }
                    .as_ref(),
                );
                stated.map(|_| Listing::Settings(number + 1))
            }
            Listing::Parameters(number) => {
                put_parameter(number, settings, outbox).then_some(Listing::Parameters(number + 1))
            }
            Listing::Devices(number) => devices(number, outbox, shared),
            Listing::Log { after, is_asked } => log(after, is_asked, outbox, shared),
            Listing::Record { record, part } => Some(record_on(record, part, outbox)),
        };
        outbox.len() > before
    }
}

/// Puts the device of this number, or the next one that the instrument has, with what came of its self-test.
fn devices(number: usize, outbox: &mut Outbox, shared: &Shared<'_>) -> Option<Listing> {
    let (passed, failed) = (shared.passed.get(), shared.failed.get());
    let mut known = Device::ALL.iter().enumerate().skip(number);
    let found = known.find(|(_, device)| passed.contains(**device) || failed.contains(**device));
    let Some((place, device)) = found else {
        outbox.put(answer::done("test").as_ref());
        return None;
    };
    let mut name = String::<{ answer::LONGEST_NAME }>::new();
    let _ = write!(name, "{device}");
    let name: String<{ answer::LONGEST_NAME }> =
        name.chars().map(|letter| if letter == ' ' { '_' } else { letter }).collect();
    let outcome = if failed.contains(*device) { "failed" } else { "passed" };
    outbox.put(answer::value("test", &name, outcome).as_ref());
    Some(Listing::Devices(place + 1))
}

/// Asks the store for the next record, or waits for it.
fn log(after: u32, is_asked: bool, outbox: &mut Outbox, shared: &Shared<'_>) -> Option<Listing> {
    if !is_asked {
        shared.line.reset();
        shared.wanted_line.signal(after);
        return Some(Listing::Log { after, is_asked: true });
    }
    match shared.line.try_take() {
        None => Some(Listing::Log { after, is_asked: true }),
        Some(None) => {
            outbox.put(answer::done("log").as_ref());
            None
        }
        Some(Some(record)) => Some(record_on(record, 0, outbox)),
    }
}

/// Puts a part of a record, after whose last part the next record is next.
fn record_on(record: LogRecord, part: u8, outbox: &mut Outbox) -> Listing {
    let (number, content) = record;
    let mut parts = content.chunks(answer::PART).skip(part.into());
    let sentence = parts.next().and_then(|bytes| answer::record(number, part, bytes));
    outbox.put(sentence.as_ref());
    if parts.next().is_some() {
        Listing::Record { record, part: part + 1 }
    } else {
        Listing::Log { after: number, is_asked: false }
    }
}
