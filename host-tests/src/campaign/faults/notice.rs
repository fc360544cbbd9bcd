//! What a board reports that a healthy one does not.

use firmware::event::Event;
use firmware::simulated::fault::Notice;
use orientation::alignment::refusal::Refusal;
use orientation::attitude::Realigned;
use orientation::device::Device;
use orientation::roll::Condition;

/// The first event that reports something wrong.
pub(super) fn first(events: &[Event]) -> Option<&Event> {
    events.iter().find(|event| is_wrong(event))
}

/// Whether what must be noticed was noticed; none where nothing must be.
pub(super) fn is_noticed(notice: Notice, events: &[Event]) -> Option<bool> {
    match notice {
        Notice::Nothing => None,
        Notice::Anything => Some(first(events).is_some()),
        Notice::Named(device) => Some(events.iter().any(|event| blamed(event) == Some(device))),
    }
}

/// The device about which an event reports something wrong.
fn blamed(event: &Event) -> Option<Device> {
    match event {
        Event::Lost(device, _)
        | Event::Clipped(device)
        | Event::Restarting(device, _)
        | Event::GivenUp(device, _)
        | Event::Corrected(device, _)
        | Event::Blocked(device)
        | Event::Refused(Refusal::Device { device, .. })
        | Event::RollEnded(Refusal::Device { device, .. }) => Some(*device),
        _ => None,
    }
}

/// Whether an event reports something wrong.
fn is_wrong(event: &Event) -> bool {
    match event {
        Event::HandedOver(.., outcome) => matches!(outcome, Realigned::Disagrees { .. }),
        Event::Roll(state) => !matches!(state.condition, Condition::Searching | Condition::Locked),
        Event::Missing(_)
        | Event::Late(_)
        | Event::Overflowed(_)
        | Event::CutShort(_)
        | Event::Repeated(..)
        | Event::LeftOut(..)
        | Event::TurnsLeftOut(..)
        | Event::CalibrationUnreadable(_)
        | Event::CalibrationNotSaved(_)
        | Event::NoMotion
        | Event::AzimuthLost
        | Event::BiasBeyondStated
        | Event::RecallRefused(_)
        | Event::HeadingNotKept(_)
        | Event::LinkSilent
        | Event::Refused(_)
        | Event::RollEnded(_) => true,
        other => blamed(other).is_some(),
    }
}
