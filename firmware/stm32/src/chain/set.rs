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
    /// Ends of the conversions: the lower and the upper half of the time, µs, and the count.
    ends: [[AtomicU32; 3]; CHANNELS],
    /// What came back for the command, and with it.
    readings: [[AtomicU32; WORDS]; CHANNELS],
}

impl Set {
    /// An empty set.
    pub(super) const fn new() -> Self {
        Self {
            ends: [const { [const { AtomicU32::new(0) }; 3] }; CHANNELS],
            readings: [const { [const { AtomicU32::new(0) }; WORDS] }; CHANNELS],
        }
    }

    /// Address of the bytes of a converter, for direct memory access.
    pub(super) fn address(&self, place: usize) -> u32 {
        self.readings[place].as_ptr() as u32
    }

    /// Stores the end of the conversion of a converter, as its line has it.
    pub(super) fn set_end(&self, place: usize, words: [u32; 3]) {
        self.ends[place]
            .iter()
            .zip(words)
            .for_each(|(kept, word)| kept.store(word, Ordering::Relaxed));
    }

    /// End of the conversion of a converter.
    pub(super) fn end(&self, place: usize) -> Edge {
        let [low, high, count] =
            self.ends[place].each_ref().map(|word| word.load(Ordering::Relaxed));
        Edge { at: Instant(u64::from(high) << 32 | u64::from(low)), count }
    }

    /// Frame of a converter.
    pub(super) fn frame(&self, place: usize) -> [u8; codec::FRAME] {
        let words =
            self.readings[place].each_ref().map(|word| word.load(Ordering::Relaxed).to_le_bytes());
        let [[_, status, a, b], [c, d, sum, _]] = words;
        [status, a, b, c, d, sum]
    }
}
