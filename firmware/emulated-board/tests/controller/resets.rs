//! What a reset ends, and what outlasts it (RM0351, 6.1).

use emulated_board::controller::ResetReason;
use emulated_board::time::Time;
use emulated_board::wiring::Pin;

use super::{Bench, GPIO, MEMORY, RCC};

/// The interfaces SPI1 and SPI2.
const SPI: [u32; 2] = [0x4001_3000, 0x4000_3800];
/// The controllers DMA1 and DMA2.
const DMA: [u32; 2] = [0x4002_0000, 0x4002_0400];
/// The interface I2C2.
const I2C: u32 = 0x4000_5800;
/// The serial port USART1.
const PORT: u32 = 0x4001_3800;
/// The timer TIM15.
const TIMER: u32 = 0x4001_4000;
/// The interrupt controller of edges, and the system configuration, which has the ports of its lines.
const EDGES: [u32; 2] = [0x4001_0400, 0x4001_0000];
/// The independent watchdog.
const WATCHDOG: u32 = 0x4000_3000;
/// Power control.
const POWER: u32 = 0x4000_7000;
/// The debug unit.
const DEBUG: u32 = 0xE004_2000;
/// Registers of the core: the interrupts that are enabled, `VTOR`, and `MPU_CTRL`.
const CORE: [u32; 3] = [0xE000_E100, 0xE000_ED08, 0xE000_ED94];

/// The reasons, each with its flag in the upper byte of `RCC_CSR` beside that of the pin (6.4.30).
const REASONS: [(ResetReason, u32); 4] = [
    (ResetReason::Supply, 0x08),
    (ResetReason::Software, 0x10),
    (ResetReason::Watchdog, 0x20),
    (ResetReason::Pin, 0),
];
/// The flag of the pin, which each reset pulls.
const PIN: u32 = 0x04;

/// A register, what is written there, and what a reset makes of it.
type Register = (u32, u32, u32);

/// Registers by the tables of their chapters, in an order in which they can be written.
fn registers() -> Vec<Register> {
    let mut all = vec![
        (RCC, 0x163, 0x63),
        (RCC + 0x0C, 0x0100_2801, 0x1000),
        (PORT + 0x0C, 400, 0),
        (PORT + 0x08, 1, 0),
        (PORT, 0x2D, 0),
        (I2C + 0x10, 0x0010_0408, 0),
        (I2C, 0x41, 0),
        (TIMER + 0x0C, 6, 0),
        (TIMER + 0x28, 3, 0),
        (TIMER + 0x2C, 0x1234, 0xFFFF),
        (TIMER + 0x34, 1400, 0),
        (TIMER + 0x38, 1500, 0),
        (TIMER, 5, 0),
        (EDGES[0], 1 << 14, 0xFF82_0000),
        (EDGES[0] + 0x08, 1 << 3, 0),
        (EDGES[0] + 0x0C, 1 << 14, 0),
        (EDGES[1] + 0x14, 3 << 8, 0),
        (POWER, 0x300, 0x200),
        (CORE[0], 1, 0),
        (CORE[1], 0x0800_0400, 0),
        (CORE[2], 4, 0),
    ];
    for spi in SPI {
        all.extend([(spi, 0x345, 0), (spi + 4, 0x1703, 0x700)]);
    }
    for dma in DMA {
        let channel = dma + 8 + 20 * 6;
        let settings = [(4, 3, 0), (8, PORT + 0x28, 0), (12, MEMORY, 0), (0, 0x93, 0)];
        all.extend(settings.map(|(offset, written, after)| (channel + offset, written, after)));
        all.push((dma + 0xA8, 0x0010_0000, 0));
    }
    for port in 0..8 {
        let mode = [0xABFF_FFFF, 0xFFFF_FEBF].get(port).copied().unwrap_or(0xFFFF_FFFF);
        let mode = if port == 7 { 0xF } else { mode };
        let base = GPIO + 0x400 * port as u32;
        all.extend([(base + 0x14, 0xFFFF, 0), (base + 4, 1, 0), (base + 0x20, 0x55, 0)]);
        all.push((base, 0x5555_5555, mode));
    }
    all
}

