//! The serial port, both ways.

use emulated_board::controller::{Refused, ResetReason};
use emulated_board::time::Time;

use super::Bench;

/// The serial port USART1.
const PORT: u32 = 0x4001_3800;
/// Time of a frame at 4 MHz and a divider of 400, and of one of the other side: ten bits of 100 µs.
const FRAME: Time = Time::microseconds(1000);

/// A port that sends and receives.
fn port() -> Bench {
    let mut bench = Bench::new();
    set_up(&mut bench);
    bench
}

/// Has the port send and receive.
fn set_up(bench: &mut Bench) {
    bench.write(PORT + 0x0C, 400);
    bench.write(PORT, 0xD);
}

/// The byte that was received, where there is one.
fn received(bench: &mut Bench) -> Option<u8> {
    let has_byte = bench.read(PORT + 0x1C) & 0x20 != 0;
    has_byte.then(|| bench.read(PORT + 0x24) as u8)
}

#[test]
fn a_byte_is_sent_in_the_time_of_its_frame() {
    let mut bench = port();
    bench.write(PORT + 0x28, b'A'.into());
    assert_eq!(
        bench.read(PORT + 0x1C) & 0xC0,
        0x80,
        "another byte can wait, the first is on the wire"
    );
    bench.write(PORT + 0x28, b'B'.into());
    assert_eq!(bench.read(PORT + 0x1C) & 0xC0, 0);
    bench.pass(FRAME);
    assert_eq!(bench.controller.usart.sent, b"A");
    bench.pass(FRAME);
    assert_eq!(bench.controller.usart.sent, b"AB");
    assert_eq!(bench.read(PORT + 0x1C) & 0xC0, 0xC0);
}

#[test]
fn bytes_of_the_other_side_interrupt_one_after_the_other() {
    let mut bench = port();
    bench.write(PORT, 0x2D);
    bench.controller.hear(b"xy", bench.now);
    for byte in *b"xy" {
        bench.pass(FRAME - Time::microseconds(1));
        assert!(!bench.interrupts(37));
        bench.pass(Time::microseconds(1));
        assert!(bench.interrupts(37));
        assert_eq!(bench.read(PORT + 0x24), u32::from(byte));
        assert!(!bench.interrupts(37));
    }
}

#[test]
fn a_byte_that_is_not_read_in_time_costs_the_next_one() {
    let mut bench = port();
    bench.controller.hear(b"xyz", bench.now);
    bench.pass(FRAME.times(3));
    assert_eq!(bench.read(PORT + 0x1C) & 8, 8, "the overrun is told");
    assert_eq!(bench.read(PORT + 0x24), u32::from(b'x'));
    assert_eq!(bench.controller.usart.overruns, 2);
}

#[test]
fn bytes_that_come_while_the_port_does_not_receive_are_lost() {
    // It is off; it only sends; it is to do both, and is off.
    for control in [0, 0x9, 0xC] {
        let mut bench = port();
        bench.write(PORT, control);
        bench.controller.hear(b"xy", bench.now);
        bench.pass(FRAME.times(2));
        bench.write(PORT, 0xD);
        bench.pass(FRAME.times(5));
        assert_eq!(received(&mut bench), None, "{control:#x}");
        bench.controller.hear(b"z", bench.now);
        bench.pass(FRAME);
        assert_eq!(received(&mut bench), Some(b'z'), "{control:#x}");
        assert_eq!(bench.controller.usart.overruns, 0);
    }
}

#[test]
fn a_byte_within_whose_frame_the_receiver_is_switched_is_lost_and_the_next_one_comes() {
    let quarter = Time::microseconds(250);
    for before in [0xD, 0x9] {
        let mut bench = port();
        bench.write(PORT, before);
        bench.controller.hear(b"xy", bench.now);
        bench.pass(quarter);
        bench.write(PORT, 0x9);
        bench.pass(quarter);
        bench.write(PORT, 0xD);
        bench.pass(quarter.times(2));
        assert_eq!(received(&mut bench), None);
        bench.pass(FRAME);
        assert_eq!(received(&mut bench), Some(b'y'));
    }
}

