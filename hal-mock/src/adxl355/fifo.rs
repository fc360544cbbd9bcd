//! The FIFO of the ADXL355: 96 values of one axis each, three bytes on the bus.

use heapless::Deque;

/// Number of values that fit into the buffer.
const SIZE: usize = 96;

/// Marks an x value.
const X: u32 = 0b01;

/// Marks a read of the empty FIFO.
const EMPTY: u32 = 0b10;

/// A FIFO in stream mode: new values push out the oldest.
#[derive(Clone, Debug, Default)]
pub struct Fifo {
    /// Values of 20 bits, shifted up by four, with the mark of x, oldest first.
    values: Deque<u32, SIZE>,
    /// The value that is going out.
    word: u32,
    /// Bytes of that value that are still to go out.
    bytes_left: u8,
}

impl Fifo {
    /// Takes a sample; returns whether older values were lost for it.
    pub fn push(&mut self, counts: [i32; 3]) -> bool {
        let is_full = self.values.len() + counts.len() > SIZE;
        for (axis, count) in counts.into_iter().enumerate() {
            if self.values.is_full() {
                self.values.pop_front();
            }
            let mark = if axis == 0 { X } else { 0 };
            // There is room: it was just made.
            let _ = self.values.push_back((count.cast_unsigned() << 4 & 0xFF_FFFF) | mark);
        }
        is_full
    }

    /// The next byte; every third takes a value out.
    pub fn read(&mut self) -> u8 {
        if self.bytes_left == 0 {
            self.word = self.values.pop_front().unwrap_or(EMPTY);
            self.bytes_left = 3;
        }
        self.bytes_left -= 1;
        (self.word >> (8 * self.bytes_left)) as u8
    }

    /// Values in it, 0 … 96.
    pub fn entries(&self) -> u8 {
        self.values.len() as u8
    }
}
