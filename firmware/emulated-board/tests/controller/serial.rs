//! The serial port, both ways.

use emulated_board::controller::Refused;
use emulated_board::time::Time;

use super::Bench;

/// The serial port USART1.
const PORT: u32 = 0x4001_3800;
/// Time of a frame at 4 MHz and a divider of 400: ten bits of 100 µs.
const FRAME: Time = Time::microseconds(1000);

/// A port that sends and receives.
fn port() -> Bench {
    let mut bench = Bench::new();
    bench.write(PORT + 0x0C, 400);
    bench.write(PORT, 0xD);
    bench
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
fn what_the_serial_port_does_not_do_here_is_refused() {
    // CR1: nine bits, parity, oversampling, an idle line that interrupts; CR2: two stop bits; CR3: a handshake; RQR: a break.
    for (offset, value) in [
        (0x00, 1 << 12),
        (0x00, 1 << 10),
        (0x00, 1 << 15),
        (0x00, 1 << 4),
        (0x04, 2 << 12),
        (0x08, 1 << 8),
        (0x18, 2),
    ] {
        let refused = port().try_write(PORT + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{offset:#x}: {refused:?}");
    }
}