#[test]
fn bytes_that_are_on_their_way_over_a_reset_are_lost() {
    let mut bench = port();
    bench.controller.hear(b"wxyz", bench.now);
    bench.pass(FRAME + Time::microseconds(100));
    bench.controller.restart(ResetReason::Software, bench.now);
    bench.pass(FRAME);
    bench.clock_all();
    bench.connect_all();
    set_up(&mut bench);
    assert_eq!(received(&mut bench), None, "what was received before");
    bench.pass(FRAME);
    assert_eq!(received(&mut bench), None, "what began before it receives again");
    bench.pass(FRAME);
    assert_eq!(received(&mut bench), Some(b'z'));
}

#[test]
fn bytes_come_at_the_rate_of_the_other_side() {
    let mut bench = port();
    bench.write(PORT + 0x0C, 4000);
    bench.controller.hear(b"x", bench.now);
    bench.pass(FRAME - Time::microseconds(1));
    assert_eq!(received(&mut bench), None);
    bench.pass(Time::microseconds(1));
    assert_eq!(received(&mut bench), Some(b'x'));
}

#[test]
fn the_wires_hear_of_the_rate_of_each_frame_both_ways() {
    let mut bench = port();
    bench.write(PORT + 0x28, b'A'.into());
    assert_eq!(bench.wires.0.borrow().rates, [10_000], "it begins to be sent");
    bench.pass(FRAME);
    bench.write(PORT + 0x0C, 800);
    bench.controller.hear(b"x", bench.now);
    bench.pass(FRAME);
    assert_eq!(bench.wires.0.borrow().rates, [10_000, 5000], "it was received");
    bench.write(PORT, 0x9);
    bench.controller.hear(b"y", bench.now);
    bench.pass(FRAME);
    assert_eq!(bench.wires.0.borrow().rates.len(), 2, "it was lost");
}

/// Whether the port tells of an idle line (40.8.8, bit 4).
fn is_idle(bench: &mut Bench) -> bool {
    bench.read(PORT + 0x1C) & 1 << 4 != 0
}

/// A port that has told of the first idle line, at which it interrupts.
fn quiet_port() -> Bench {
    let mut bench = port();
    bench.pass(FRAME);
    bench.write(PORT + 0x20, 1 << 4);
    bench.write(PORT, 0x1D);
    bench
}

#[test]
fn an_idle_line_is_told_a_frame_after_the_last_byte_and_once() {
    let mut bench = quiet_port();
    bench.controller.hear(b"xy", bench.now);
    // Two frames of 1000 µs, and ten bits without one.
    bench.pass(Time::microseconds(2999));
    assert!(!is_idle(&mut bench) && !bench.interrupts(37));
    bench.pass(Time::microseconds(1));
    assert!(is_idle(&mut bench) && bench.interrupts(37));
    bench.write(PORT + 0x20, 1 << 4);
    assert!(!is_idle(&mut bench) && !bench.interrupts(37));
    bench.pass(FRAME.times(5));
    assert!(!is_idle(&mut bench), "nothing has come since");
}

#[test]
fn an_idle_line_that_nobody_clears_stays_while_bytes_come() {
    let mut bench = quiet_port();
    bench.controller.hear(b"x", bench.now);
    bench.pass(FRAME.times(2));
    bench.controller.hear(b"y", bench.now);
    bench.pass(FRAME);
    assert!(is_idle(&mut bench) && bench.interrupts(37));
    bench.write(PORT, 0xD);
    assert!(is_idle(&mut bench) && !bench.interrupts(37), "it is told, and not asked for");
}

