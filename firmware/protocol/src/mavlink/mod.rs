//! Messages of MAVLink 2: the instrument is the component of an inertial measurement unit beside an autopilot.
//!
//! | message | what | while it is not valid |
//! |---|---|---|
//! | [`heartbeat`] | the component and its state | |
//! | [`sys_status`] | which sensors work | the azimuth's bit is not healthy |
//! | [`attitude_quaternion`] | attitude | it is not sent |
//! | [`vision_position_estimate`] | azimuth, pitch and roll for an autopilot to fuse | it is not sent |
//! | [`statustext`] | words | |
//!
//! What it is asked, and its answers, are in `requests.rs`.
//!
//! An autopilot fuses the azimuth of [`vision_position_estimate`] alone, which none of the others carries to it; the message
//! has no sign of its validity.

mod payload;
mod requests;
mod telemetry;

pub use payload::Acknowledgement;
pub use requests::{
    Action, Command, HEARTBEAT, MavResult, Name, Request, acknowledgement, interval, parameter,
    request,
};
pub use telemetry::{
    WORDS, attitude_quaternion, heartbeat, statustext, sys_status, vision_position_estimate,
};

pub use mavlink::MessageData;
pub use mavlink::dialects::common::MavSeverity;
use mavlink::{MAVLinkV2MessageRaw, MavHeader};

/// A frame as it is sent.
pub type Frame = MAVLinkV2MessageRaw;

/// Who sends: the instrument's place in a MAVLink network.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sender {
    /// Number of the system, that of the autopilot to which the instrument belongs, from 1 on. With 255 an instrument
    /// would pass for a ground station.
    pub system: u8,
    /// Number of the component in it; 200 to 202 are those of inertial measurement units.
    pub component: u8,
    /// Number of the next frame, by which receivers count those that are lost.
    sequence: u8,
}

/// Number of the component `MAV_COMP_ID_IMU`.
const IMU: u8 = 200;

impl Sender {
    /// The first inertial measurement unit of a system.
    #[must_use]
    pub const fn of_system(system: u8) -> Self {
        Self { system, component: IMU, sequence: 0 }
    }

    /// A frame with a message.
    pub fn frame<M: MessageData>(&mut self, message: &M) -> Frame {
        let mut frame = Frame::new();
        let header = MavHeader {
            system_id: self.system.into(),
            component_id: self.component,
            sequence: self.sequence,
        };
        frame.serialize_message_data(header, message);
        self.sequence = self.sequence.wrapping_add(1);
        frame
    }
}
