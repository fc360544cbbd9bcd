//! The unique number of the device (RM0351, 49.1), by which it knows its own records.

use emulated_board::controller::{Refused, identity};

use super::Bench;

/// Its first word.
const NUMBER: u32 = 0x1FFF_7590;

#[test]
fn the_number_of_the_device_is_read_by_words_and_bytes_and_is_not_written() {
    let mut bench = Bench::clocked();
    let words = [0, 4, 8].map(|offset| bench.read(NUMBER + offset).to_le_bytes());
    assert_eq!(words.concat(), identity::NUMBER);
    let byte = bench.try_read(NUMBER + 5, 1).map(|word| word as u8);
    assert_eq!(byte, Ok(identity::NUMBER[5]));
    let refused = Refused::NotModelled("a write to the device's number");
    assert_eq!(bench.try_write(NUMBER, 0, 4), Err(refused));
    for beside in [NUMBER - 4, NUMBER + 12] {
        assert_eq!(bench.try_read(beside, 4), Err(Refused::Unknown), "{beside:#x}");
    }
}
