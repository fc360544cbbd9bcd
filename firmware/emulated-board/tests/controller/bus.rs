//! Serial buses with direct memory access, and the two-wire bus.

use embedded_hal::spi::{MODE_1, MODE_3};
use emulated_board::controller::{Refused, ResetReason};
use emulated_board::time::Time;
use emulated_board::wiring::Pin;

use super::{Bench, MEMORY};

/// The interface SPI1, and SPI2.
const SPI: [u32; 2] = [0x4001_3000, 0x4000_3800];
/// The controller DMA1.
const DMA: u32 = 0x4002_0000;
/// The interface I2C2.
const I2C: u32 = 0x4000_5800;

#[test]
fn a_byte_takes_eight_periods_and_comes_back() {
    let mut bench = Bench::new();
    // Mode 3, 4 MHz / 8, enabled; received bytes count one by one.
    bench.write(SPI[1] + 4, 0x1700);
    bench.write(SPI[1], 0x344 | 2 << 3 | 3);
    bench.try_write(SPI[1] + 0x0C, 0x5A, 1).expect("a byte");
    assert_eq!(bench.read(SPI[1] + 8) & 0x81, 0x80, "busy");
    bench.pass(Time::microseconds(15));
    assert_eq!(bench.read(SPI[1] + 8) & 0x81, 0x80);
    bench.pass(Time::microseconds(1));
    assert_eq!(bench.read(SPI[1] + 8) & 0x81, 0x01);
    assert_eq!(bench.try_read(SPI[1] + 0x0C, 1), Ok(0xA5));
    let (bus, byte, clock, _) = bench.wires.0.borrow().bytes[0];
    assert_eq!((bus, byte, clock.hertz, clock.mode), (1, 0x5A, 500_000, MODE_3));
}

#[test]
fn four_bytes_wait_to_be_read_and_a_fifth_is_lost() {
    let mut bench = Bench::new();
    bench.write(SPI[0] + 4, 0x1700);
    bench.write(SPI[0], 0x345);
    for byte in 0..5 {
        bench.try_write(SPI[0] + 0x0C, byte, 1).expect("a byte");
        bench.pass(Time::microseconds(4));
    }
    assert_eq!(bench.read(SPI[0] + 8) & 0x640, 0x640, "full, and an overrun");
    assert_eq!(bench.controller.spi[0].overruns, 1);
}

/// An interface SPI1 of 2 MHz in which five bytes came and none was read.
fn overrun() -> Bench {
    let mut bench = Bench::new();
    bench.write(SPI[0] + 4, 0x1700);
    bench.write(SPI[0], 0x345);
    for byte in 0..5 {
        send(&mut bench, byte);
    }
    bench
}

/// Sends a byte by SPI1, and waits for its end.
fn send(bench: &mut Bench, byte: u32) {
    bench.try_write(SPI[0] + 0x0C, byte, 1).expect("a byte");
    bench.pass(Time::microseconds(4));
}

#[test]
fn a_read_of_the_data_and_then_one_of_the_status_clear_an_overrun_and_nothing_else_does() {
    let is_overrun = |bench: &mut Bench| bench.read(SPI[0] + 8) & 0x40 != 0;
    let mut bench = overrun();
    assert!(is_overrun(&mut bench) && is_overrun(&mut bench), "the status alone clears it");
    bench.write(SPI[0] + 8, 0);
    bench.write(SPI[0], 0x305);
    bench.write(SPI[0], 0x345);
    assert!(is_overrun(&mut bench), "a write, or a disabled interface, clears it");
    assert_eq!(bench.try_read(SPI[0] + 0x0C, 1), Ok(0xFF), "the first byte, inverted");
    assert!(is_overrun(&mut bench), "the read that clears it still shows it");
    assert!(!is_overrun(&mut bench));
}

#[test]
fn all_that_comes_after_an_overrun_is_lost_until_it_is_cleared() {
    let mut bench = overrun();
    for expected in [0xFF, 0xFE, 0xFD, 0xFC] {
        assert_eq!(bench.try_read(SPI[0] + 0x0C, 1), Ok(expected));
    }
    send(&mut bench, 9);
    assert_eq!(bench.controller.spi[0].overruns, 2);
    assert_eq!(bench.read(SPI[0] + 8) & 0x641, 0x40, "no byte, and still an overrun");
    send(&mut bench, 8);
    assert_eq!(bench.try_read(SPI[0] + 0x0C, 1), Ok(0xF7));
}

/// What is told of a byte that is sent while the buffer counts as full.
const NO_ROOM: Refused = Refused::NotModelled("a byte to be sent while there is no room");

