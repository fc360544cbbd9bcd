//! The ramp generator (data sheet, chapter 12) in exact integers.
//!
//! The chip's velocity grows by its acceleration every 2¹⁷ clocks, and its position by its velocity
//! every 2²⁴. A velocity kept 2¹⁷ times larger therefore grows by the acceleration every clock, and a
//! position kept 2⁴² times larger by the sum of the velocities before and after it: nothing is ever
//! rounded, and the way to brake from v is v²/a in these units. A step that would cross a corner of
//! the ramp is halved until the corner is met to one clock, so a corner costs about thirty short
//! evaluations and all other milliseconds one.

use super::demand::{Demand, FRACTION_BITS, Mode, Segment, VELOCITY_BITS};

/// Less than this remains where the step counter arrives.
const HALF_STEP: i128 = 1 << (FRACTION_BITS - 1);

/// Braking aims so far before the target, which hides what the corners cost: one clock at V1 is at
/// most 2²⁰/2²⁴ of a microstep.
const MARGIN: i128 = 1 << (FRACTION_BITS - 2);

/// Where the motor's field stands and how fast it turns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Motion {
    /// Where the field stands, whole microsteps.
    pub field: i64,
    /// How far it stands beyond, 2⁻⁴² microsteps, ≥ 0.
    pub fraction: i64,
    /// How fast it turns, 2⁻¹⁷ units of VACTUAL.
    pub velocity: i64,
}

impl Motion {
    /// The motion after `clocks` clocks in which the velocity changes by `rate` each clock.
    fn after(self, clocks: u32, rate: i64) -> Self {
        let clocks = i64::from(clocks);
        let velocity = self.velocity + rate * clocks;
        let way = self.fraction + (self.velocity + velocity) * clocks;
        Self {
            field: self.field + (way >> FRACTION_BITS),
            fraction: way & ((1 << FRACTION_BITS) - 1),
            velocity,
        }
    }
}

/// What ends a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Corner {
    /// From here on the way left is needed to brake.
    Brake,
    /// The velocity of the segment's end.
    Velocity,
    /// The target.
    Target,
}

/// How near the target is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Approach {
    /// The target is too far off to brake for it.
    #[default]
    Free,
    /// One more clock of acceleration would be one too many.
    Coasting,
    /// The way left is what slowing down takes.
    Braking,
}

/// Which directions are shut by reference switches, and how they stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Stops {
    /// The left switch shuts the way back.
    pub backward: bool,
    /// The right switch shuts the way forward.
    pub forward: bool,
    /// A shut direction is left by the ramp, not at once.
    pub soft: bool,
}

/// The ramp generator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Ramp {
    /// Where the field is, and how fast it turns.
    pub motion: Motion,
    /// The field where XACTUAL is 0.
    origin: i64,
    /// What the registers ask for.
    demand: Demand,
    /// What the switches shut.
    stops: Stops,
    /// How near the target is.
    approach: Approach,
    /// Clocks of rest that are left.
    resting: u32,
    /// The motor may not move until the stall is cleared.
    pub stalled: bool,
    /// The ramp had to move back.
    pub second_move: bool,
}

impl Ramp {
    /// A standing motor, drawn to a field.
    pub fn at(field: i64) -> Self {
        Self { motion: Motion { field, ..Motion::default() }, origin: field, ..Self::default() }
    }

    /// XACTUAL; it wraps around (6.3.1, XTARGET).
    pub fn position(&self) -> i32 {
        (self.motion.field - self.origin) as i32
    }

    /// Whole microsteps to the target.
    fn distance(&self, motion: Motion) -> i32 {
        self.demand.target.wrapping_sub((motion.field - self.origin) as i32)
    }

    /// The way to the target, in 2⁻⁴² microsteps.
    fn remaining(&self, motion: Motion) -> i128 {
        (i128::from(self.distance(motion)) << FRACTION_BITS) - i128::from(motion.fraction)
    }

