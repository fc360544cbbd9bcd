//! Bytes over a link without a pause, none of which is a command: noise, lines and sentences that are nearly commands, and
//! frames that are nearly messages of MAVLink.

use hal_mock::noise::Generator;
use heapless::Vec;

/// Most bytes of a piece.
const LONGEST: usize = 300;
/// Words of commands and of others.
const WORDS: [&str; 20] = [
    "start",
    "stop",
    "realign",
    "azimuth",
    "get",
    "set",
    "save",
    "restore",
    "test",
    "log",
    "reboot",
    "latitude",
    "dwell",
    "10",
    "-1e9",
    "nan",
    "$",
    "GGA",
    "48.5",
    "xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx",
];
/// A word after which a line is no command: none has it, and none has so many words.
const NONE: &str = " ? ? ? ?";

/// Such bytes, without end.
#[derive(Clone, Debug)]
pub struct Flood {
    random: Generator,
    piece: Vec<u8, LONGEST>,
    /// How many of the piece have gone.
    gone: usize,
}

impl Flood {
    /// Those of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { random: Generator::new(seed), piece: Vec::new(), gone: 0 }
    }

    /// A number from zero to less than this.
    fn below(&mut self, end: usize) -> usize {
        (self.random.next_u64() % end as u64) as usize
    }

    /// A byte.
    fn byte(&mut self) -> u8 {
        (self.random.next_u64() >> 56) as u8
    }

    /// Another piece.
    fn renew(&mut self) {
        (self.gone, self.piece) = (0, Vec::new());
        match self.below(5) {
            0 => {
                for _ in 0..=self.below(200) {
                    let byte = self.byte();
                    self.put(&[byte]);
                }
            }
            1 => {
                self.words();
                self.put(b"\r\n");
            }
            2 => self.sentence(),
            3 => self.frame(),
            _ => {
                for _ in 0..=self.below(50) {
                    self.put(b"\xFD");
                }
            }
        }
    }

    /// Puts bytes to the piece; what finds no room is not sent.
    fn put(&mut self, bytes: &[u8]) {
        for byte in bytes {
            let _ = self.piece.push(*byte);
        }
    }

    /// Puts words that are no command.
    fn words(&mut self) {
        for _ in 0..=self.below(3) {
            let word = WORDS[self.below(WORDS.len())];
            self.put(word.as_bytes());
            self.put(b" ");
        }
        self.put(NONE.as_bytes());
    }

    /// Puts a sentence whose checksum is another.
    fn sentence(&mut self) {
        const HEX: &[u8; 16] = b"0123456789ABCDEF";
        self.put(b"$PMRDC,");
        self.words();
        let sum = self.piece[1..].iter().fold(0, |sum, byte| sum ^ byte);
        let wrong = sum ^ (1 + self.below(255) as u8);
        let digits = [wrong >> 4, wrong & 0xF].map(|digit| HEX[usize::from(digit)]);
        self.put(b"*");
        self.put(&digits);
        self.put(b"\r\n");
    }

    /// Puts a frame of MAVLink 2 whose checksum is of other bytes: a message about parameters, a position, or a command.
    fn frame(&mut self) {
        const NUMBERS: [u8; 5] = [20, 21, 23, 24, 76];
        let length = 1 + self.below(40) as u8;
        let number = NUMBERS[self.below(NUMBERS.len())];
        self.put(&[0xFD, length, 0, 0, 7, 255, 190, number, 0, 0]);
        // The last byte of a payload that is not shortened is not zero.
        for _ in 1..length {
            let byte = self.byte();
            self.put(&[byte]);
        }
        self.put(&[1]);
        // The right checksum is another but once in 65 536, and then the payload must say something, too.
        let sum = [self.byte(), self.byte()];
        self.put(&sum);
    }
}

impl Iterator for Flood {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        while self.gone >= self.piece.len() {
            self.renew();
        }
        self.gone += 1;
        self.piece.get(self.gone - 1).copied()
    }
}
