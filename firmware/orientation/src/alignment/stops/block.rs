//! Averages of the drive in blocks, which grow so that any time fits into fixed memory.

use heapless::Vec;

use crate::math::rotation::{dot, sum};
use crate::signal::strapdown::Rough;

/// Greatest number of blocks of all stops together.
pub(crate) const AT_REST: usize = 64;
/// Greatest number of blocks of all drives together.
pub(crate) const DRIVEN: usize = 24;
/// Least number of block triplets from which a scatter is computed.
const LEAST_TRIPLETS: f64 = 4.0;
/// Factor from the scatter that joining blocks removes to the variance of a velocity that varies
/// within a block, per second of block length: 20/6 of the second difference of its change, over
/// the block length squared.
const SWINGING: f64 = 0.3;

/// Averages of an interval at rest, or of driving.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Block {
    /// Middle of the interval, s.
    pub middle: f64,
    /// Length of the interval, s.
    pub seconds: f32,
    /// Mean specific force on the axes of the start frame, m/s².
    pub force: [f32; 3],
    /// Mean attitude: rotation from body axes to the start frame's.
    pub attitude: Rough,
    /// Sensitivity of the start frame's rotation to gyro biases at its middle, s.
    pub bias: Rough,
    /// Variance of the start frame's rotation by missing samples, at its middle, rad².
    pub lost: f32,
    /// Number of the stop to which it belongs, or after which it was driven.
    pub stop: u8,
}

impl Block {
    /// Average of two blocks, weighted by their lengths.
    fn joined(&self, other: &Self) -> Self {
        let seconds = self.seconds + other.seconds;
        let [a, b] = [self.seconds / seconds, other.seconds / seconds];
        let rough = |x, y| combined(x, y, |x, y| a * x + b * y);
        Self {
            middle: f64::from(a) * self.middle + f64::from(b) * other.middle,
            seconds,
            force: sum(&self.force.map(|part| a * part), &other.force.map(|part| b * part)),
            attitude: rough(&self.attitude, &other.attitude),
            bias: rough(&self.bias, &other.bias),
            lost: a * self.lost + b * other.lost,
            stop: self.stop,
        }
    }
}

/// Matrix of what becomes of the elements of two matrices.
pub(super) fn combined(x: &Rough, y: &Rough, of: impl Fn(f32, f32) -> f32) -> Rough {
    core::array::from_fn(|row| core::array::from_fn(|column| of(x[row][column], y[row][column])))
}

/// The blocks of all stops, or of all drives, in order.
#[derive(Clone, Debug)]
pub(crate) struct Blocks<const N: usize> {
    /// Blocks in the order of time.
    pub(super) list: Vec<Block, N>,
    /// Greatest length of a block at present, s.
    span: f32,
    /// Variance of the velocity with which the body swayed, (m/s)², from the scatter that vanished
    /// when blocks were joined: longer blocks may hide a sway, of which only the velocities at both
    /// ends of a stop remain.
    pub(super) swing: f64,
}

impl<const N: usize> Blocks<N> {
    /// No blocks yet; each lasts `span` seconds as long as there is room.
    pub(crate) const fn new(span: f32) -> Self {
        Self { list: Vec::new(), span, swing: 0.0 }
    }

    /// Removes all blocks; the next last `span` seconds as long as there is room.
    pub(crate) fn clear(&mut self, span: f32) {
        self.list.clear();
        (self.span, self.swing) = (span, 0.0);
    }

    /// Adds the next block, which must be later than all before it.
    pub(crate) fn push(&mut self, block: Block) {
        if let Some(last) = self.list.last_mut()
            && last.stop == block.stop
            && last.seconds + 0.5 * block.seconds < self.span
        {
            *last = last.joined(&block);
            return;
        }
        if self.list.is_full() {
            self.halve();
        }
        // There are fewer stops than half of the blocks, so there is room; losing one block would
        // do no harm.
        let _ = self.list.push(block);
    }

    /// Joins neighbouring blocks of each stop and doubles the block length.
    pub(crate) fn halve(&mut self) {
        let (span, scatter) = (f64::from(self.span), self.scatter());
        self.span *= 2.0;
        let mut kept: usize = 0;
        let mut next = 0;
        while let Some(block) = self.list.get(next).copied() {
            let partner = self.list.get(next + 1).filter(|other| other.stop == block.stop);
            next += if partner.is_some() { 2 } else { 1 };
            let joined = partner.map_or(block, |other| block.joined(other));
            self.list[kept] = joined;
            kept += 1;
        }
        self.list.truncate(kept);
        self.swing = self.swing.max(SWINGING * span * (scatter - self.scatter()));
    }

    /// Removes the blocks of the last stop, where it turned out not to be one.
    pub(crate) fn discard(&mut self, stop: usize) {
        while self.list.last().is_some_and(|block| usize::from(block.stop) == stop) {
            self.list.pop();
        }
    }

    /// Power of the changes of the force from block to block, (m/s²)²·s; zero with too few blocks.
    pub(crate) fn scatter(&self) -> f64 {
        let (mut power, mut count) = (0.0, 0.0);
        for [a, b, c] in self.list.array_windows::<3>() {
            if a.stop == c.stop {
                power += second_difference(a, b, c);
                count += 1.0;
            }
        }
        if count < LEAST_TRIPLETS { 0.0 } else { power / count }
    }

    /// Blocks of one stop.
    pub(crate) fn of(&self, stop: usize) -> impl Iterator<Item = &Block> + Clone {
        self.list.iter().filter(move |block| usize::from(block.stop) == stop)
    }
}

/// Power that three successive blocks show across the vertical. A straight line through them, as
/// Earth rotation draws it, contributes none.
fn second_difference(a: &Block, b: &Block, c: &Block) -> f64 {
    let bend: [f32; 3] =
        core::array::from_fn(|axis| a.force[axis] - 2.0 * b.force[axis] + c.force[axis]);
    let upward = dot(&bend, &b.force);
    let across = dot(&bend, &bend) - upward * upward / dot(&b.force, &b.force);
    f64::from(across * b.seconds) / 12.0
}
