//! One whole turn of the platform as phasors, and the stretch of turns at one speed in one sense.

use heapless::Vec;

use super::part::AXES;
use crate::align::regression::{Column, Regression};
use crate::signal::phasor::{COLUMNS, COSINE, ONE, RATE, Reference, SINE, Sums, TIME, TURNING};

/// Most turns that are kept apart in a stretch; of more, neighbours are joined.
pub const TURNS: usize = 32;

/// What one turn, or several neighbours, left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// Coefficients of cosine and sine in the gyro's rate, rad/s.
    pub rate: [f32; 2],
    /// In the platform's rate, rad/s.
    pub turning: [f32; 2],
    /// In the time itself, s: what a slope of 1 rad/s² of the rate would add to `rate`.
    pub leak: [f32; 2],
    /// In the force along the sensitive axis, m/s².
    pub force: [f32; 2],
    /// In the force 90° clockwise of it, m/s²; zeros where nothing reads that axis.
    pub across: [f32; 2],
    /// Mean force along the sensitive axis, m/s².
    pub mean_force: f32,
    /// Mean of the gyro's rate, rad/s.
    pub offset: f32,
    /// Time of its middle since the stretch's first turn, s.
    pub middle: f32,
    /// Its length, s.
    pub seconds: f32,
    /// Mean rate of the platform, rad/s, clockwise positive.
    pub speed: f32,
}

/// A constant, cosine and sine.
const PHASOR: [Column; COLUMNS] = {
    let mut model = [Column::Absent; COLUMNS];
    model[ONE] = Column::Free;
    model[COSINE] = Column::Free;
    model[SINE] = Column::Free;
    model
};

/// Mean and coefficients of cosine and sine; `None` where the platform did not turn round.
#[must_use]
pub fn phasor(regression: &Regression<COLUMNS>) -> Option<(f64, [f32; 2])> {
    let found = regression.solve(&PHASOR)?.coefficients;
    Some((found[ONE], [found[COSINE] as f32, found[SINE] as f32]))
}

impl Turn {
    /// From the sums of a whole turn of `seconds` that began at `since` µs in its stretch, and the
    /// regressions of its forces; `None` where either does not go round.
    #[must_use]
    pub fn of(
        sums: &Sums,
        reference: &Reference,
        since: u64,
        seconds: f64,
        forces: &[Regression<COLUMNS>; AXES],
    ) -> Option<Self> {
        let (offset, rate) = phasor(&sums.regression(RATE))?;
        let (speed, turning) = phasor(&sums.regression(TURNING))?;
        let (middle, leak) = phasor(&sums.regression(TIME))?;
        let [along, across] = forces;
        let (mean_force, force) = phasor(along)?;
        let (_, across) = phasor(across)?;
        let begun = reference.time.saturating_sub(since) as f64 * 1e-6;
        Some(Self {
            rate,
            turning,
            leak,
            force,
            across,
            mean_force: mean_force as f32,
            offset: (offset + f64::from(reference.rate) * 1e-9) as f32,
            middle: (begun + middle) as f32,
            seconds: seconds as f32,
            speed: (f64::from(reference.turning) + speed) as f32,
        })
    }

    /// This turn and another as one: means weighted by their lengths.
    fn joined(&self, other: &Self) -> Self {
        let seconds = self.seconds + other.seconds;
        let share = other.seconds / seconds;
        let mean = |a: f32, b: f32| a + (b - a) * share;
        let pair = |a: [f32; 2], b: [f32; 2]| [mean(a[0], b[0]), mean(a[1], b[1])];
        Self {
            rate: pair(self.rate, other.rate),
            turning: pair(self.turning, other.turning),
            leak: pair(self.leak, other.leak),
            force: pair(self.force, other.force),
            across: pair(self.across, other.across),
            mean_force: mean(self.mean_force, other.mean_force),
            offset: mean(self.offset, other.offset),
            middle: mean(self.middle, other.middle),
            speed: mean(self.speed, other.speed),
            seconds,
        }
    }
}

/// Which way the platform turns, seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// Angles rise.
    Clockwise,
    /// Angles fall.
    CounterClockwise,
}

impl Sense {
    /// That of a rate.
    #[must_use]
    pub fn of(rate: f64) -> Self {
        if rate < 0.0 { Self::CounterClockwise } else { Self::Clockwise }
    }

    /// A speed with its sign.
    #[must_use]
    pub fn signed(self, speed: f64) -> f64 {
        if self == Self::Clockwise { speed } else { -speed }
    }
}

crate::words! { Sense:
    Self::Clockwise => "clockwise";
    Self::CounterClockwise => "counter-clockwise";
}

/// Turns at one speed in one sense.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// Which way.
    pub sense: Sense,
    /// Time of its first reference, µs.
    since: u64,
    turns: Vec<Turn, TURNS>,
    /// How many turns each of `turns` stands for; how many wait to be joined, and what they are so far.
    joined: u32,
    waiting: u32,
    sum: Turn,
}

impl Stretch {
    /// A stretch without a turn, that begins at `since` µs.
    #[must_use]
    pub fn new(sense: Sense, since: u64) -> Self {
        Self { sense, since, turns: Vec::new(), joined: 1, waiting: 0, sum: Turn::default() }
    }

    /// When it began, µs.
    #[must_use]
    pub const fn since(&self) -> u64 {
        self.since
    }

    /// The turns, joined where there were many.
    #[must_use]
    pub fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// How many turns of the platform.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.turns.len() as u32 * self.joined
    }

    /// Mean speed, rad/s, ≥ 0.
    #[must_use]
    pub fn speed(&self) -> f64 {
        let sum: f64 = self.turns.iter().map(|turn| f64::from(turn.speed)).sum();
        (sum / self.turns.len().max(1) as f64).abs()
    }

    /// Time in its turns, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.turns.iter().map(|turn| f64::from(turn.seconds)).sum()
    }

    /// Takes one more turn. Where there is no room, neighbours are joined.
    pub fn push(&mut self, turn: Turn) {
        self.sum = if self.waiting == 0 { turn } else { self.sum.joined(&turn) };
        self.waiting += 1;
        if self.waiting < self.joined {
            return;
        }
        if self.turns.is_full() {
            self.halve();
        } else {
            self.waiting = 0;
            // There is room: it was not full.
            let _ = self.turns.push(self.sum);
        }
    }

    /// Joins every two neighbours; what waits is then half of one.
    fn halve(&mut self) {
        let half = self.turns.len() / 2;
        for index in 0..half {
            self.turns[index] = self.turns[2 * index].joined(&self.turns[2 * index + 1]);
        }
        self.turns.truncate(half);
        self.joined *= 2;
    }
}
