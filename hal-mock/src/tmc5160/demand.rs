//! What the registers ask of the ramp: its corners, its slopes and the way it takes to brake.

use super::map::{ADDRESSES, address};

/// Bits below one unit of the chip's velocity.
pub(super) const VELOCITY_BITS: u32 = 17;

/// Bits below one microstep.
pub(super) const FRACTION_BITS: u32 = 42;

/// Microsteps to brake from a velocity with the weaker slope, v²/a/2⁸ (12.1), rounded up.
fn zone(velocity: i64, slope: i64) -> u64 {
    let square = velocity.unsigned_abs() * velocity.unsigned_abs();
    square.checked_div(slope.unsigned_abs() << 8).map_or(u64::MAX >> 1, |way| way + 1)
}

/// Motion with one acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Segment {
    /// Change of velocity per clock.
    pub rate: i64,
    /// The velocity with which it ends.
    pub until: i64,
}

impl Segment {
    /// Whether a velocity lies beyond its end; rest is a corner of its own.
    pub fn is_left_at(self, velocity: i64) -> bool {
        let beyond = (velocity - self.until) * self.rate.signum();
        beyond > 0 || (beyond == 0 && self.until == 0 && self.rate != 0)
    }
}

/// RAMPMODE.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Mode {
    /// Ramps to XTARGET.
    #[default]
    Position,
    /// Ramps to +VMAX by AMAX.
    Forward,
    /// Ramps to −VMAX by AMAX.
    Backward,
    /// Keeps the velocity.
    Hold,
}

/// What the registers ask for; velocities as fine as the ramp keeps them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Demand {
    /// How the other registers are to be taken.
    pub mode: Mode,
    /// XTARGET, microsteps.
    pub target: i32,
    /// VSTART, 2⁻¹⁷ units.
    pub start: i64,
    /// A1, change of the fine velocity per clock.
    first: i64,
    /// V1, 2⁻¹⁷ units.
    knee: i64,
    /// AMAX, change of the fine velocity per clock.
    acceleration: i64,
    /// VMAX, 2⁻¹⁷ units.
    pub peak: i64,
    /// DMAX, change of the fine velocity per clock.
    deceleration: i64,
    /// D1, change of the fine velocity per clock.
    last: i64,
    /// VSTOP, 2⁻¹⁷ units.
    pub stop: i64,
    /// Clocks of rest after a stop.
    pub rest: u32,
    /// Way to the target in microsteps beyond which a motor up to VMAX need not brake yet.
    zone: u64,
}

impl Demand {
    /// The demand that the registers state.
    pub fn of(registers: &[u32; ADDRESSES]) -> Self {
        let plain = |address: u8| i64::from(registers[usize::from(address)]);
        let fine = |address: u8| plain(address) << VELOCITY_BITS;
        Self {
            mode: match plain(address::RAMPMODE) {
                0 => Mode::Position,
                1 => Mode::Forward,
                2 => Mode::Backward,
                _ => Mode::Hold,
            },
            target: plain(address::XTARGET) as i32,
            start: fine(address::VSTART),
            first: plain(address::A1),
            knee: fine(address::V1),
            acceleration: plain(address::AMAX),
            peak: fine(address::VMAX),
            deceleration: plain(address::DMAX),
            last: plain(address::D1),
            stop: fine(address::VSTOP),
            rest: registers[usize::from(address::TZEROWAIT)] * 512,
            zone: zone(plain(address::VMAX), plain(address::DMAX).min(plain(address::D1))),
        }
    }

    /// DMAX down to V1, D1 down to VSTOP, then on with VSTOP.
    pub fn slow_down(&self, speed: i64) -> (i64, i64) {
        let Demand { knee, stop, deceleration, last, .. } = *self;
        if speed <= stop {
            (0, speed)
        } else if speed > knee {
            (-deceleration, knee.max(stop))
        } else {
            (-last, stop)
        }
    }

    /// A1 below V1 and AMAX above it, up or down to VMAX (12.2.5).
    pub fn adapt(&self, speed: i64) -> (i64, i64) {
        let Demand { knee, peak, first, acceleration, .. } = *self;
        match speed.cmp(&peak) {
            core::cmp::Ordering::Less if speed < knee => (first, peak.min(knee)),
            core::cmp::Ordering::Less => (acceleration, peak),
            core::cmp::Ordering::Equal => (0, peak),
            core::cmp::Ordering::Greater if speed > knee => (-acceleration, peak.max(knee)),
            core::cmp::Ordering::Greater => (-first, peak),
        }
    }

    /// Velocity mode: AMAX alone (12.2.3).
    pub fn follow(&self, speed: i64, along: bool) -> (i64, i64) {
        let goal = if along { self.peak } else { 0 };
        (self.acceleration * (goal - speed).signum(), goal)
    }

    /// Whether the way to come down from a speed to VSTOP is longer than the way left, 2⁻⁴² microsteps.
    pub fn must_brake(&self, speed: i64, way: i128) -> bool {
        let Demand { knee, stop, deceleration, last, .. } = *self;
        let square = |velocity: i64| i128::from(velocity) * i128::from(velocity);
        let knee = knee.max(stop);
        let (upper, lower) = (i128::from(deceleration), i128::from(last));
        let is_far = speed <= self.peak && way >> FRACTION_BITS > i128::from(self.zone);
        if speed <= stop || is_far {
            false
        } else if knee == stop {
            square(speed) - square(stop) > way * upper
        } else if speed <= knee {
            square(speed) - square(stop) > way * lower
        } else {
            (square(speed) - square(knee)) * lower + (square(knee) - square(stop)) * upper
                > way * upper * lower
        }
    }
}