#[test]
fn a_byte_to_be_sent_is_refused_while_the_status_has_no_room_for_it() {
    // 42.4.9: three bytes, or four where the last two were written together, fill the buffer.
    for sizes in [&[1, 1, 1][..], &[1, 2], &[2, 2], &[1, 1, 2]] {
        let mut bench = Bench::new();
        bench.write(SPI[0] + 4, 0x1700);
        for size in sizes {
            assert_eq!(bench.read(SPI[0] + 8) & 2, 2, "{sizes:?}");
            assert_eq!(bench.try_write(SPI[0] + 0x0C, 0x2211, *size), Ok(()), "{sizes:?}");
        }
        assert_eq!(bench.read(SPI[0] + 8) & 2, 0, "{sizes:?}");
        assert_eq!(bench.try_write(SPI[0] + 0x0C, 0x33, 1), Err(NO_ROOM), "{sizes:?}");
        bench.write(SPI[0], 0x345);
        bench.pass(Time::microseconds(30));
        let sent = bench.wires.0.borrow().bytes.len();
        assert_eq!(sent, sizes.iter().sum::<u32>() as usize, "{sizes:?}: all of them and no other");
    }
}

#[test]
fn a_serial_bus_interrupts_by_room_by_a_byte_and_by_an_overrun() {
    for (bus, interrupt) in [(0, 35), (1, 36)] {
        let mut bench = Bench::new();
        bench.write(SPI[bus], 0x345);
        // TXEIE alone: there is room.
        bench.write(SPI[bus] + 4, 0x1780);
        assert!(bench.interrupts(interrupt));
        // RXNEIE alone: nothing has come yet.
        bench.write(SPI[bus] + 4, 0x1740);
        assert!(!bench.interrupts(interrupt));
        bench.try_write(SPI[bus] + 0x0C, 1, 1).expect("a byte");
        bench.pass(Time::microseconds(4));
        assert!(bench.interrupts(interrupt));
        // ERRIE alone: nothing is wrong until a fifth byte comes.
        bench.write(SPI[bus] + 4, 0x1720);
        assert!(!bench.interrupts(interrupt));
        for _ in 0..4 {
            bench.try_write(SPI[bus] + 0x0C, 1, 1).expect("a byte");
            bench.pass(Time::microseconds(4));
        }
        assert!(bench.interrupts(interrupt));
    }
}