#[test]
fn the_first_idle_line_after_the_receiver_is_switched_on_is_told_without_a_byte() {
    // 40.8.8 asks for a byte only before the next one.
    for (control, is_told) in [(0xD, true), (0x5, true), (0x9, false), (0xC, false)] {
        let mut bench = Bench::new();
        bench.write(PORT + 0x0C, 400);
        bench.write(PORT, control);
        bench.pass(Time::microseconds(999));
        assert!(!is_idle(&mut bench), "{control:#x}");
        bench.pass(Time::microseconds(1));
        assert_eq!(is_idle(&mut bench), is_told, "{control:#x}");
    }
}

#[test]
fn a_byte_within_a_frame_after_another_leaves_no_idle_line_between_them() {
    let mut bench = quiet_port();
    bench.controller.hear(b"x", bench.now);
    bench.pass(FRAME + Time::microseconds(900));
    bench.controller.hear(b"y", bench.now);
    bench.pass(Time::microseconds(1999));
    assert!(!is_idle(&mut bench));
    bench.pass(Time::microseconds(1));
    assert!(is_idle(&mut bench));
}

#[test]
fn a_frame_that_is_lost_keeps_the_line_from_being_idle() {
    let mut bench = port();
    bench.write(PORT, 0x9);
    bench.controller.hear(b"x", bench.now);
    bench.pass(Time::microseconds(250));
    bench.write(PORT, 0xD);
    bench.pass(Time::microseconds(1749));
    assert!(!is_idle(&mut bench), "the frame ended 999 µs ago");
    bench.pass(Time::microseconds(1));
    assert!(is_idle(&mut bench));
    assert_eq!(received(&mut bench), None);
}

#[test]
fn an_idle_line_lasts_a_frame_at_the_rate_of_the_receiver() {
    let mut bench = quiet_port();
    // 4 MHz / 800 are 5000 baud: ten bits of 200 µs.
    bench.write(PORT + 0x0C, 800);
    bench.controller.hear(b"x", bench.now);
    bench.pass(FRAME + Time::microseconds(1999));
    assert!(!is_idle(&mut bench));
    bench.pass(Time::microseconds(1));
    assert!(is_idle(&mut bench));
}

#[test]
fn the_port_is_busy_from_the_start_to_the_end_of_a_frame_that_it_hears() {
    let mut bench = port();
    let is_busy = |bench: &mut Bench| bench.read(PORT + 0x1C) >> 16 & 1 != 0;
    assert!(!is_busy(&mut bench));
    bench.controller.hear(b"x", bench.now);
    assert!(is_busy(&mut bench));
    bench.pass(Time::microseconds(999));
    assert!(is_busy(&mut bench));
    bench.pass(Time::microseconds(1));
    assert!(!is_busy(&mut bench));
}

#[test]
fn an_overrun_interrupts_where_errors_are_to_and_ends_with_its_flag() {
    for (errors, interrupts) in [(0, false), (1, true)] {
        let mut bench = port();
        bench.write(PORT + 8, errors);
        bench.controller.hear(b"xy", bench.now);
        bench.pass(FRAME);
        assert!(!bench.interrupts(37));
        bench.pass(FRAME);
        assert_eq!(bench.interrupts(37), interrupts, "EIE {errors}");
        bench.write(PORT + 0x20, 1 << 3);
        assert!(!bench.interrupts(37));
        assert_eq!(bench.read(PORT + 0x1C) & 8, 0);
    }
}

#[test]
fn what_the_serial_port_does_not_do_here_is_refused() {
    // CR1: nine bits, parity, oversampling, a wrong parity that interrupts; CR2: two stop bits; CR3: a handshake; RQR: a break.
    for (offset, value) in [
        (0x00, 1 << 12),
        (0x00, 1 << 10),
        (0x00, 1 << 15),
        (0x00, 1 << 8),
        (0x04, 2 << 12),
        (0x08, 1 << 8),
        (0x18, 2),
    ] {
        let refused = port().try_write(PORT + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{offset:#x}: {refused:?}");
    }
}
