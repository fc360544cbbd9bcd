//! The core's exceptions, faults and memory protection, held to those of QEMU by an image that both execute.

mod exceptions;
mod images;
mod memory;
mod protection;
mod returns;
mod system;
mod time;

use emulated_board::controller::ResetReason;
use emulated_board::processor::blocks::Blocks;
use emulated_board::time::Time;
use images::{Board, LOOK};

/// What QEMU says beside the steps when the core has locked up.
const LOCKED: &str = "Lockup: can't escalate 3 to HardFault";

/// Steps in which QEMU 7.2 departs from the ARMv7-M Architecture Reference Manual: what it tells, and what the manual
/// asks for.
const DEPARTURES: [(&str, &str); 5] = [
    // The controller has the upper four bits of a priority (RM0351, 12.1); QEMU has all eight.
    (
        "bits of a priority: 80803f4f 21000000 4f >3d <3d held f >3c <3c",
        "bits of a priority: 80803040 20000000 40 >3d <3d held >3c <3c 0",
    ),
    // Registers are devices, where each access must be aligned (A3.2.1).
    (
        "registers not aligned: 0",
        "registers not aligned: >6 1000000 0 70008 at 0 <6 >6 1000000 0 70008 at 0 <6 0",
    ),
    // INVSTATE (B1.5.8); QEMU takes the address for that of an instruction of four bytes that is not aligned.
    (
        "to code without Thumb: >3c <3c >6 1000000 0 70008 0 <6",
        "to code without Thumb: >3c <3c >6 20000 0 70008 0 <6",
    ),
    // An access that is not aligned is several that are (A3.2.1), each of which is checked; QEMU checks the first byte.
    (
        "small region: 55 >4 40 82 <4 >4 40 82 <4 f >4 5c 82 <4 >4 5c 82 <4 f 55 11000000",
        "small region: 55 >4 40 82 <4 >4 40 82 <4 f >4 5c 82 <4 >4 5c 82 <4 f 55 >4 40 82 <4 f",
    ),
    // The third eighth is of the region (B3.5.3); QEMU keeps what it found for the second one, for a page of 1 KiB.
    (
        "subregion: >4 fc 82 <4 >4 fc 82 <4 f 55 55 55 >4 6fc 82 <4 >4 6fc 82 <4 f 55",
        "subregion: >4 fc 82 <4 >4 fc 82 <4 f 55 55 >4 200 82 <4 >4 200 82 <4 f >4 6fc 82 <4 >4 6fc 82 <4 f 55",
    ),
];

#[test]
fn every_step_goes_as_in_qemu_or_as_the_manual_has_it() -> Result<(), String> {
    let told = images::in_qemu()?;
    let (expected, after) =
        told.split_once("end\n").ok_or_else(|| format!("QEMU ended early:\n{told}"))?;
    assert!(after.contains(LOCKED), "the last fault did not lock QEMU's core up: {after}");
    for (line, _) in DEPARTURES {
        assert!(expected.lines().any(|told| told == line), "QEMU no longer tells {line}");
    }
    let mut board = Board::new()?;
    let lines = board.lines_until("end");
    let expected: Vec<&str> = expected.lines().map(by_manual).chain(["end"]).collect();
    let differences = expected.iter().enumerate().filter_map(|(place, expected)| {
        let told = lines.get(place).map_or("nothing", String::as_str);
        (told != *expected).then(|| format!("\nexpected {expected}\n    told {told}"))
    });
    let differences: String = differences.collect();
    assert!(differences.is_empty(), "{differences}");
    Ok(())
}

/// The line of a step by the manual, for which QEMU tells this one.
fn by_manual(told: &str) -> &str {
    DEPARTURES.iter().find(|(line, _)| *line == told).map_or(told, |(_, manual)| *manual)
}

#[test]
fn a_fault_in_the_handler_of_hard_faults_locks_the_core_up() -> Result<(), String> {
    let mut board = Board::new()?;
    board.lines_until("end");
    board.go_on(LOOK)?;
    assert!(board.processor.is_locked(), "the core goes on");
    let instructions = board.processor.with_blocks(Blocks::instructions);
    let now = board.processor.now();
    board.go_on(LOOK)?;
    assert_eq!(board.processor.with_blocks(Blocks::instructions), instructions, "it executes");
    assert!(board.processor.now() > now, "time stands still");
    Ok(())
}

#[test]
fn no_interrupt_between_two_instructions_changes_what_is_computed() -> Result<(), String> {
    /// The interrupt whose handler overwrites all registers that it may.
    const QUIET: u32 = 16 + 50;
    let told = images::in_qemu()?;
    let mut board = Board::new()?;
    let (mut lines, mut pended) = (Vec::new(), 0);
    while lines.last().is_none_or(|line: &String| !line.starts_with("storm")) {
        let is_enabled = board.processor.with_controller(|controller| {
            let exceptions = &mut controller.exceptions;
            exceptions.pending.put(QUIET, exceptions.enabled.has(QUIET) && pended % 3 != 0);
            exceptions.enabled.has(QUIET)
        });
        pended += u64::from(is_enabled);
        // Blocks of few instructions, each at another place of the loop.
        let span = if is_enabled { 5 + pended % 7 } else { 500 };
        lines.extend(board.go_on(Time::microseconds(span))?);
    }
    let exceptions = board.processor.counts().exceptions;
    assert!(exceptions > 2000, "only {exceptions} exceptions");
    assert!(
        told.lines().any(|line| Some(line) == lines.last().map(String::as_str)),
        "{:?}",
        lines.last()
    );
    Ok(())
}

#[test]
fn a_core_that_loops_stops_when_it_is_to() -> Result<(), String> {
    let mut board = Board::new()?;
    // A branch to itself, in RAM.
    board.processor.poke(emulated_board::RAM, &[0xFE, 0xE7]);
    board.processor.jump(emulated_board::RAM);
    board.go_on(Time::microseconds(500))?;
    assert!(board.processor.now() < Time::microseconds(501), "{:?}", board.processor.now());
    Ok(())
}

#[test]
fn a_reset_ends_the_time_with_interrupts_off() -> Result<(), String> {
    /// `CPSID i` and `CPSIE i`, each with a branch to itself, and where they are.
    const CODE: [(u32, [u8; 4]); 2] = [
        (emulated_board::RAM, [0x72, 0xB6, 0xFE, 0xE7]),
        (emulated_board::RAM + 64, [0x62, 0xB6, 0xFE, 0xE7]),
    ];
    for is_reset in [false, true] {
        let mut board = Board::new()?;
        for (address, code) in CODE {
            board.processor.poke(address, &code);
            board.processor.jump(address);
            board.go_on(LOOK)?;
            if is_reset {
                board.processor.reset(ResetReason::Software);
            }
        }
        let (longest, _) = board.processor.counts().masked;
        assert_eq!(longest < Time::microseconds(50), is_reset, "{longest:?}");
    }
    Ok(())
}