#[test]
fn what_a_serial_bus_does_not_do_here_is_refused() {
    // Reverse order of bits, receive only, checksums, half duplex; a bus that another one masters, a select line of the
    // hardware; in CR2 pulses of it, TI's frames, odd last items; words of sixteen bits.
    let first = [0x3C4, 0x744, 0x2344, 0x8344, 0x340, 0x144].map(|value| (0, value));
    let second = [0x1708, 0x1710, 0x3700, 0x5700, 0xF00].map(|value| (4, value));
    for (offset, value) in first.into_iter().chain(second) {
        let refused = Bench::new().try_write(SPI[0] + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{value:#x}: {refused:?}");
    }
}

/// Has a channel of a controller for direct memory access, from zero, move bytes between memory and SPI1.
fn arm(bench: &mut Bench, dma: u32, channel: u32, (memory, count): (u32, u32), control: u32) {
    let registers = dma + 8 + 20 * channel;
    bench.write(registers + 4, count);
    bench.write(registers + 8, SPI[0] + 0x0C);
    bench.write(registers + 12, memory);
    bench.write(registers, control);
}

#[test]
fn the_second_controller_serves_the_first_serial_bus_by_its_channels_3_and_4() {
    let mut bench = Bench::new();
    bench.ram.0[..3].copy_from_slice(&[1, 2, 3]);
    // Request 4 of both channels (table 45).
    bench.write(DMA + 0x400 + 0xA8, 4 << 8 | 4 << 12);
    arm(&mut bench, DMA + 0x400, 2, (MEMORY + 64, 3), 0x83);
    arm(&mut bench, DMA + 0x400, 3, (MEMORY, 3), 0x93);
    bench.write(SPI[0] + 4, 0x1703);
    bench.write(SPI[0], 0x345);
    bench.pass(Time::microseconds(12));
    assert_eq!(bench.ram.0[64..67], [!1, !2, !3]);
    assert!(bench.interrupts(58) && bench.interrupts(59));
}

#[test]
fn of_two_channels_that_are_due_the_one_with_the_higher_priority_goes_first() {
    // RM0351, 11.4.3: by priority, and among equals the lower channel.
    for (priorities, first) in [([0, 0], 3), ([1, 1], 3), ([0, 1], 4), ([2, 3], 4), ([3, 2], 3)] {
        let mut bench = Bench::new();
        // Channel 4 receives from SPI2, channel 5 sends to it: a byte that waits, and room for one.
        bench.write(SPI[1] + 4, 0x1700);
        bench.write(SPI[1], 0x345);
        bench.try_write(SPI[1] + 0x0C, 0x0F, 1).expect("a byte");
        bench.pass(Time::microseconds(4));
        bench.write(DMA + 0xA8, 1 << 12 | 1 << 16);
        // Both use the same byte of memory: what is received first is what is sent.
        bench.ram.0[0] = 0x33;
        for (channel, direction) in [(3, 0x00), (4, 0x10)] {
            let registers = DMA + 8 + 20 * channel;
            bench.write(registers + 4, 1);
            bench.write(registers + 8, SPI[1] + 0x0C);
            bench.write(registers + 12, MEMORY);
            let priority = priorities[channel as usize - 3] << 12;
            bench.write(registers, priority | direction | 1);
        }
        bench.write(SPI[1] + 4, 0x1703);
        let sent = bench.wires.0.borrow().bytes[1].1;
        assert_eq!(sent, if first == 3 { 0xF0 } else { 0x33 }, "{priorities:?}");
    }
}

/// What is told of channel 3 of DMA1, which listens to SPI1, where it writes so many bytes to this register.
fn refusal(register: u32, count: u32) -> Option<Refused> {
    let mut bench = Bench::new();
    bench.write(DMA + 0xA8, 1 << 8);
    for (offset, value) in [(4, count), (8, register), (12, MEMORY), (0, 0x13)] {
        bench.write(DMA + 8 + 40 + offset, value);
    }
    bench.write(SPI[0], 0x345);
    bench.try_write(SPI[0] + 4, 0x1702, 4).err()
}

#[test]
fn direct_memory_access_to_a_register_that_holds_no_data_is_refused() {
    let expected = "direct memory access to another register than one of data";
    for register in [super::GPIO + 0x18, SPI[0] + 8, 0x5000_0000] {
        assert_eq!(refusal(register, 1), Some(Refused::NotModelled(expected)), "{register:#x}");
    }
}

#[test]
fn what_a_register_refuses_is_told_of_direct_memory_access_as_of_any_other() {
    // SPI2 is off, and three bytes fill its buffer.
    assert_eq!(refusal(SPI[1] + 0x0C, 3), None);
    assert_eq!(refusal(SPI[1] + 0x0C, 4), Some(NO_ROOM));
}

#[test]
fn what_the_two_wire_bus_does_not_do_here_is_refused() {
    // CR1 with a digital filter, and as a device; CR2 with ten bits, and a checksum; an own address; a time-out.
    let cases =
        [(0, 1 << 8), (0, 1 << 17), (4, 1 << 11), (4, 1 << 26), (8, 1 << 15), (20, 1 << 15)];
    for (offset, value) in cases {
        let refused = Bench::new().try_write(I2C + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{offset}: {refused:?}");
    }
}

#[test]
fn direct_memory_access_moves_a_whole_transfer_and_interrupts_at_its_end() {
    let mut bench = Bench::new();
    bench.ram.0[..6].copy_from_slice(&[1, 2, 3, 4, 5, 6]);
    // Channel 2 receives, channel 3 sends; both listen to SPI1.
    bench.write(DMA + 0xA8, 1 << 4 | 1 << 8);
    for (channel, memory, control) in [(1, MEMORY + 64, 0x83), (2, MEMORY, 0x93)] {
        let registers = DMA + 8 + 20 * channel;
        bench.write(registers + 4, 6);
        bench.write(registers + 8, SPI[0] + 0x0C);
        bench.write(registers + 12, memory);
        bench.write(registers, control);
    }
    bench.write(SPI[0] + 4, 0x1703);
    bench.write(SPI[0], 0x345);
    // 2 MHz: four microseconds a byte.
    bench.pass(Time::microseconds(23));
    assert!(!bench.interrupts(12));
    bench.pass(Time::microseconds(1));
    assert!(bench.interrupts(12) && bench.interrupts(13));
    assert_eq!(bench.ram.0[64..70], [1, 2, 3, 4, 5, 6].map(|byte: u8| !byte));
    let begun: Vec<u64> =
        bench.wires.0.borrow().bytes.iter().map(|(.., at)| at.as_nanoseconds()).collect();
    assert_eq!(begun, [0, 4000, 8000, 12_000, 16_000, 20_000], "without a pause between bytes");
    assert_eq!(bench.wires.0.borrow().bytes[0].2.mode, MODE_1);
    bench.write(DMA + 4, 0xFF0);
    assert!(!bench.interrupts(12) && !bench.interrupts(13));
}

#[test]
fn a_transfer_that_meets_no_memory_ends_its_channel() {
    let mut bench = Bench::new();
    bench.write(DMA + 0xA8, 1 << 8);
    bench.write(DMA + 8 + 40 + 4, 2);
    bench.write(DMA + 8 + 40 + 8, SPI[0] + 0x0C);
    bench.write(DMA + 8 + 40 + 12, 0x1234_0000);
    bench.write(DMA + 8 + 40, 0x99);
    bench.write(SPI[0] + 4, 0x1702);
    bench.write(SPI[0], 0x345);
    assert_eq!(bench.read(DMA) >> 8 & 0xF, 0x9, "the flag of the error, and the global one");
    assert_eq!(bench.read(DMA + 8 + 40) & 1, 0);
}

#[test]
fn the_two_wire_bus_writes_a_register_and_reads_it_back_after_a_repeated_start() {
    let mut bench = Bench::new();
    bench.write(I2C + 0x10, 0x0010_0408);
    bench.write(I2C, 1);
    bench.write(I2C + 4, 0xD4 | 1 << 16 | 1 << 13);
    bench.pass(Time::microseconds(100));
    assert_eq!(bench.read(I2C + 0x18) & 2, 2, "the first byte is wanted");
    bench.write(I2C + 0x28, 0x0F);
    bench.pass(Time::microseconds(100));
    assert_eq!(bench.read(I2C + 0x18) & 0x40, 0x40, "the transfer is complete");
    bench.write(I2C + 4, 0xD4 | 2 << 16 | 1 << 10 | 1 << 13 | 1 << 25);
    for _ in 0..2 {
        bench.pass(Time::microseconds(100));
        assert_eq!(bench.read(I2C + 0x18) & 4, 4);
        assert_eq!(bench.read(I2C + 0x24), 0x42);
    }
    bench.pass(Time::microseconds(100));
    assert_eq!(bench.read(I2C + 0x18) & 0x20, 0x20, "a stop followed");
    let expected =
        ["start 0x6a writes", "write 0xf", "start 0x6a reads", "read", "read the last", "stop"];
    assert_eq!(bench.wires.0.borrow().conditions, expected);
}

#[test]
fn an_address_that_nobody_has_is_told() {
    let mut bench = Bench::new();
    bench.write(I2C + 0x10, 0x0010_0408);
    bench.write(I2C, 1);
    bench.write(I2C + 4, 0x20 | 1 << 16 | 1 << 13 | 1 << 25);
    bench.pass(Time::microseconds(200));
    assert_eq!(bench.read(I2C + 0x18) & 0x30, 0x30, "no acknowledge, and a stop");
}

#[test]
fn the_two_wire_bus_is_busy_while_its_data_line_is_low_and_a_start_waits_for_it() {
    let mut bench = Bench::new();
    bench.wires.0.borrow_mut().low.push(Pin::named(b"PB11"));
    bench.write(I2C + 0x10, 0x0010_0408);
    let is_busy = |bench: &mut Bench| bench.read(I2C + 0x18) >> 15 & 1 != 0;
    assert!(!is_busy(&mut bench), "the interface is off (39.7.7)");
    bench.write(I2C, 1);
    assert!(is_busy(&mut bench));
    bench.write(I2C + 4, 0xD4 | 1 << 16 | 1 << 13);
    bench.pass(Time::microseconds(1000));
    assert!(is_busy(&mut bench) && bench.wires.0.borrow().conditions.is_empty());
    bench.wires.0.borrow_mut().low.clear();
    bench.read(I2C);
    bench.pass(Time::microseconds(100));
    assert_eq!(bench.wires.0.borrow().conditions, ["start 0x6a writes"]);
}

/// Ends what the two-wire bus does: a name for it, and how.
type End = (&'static str, fn(&mut Bench));

#[test]
fn whatever_ends_a_byte_that_a_device_sends_leaves_the_device_amid_it() {
    let ends: [End; 3] = [
        ("switched off", |bench| bench.write(I2C, 0)),
        ("reset alone", |bench| bench.write(super::RCC + 0x38, 1 << 22)),
        ("reset with the controller", |bench| {
            bench.controller.restart(ResetReason::Watchdog, bench.now);
        }),
    ];
    // 4 MHz / 18: an address takes 45 µs, a byte 40.5 µs.
    let at = [(20, None), (50, Some(1)), (60, Some(3)), (85, Some(8)), (90, Some(0)), (150, None)];
    for (how, end) in ends {
        for (microseconds, bit) in at {
            let mut bench = Bench::new();
            bench.write(I2C + 0x10, 0x0010_0408);
            bench.write(I2C, 1);
            bench.write(I2C + 4, 0xD4 | 2 << 16 | 1 << 10 | 1 << 13 | 1 << 25);
            bench.pass(Time::microseconds(microseconds));
            if microseconds > 130 {
                bench.read(I2C + 0x24);
                bench.pass(Time::microseconds(100));
            }
            end(&mut bench);
            let stopped = bit.map(|bit| format!("no clock from bit {bit} on"));
            let conditions = &bench.wires.0.borrow().conditions;
            let found = conditions.iter().find(|line| line.starts_with("no clock"));
            assert_eq!(found, stopped.as_ref(), "{how} after {microseconds} µs: {conditions:?}");
        }
    }
}