    /// VACTUAL, towards zero.
    pub fn velocity(&self) -> i32 {
        (self.motion.velocity / (1 << VELOCITY_BITS)) as i32
    }

    /// Whether XACTUAL is XTARGET.
    pub fn reached(&self) -> bool {
        self.distance(self.motion) == 0
    }

    /// Whether the velocity is that of VMAX, in either direction.
    pub fn at_peak(&self) -> bool {
        self.motion.velocity.abs() == self.demand.peak
    }

    /// Whether TZEROWAIT is being waited out.
    pub fn is_resting(&self) -> bool {
        self.resting > 0
    }

    /// Whether anything moves, or is about to.
    pub fn is_busy(&self) -> bool {
        self.motion.velocity != 0 || self.wanted() != 0
    }

    /// Whether a shut direction holds the motor or slows it down.
    pub fn is_stopped(&self, direction: i64) -> bool {
        let heading = if self.motion.velocity == 0 { self.asked() } else { self.heading() };
        heading == direction && self.is_shut(direction)
    }

    /// Takes new demands; the way to brake is judged anew.
    pub fn ask(&mut self, demand: Demand) {
        self.demand = demand;
        self.approach = Approach::Free;
    }

    /// Sets the step counter.
    pub fn place(&mut self, position: i32) {
        self.origin = self.motion.field - i64::from(position);
        self.approach = Approach::Free;
    }

    /// Shuts and opens directions; a hard stop takes no time.
    pub fn obey(&mut self, stops: Stops) {
        self.stops = stops;
        if !stops.soft && self.motion.velocity != 0 && self.is_shut(self.heading()) {
            self.halt();
        }
    }

    /// Stops at once, on the microstep that XACTUAL shows.
    pub fn halt(&mut self) {
        self.motion.fraction = 0;
        self.motion.velocity = 0;
        self.approach = Approach::Free;
        self.resting = self.demand.rest;
    }

    /// Lets `clocks` clocks pass.
    pub fn advance(&mut self, clocks: u32) {
        let mut left = clocks;
        let mut step = left;
        while left > 0 {
            self.begin();
            if self.resting > 0 {
                left = self.rest(left);
                continue;
            }
            if !self.is_busy() {
                return;
            }
            left -= self.stride(&mut step, left);
        }
    }

    /// Moves a step or halves it; the clocks it took.
    fn stride(&mut self, step: &mut u32, left: u32) -> u32 {
        *step = left.min(*step);
        let segment = self.segment();
        let next = self.motion.after(*step, segment.rate);
        match self.corner(segment, next) {
            None => {
                self.motion = next;
                *step
            }
            Some(_) if *step > 1 => {
                *step = step.div_ceil(2);
                0
            }
            Some(corner) => {
                *step = left;
                self.turn(corner, segment, next)
            }
        }
    }

    /// Waits out TZEROWAIT; the clocks that are left.
    fn rest(&mut self, clocks: u32) -> u32 {
        let pause = self.resting.min(clocks);
        self.resting -= pause;
        clocks - pause
    }

    /// Leaves rest with VSTART, and enters it from VSTOP where the motor must turn back or stop.
    fn begin(&mut self) {
        let velocity = self.motion.velocity;
        if velocity == 0 {
            self.approach = Approach::Free;
            if self.resting == 0 && self.demand.mode == Mode::Position {
                self.motion.velocity = self.wanted() * self.demand.start.min(self.demand.peak);
            }
        } else if self.must_leave() && velocity.abs() <= self.demand.stop {
            self.second_move |= !self.is_shut(velocity.signum());
            self.halt();
        }
    }

    /// Whether the motor must come to rest wherever it is.
    fn must_leave(&self) -> bool {
        self.is_shut(self.heading()) || self.is_leaving()
    }

