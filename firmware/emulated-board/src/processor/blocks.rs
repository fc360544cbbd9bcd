//! Runs of instructions that are executed as one: how many instructions each has, and what becomes of the time.

use std::collections::HashMap;

use super::checks::Checks;
use super::instructions::instructions;

/// Instructions that follow each other up to a branch.
#[derive(Clone, Debug)]
pub struct Block {
    /// Address of the first one.
    pub address: u32,
    /// Addresses of all, as distances in bytes from the first.
    pub offsets: Vec<u16>,
    /// What they may do beside what they compute.
    pub effects: Effects,
    /// Whether it is a branch to itself, which an exception or a reset alone ends.
    pub is_endless: bool,
    /// What is to be checked before it is executed.
    pub checks: Checks,
    /// How often it was executed.
    pub count: u64,
}

/// What instructions may do beside what they compute.
#[derive(Clone, Copy, Debug, Default)]
pub struct Effects {
    /// Whether interrupts are taken may change.
    pub masks: bool,
    /// An event is sent, which the next wait for an event takes.
    pub signals: bool,
    /// The stack grows.
    pub grows_stack: bool,
}

impl Block {
    /// Reads the instructions of a block from its bytes.
    pub fn decode(address: u32, bytes: &[u8]) -> Self {
        let mut block = Self {
            address,
            offsets: Vec::new(),
            effects: Effects::default(),
            is_endless: bytes == [0xFE, 0xE7],
            checks: Checks::of(bytes),
            count: 0,
        };
        let effects = &mut block.effects;
        for (offset, first, second) in instructions(bytes) {
            block.offsets.push(offset);
            // CPS; MSR.
            effects.masks |=
                first & 0xFFE8 == 0xB660 || (second.is_some() && first & 0xFFE0 == 0xF380);
            // SEV.
            effects.signals |= first == 0xBF40;
            effects.grows_stack |= grows_stack(first, second);
        }
        block
    }
}

/// Whether an instruction makes the stack grow (A7.7): PUSH, VPUSH, a store that moves the stack pointer, SUB.
const fn grows_stack(first: u16, second: Option<u16>) -> bool {
    match second {
        None => first & 0xFE00 == 0xB400 || first & 0xFF80 == 0xB080,
        Some(_) => {
            matches!(first, 0xE96D | 0xF84D)
                || first & 0xFFBF == 0xED2D
                || matches!(first & 0xFBEF, 0xE92D | 0xEBAD | 0xF1AD | 0xF2AD)
        }
    }
}

/// The blocks that were executed.
#[derive(Debug, Default)]
pub struct Blocks {
    /// In the order in which they came.
    pub all: Vec<Block>,
    /// Their places by address and length in bytes.
    places: HashMap<(u32, u32), usize, std::hash::BuildHasherDefault<Fold>>,
    /// The latest one at each address, as half-words from the beginning of the flash: its length and its place.
    latest: Vec<(u32, u32)>,
}

impl Blocks {
    /// The place of a block, which is decoded where it is new.
    pub fn place(&mut self, address: u32, size: u32, read: impl FnOnce(&mut [u8])) -> usize {
        let slot = (address.wrapping_sub(crate::FLASH) / 2) as usize;
        if let Some((length, place)) = self.latest.get(slot)
            && *length == size
        {
            return *place as usize;
        }
        let place = *self.places.entry((address, size)).or_insert_with(|| {
            let mut bytes = vec![0; size as usize];
            read(&mut bytes);
            self.all.push(Block::decode(address, &bytes));
            self.all.len() - 1
        });
        if slot < crate::FLASH_BYTES / 2 {
            self.latest.resize(self.latest.len().max(slot + 1), (0, 0));
            self.latest[slot] = (size, place as u32);
        }
        place
    }

    /// Instructions that were executed.
    pub fn instructions(&self) -> u64 {
        self.all.iter().map(|block| block.count * block.offsets.len() as u64).sum()
    }
}

/// A hash of few numbers, for a table that is asked often.
#[derive(Debug, Default)]
struct Fold(u64);

impl std::hash::Hasher for Fold {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.write_u32((*byte).into());
        }
    }

    fn write_u32(&mut self, word: u32) {
        self.0 = (self.0 ^ u64::from(word)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    }
}
