//! Progress of the tracking of a roll, with the sentences of the log.

use super::state::{Condition, State};
use crate::alignment::Refusal;
use crate::units::{DEGREES_PER_RADIAN as DEGREES, Radians, Seconds, TURN, wrapped};
use crate::words::Rounded;

/// Progress of the tracking of a roll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The tracking begins.
    Begun,
    /// The source of the roll estimate from now on.
    Changed(State),
    /// The modulation of the lift is detected again, after this time.
    LiftBack(Seconds),
    /// The roll at present, since the first sample, its 1σ, and its source; for the status,
    /// not for the log.
    Tracked(Radians, Option<Radians>, Condition),
    /// The flight is over: the roll since the first sample, positive in the sense of positive
    /// roll, and its 1σ, if the roll is known.
    Flown(Radians, Option<Radians>),
    /// The tracking has ended, because a sensor was given up.
    Ended(Refusal),
}

crate::words! { Progress:
    Self::Begun => "begin: following the roll of a spinning body";
    Self::Changed(state) => "roll: {}", state;
    Self::LiftBack(seconds) => "roll: locked, the lift is back after {} s", Rounded::<2>(seconds.0);
    Self::Tracked(roll, ..) => "roll {}°", Rounded::<3>(wrapped(roll.0) * DEGREES);
    Self::Flown(roll, Some(sigma)) =>
        "flown: {} turns and {}° ± {}° (1σ)",
        turns(roll.0), Rounded::<4>(wrapped(roll.0) * DEGREES), Rounded::<4>(sigma.degrees());
    Self::Flown(roll, None) =>
        "flown: {} turns and {}°, not known", turns(roll.0), Rounded::<1>(wrapped(roll.0) * DEGREES);
    Self::Ended(reason) => "no roll: {}", reason;
}

/// Number of whole turns of a roll, rad.
fn turns(roll: f64) -> i32 {
    libm::floor(roll / TURN) as i32
}