    /// Whether the motor moves away from its target.
    fn is_leaving(&self) -> bool {
        let positioning = self.demand.mode == Mode::Position;
        positioning && self.motion.velocity != 0 && self.way(self.motion) <= 0
    }

    /// Whether a switch shuts a direction.
    fn is_shut(&self, direction: i64) -> bool {
        (direction < 0 && self.stops.backward) || (direction > 0 && self.stops.forward)
    }

    /// The direction of motion, zero at rest.
    fn heading(&self) -> i64 {
        self.motion.velocity.signum()
    }

    /// The way left in the direction of motion.
    fn way(&self, motion: Motion) -> i128 {
        self.remaining(motion) * i128::from(self.heading())
    }

    /// The direction that the registers ask a standing motor to take.
    fn asked(&self) -> i64 {
        if self.demand.peak == 0 {
            return 0;
        }
        match self.demand.mode {
            Mode::Position => self.remaining(self.motion).signum() as i64,
            Mode::Forward => 1,
            Mode::Backward => -1,
            Mode::Hold => 0,
        }
    }

    /// The direction that a standing motor takes.
    fn wanted(&self) -> i64 {
        let direction = self.asked();
        if self.stalled || self.is_shut(direction) { 0 } else { direction }
    }

    /// The slope that holds now, and the velocity at which it ends.
    fn segment(&self) -> Segment {
        let velocity = self.motion.velocity;
        let heading = if velocity == 0 { self.wanted() } else { velocity.signum() };
        let speed = velocity.abs();
        let (rate, until) = match self.demand.mode {
            _ if self.approach == Approach::Braking || self.must_leave() => {
                self.demand.slow_down(speed)
            }
            Mode::Position if self.approach == Approach::Coasting => (0, speed),
            Mode::Position => self.demand.adapt(speed),
            Mode::Hold => (0, speed),
            Mode::Forward => self.demand.follow(speed, heading > 0),
            Mode::Backward => self.demand.follow(speed, heading < 0),
        };
        Segment { rate: heading * rate, until: heading * until }
    }

    /// What stands between now and a motion within a segment.
    fn corner(&self, segment: Segment, next: Motion) -> Option<Corner> {
        let positioning = self.demand.mode == Mode::Position && !self.must_leave();
        if positioning && self.approach != Approach::Braking && self.must_brake(next) {
            Some(Corner::Brake)
        } else if segment.is_left_at(next.velocity) {
            Some(Corner::Velocity)
        } else if positioning && self.motion.velocity != 0 && self.arrives(next) {
            Some(Corner::Target)
        } else {
            None
        }
    }

    /// Crosses a corner; the clocks it took.
    fn turn(&mut self, corner: Corner, segment: Segment, next: Motion) -> u32 {
        match corner {
            Corner::Brake => {
                let coasts = self.approach == Approach::Free && segment.rate != 0;
                self.approach = if coasts { Approach::Coasting } else { Approach::Braking };
                return 0;
            }
            Corner::Target if next.velocity.abs() <= self.demand.stop => {
                self.motion.field += i64::from(self.distance(self.motion));
                self.motion.fraction = 0;
                self.halt();
            }
            Corner::Target => {
                self.motion = next;
                self.approach = Approach::Free;
            }
            Corner::Velocity => {
                self.motion = Motion { velocity: segment.until, ..next };
                if segment.until == 0 {
                    self.halt();
                }
            }
        }
        1
    }

    /// Whether a motion stands at the target or beyond it.
    fn arrives(&self, next: Motion) -> bool {
        let way = self.way(next);
        way <= 0 || (way < HALF_STEP && next.velocity.abs() <= self.demand.stop)
    }

    /// Whether the way to come down to VSTOP is longer than the way left.
    fn must_brake(&self, next: Motion) -> bool {
        let way = self.remaining(next) * i128::from(next.velocity.signum()) - MARGIN;
        self.demand.must_brake(next.velocity.abs(), way)
    }
}
