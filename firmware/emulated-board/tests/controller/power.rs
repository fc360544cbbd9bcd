//! Power control (RM0351, chapter 5) and the debug unit (chapter 48).

use emulated_board::controller::{Refused, ResetReason};
use emulated_board::time::Time;

use super::{Bench, RCC};

/// Power control.
const POWER: u32 = 0x4000_7000;
/// The debug unit.
const DEBUG: u32 = 0xE004_2000;
/// The independent watchdog.
const WATCHDOG: u32 = 0x4000_3000;

#[test]
fn power_control_begins_as_the_manual_has_it() {
    let mut bench = Bench::clocked();
    // 5.4.1 to 5.4.4: CR1 to CR4; the low-power regulator is ready (5.4.6).
    let held = [0x00, 0x04, 0x08, 0x0C, 0x14].map(|offset| bench.read(POWER + offset));
    assert_eq!(held, [0x200, 0, 0x8000, 0, 0x100]);
}

#[test]
fn the_backup_domain_is_written_only_while_it_is_open() {
    let mut bench = Bench::clocked();
    let crystal = |bench: &mut Bench, value: u32| {
        bench.write(RCC + 0x90, value);
        bench.read(RCC + 0x90) & 1
    };
    assert_eq!(crystal(&mut bench, 1), 0);
    bench.write(POWER, 0x300);
    assert_eq!(crystal(&mut bench, 1), 1);
    // A reset of power control closes it again.
    bench.write(RCC + 0x38, 1 << 28);
    bench.write(RCC + 0x38, 0);
    assert_eq!(bench.read(POWER), 0x200);
    assert_eq!(crystal(&mut bench, 0), 1);
}

#[test]
fn other_voltages_their_monitors_and_standby_are_refused() {
    let mut bench = Bench::clocked();
    let range_2 = (0x00, 0x400);
    let low_power_run = (0x00, 0x4200);
    let (detector, pulls, wake_up) = ((0x04, 1), (0x08, 0x8400), (0x0C, 1));
    for (offset, value) in [range_2, low_power_run, detector, pulls, wake_up] {
        let before = bench.read(POWER + offset);
        let refused = bench.try_write(POWER + offset, value, 4);
        assert!(matches!(refused, Err(Refused::NotModelled(_))), "{offset:#x}: {refused:?}");
        assert_eq!(bench.read(POWER + offset), before);
    }
}

#[test]
fn the_debug_unit_keeps_what_is_to_stop_with_the_core_which_nothing_halts() {
    let mut bench = Bench::clocked();
    // 48.16.3 to 48.16.6: DBGMCU_CR, APB1FZR1 with the watchdog, APB1FZR2, APB2FZR.
    for (offset, value) in [(0x04, 7), (0x08, 1 << 12), (0x0C, 1 << 5), (0x10, 1 << 16)] {
        assert_eq!(bench.read(DEBUG + offset), 0);
        bench.write(DEBUG + offset, value);
        assert_eq!(bench.read(DEBUG + offset), value);
    }
    bench.write(WATCHDOG, 0xCCCC);
    bench.pass(Time::seconds(1.0));
    assert_eq!(bench.controller.reset, Some(ResetReason::Watchdog));
    assert_eq!(bench.try_read(DEBUG, 4), Err(Refused::Unknown), "the identity is not modelled");
}
