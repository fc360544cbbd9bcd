//! Parameters and commands of MAVLink, answered by messages.

use firmware::settings::{EditError, Editable, Format, Item, Stated};
use firmware::shared::Shared;
use orientation::units::Radians;
use protocol::mavlink::{
    Action, Command, HEARTBEAT, MavResult, MavSeverity, Request, acknowledgement, interval,
    parameter, statustext,
};
use protocol::words::Words;

use super::commands::stop;
use super::listing::Listing;
use super::{Console, Outbox, Refused, Requester, take_latitude};
use crate::reporter::put_now;

/// The name of the setting of the latitude.
const LATITUDE: &str = "latitude";

impl Console {
    /// Does what a frame asks, and answers it.
    pub(super) fn take_request(
        &mut self,
        request: Request,
        settings: &mut dyn Editable,
        outbox: &mut Outbox,
        shared: &Shared<'_>,
    ) {
        match request {
            Request::Latitude(latitude) => take_latitude(latitude, settings, shared),
            Request::List => outbox.put(self.begin(Listing::Parameters(0)).as_ref()),
            Request::ReadNumber(number) => {
                put_parameter(number.into(), settings, outbox);
            }
            Request::Read(name) => put_parameter_of(&name, Ok(()), settings, outbox),
            Request::Set(name, value) => {
                let places = settings.get(&name).map_or(0, |stated| stated.places);
                let outcome = self.set(&name, shortest(value, places), settings, shared);
                put_parameter_of(&name, outcome, settings, outbox);
            }
            Request::Command(command) => self.take_command(command, settings, outbox, shared),
        }
    }

    /// Obeys a command, and answers it.
    fn take_command(
        &mut self,
        command: Command,
        settings: &mut dyn Editable,
        outbox: &mut Outbox,
        shared: &Shared<'_>,
    ) {
        let result = match command.action {
            Err(result) => result,
            Ok(Action::Save) => match self.save(Requester::Frame(command), shared) {
                Ok(()) => return,
                Err(reason) => result_of(Err(reason)),
            },
            Ok(Action::Test) => send(Item::SysStatus, outbox, shared),
            Ok(Action::Send(number)) => Item::of_message(number)
                .map_or(MavResult::MAV_RESULT_DENIED, |item| send(item, outbox, shared)),
            Ok(Action::StateInterval(number)) => {
                let output = shared.output.get();
                let rate = match Item::of_message(number) {
                    Some(item) => Some(output.rate(item)),
                    None if number == HEARTBEAT && output.format == Format::Mavlink => Some(1),
                    None => None,
                };
                outbox.put_message(&interval(number, rate));
                MavResult::MAV_RESULT_ACCEPTED
            }
            Ok(action) => self.act(action, settings, shared),
        };
        // What is not done of an order to all is left to the others: an answer might pass for the autopilot's.
        if command.is_to_this || result == MavResult::MAV_RESULT_ACCEPTED {
            outbox.put_message(&acknowledgement(&command, result));
        }
    }

    /// Does what a command orders that has no other answer; what came of it.
    fn act(
        &mut self,
        action: Action,
        settings: &mut dyn Editable,
        shared: &Shared<'_>,
    ) -> MavResult {
        let done = match action {
            Action::Align => self.realign(settings, shared),
            Action::Stop => stop(shared),
            Action::Restore => self.restore(settings, shared),
            Action::Reboot => {
                self.reboots = true;
                Ok(())
            }
            Action::SetLatitude(latitude) => {
                self.set(LATITUDE, Radians(latitude.rad()).degrees(), settings, shared)
            }
            Action::SetRate(number, rate) => match Item::of_message(number) {
                Some(item) => {
                    let rate = rate.unwrap_or_else(|| item.usual_rate().into());
                    self.set(item.rate_name(), rate.into(), settings, shared)
                }
                None => Err(Refused::Setting(EditError::Unknown)),
            },
            Action::Save | Action::Test | Action::Send(_) | Action::StateInterval(_) => Ok(()),
        };
        result_of(done)
    }
}

/// The result of a command of which this came.
const fn result_of(done: Result<(), Refused>) -> MavResult {
    match done {
        Ok(()) => MavResult::MAV_RESULT_ACCEPTED,
        Err(Refused::Setting(_) | Refused::Azimuth) => MavResult::MAV_RESULT_DENIED,
        Err(_) => MavResult::MAV_RESULT_TEMPORARILY_REJECTED,
    }
}

/// Sends a message once, in front of the answer to the command for it; the result of that.
fn send(item: Item, outbox: &mut Outbox, shared: &Shared<'_>) -> MavResult {
    if put_now(item, outbox, shared) {
        MavResult::MAV_RESULT_ACCEPTED
    } else {
        MavResult::MAV_RESULT_TEMPORARILY_REJECTED
    }
}

/// Puts the value of the parameter of this number; whether there is one.
pub(super) fn put_parameter(
    number: usize,
    settings: &mut dyn Editable,
    outbox: &mut Outbox,
) -> bool {
    let stated = settings.nth(number);
    if let Some(stated) = stated {
        put_stated((number, stated), settings, outbox);
    }
    stated.is_some()
}

/// Puts a parameter by its number.
fn put_stated(
    (number, Stated { name, value, .. }): (usize, Stated),
    settings: &mut dyn Editable,
    outbox: &mut Outbox,
) {
    outbox.put_message(&parameter(name, value, [number as u16, settings.count() as u16]));
}

/// Puts the value of the parameter of this name as it is now; words where there is none, or where it is not as it was
/// ordered.
fn put_parameter_of(
    name: &str,
    outcome: Result<(), Refused>,
    settings: &mut dyn Editable,
    outbox: &mut Outbox,
) {
    let reason = match settings.numbered(name) {
        Some(numbered) => {
            put_stated(numbered, settings, outbox);
            outcome.err()
        }
        None => Some(Refused::Setting(EditError::Unknown)),
    };
    if let Some(reason) = reason {
        let words = format_args!("{name}: {reason}");
        let severity = MavSeverity::MAV_SEVERITY_WARNING;
        outbox.put_message(&statustext(severity, [0, 0], Words(&words)));
    }
}

/// The number with the fewest decimal places, so many at most, that a number of single precision stands for.
fn shortest(value: f32, places: u8) -> f64 {
    let exact = f64::from(value);
    let rounded = (0..=places).map(|places| {
        let unit = (0..places).fold(1.0, |unit, _| unit * 10.0);
        libm::round(exact * unit) / unit
    });
    let mut fitting = rounded.filter(|rounded| *rounded as f32 == value);
    fitting.next().unwrap_or(exact)
}
