//! Clocks, the timer and the watchdog.

use emulated_board::controller::{Refused, ResetReason};
use emulated_board::time::Time;

use super::{Bench, RCC};

/// The timer TIM15.
const TIMER: u32 = 0x4001_4000;
/// The independent watchdog.
const WATCHDOG: u32 = 0x4000_3000;
/// Registers of the flash.
const FLASH: u32 = 0x4002_2000;
/// `RCC_PLLCFGR` that makes 80 MHz of the 4 MHz of the oscillator MSI.
const PLL: u32 = 1 | 40 << 8 | 1 << 24;
/// Power control.
const POWER: u32 = 0x4000_7000;

#[test]
fn a_peripheral_without_its_clock_is_refused() {
    let mut bench = Bench::new();
    bench.write(RCC + 0x60, 0);
    assert_eq!(bench.try_read(TIMER, 4), Err(Refused::NoClock));
    bench.write(RCC + 0x60, 1 << 16);
    assert_eq!(bench.try_read(TIMER, 4), Ok(0));
}

#[test]
fn what_the_model_does_not_have_is_refused() {
    let mut bench = Bench::new();
    // A timer that no image uses, a reserved register of a port, one of the clocks, an address that is none.
    for address in [0x4000_0000, 0x4800_0030, RCC + 0x24, 0x5000_0000] {
        assert_eq!(bench.try_read(address, 4), Err(Refused::Unknown), "{address:#x}");
        assert_eq!(bench.try_write(address, 0, 4), Err(Refused::Unknown), "{address:#x}");
    }
}

#[test]
fn the_oscillator_follows_the_crystal_when_that_oscillates() {
    let mut bench = Bench::new();
    assert_eq!(bench.controller.hertz(), 4_000_000);
    bench.write(RCC + 0x90, 1);
    assert_eq!(bench.read(RCC + 0x90), 0, "the backup domain is closed");
    bench.write(POWER, 0x300);
    bench.write(RCC + 0x90, 1);
    let control = bench.read(RCC);
    bench.write(RCC, control | 4);
    assert_eq!((bench.read(RCC + 0x90) & 2, bench.controller.hertz()), (0, 4_000_000));
    bench.pass(Time::seconds(2.1));
    assert_eq!(bench.read(RCC + 0x90) & 2, 2);
    // 122 periods of 32 768 Hz.
    assert_eq!(bench.controller.hertz(), 3_997_696);
    // With four wait states the PLL makes twenty times that of it.
    bench.write(FLASH, 0x604);
    bench.write(RCC + 0x0C, PLL);
    bench.write(RCC + 0x08, 3);
    assert_eq!(bench.controller.hertz(), 79_953_920);
}

#[test]
fn a_clock_that_is_too_fast_for_the_wait_states_of_the_flash_is_refused() {
    // 80 MHz and wait states (RM0351, 3.3.3, range 1): four are enough, three are for 64 MHz.
    for (wait_states, is_enough) in [(4, true), (3, false), (0, false)] {
        let mut bench = Bench::clocked();
        bench.write(RCC + 0x0C, PLL);
        bench.write(FLASH, 0x600 | wait_states);
        let switched = bench.try_write(RCC + 0x08, 3, 4);
        assert_eq!(switched.is_ok(), is_enough, "{wait_states}: {switched:?}");
    }
    // 16 MHz need none.
    let mut bench = Bench::clocked();
    bench.write(RCC, 0x163);
    bench.write(RCC + 0x08, 1);
    assert_eq!(bench.controller.hertz(), 16_000_000);
}

#[test]
fn a_divider_that_is_not_modelled_is_refused() {
    let mut bench = Bench::new();
    let refused = bench.try_write(RCC + 0x08, 8 << 4, 4);
    assert!(matches!(refused, Err(Refused::NotModelled(_))), "{refused:?}");
}

