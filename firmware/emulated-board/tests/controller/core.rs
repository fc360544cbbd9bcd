//! Registers of the core (ARMv7-M Architecture Reference Manual, B3).

use emulated_board::controller::Refused;

use super::Bench;

/// `SYST_CSR`, `SYST_RVR` and `SYST_CVR`.
const TICK: [u32; 3] = [0xE000_E010, 0xE000_E014, 0xE000_E018];
/// `SHCSR`.
const HANDLERS: u32 = 0xE000_ED24;

/// What a write of the core is refused for.
fn refusal(address: u32, value: u32) -> Option<Refused> {
    Bench::clocked().try_write(address, value, 4).err()
}

#[test]
fn the_timer_of_the_core_may_be_set_and_is_refused_when_it_is_to_count() {
    let mut bench = Bench::clocked();
    bench.write(TICK[1], 0x1234_5678);
    assert_eq!(bench.read(TICK[1]), 0x34_5678, "24 bits");
    bench.write(TICK[2], 5);
    assert_eq!(bench.read(TICK[2]), 0, "any value clears the count");
    bench.write(TICK[0], 6);
    assert_eq!(bench.read(TICK[0]), 6);
    assert_eq!(bench.try_write(TICK[0], 7, 4), Err(Refused::NotModelled("the core's timer")));
}

#[test]
fn faults_are_enabled_and_no_exception_is_made_active_or_pending_by_hand() {
    let mut bench = Bench::clocked();
    bench.write(HANDLERS, 7 << 16);
    assert_eq!(bench.read(HANDLERS), 7 << 16);
    bench.write(HANDLERS, 1 << 17);
    assert_eq!(bench.read(HANDLERS), 1 << 17);
    for bit in [0, 1, 3, 7, 10, 11, 12, 13, 14, 15] {
        let refused = refusal(HANDLERS, 1 << bit);
        assert!(matches!(refused, Some(Refused::NotModelled(_))), "bit {bit}: {refused:?}");
    }
}

#[test]
fn a_supervisor_call_that_is_pending_stays_so_when_faults_are_enabled() {
    let mut bench = Bench::clocked();
    bench.controller.exceptions.pending.put(11, true);
    let held = bench.read(HANDLERS);
    assert_eq!(held, 1 << 15);
    bench.write(HANDLERS, held | 1 << 18);
    assert_eq!(bench.read(HANDLERS), 1 << 15 | 1 << 18);
}

#[test]
fn what_the_core_does_not_do_here_is_refused() {
    // AIRCR with groups of priorities, and without its key; SCR with deep sleep, and sleep after handlers; CCR with faults
    // that are ignored, and interrupts by threads without privilege; CPACR without floats; DEMCR with the monitor; FPCCR
    // without stacking; FPDSCR.
    for (address, value) in [
        (0xE000_ED0C, 0x05FA_0300),
        (0xE000_ED0C, 4),
        (0xE000_ED10, 4),
        (0xE000_ED10, 2),
        (0xE000_ED14, 0x300),
        (0xE000_ED14, 0x202),
        (0xE000_ED88, 0),
        (0xE000_EDFC, 1 << 16),
        (0xE000_EF34, 0),
        (0xE000_EF3C, 1 << 24),
    ] {
        let refused = refusal(address, value);
        assert!(matches!(refused, Some(Refused::NotModelled(_))), "{address:#x}: {refused:?}");
    }
}