#[test]
fn every_reset_brings_registers_back_to_what_the_manual_has_for_it() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        for (address, written, after) in registers() {
            bench.write(address, written);
            assert_ne!(bench.read(address), after, "{address:#x} is not changed");
        }
        bench.controller.restart(reason, bench.now);
        bench.clock_all();
        for (address, _, after) in registers() {
            assert_eq!(bench.read(address), after, "{address:#x} after {reason:?}");
        }
    }
}

#[test]
fn every_reset_takes_the_clocks_of_all_peripherals_away() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        bench.controller.restart(reason, bench.now);
        // 6.4.15 to 6.4.21: the interface of the flash alone keeps its clock.
        let clocks = [0x48, 0x4C, 0x58, 0x60].map(|offset| bench.read(RCC + offset));
        assert_eq!(clocks, [0x100, 0, 0, 0], "{reason:?}");
    }
}

#[test]
fn every_reset_has_the_core_go_on_by_the_oscillator_of_4_megahertz() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        bench.write(RCC, 0x163);
        bench.write(RCC + 0x08, 1);
        assert_eq!(bench.controller.hertz(), 16_000_000);
        bench.controller.restart(reason, bench.now);
        assert_eq!(bench.controller.hertz(), 4_000_000, "{reason:?}");
    }
}

/// Something that goes on of itself until it interrupts.
type Activity = (&'static str, fn(&mut Bench), usize);

/// Begins one thing at a time, each with the interrupt that tells its end.
const ACTIVITIES: [Activity; 6] = [
    ("a byte on SPI1", |bench| exchange(bench, SPI[0]), 35),
    ("a byte on SPI2", |bench| exchange(bench, SPI[1]), 36),
    (
        "an address on the two-wire bus",
        |bench| {
            bench.write(I2C + 0x10, 0x0010_0408);
            bench.write(I2C, 0x43);
            bench.write(I2C + 4, 0xD4 | 1 << 16 | 1 << 13);
        },
        33,
    ),
    (
        "a frame that is sent",
        |bench| {
            bench.write(PORT + 0x0C, 400);
            bench.write(PORT, 0x4D);
            bench.write(PORT + 0x28, b'A'.into());
        },
        37,
    ),
    (
        "a count of the timer",
        |bench| {
            bench.write(TIMER + 0x34, 1400);
            bench.write(TIMER + 0x0C, 2);
            bench.write(TIMER, 5);
        },
        24,
    ),
    (
        "a transfer of the memory to SPI1",
        |bench| {
            bench.write(DMA[1] + 0xA8, 4 << 12);
            let channel = DMA[1] + 8 + 20 * 3;
            for (offset, value) in [(4, 6), (8, SPI[0] + 0x0C), (12, MEMORY), (0, 0x93)] {
                bench.write(channel + offset, value);
            }
            bench.write(SPI[0] + 4, 0x1702);
            bench.write(SPI[0], 0x345);
        },
        59,
    ),
];

/// Has an interface send a byte, whose answer interrupts.
fn exchange(bench: &mut Bench, spi: u32) {
    bench.write(spi + 4, 0x1740);
    bench.write(spi, 0x345);
    bench.try_write(spi + 0x0C, 0x5A, 1).expect("a byte");
}

#[test]
fn every_reset_ends_what_was_under_way() {
    let span = Time::microseconds(2000);
    for (what, begin, interrupt) in ACTIVITIES {
        let mut bench = Bench::new();
        begin(&mut bench);
        assert!(!bench.interrupts(interrupt), "{what} has ended at once");
        bench.pass(span);
        assert!(bench.interrupts(interrupt), "{what} does not end");
        for (reason, _) in REASONS {
            let mut bench = Bench::new();
            begin(&mut bench);
            bench.controller.restart(reason, bench.now);
            assert_eq!(bench.controller.due(bench.now), Time::NEVER, "{what} after {reason:?}");
            bench.clock_all();
            bench.pass(span);
            let active: Vec<usize> = (0..82).filter(|number| bench.interrupts(*number)).collect();
            assert!(active.is_empty(), "{what} after {reason:?}: {active:?}");
            assert!(bench.controller.usart.sent.is_empty(), "{what} after {reason:?}");
        }
    }
}

#[test]
fn every_reset_forgets_an_edge_that_was_not_served() {
    let pin = Pin::named(b"PD14");
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        bench.set_mode(pin, 0);
        bench.write(EDGES[1] + 0x14, 3 << 8);
        bench.write(EDGES[0] + 0x0C, 1 << 14);
        bench.wires.0.borrow_mut().edge = Some((Time::microseconds(1), pin, false));
        bench.pass(Time::microseconds(1));
        assert_eq!(bench.read(EDGES[0] + 0x14), 1 << 14);
        bench.controller.restart(reason, bench.now);
        assert_eq!(bench.read(EDGES[0] + 0x14), 0, "{reason:?}");
    }
}

