//! What frames ask of the instrument, and its answers.
//!
//! | message | what is asked | answer |
//! |---|---|---|
//! | `PARAM_REQUEST_LIST`, `PARAM_REQUEST_READ`, `PARAM_SET` | settings, all as `REAL32`, in which both encodings of parameters are the same | [`parameter`] |
//! | `COMMAND_LONG` | an [`Action`] | [`acknowledgement`] |
//! | `GPS_RAW_INT` | the latitude of a satellite receiver | |
//!
//! A command that is unknown, or not possible, to all components of a system is left to the others: an answer might pass
//! for the autopilot's.

use heapless::String;
use mavlink::MessageData;
use mavlink::dialects::common::{
    COMMAND_LONG_DATA, GPS_RAW_INT_DATA, HEARTBEAT_DATA, MESSAGE_INTERVAL_DATA, MavParamType,
    PARAM_REQUEST_LIST_DATA, PARAM_REQUEST_READ_DATA, PARAM_SET_DATA, PARAM_VALUE_DATA,
};
use orientation::earth::Latitude;

pub use mavlink::dialects::common::MavResult;

use super::payload::Payload;
use super::{Acknowledgement, Frame, Sender};

/// Numbers of commands (`MAV_CMD`).
mod numbers {
    pub const PREFLIGHT_CALIBRATION: u16 = 241;
    pub const PREFLIGHT_STORAGE: u16 = 245;
    pub const PREFLIGHT_REBOOT_SHUTDOWN: u16 = 246;
    pub const RUN_PREARM_CHECKS: u16 = 401;
    pub const SET_MESSAGE_INTERVAL: u16 = 511;
    pub const REQUEST_MESSAGE: u16 = 512;
    pub const DO_SET_GLOBAL_ORIGIN: u16 = 611;
}

/// Number of the message that is sent once a second whatever is set.
pub const HEARTBEAT: u32 = HEARTBEAT_DATA::ID;

/// Name of a parameter.
pub type Name = String<16>;

/// What a frame asks.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// The values of all parameters.
    List,
    /// The value of the parameter of this name.
    Read(Name),
    /// The value of the parameter of this number from zero.
    ReadNumber(u16),
    /// The parameter of this name is to have this value.
    Set(Name, f32),
    /// A command.
    Command(Command),
    /// The latitude that a satellite receiver has measured.
    Latitude(Latitude),
}

/// A command with what its answer has to repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// Its number.
    pub number: u16,
    /// System and component that have sent it.
    pub from: [u8; 2],
    /// Whether it is to this component alone.
    pub is_to_this: bool,
    /// What is to be done; [`None`] where it is unknown, or its parameters are not possible.
    pub action: Result<Action, MavResult>,
}

/// What a command has the instrument do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Begins an alignment, anew where one runs (`MAV_CMD_PREFLIGHT_CALIBRATION` of the gyros).
    Align,
    /// Ends the alignment that runs (`MAV_CMD_PREFLIGHT_CALIBRATION` of nothing, by which autopilots end a calibration).
    Stop,
    /// Keeps the settings in flash (`MAV_CMD_PREFLIGHT_STORAGE`, 1).
    Save,
    /// Takes the factory settings (`MAV_CMD_PREFLIGHT_STORAGE`, 2).
    Restore,
    /// States which devices have passed their self-tests (`MAV_CMD_RUN_PREARM_CHECKS`).
    Test,
    /// Starts the instrument anew (`MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN`).
    Reboot,
    /// States the latitude (`MAV_CMD_DO_SET_GLOBAL_ORIGIN`).
    SetLatitude(Latitude),
    /// Sends a message once (`MAV_CMD_REQUEST_MESSAGE`).
    Send(u32),
    /// States the interval of a message (`MAV_CMD_REQUEST_MESSAGE` of `MESSAGE_INTERVAL`).
    StateInterval(u32),
    /// Sends a message so many times a second, zero for never, or as usual (`MAV_CMD_SET_MESSAGE_INTERVAL`).
    SetRate(u32, Option<f32>),
}

/// What a frame asks of the component that `own` sends for; [`None`] where it is for others, or for nobody.
#[must_use]
pub fn request(frame: &Frame, own: &Sender) -> Option<Request> {
    let is_own = |system: u8, component: u8| {
        [0, own.system].contains(&system) && [0, own.component].contains(&component)
    };
    let payload = Payload(frame.payload());
    match frame.message_id() {
        PARAM_REQUEST_LIST_DATA::ID => {
            is_own(payload.byte(0), payload.byte(1)).then_some(Request::List)
        }
        PARAM_REQUEST_READ_DATA::ID if is_own(payload.byte(2), payload.byte(3)) => {
            let number = i16::from_le_bytes(payload.bytes(0));
            let by_name = || payload.name(4).map(Request::Read);
            u16::try_from(number).ok().map(Request::ReadNumber).or_else(by_name)
        }
        PARAM_SET_DATA::ID if is_own(payload.byte(4), payload.byte(5)) => {
            let is_single = payload.byte(22) == MavParamType::MAV_PARAM_TYPE_REAL32 as u8;
            let name = payload.name(6)?;
            // One of another type is not set, and answered by the value that it keeps.
            Some(if is_single { Request::Set(name, payload.float(0)) } else { Request::Read(name) })
        }
        COMMAND_LONG_DATA::ID if is_own(payload.byte(30), payload.byte(31)) => {
            command(frame, &payload, *own).map(Request::Command)
        }
        GPS_RAW_INT_DATA::ID => latitude(&payload).map(Request::Latitude),
        _ => None,
    }
}

