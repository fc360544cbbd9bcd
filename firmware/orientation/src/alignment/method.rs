//! What every method of alignment does: takes samples, requests motion, reports its progress, and
//! comes to a verdict.
//!
//! ```text
//!  samples, end, failure ─▶ take ─┬─▶ request: point, turn, let drive ─▶ mechanism, driver
//!                                 └─▶ compute (plans, noise fits, conclusions: up to a second)
//!                           both ─▶ progress ─▶ log, link
//! ```
//!
//! A method has no clock: time is in its samples, so that a recording replays the alignment that a
//! board made.

use super::progress::Listener;
use super::refusal::Refusal;
use super::rotating::misalignment::AxisMisalignment;
use super::verdict::Verdict;
use crate::signal::SwayNoise;
use crate::units::{Metres, Radians, RadiansPerSecond};

/// Input of an alignment whose samples are of the type `S`.
#[derive(Clone, Copy, Debug)]
pub enum Input<'a, S> {
    /// A sample.
    Sample(&'a S),
    /// Noise that the compensated sway of the base leaves in the samples, before the first of them.
    Sway(&'a SwayNoise),
    /// Answer to [`Request::Locate`]: displacement of the vehicle, north and east, from a point
    /// that stays the same.
    Displaced(&'a [Metres; 2]),
    /// The end of the samples.
    End,
    /// A permanent failure of the instrument.
    Failed(&'a Refusal),
}

/// Request of an alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// Continue sampling.
    Continue,
    /// Point the gyro at this stage angle, not wrapped to one turn.
    Point(Radians),
    /// Turn the platform at this rate, clockwise positive; zero brings it to rest.
    Turn(RadiansPerSecond),
    /// Stand as the azimuth is held best: a two-frame mount with the sensitive axis vertical, a platform that turns
    /// at rest.
    Vertical,
    /// State how far the vehicle has driven, if that is known, by [`Input::Displaced`].
    Locate,
    /// The vehicle may drive on.
    MayDrive,
    /// Call [`Method::compute`]; samples are passed by until then.
    Compute,
    /// The alignment is over and its verdict is final.
    Done,
}

/// A method of alignment, or of tracking a roll, whose samples are of the type `S`. It is used as a
/// trait object, so that an image with several methods contains one instrument.
pub trait Method<S> {
    /// Begins the alignment, also anew after one that is over: all fields are reset in place.
    /// Returns [`Request::Done`] where the alignment is refused before anything moves.
    fn begin(&mut self, listener: Listener) -> Request;

    /// Takes an input, within bounded time.
    fn take(&mut self, input: Input<'_, S>, listener: Listener) -> Request;

    /// Computes what the latest request announced.
    fn compute(&mut self, listener: Listener) -> Request;

    /// The verdict; [`None`] until the alignment is over.
    fn verdict(&self) -> Option<Verdict>;

    /// Standard deviation of the azimuth that is required, 1σ; [`None`] from a method that determines none.
    fn required_sigma(&self) -> Option<Radians> {
        None
    }

    /// The axis misalignment that the alignment has found at the speed of this index, to be saved
    /// against a loss of supply; [`None`] from any method without rate-modulated turns.
    fn misalignment(&self, _speed: usize) -> Option<AxisMisalignment> {
        None
    }

    /// Takes an input and computes at once what it requires, without reports.
    fn feed(&mut self, input: Input<'_, S>) -> Request {
        match self.take(input, &mut |_| ()) {
            Request::Compute => self.compute(&mut |_| ()),
            other => other,
        }
    }
}
