//! Which exception goes before which, against the manual's rules (ARMv7-M Architecture Reference Manual, B1.5).

use emulated_board::exceptions::{
    BUS_FAULT, Exceptions, FIRST_INTERRUPT, HARD_FAULT, Masks, NOT_MASKABLE, SUPERVISOR_CALL, Set,
};

/// Two interrupts: the third and the fortieth.
const FIRST: u32 = FIRST_INTERRUPT + 3;
const SECOND: u32 = FIRST_INTERRUPT + 40;
const NO_MASK: Masks = Masks { all: false, faults: false, base: 0 };

/// Two interrupts that are enabled, with these priorities.
fn two(priorities: [u8; 2]) -> Exceptions {
    let mut exceptions = Exceptions::default();
    for (number, priority) in [FIRST, SECOND].into_iter().zip(priorities) {
        exceptions.enabled.put(number, true);
        exceptions.priorities[number as usize] = priority;
    }
    exceptions
}

#[test]
fn of_two_as_urgent_that_of_the_lower_number_goes_first() {
    for (priorities, expected) in [([0x40, 0x40], FIRST), ([0x50, 0x40], SECOND)] {
        let mut exceptions = two(priorities);
        exceptions.pending.put_interrupts(0, 1 << 3, true);
        exceptions.pending.put_interrupts(32, 1 << 8, true);
        assert_eq!(exceptions.next(NO_MASK), Some(expected), "{priorities:x?}");
    }
}

#[test]
fn only_what_is_more_urgent_interrupts_a_handler() {
    for (second, expected) in [(0x30, Some(SECOND)), (0x40, None), (0x50, None)] {
        let mut exceptions = two([0x40, second]);
        exceptions.enter(FIRST);
        exceptions.lines.put(SECOND, true);
        assert_eq!(exceptions.next(NO_MASK), expected, "{second:x}");
        exceptions.leave(FIRST);
        assert_eq!(exceptions.next(NO_MASK), Some(SECOND));
    }
}

#[test]
fn each_mask_holds_back_what_it_is_for() {
    let masks = |all, faults, base| Masks { all, faults, base };
    // PRIMASK, FAULTMASK, BASEPRI: then whether an interrupt of 40, a hard fault and what nothing masks are taken.
    let table = [
        (masks(false, false, 0), [true, true, true]),
        (masks(true, false, 0), [false, true, true]),
        (masks(false, true, 0), [false, false, true]),
        (masks(false, false, 0x40), [false, true, true]),
        (masks(false, false, 0x50), [true, true, true]),
    ];
    for (masks, expected) in table {
        let taken = [FIRST, HARD_FAULT, NOT_MASKABLE].map(|number| {
            let mut exceptions = two([0x40, 0]);
            exceptions.pending.put(number, true);
            exceptions.next(masks) == Some(number)
        });
        assert_eq!(taken, expected, "{masks:?}");
    }
}

#[test]
fn a_line_that_is_active_makes_its_exception_pending_only_when_its_handler_has_ended() {
    let mut exceptions = two([0x40, 0x40]);
    exceptions.lines.put(FIRST, true);
    exceptions.enter(FIRST);
    assert!(!exceptions.requested().has(FIRST) && !exceptions.waits());
    // One that was made pending is pending while it is active too (B3.4.1).
    exceptions.pending.put(FIRST, true);
    assert!(exceptions.requested().has(FIRST) && exceptions.next(NO_MASK).is_none());
    exceptions.pending.put(FIRST, false);
    exceptions.leave(FIRST);
    assert_eq!(exceptions.next(NO_MASK), Some(FIRST));
}

#[test]
fn the_mask_of_all_does_not_keep_an_interrupt_from_waking_the_core_but_that_of_priorities_does() {
    let mut exceptions = two([0x40, 0x40]);
    exceptions.pending.put(FIRST, true);
    let wakes = |masks| exceptions.wakes(masks);
    assert!(wakes(Masks { all: true, ..NO_MASK }) && wakes(Masks { base: 0x50, ..NO_MASK }));
    assert!(!wakes(Masks { base: 0x40, ..NO_MASK }) && !wakes(Masks { faults: true, ..NO_MASK }));
}

#[test]
fn a_fault_that_is_disabled_or_not_urgent_enough_is_a_hard_fault() {
    let mut exceptions = two([0x40, 0x40]);
    assert!(exceptions.escalates(BUS_FAULT, NO_MASK), "it is disabled after a reset");
    exceptions.enabled.put(BUS_FAULT, true);
    assert!(!exceptions.escalates(BUS_FAULT, NO_MASK));
    assert!(exceptions.escalates(BUS_FAULT, Masks { all: true, ..NO_MASK }));
    exceptions.enter(FIRST);
    for (priority, expected) in [(0x30, false), (0x40, true), (0x50, true)] {
        exceptions.priorities[BUS_FAULT as usize] = priority;
        exceptions.priorities[SUPERVISOR_CALL as usize] = priority;
        assert_eq!(exceptions.escalates(BUS_FAULT, NO_MASK), expected, "{priority:x}");
        assert_eq!(exceptions.escalates(SUPERVISOR_CALL, NO_MASK), expected, "{priority:x}");
    }
}

#[test]
fn nothing_but_what_nothing_masks_interrupts_a_hard_fault() {
    let mut exceptions = two([0, 0]);
    exceptions.enter(HARD_FAULT);
    exceptions.pending.put(FIRST, true);
    assert!(exceptions.next(NO_MASK).is_none() && exceptions.is_locked(NO_MASK));
    exceptions.pending.put(NOT_MASKABLE, true);
    assert_eq!(exceptions.next(NO_MASK), Some(NOT_MASKABLE));
    assert!(exceptions.is_base(HARD_FAULT) && !exceptions.is_base(FIRST));
}

#[test]
fn interrupts_that_the_controller_does_not_have_are_in_no_register() {
    let mut set = Set::default();
    for first in [0, 32, 64] {
        set.put_interrupts(first, u32::MAX, true);
    }
    assert_eq!([0, 32, 64].map(|first| set.interrupts(first)), [u32::MAX, u32::MAX, 0x3_FFFF]);
    set.put_interrupts(32, 0xFF, false);
    assert_eq!(set.interrupts(32), 0xFFFF_FF00);
}
