//! Serial buses with direct memory access, and the two-wire bus.

use embedded_hal::spi::{MODE_1, MODE_3};
use emulated_board::time::Time;

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
