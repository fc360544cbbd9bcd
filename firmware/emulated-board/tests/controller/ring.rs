//! Bytes that the serial port receives into a ring buffer, by a circular channel for direct memory access.

use emulated_board::controller::Refused;
use emulated_board::time::Time;

use super::{Bench, MEMORY};

/// The serial port USART1.
const PORT: u32 = 0x4001_3800;
/// The controller DMA2.
const DMA: u32 = 0x4002_0400;
/// Its channel 7, which has the request 2 of the port's receiver (RM0351, table 45): `DMA_CCR7`.
const CHANNEL: u32 = DMA + 8 + 20 * 6;
/// Its interrupt (table 57).
const INTERRUPT: usize = 69;
/// Bytes of the ring.
const RING: u32 = 8;
/// The channel in a circle: bytes from the peripheral to memory that counts up, priority very high; its end, its half and
/// an error interrupt.
const CIRCLE: u32 = 3 << 12 | 1 << 7 | 1 << 5 | 0xE;
/// Time of a frame of the other side: ten bits of 100 µs.
const FRAME: Time = Time::microseconds(1000);

/// Has the channel begin at the beginning of the ring.
fn set_up(bench: &mut Bench) {
    for (offset, value) in [(4, RING), (8, PORT + 0x24), (12, MEMORY), (0, CIRCLE), (0, CIRCLE | 1)]
    {
        bench.write(CHANNEL + offset, value);
    }
}

/// A port that receives into the ring.
fn ring() -> Bench {
    let mut bench = Bench::new();
    bench.write(DMA + 0xA8, 2 << 24);
    set_up(&mut bench);
    bench.write(PORT + 0x0C, 400);
    bench.write(PORT + 8, 1 << 6 | 1);
    bench.write(PORT, 0xD);
    bench
}

/// Bytes that are left until the ring begins anew.
fn left(bench: &mut Bench) -> u32 {
    bench.read(CHANNEL + 4)
}

/// The flags of the channel: 4 for the half of the ring, 2 for its end.
fn flags(bench: &mut Bench) -> u32 {
    bench.read(DMA) >> 24 & 0xE
}

#[test]
fn bytes_fill_the_ring_over_and_over_and_none_is_lost() {
    let mut bench = ring();
    bench.controller.hear(b"abcdefghijk", bench.now);
    // 11.4.5: the number counts down to one, and returns to the first one with the last byte.
    for expected in [7, 6, 5, 4, 3, 2, 1, 8, 7, 6, 5] {
        bench.pass(FRAME - Time::microseconds(1));
        assert_ne!(left(&mut bench), expected, "the frame has not ended");
        bench.pass(Time::microseconds(1));
        assert_eq!(left(&mut bench), expected);
    }
    assert_eq!(bench.ram.0[..9], *b"ijkdefgh\0");
    assert_eq!(bench.controller.usart.overruns, 0);
    assert_eq!(bench.read(PORT + 0x1C) & 0x28, 0, "neither a byte that waits nor an overrun");
}

#[test]
fn each_half_of_the_ring_interrupts_once_in_every_round() {
    let mut bench = ring();
    bench.controller.hear(&[b'x'; 24], bench.now);
    for round in 0..3 {
        for flag in [4, 2] {
            bench.pass(FRAME.times(4) - Time::microseconds(1));
            assert!(!bench.interrupts(INTERRUPT), "round {round}, flag {flag}");
            bench.pass(Time::microseconds(1));
            assert!(bench.interrupts(INTERRUPT), "round {round}, flag {flag}");
            assert_eq!(flags(&mut bench), flag);
            bench.write(DMA + 4, flag << 24);
            assert!(!bench.interrupts(INTERRUPT));
        }
    }
    assert_eq!(bench.read(CHANNEL), CIRCLE | 1, "it stays enabled");
}

#[test]
fn a_round_whose_flags_nobody_clears_goes_on() {
    let mut bench = ring();
    bench.controller.hear(b"abcdefghij", bench.now);
    bench.pass(FRAME.times(10));
    assert_eq!((flags(&mut bench), left(&mut bench)), (6, 6));
    assert_eq!(bench.ram.0[..8], *b"ijcdefgh");
}

#[test]
fn the_line_is_idle_a_frame_after_the_last_byte_that_went_into_the_ring() {
    let mut bench = ring();
    bench.pass(FRAME);
    bench.write(PORT + 0x20, 1 << 4);
    bench.write(PORT, 0x1D);
    bench.controller.hear(b"abc", bench.now);
    bench.pass(Time::microseconds(3999));
    assert!(!bench.interrupts(37));
    bench.pass(Time::microseconds(1));
    assert!(bench.interrupts(37));
    assert_eq!(left(&mut bench), 5);
}

#[test]
fn bytes_are_sent_while_others_go_into_the_ring() {
    let mut bench = ring();
    bench.ram.0[64..67].copy_from_slice(b"123");
    bench.write(DMA + 0xA8, 2 << 24 | 2 << 20);
    // Channel 6: from memory that counts up to the peripheral; its end interrupts.
    for (offset, value) in [(4, 3), (8, PORT + 0x28), (12, MEMORY + 64), (0, 0x93)] {
        bench.write(CHANNEL - 20 + offset, value);
    }
    bench.controller.hear(b"abc", bench.now);
    bench.write(PORT + 8, 1 << 7 | 1 << 6 | 1);
    bench.pass(FRAME.times(3));
    assert_eq!(bench.controller.usart.sent, b"123");
    assert_eq!(bench.ram.0[..4], *b"abc\0");
}

#[test]
fn bytes_that_no_channel_takes_any_more_overrun_and_the_ring_keeps_its_own() {
    let mut bench = ring();
    bench.controller.hear(b"abcd", bench.now);
    bench.pass(FRAME);
    bench.write(PORT + 8, 0);
    bench.pass(FRAME.times(3));
    assert_eq!(bench.ram.0[..2], *b"a\0");
    assert_eq!((left(&mut bench), bench.controller.usart.overruns), (7, 2));
    bench.write(PORT + 8, 1 << 6);
    assert_eq!(bench.ram.0[..3], *b"ab\0", "the byte that waits goes where it would have gone");
}

#[test]
fn a_channel_that_was_switched_off_amid_the_ring_begins_anew_with_all_its_bytes() {
    let mut bench = ring();
    bench.controller.hear(b"abc", bench.now);
    bench.pass(FRAME.times(3));
    bench.write(CHANNEL, CIRCLE);
    assert_eq!(left(&mut bench), 5, "what is left can be read");
    // 11.4.5 does not promise what comes of a channel that goes on as it is.
    let refused = bench.try_write(CHANNEL, CIRCLE | 1, 4);
    assert!(matches!(refused, Err(Refused::NotModelled(_))), "{refused:?}");
    set_up(&mut bench);
    bench.controller.hear(b"stuvwxyz1", bench.now);
    bench.pass(FRAME.times(9));
    assert_eq!(bench.ram.0[..9], *b"1tuvwxyz\0");
    assert_eq!(left(&mut bench), 7);
}

#[test]
fn the_ring_takes_bytes_by_the_request_of_the_receiver_alone() {
    for request in [0, 1, 3] {
        let mut bench = ring();
        bench.write(DMA + 0xA8, request << 24);
        bench.controller.hear(b"a", bench.now);
        bench.pass(FRAME);
        assert_eq!(left(&mut bench), RING, "request {request}");
    }
}
