//! What is kept of the way: means over blocks, which grow so that any time finds room.

use heapless::Vec;

use crate::math::rotation::sum;
use crate::signal::strapdown::Rough;

/// Most blocks of all stops together.
pub const AT_REST: usize = 64;
/// Most blocks of all drives together.
pub const DRIVEN: usize = 24;

/// Some time at rest, or on the way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Block {
    /// Its middle, s.
    pub middle: f64,
    /// Its length, s.
    pub seconds: f32,
    /// Mean specific force on the axes of the start frame, m/s².
    pub force: [f32; 3],
    /// Mean attitude: from body axes to the start frame's.
    pub attitude: Rough,
    /// Rotation of the start frame that a bias of the gyros makes until its middle, s.
    pub bias: Rough,
    /// The stop to which it belongs, or after which it was driven.
    pub stop: u8,
}

impl Block {
    /// Both together.
    fn joined(&self, other: &Self) -> Self {
        let seconds = self.seconds + other.seconds;
        let [a, b] = [self.seconds / seconds, other.seconds / seconds];
        let mean = |x: f32, y: f32| a * x + b * y;
        let rough = |x: &Rough, y: &Rough| {
            core::array::from_fn(|row| {
                core::array::from_fn(|column| mean(x[row][column], y[row][column]))
            })
        };
        Self {
            middle: f64::from(a) * self.middle + f64::from(b) * other.middle,
            seconds,
            force: sum(&self.force.map(|part| a * part), &other.force.map(|part| b * part)),
            attitude: rough(&self.attitude, &other.attitude),
            bias: rough(&self.bias, &other.bias),
            stop: self.stop,
        }
    }
}

/// The blocks of all stops, or of all drives, in order.
#[derive(Clone, Debug)]
pub struct Blocks<const N: usize> {
    blocks: Vec<Block, N>,
    span: f32,
}

impl<const N: usize> Blocks<N> {
    /// None, which last for so many seconds as long as there is room.
    #[must_use]
    pub const fn new(span: f32) -> Self {
        Self { blocks: Vec::new(), span }
    }

    /// Takes the next, which comes later than all before it.
    pub fn push(&mut self, block: Block) {
        if let Some(last) = self.blocks.last_mut()
            && last.stop == block.stop
            && last.seconds + 0.5 * block.seconds < self.span
        {
            *last = last.joined(&block);
            return;
        }
        if self.blocks.is_full() {
            self.halve();
        }
        // Stops are fewer than half of the blocks, so there is room; the time of one block is no loss.
        let _ = self.blocks.push(block);
    }

    /// Joins neighbours of a stop.
    pub fn halve(&mut self) {
        self.span *= 2.0;
        let mut kept: usize = 0;
        let mut next = 0;
        while let Some(block) = self.blocks.get(next).copied() {
            let partner = self.blocks.get(next + 1).filter(|other| other.stop == block.stop);
            next += if partner.is_some() { 2 } else { 1 };
            let joined = partner.map_or(block, |other| block.joined(other));
            self.blocks[kept] = joined;
            kept += 1;
        }
        self.blocks.truncate(kept);
    }

    /// Takes those of the last stop out, which is none.
    pub fn forget(&mut self, stop: usize) {
        while self.blocks.last().is_some_and(|block| usize::from(block.stop) == stop) {
            self.blocks.pop();
        }
    }

    /// All of them.
    #[must_use]
    pub fn all(&self) -> &[Block] {
        &self.blocks
    }

    /// Those of a stop.
    pub fn of(&self, stop: usize) -> impl Iterator<Item = &Block> + Clone {
        self.blocks.iter().filter(move |block| usize::from(block.stop) == stop)
    }
}
