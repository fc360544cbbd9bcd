//! What a board reports that a healthy one does not.

use firmware::event::Event;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::{Progress, rotating, stepwise};
use orientation::attitude::Realigned;
use orientation::device::Device;
use orientation::navigation;
use orientation::roll::{self, Condition};
use simulated::fault::Notice;

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
        | Event::CurrentOff(device)
        | Event::Alignment(
            Progress::Refused(Refusal::Device { device, .. })
            | Progress::Roll(roll::Progress::Ended(Refusal::Device { device, .. })),
        ) => Some(*device),
        _ => None,
    }
}

/// Whether an event reports something wrong.
pub(crate) fn is_wrong(event: &Event) -> bool {
    match event {
        Event::Navigation(navigation::Progress::HandedOver(_, outcome)) => {
            matches!(outcome, Realigned::Disagrees { .. })
        }
        Event::Alignment(Progress::Roll(roll::Progress::Changed(state))) => {
            !matches!(state.condition, Condition::Searching | Condition::Locked)
        }
        Event::Missing(_)
        | Event::Late(_)
        | Event::Overflowed(_)
        | Event::Alignment(
            Progress::Stepwise(
                stepwise::Progress::CutShort(_)
                | stepwise::Progress::Repeated(..)
                | stepwise::Progress::LeftOut(..),
            )
            | Progress::Rotating(rotating::Progress::LeftOut(..))
            | Progress::Roll(roll::Progress::Ended(_))
            | Progress::Refused(_),
        )
        | Event::Navigation(
            navigation::Progress::NoMotion
            | navigation::Progress::TooLate
            | navigation::Progress::AidingUnusable
            | navigation::Progress::AzimuthLost
            | navigation::Progress::BiasBeyondStated
            | navigation::Progress::RecallRefused(_)
            | navigation::Progress::Refused(_),
        )
        | Event::CalibrationUnreadable(_)
        | Event::CalibrationNotSaved(_)
        | Event::HeadingNotKept(_)
        | Event::LinkSilent => true,
        other => blamed(other).is_some(),
    }
}