#[test]
fn clocks_begin_as_the_manual_has_them() {
    let mut bench = Bench::clocked();
    // 6.4: CR with the oscillator MSI, which is ready; the PLLs; all peripherals clocked in sleep.
    for (offset, expected) in [
        (0x00, 0x63),
        (0x08, 0),
        (0x0C, 0x1000),
        (0x10, 0x1000),
        (0x14, 0x1000),
        (0x18, 0),
        (0x1C, 0),
        (0x68, 0x0001_1303),
        (0x6C, 0x0005_32FF),
        (0x70, 0x101),
        (0x78, 0xF2FE_CA3F),
        (0x7C, 0x25),
        (0x80, 0x0167_7C01),
        (0x88, 0),
        (0x90, 0),
        (0x94, 0x0C00_0600),
    ] {
        assert_eq!(bench.read(RCC + offset), expected, "{offset:#x}");
    }
}

#[test]
fn what_the_clocks_do_not_do_here_is_refused() {
    let mut bench = Bench::clocked();
    bench.write(0x4000_7000, 0x300);
    // CR: HSE, its guard, a further PLL; ICSCR; CFGR: a pin with a clock; CIER: LSE is ready; SMENR; CCIPR: USART1, I2C2;
    // BDCR: no oscillator, a guard.
    for (offset, bits) in [
        (0x00, 1 << 16),
        (0x00, 1 << 19),
        (0x00, 1 << 26),
        (0x04, 1 << 24),
        (0x08, 1 << 24),
        (0x18, 1 << 1),
        (0x68, 1 << 0),
        (0x80, 1 << 12),
        (0x88, 1 << 0),
        (0x88, 1 << 14),
        (0x90, 1 << 2),
        (0x90, 1 << 5),
    ] {
        let before = bench.read(RCC + offset);
        let refused = bench.try_write(RCC + offset, before ^ bits, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{offset:#x}: {refused:?}");
        assert_eq!(bench.read(RCC + offset), before, "{offset:#x}");
        bench.write(RCC + offset, before);
    }
}

#[test]
fn a_part_of_a_register_is_not_written() {
    let mut bench = Bench::clocked();
    for (address, size) in
        [(super::GPIO + 0x14, 2), (RCC + 0x4C, 1), (TIMER + 0x2C, 1), (TIMER + 0x2E, 2)]
    {
        let refused = bench.try_write(address, 0, size);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{address:#x}: {refused:?}");
    }
    assert_eq!(bench.try_write(TIMER + 0x2C, 0xFF, 2), Ok(()), "a register of sixteen bits");
}

/// A timer that counts microseconds, at 4 MHz.
fn timer() -> Bench {
    let mut bench = Bench::new();
    bench.write(TIMER + 0x28, 3);
    bench.write(TIMER + 0x2C, 0xFFFF);
    bench.write(TIMER, 4);
    bench.write(TIMER + 0x14, 1);
    bench.write(TIMER, 5);
    bench
}

#[test]
fn the_timer_counts_and_wraps() {
    let mut bench = timer();
    bench.pass(Time::microseconds(1000));
    assert_eq!(bench.read(TIMER + 0x24), 1000);
    bench.pass(Time::microseconds(65_000));
    assert_eq!(bench.read(TIMER + 0x24), 66_000 - 65_536);
    assert_eq!(bench.read(TIMER + 0x10) & 1, 1, "an overflow sets its flag");
}

#[test]
fn a_timer_whose_clock_changes_keeps_its_count_and_goes_on_at_the_new_one() {
    let mut bench = timer();
    bench.write(TIMER + 0x38, 1400);
    bench.write(TIMER + 0x0C, 4);
    bench.pass(Time::microseconds(1000));
    // HSI16, four times as fast.
    let control = bench.read(RCC);
    bench.write(RCC, control | 1 << 8);
    bench.write(RCC + 0x08, 1);
    assert_eq!(bench.controller.hertz(), 16_000_000);
    assert_eq!(bench.read(TIMER + 0x24), 1000);
    bench.pass(Time::microseconds(99));
    assert_eq!((bench.read(TIMER + 0x24), bench.interrupts(24)), (1396, false));
    bench.pass(Time::microseconds(1));
    assert_eq!((bench.read(TIMER + 0x24), bench.interrupts(24)), (1400, true));
}

#[test]
fn a_prescaler_acts_from_the_update_on() {
    let mut bench = Bench::clocked();
    bench.write(TIMER + 0x28, 3);
    bench.write(TIMER, 1);
    bench.pass(Time::microseconds(10));
    assert_eq!(bench.read(TIMER + 0x24), 40, "4 MHz");
    bench.write(TIMER + 0x14, 1);
    bench.pass(Time::microseconds(10));
    assert_eq!(bench.read(TIMER + 0x24), 10, "1 MHz");
}

#[test]
fn what_the_timer_does_not_do_here_is_refused() {
    // CR1: down, one pulse; DIER: memory; EGR: a compare; SMCR: an external clock; CCER: an output; BDTR: its enable.
    for (offset, value) in [
        (0x00, 1 << 3),
        (0x00, 1 << 11),
        (0x0C, 1 << 8),
        (0x14, 2),
        (0x08, 7),
        (0x20, 1),
        (0x44, 1 << 15),
    ] {
        let refused = timer().try_write(TIMER + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{offset:#x}: {refused:?}");
    }
    let refused = timer().try_write(TIMER + 0x28, 7, 4);
    assert!(matches!(refused, Err(Refused::NotModelled(_))), "while it counts: {refused:?}");
}

#[test]
fn a_compare_channel_interrupts_once_in_each_round() {
    let mut bench = timer();
    bench.write(TIMER + 0x38, 500);
    bench.write(TIMER + 0x0C, 4);
    for _ in 0..3 {
        bench.pass(Time::microseconds(499));
        assert!(!bench.interrupts(24));
        bench.pass(Time::microseconds(1));
        assert!(bench.interrupts(24));
        bench.write(TIMER + 0x10, !4);
        assert!(!bench.interrupts(24));
        bench.pass(Time::microseconds(65_536 - 500));
    }
}

#[test]
fn the_watchdog_resets_after_its_time_and_the_reason_is_kept() {
    let mut bench = Bench::new();
    bench.write(WATCHDOG, 0xCCCC);
    bench.write(WATCHDOG, 0x5555);
    bench.write(WATCHDOG + 4, 4);
    // 4096 periods of 32 kHz / 64.
    let span = Time::seconds(8.192);
    bench.pass(Time::seconds(8.0));
    bench.write(WATCHDOG, 0xAAAA);
    bench.pass(span - Time::microseconds(1));
    assert_eq!(bench.controller.reset, None);
    bench.pass(Time::microseconds(2));
    assert_eq!(bench.controller.reset, Some(ResetReason::Watchdog));
    bench.controller.restart(ResetReason::Watchdog, bench.now);
    // The flag of the watchdog, beside those of the pin and of the supply before it.
    assert_eq!(bench.read(RCC + 0x94) >> 24, 0x2C);
    bench.write(RCC + 0x94, 1 << 23);
    assert_eq!(bench.read(RCC + 0x94) >> 24, 0);
    bench.pass(Time::seconds(20.0));
    assert_eq!(bench.controller.reset, None, "a reset stops the watchdog");
}

#[test]
fn the_key_of_reloading_alone_feeds_the_watchdog() {
    // 36.4.1: 0xAAAA reloads, 0x5555 opens the registers, 0xCCCC starts, which it does once; any other means nothing.
    for (key, feeds) in [(0xAAAA, true), (0x5555, false), (0xCCCC, false), (0, false)] {
        let mut bench = Bench::clocked();
        bench.write(WATCHDOG, 0xCCCC);
        // 4096 periods of 32 kHz / 4.
        bench.pass(Time::microseconds(300_000));
        bench.write(WATCHDOG, key);
        bench.pass(Time::microseconds(300_000));
        let reset = (!feeds).then_some(ResetReason::Watchdog);
        assert_eq!(bench.controller.reset, reset, "{key:#x}");
    }
}