/// A command, where it is to this component alone, or one that it obeys.
fn command(frame: &Frame, payload: &Payload<'_>, own: Sender) -> Option<Command> {
    let number = u16::from_le_bytes(payload.bytes(28));
    let is_to_this = payload.byte(31) == own.component;
    let action = action(number, payload, is_to_this, own);
    let from = [frame.system_id() as u8, frame.component_id()];
    (is_to_this || action.is_ok()).then_some(Command { number, from, is_to_this, action })
}

/// Kinds of a position that was measured in three dimensions (`GPS_FIX_TYPE`): 3D, differential, real-time kinematic, and
/// precise point positioning. 7 is a position that was surveyed.
const MEASURED: [u8; 5] = [3, 4, 5, 6, 8];

/// The latitude of a position that was measured in three dimensions.
fn latitude(payload: &Payload<'_>) -> Option<Latitude> {
    let latitude = i32::from_le_bytes(payload.bytes(8));
    let is_measured = MEASURED.contains(&payload.byte(28));
    Latitude::from_degrees(f64::from(latitude) * 1e-7).filter(|_| is_measured)
}

/// Numbers of the actions in the first parameter of `MAV_CMD_PREFLIGHT_STORAGE`: save, take the factory settings.
const STORAGE: [f32; 2] = [1.0, 2.0];
/// The action in the first or third parameter of `MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN`.
const REBOOT: f32 = 1.0;
/// Microseconds of a second.
const SECOND: f32 = 1e6;

/// What a command asks.
fn action(
    number: u16,
    payload: &Payload<'_>,
    is_to_this: bool,
    own: Sender,
) -> Result<Action, MavResult> {
    let denied = MavResult::MAV_RESULT_DENIED;
    let [first, second, third, fourth, fifth] =
        [0, 4, 8, 12, 16].map(|offset| payload.float(offset));
    let message = |number: f32| if number >= 0.0 { Ok(number as u32) } else { Err(denied) };
    match number {
        numbers::PREFLIGHT_CALIBRATION if first == 1.0 && is_to_this => Ok(Action::Align),
        // All seven parameters are zero.
        numbers::PREFLIGHT_CALIBRATION if payload.bytes(0) == [0; 28] && is_to_this => {
            Ok(Action::Stop)
        }
        numbers::PREFLIGHT_STORAGE if first == STORAGE[0] => Ok(Action::Save),
        numbers::PREFLIGHT_STORAGE if first == STORAGE[1] && is_to_this => Ok(Action::Restore),
        numbers::RUN_PREARM_CHECKS => Ok(Action::Test),
        numbers::PREFLIGHT_REBOOT_SHUTDOWN => {
            // The first parameter is the autopilot's, unless the command is to this component alone.
            let is_named = [0.0, f32::from(own.component)].contains(&fourth);
            let is_meant =
                (is_to_this && first == REBOOT) || (third == REBOOT && (is_to_this || is_named));
            if is_meant { Ok(Action::Reboot) } else { Err(denied) }
        }
        numbers::DO_SET_GLOBAL_ORIGIN if is_to_this => {
            Latitude::from_degrees(fifth.into()).map(Action::SetLatitude).ok_or(denied)
        }
        numbers::REQUEST_MESSAGE if message(first)? == MESSAGE_INTERVAL_DATA::ID => {
            Ok(Action::StateInterval(message(second)?))
        }
        numbers::REQUEST_MESSAGE => Ok(Action::Send(message(first)?)),
        numbers::SET_MESSAGE_INTERVAL => {
            let rate = match second {
                -1.0 => Some(0.0),
                0.0 => None,
                interval => {
                    let rate = libm::roundf(SECOND / interval);
                    // Not less than once in two seconds.
                    if rate >= 1.0 { Some(rate) } else { return Err(denied) }
                }
            };
            Ok(Action::SetRate(message(first)?, rate))
        }
        numbers::PREFLIGHT_CALIBRATION | numbers::PREFLIGHT_STORAGE => Err(denied),
        _ => Err(MavResult::MAV_RESULT_UNSUPPORTED),
    }
}

/// The value of the parameter of this number among so many.
#[must_use]
pub fn parameter(name: &str, value: f64, [number, count]: [u16; 2]) -> PARAM_VALUE_DATA {
    PARAM_VALUE_DATA {
        param_value: value as f32,
        param_count: count,
        param_index: number,
        param_id: name.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    }
}

/// The answer to a command.
#[must_use]
pub const fn acknowledgement(command: &Command, result: MavResult) -> Acknowledgement {
    Acknowledgement { number: command.number, result, to: command.from }
}

/// The interval of a message that is sent so many times a second, zero for never; [`None`] for one that is never sent.
#[must_use]
pub fn interval(message: u32, rate: Option<u8>) -> MESSAGE_INTERVAL_DATA {
    let interval_us = match rate {
        None => 0,
        Some(0) => -1,
        Some(rate) => (SECOND as i32) / i32::from(rate),
    };
    MESSAGE_INTERVAL_DATA { interval_us, message_id: message as u16 }
}