#[test]
fn every_reset_lets_all_pins_go() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        for port in 0..8 {
            bench.write(GPIO + 0x400 * port, 0x5555_5555);
        }
        bench.controller.restart(reason, bench.now);
        let wires = bench.wires.0.borrow();
        for pin in (0..8).flat_map(|port| (0..16).map(move |number| Pin { port, number })) {
            let levels: Vec<Option<bool>> = wires
                .driven
                .iter()
                .filter(|(own, _)| *own == pin)
                .map(|(_, level)| *level)
                .collect();
            assert!(levels.contains(&Some(false)), "{pin} was no output");
            assert_eq!(levels.last(), Some(&None), "{pin} after {reason:?}");
        }
    }
}

#[test]
fn every_reset_stops_the_watchdog_and_brings_its_time_back() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        for (offset, value) in [(0, 0xCCCC), (0, 0x5555), (4, 4), (8, 0x7FF)] {
            bench.write(WATCHDOG + offset, value);
        }
        bench.controller.restart(reason, bench.now);
        bench.pass(Time::seconds(30.0));
        assert_eq!(bench.controller.reset, None, "after {reason:?}");
        assert_eq!([4, 8].map(|offset| bench.read(WATCHDOG + offset)), [0, 0xFFF], "{reason:?}");
        bench.write(WATCHDOG + 8, 1);
        assert_eq!(bench.read(WATCHDOG + 8), 0xFFF, "it is open after {reason:?}");
    }
}

#[test]
fn reasons_add_up_until_they_are_cleared_or_the_supply_is_lost() {
    for (reason, flag) in REASONS {
        let mut bench = Bench::clocked();
        bench.controller.restart(ResetReason::Watchdog, bench.now);
        bench.controller.restart(reason, bench.now);
        // Those of the supply and of the watchdog came before.
        let before = if reason == ResetReason::Supply { 0 } else { 0x28 };
        assert_eq!(bench.read(RCC + 0x94) >> 24, before | flag | PIN, "{reason:?}");
        bench.write(RCC + 0x94, 1 << 23);
        bench.controller.restart(reason, bench.now);
        assert_eq!(bench.read(RCC + 0x94) >> 24, flag | PIN, "{reason:?}, after they were cleared");
    }
}

#[test]
fn the_crystal_goes_on_over_every_reset_but_a_loss_of_supply() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        bench.write(POWER, 0x300);
        bench.write(RCC + 0x90, 1 | 2 << 3);
        bench.pass(Time::seconds(2.1));
        bench.controller.restart(reason, bench.now);
        // Switched on, ready at once, with its drive; or the reset value (6.4.29).
        let expected = if reason == ResetReason::Supply { 0 } else { 0b1_0011 };
        assert_eq!(bench.read(RCC + 0x90), expected, "{reason:?}");
    }
}

#[test]
fn the_debug_unit_is_reset_by_a_loss_of_supply_alone() {
    for (reason, _) in REASONS {
        let mut bench = Bench::clocked();
        bench.write(DEBUG + 4, 7);
        bench.write(DEBUG + 8, 1 << 12);
        bench.controller.restart(reason, bench.now);
        // 48.16.3 to 48.16.6: a reset of the system does not touch it.
        let expected = if reason == ResetReason::Supply { [0, 0] } else { [7, 1 << 12] };
        assert_eq!([4, 8].map(|offset| bench.read(DEBUG + offset)), expected, "{reason:?}");
    }
}
