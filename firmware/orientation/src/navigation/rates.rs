//! How fast the body turns, for those who steer by it.

use crate::attitude::Keeper;
use crate::units::RadiansPerSecond;

/// Part that the rate of turn since the latest look has in its mean: with ten looks a second, the mean is that of about
/// a second.
const SHARE: f32 = 0.1;
/// Rate of turn, look by look.
#[derive(Clone, Debug, Default)]
pub(super) struct Rates {
    /// Mean rate of turn, rad/s.
    turn: Option<f32>,
}

/// Rates of the body at a look.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shown {
    /// About its axes forward, right, down, less their biases: mean since the look before.
    pub body: Option<[RadiansPerSecond; 3]>,
    /// Of its azimuth against north: mean of about a second.
    pub turn: Option<RadiansPerSecond>,
}

impl Rates {
    /// The rates since the latest look.
    pub fn look(&mut self, keeper: &mut Keeper) -> Shown {
        let (body, turn) =
            keeper.take_rates().map_or((None, None), |(body, turn)| (Some(body), turn));
        let mean = |turn: f32| self.turn.map_or(turn, |mean| mean + SHARE * (turn - mean));
        self.turn = turn.map(mean);
        let rate = |rate: f32| RadiansPerSecond(rate.into());
        Shown { body: body.map(|body| body.map(rate)), turn: self.turn.map(rate) }
    }
}
