//! Frames by hand and by chance.

use drivers::ads1262::codec::{Conversion, Status, decode, sum};
use drivers::fault::Fault;
use proptest::prelude::*;

/// A frame whose sum is right.
fn frame(status: u8, code: i32) -> [u8; 6] {
    let [a, b, c, d] = code.to_be_bytes();
    [status, a, b, c, d, sum([a, b, c, d])]
}

/// 12345678h → `AFh`: TI's correction of the data sheet's example (e2e.ti.com thread 634263).
/// 12h 34h 56h → 37h: TI application report SBAA106A section 2, here with a zero byte in front.
#[test]
fn sums_are_those_that_others_print() {
    assert_eq!(sum([0x12, 0x34, 0x56, 0x78]), 0xAF);
    assert_eq!(sum([0x00, 0x12, 0x34, 0x56]), 0x37);
}

#[test]
fn a_stuck_line_is_no_frame() {
    assert_eq!(decode([0x00; 6]), Err(Fault::Checksum));
    assert_eq!(decode([0xFF; 6]), Err(Fault::Checksum));
}

#[test]
fn each_status_bit_has_its_consequence() {
    let plain = Conversion { code: 5, is_new: false, is_clipped: false, status: Status(0) };
    let with = |status: u8| Conversion { status: Status(status), ..plain };
    assert_eq!(decode(frame(0x00, 5)), Ok(plain));
    assert_eq!(decode(frame(0x40, 5)), Ok(Conversion { is_new: true, ..with(0x40) }));
    assert_eq!(decode(frame(0x80, 5)), Ok(with(0x80)));
    assert_eq!(decode(frame(0x20, 5)), Ok(with(0x20)));
    for alarm in [0x08, 0x04, 0x02] {
        assert_eq!(decode(frame(alarm, 5)), Ok(Conversion { is_clipped: true, ..with(alarm) }));
    }
    assert_eq!(decode(frame(0x10, 5)), Err(Fault::Alarm { status: 0x10 }));
    assert_eq!(decode(frame(0x01, 5)), Err(Fault::Reset));
    assert_eq!(decode(frame(0x51, 5)), Err(Fault::Reset), "before the alarm of a chip just reset");
    assert!(Status(0x20).has(Status::EXTERNAL_CLOCK));
}

#[test]
fn the_ends_of_the_range_are_clipped() {
    for (code, is_clipped) in
        [(i32::MAX, true), (i32::MIN, true), (i32::MAX - 1, false), (i32::MIN + 1, false)]
    {
        assert_eq!(decode(frame(0x40, code)).map(|found| found.is_clipped), Ok(is_clipped));
    }
}

proptest! {
    #[test]
    fn every_code_comes_back(code: i32) {
        let found = decode(frame(0x40, code)).expect("the frame is right");
        prop_assert_eq!(found.code, code);
    }

    #[test]
    fn no_wrong_bit_or_byte_in_data_or_sum_is_believed(
        code: i32, place in 1_usize..6, wrong in 1_u8..
    ) {
        let mut bytes = frame(0x40, code);
        bytes[place] ^= wrong;
        prop_assert_eq!(decode(bytes), Err(Fault::Checksum));
    }
}
