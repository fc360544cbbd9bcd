//! One whole turn of the platform as phasors, and a stretch of turns at one speed in one sense.

use heapless::Vec;

use super::part::AXES;
use crate::math::{Column, Regression};
use crate::signal::phasor::{Block, COLUMNS, COSINE, ONE, RATE, SINE, Sums, TIME, TURNING};

/// Greatest number of entries in a stretch; with more turns, neighbours are joined.
pub const TURNS: usize = 32;
/// Greatest number of speeds of the platform in an alignment.
pub const SPEEDS: usize = 2;
/// Greatest number of stretches in an alignment: one for each speed and sense.
pub(crate) const STRETCHES: usize = 2 * SPEEDS;

/// Averages of one turn, or of several neighbouring turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// Coefficients of cosine and sine in the gyro's rate, rad/s.
    pub rate: [f32; 2],
    /// Coefficients of cosine and sine in the platform's rate, rad/s.
    pub turning: [f32; 2],
    /// Coefficients of cosine and sine in the time itself, s: the response of `rate` to a slope of
    /// 1 rad/s².
    pub leak: [f32; 2],
    /// Coefficients of cosine and sine in the force along the sensitive axis, m/s².
    pub force: [f32; 2],
    /// Coefficients of cosine and sine in the force 90° clockwise of it, m/s²; zeros where that
    /// axis is not measured.
    pub across: [f32; 2],
    /// Mean force along the sensitive axis, m/s².
    pub mean_force: f32,
    /// Mean of the gyro's rate, rad/s.
    pub offset: f32,
    /// Time of the turn's middle since the stretch's first turn, s.
    pub middle: f32,
    /// Length of the turn, s.
    pub seconds: f32,
    /// Mean rate of the platform, rad/s, clockwise positive.
    pub speed: f32,
}

/// Model of a phasor: constant, cosine and sine.
const PHASOR: [Column; COLUMNS] = {
    let mut model = [Column::Absent; COLUMNS];
    model[ONE] = Column::Free;
    model[COSINE] = Column::Free;
    model[SINE] = Column::Free;
    model
};

/// Mean of a signal and its coefficients of cosine and sine; `None` where the angles do not cover a
/// turn.
pub(super) fn phasor(regression: &Regression<COLUMNS>) -> Option<(f64, [f32; 2])> {
    let found = regression.solve(&PHASOR)?.coefficients;
    Some((found[ONE], [found[COSINE] as f32, found[SINE] as f32]))
}

impl Turn {
    /// Turn from the sums of a whole turn of `seconds` that began at `since` µs in its stretch, and
    /// the regressions of its forces; `None` where either does not cover a turn.
    pub(crate) fn of(
        sums: &Sums,
        reference: &Block,
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

    /// Average of this turn and another, weighted by their lengths.
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

/// Sense of rotation, seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Sense {
    /// Clockwise: encoder angles increase.
    Clockwise,
    /// Counter-clockwise: encoder angles decrease.
    CounterClockwise,
}

impl Sense {
    /// Sense of a rate; zero counts as clockwise.
    pub(crate) fn of(rate: f64) -> Self {
        if rate < 0.0 { Self::CounterClockwise } else { Self::Clockwise }
    }

    /// Rate of this sense for a speed.
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
    /// Sense of rotation.
    pub sense: Sense,
    /// Beginning of the stretch, the time of its first reference, µs.
    pub since: u64,
    /// Entries of the stretch, joined where there were many turns.
    pub turns: Vec<Turn, TURNS>,
    /// Number of turns that each entry stands for; number of turns waiting to be joined, and their
    /// average.
    pub(super) joined: u32,
    waiting: u32,
    sum: Turn,
}

impl Stretch {
    /// A stretch without a turn, that begins at `since` µs.
    #[must_use]
    pub fn new(sense: Sense, since: u64) -> Self {
        Self { sense, since, turns: Vec::new(), joined: 1, waiting: 0, sum: Turn::default() }
    }

    /// Number of turns of the platform.
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

    /// Adds one turn. Where there is no room, neighbours are joined, and each entry stands for
    /// twice as many turns.
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
            // The vector was not full, so the push cannot fail.
            let _ = self.turns.push(self.sum);
        }
    }

    /// Joins every two neighbours; the turns waiting are then half of an entry.
    fn halve(&mut self) {
        let half = self.turns.len() / 2;
        for index in 0..half {
            self.turns[index] = self.turns[2 * index].joined(&self.turns[2 * index + 1]);
        }
        self.turns.truncate(half);
        self.joined *= 2;
    }
}
