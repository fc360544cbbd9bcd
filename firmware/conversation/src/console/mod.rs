//! Commands and settings over the link, while it is sending.
//!
//! ```text
//!  bytes ─▶ lines and frames ─▶ console ─▶ orders to the aligner, an azimuth to the navigator
//!                                  │  └──▶ errands to the store: a record of settings, the lines of the log
//!                                  └─────▶ answers, in the form of their questions
//! ```
//!
//! | file | what it is |
//! |---|---|
//! | `commands.rs` | what a command does, whatever its form |
//! | `lines.rs` | commands as lines of text, answered by sentences |
//! | `frames.rs` | parameters and commands of MAVLink, answered by messages |
//! | `identity.rs` | what the instrument is, by names beside those of its settings |
//! | `listing.rs` | answers of many parts, which take their time |
//!
//! It runs beside the link, so that it answers also while a conclusion is computed; only what the store has to do waits for
//! that. Whatever is received: without a valid command nothing changes but what the link says.

mod commands;
mod frames;
mod identity;
mod lines;
mod listing;

pub use commands::Refused;

use firmware::settings::{Editable, Serial, SettingsError};
use firmware::shared::Shared;
use orientation::earth::{HIGHEST_LATITUDE, Latitude};
use protocol::answer;
use protocol::mavlink::{self, MavResult, acknowledgement, request};
use protocol::position;
use protocol::receiver::Received;

use super::outbox::Outbox;
use listing::Listing;

/// Who waits for what the store has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Requester {
    /// Who has sent a line.
    Line,
    /// Who has sent this command of MAVLink.
    Frame(mavlink::Command),
}

/// Takes commands, and answers them.
pub struct Console {
    /// Serial number of the controller.
    serial: Serial,
    /// Starts the instrument anew.
    reboot: fn(),
    /// An answer that has not been sent to its end.
    listing: Option<Listing>,
    /// Who waits for the settings to be kept.
    saving: Option<Requester>,
    /// Whether the instrument is to be started anew once the answer is sent.
    reboots: bool,
    /// Checksum of the settings that the instrument has begun with, once others may hold.
    begun: Option<u32>,
}

impl Console {
    /// A console that was asked nothing.
    pub(super) const fn new(serial: Serial, reboot: fn()) -> Self {
        Self { serial, reboot, listing: None, saving: None, reboots: false, begun: None }
    }

    /// Takes what was received, as far as it is for this instrument, and answers it.
    pub(super) fn take(
        &mut self,
        received: &Received<'_>,
        settings: &mut dyn Editable,
        outbox: &mut Outbox,
        shared: &Shared<'_>,
    ) {
        match received {
            Received::Line(line) => match position::latitude(line) {
                Some(latitude) => take_latitude(latitude, settings, shared),
                None => self.take_line(line, settings, outbox, shared),
            },
            Received::Frame(frame) => {
                if let Some(request) = request(frame, &outbox.sender) {
                    self.take_request(request, settings, outbox, shared);
                }
            }
        }
    }

    /// Goes on with what has waited; whether it put a part of an answer to what is sent.
    pub(super) fn go_on(
        &mut self,
        settings: &mut dyn Editable,
        outbox: &mut Outbox,
        shared: &Shared<'_>,
    ) -> bool {
        shared.go_on();
        if let Some(requester) = self.saving
            && let Some(outcome) = shared.kept.try_take()
        {
            self.saving = None;
            answer_save(requester, outcome, outbox);
            return true;
        }
        self.list_on(settings, outbox, shared)
    }

    /// Starts the instrument anew, where that was ordered, and nothing is being kept; its answer has been sent.
    pub(super) fn finish(&mut self) {
        if self.saving.is_none() && core::mem::take(&mut self.reboots) {
            (self.reboot)();
        }
    }
}

/// Takes the latitude of a satellite receiver, which holds where the settings state none; one that they could not state is
/// none. What was only waiting for that begins.
fn take_latitude(latitude: Latitude, settings: &dyn Editable, shared: &Shared<'_>) {
    if latitude.rad().abs() > HIGHEST_LATITUDE {
        return;
    }
    shared.latitude.set(Some(latitude));
    if shared.is_waiting() {
        let start = settings.start();
        if start.is_at_power_on && start.stated.is_none() {
            shared.begin.signal(());
        }
    }
}

/// Answers who has had the settings kept.
fn answer_save(requester: Requester, outcome: Result<(), SettingsError>, outbox: &mut Outbox) {
    match requester {
        Requester::Line => {
            let sentence = match outcome {
                Ok(()) => answer::done("save"),
                Err(error) => answer::refused("save", error),
            };
            outbox.put(sentence.as_ref());
        }
        Requester::Frame(command) => {
            let result = match outcome {
                Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
                Err(_) => MavResult::MAV_RESULT_FAILED,
            };
            outbox.put_message(&acknowledgement(&command, result));
        }
    }
}
