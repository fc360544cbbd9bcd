//! Random sequences of what programs do with a store, and of losses of supply amid it. A seed gives the same one to every
//! program that plays it.

use super::nor::Loss;
use crate::noise::Generator;

/// A step of a sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// An item is saved into the slot of this place.
    Save(usize),
    /// The program starts anew and saves, and the supply is lost meanwhile, unless the save is over before.
    Cut(usize, Loss),
    /// The item in the slot of this place is loaded.
    Load(usize),
    /// The program starts anew.
    Restart,
}

/// The steps of a seed on so many slots, without end. Supplies are lost within operations, too, or only between them.
pub fn steps(seed: u64, slots: u32, is_within: bool) -> impl Iterator<Item = Step> {
    let mut noise = Generator::stream(seed, 3);
    core::iter::repeat_with(move || {
        let mut below = |limit: u32| (noise.next_u64() % u64::from(limit)) as u32;
        let slot = below(slots) as usize;
        match below(10) {
            0..3 => {
                // A save has up to 27 operations, or up to 91 where pages are changed.
                let limit = [28, 96][below(2) as usize];
                let operation = below(limit);
                let is_within = is_within && below(2) == 0;
                let loss = if is_within { Loss::Within } else { Loss::After };
                Step::Cut(slot, loss(operation))
            }
            3..6 => Step::Save(slot),
            6..9 => Step::Load(slot),
            _ => Step::Restart,
        }
    })
}
