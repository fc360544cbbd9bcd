//! Conversions that the chain has read, as the interrupts leave them to acquisition: words that are read and written
//! each by itself.

use core::sync::atomic::{AtomicU32, Ordering};

use drivers::ads1262::{BYTES_PER_SAMPLE, codec};
use drivers::data_ready::Edge;
use firmware::spin::configuration::CHANNELS;
use orientation::units::Instant;

/// Words of a reading.
const WORDS: usize = BYTES_PER_SAMPLE.div_ceil(4);

/// One conversion of each converter.
pub(super) struct Set {
    /// End of the last converter's conversion: the lower and the upper half of the time, µs, and the count.
    end: [AtomicU32; 3],
    /// How long before that each conversion ended, µs; it wraps.
    before: [AtomicU32; CHANNELS],
    /// What came back for the command, and with it.
    readings: [[AtomicU32; WORDS]; CHANNELS],
}

impl Set {
    /// An empty set.
    pub(super) const fn new() -> Self {
        Self {
            end: [const { AtomicU32::new(0) }; 3],
            before: [const { AtomicU32::new(0) }; CHANNELS],
            readings: [const { [const { AtomicU32::new(0) }; WORDS] }; CHANNELS],
        }
    }

    /// Address of the bytes of a converter, for direct memory access.
    pub(super) fn address(&self, place: usize) -> u32 {
        self.readings[place].as_ptr() as u32
    }

    /// Stores the end of the last converter's conversion, as its line has it, and how long before it each ended.
    pub(super) fn set_ends(&self, end: [u32; 3], before: &[AtomicU32; CHANNELS]) {
        self.end.iter().zip(end).for_each(|(kept, word)| kept.store(word, Ordering::Relaxed));
        for (kept, before) in self.before.iter().zip(before) {
            kept.store(before.load(Ordering::Relaxed), Ordering::Relaxed);
        }
    }

    /// End of the conversion of a converter, with the count of the last one's.
    pub(super) fn end(&self, place: usize) -> Edge {
        let [low, high, count] = self.end.each_ref().map(|word| word.load(Ordering::Relaxed));
        let before = self.before[place].load(Ordering::Relaxed).cast_signed();
        let last = u64::from(high) << 32 | u64::from(low);
        Edge { at: Instant(last.wrapping_add_signed(-i64::from(before))), count }
    }

    /// Frame of a converter.
    pub(super) fn frame(&self, place: usize) -> [u8; codec::FRAME] {
        let words =
            self.readings[place].each_ref().map(|word| word.load(Ordering::Relaxed).to_le_bytes());
        let [[_, status, a, b], [c, d, sum, _]] = words;
        [status, a, b, c, d, sum]
    }
}
