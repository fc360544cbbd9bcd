//! The core does not go on: a stuck task, a panic, faults of the core.
//!
//! All of them end the same way. The watchdog, which was last fed up to a second before, resets after 8.2 s at the
//! latest; until then log and link are silent, and a platform turns on. The log of the next start says "started by
//! Watchdog" and nothing of the cause. The alignment begins anew.
//!
//! As it should be: the reason, and where it was, outlast the reset in RAM; the next start logs it and sends it, and a
//! reset follows a panic or a fault at once, with the motors off.

use std::sync::LazyLock;

use emulated_board::exceptions::HARD_FAULT;
use firmware::platform::Platform;

use crate::board::Board;
use crate::defect::hold;
use crate::images::image;
use crate::turning::TurningBoard;

/// Where there is nothing.
const NOWHERE: u32 = 0x6000_0000;
/// The shortest and longest time from a fault to the first line of the next log where the watchdog resets, s.
const WATCHDOG: std::ops::RangeInclusive<f64> = 7.1..=8.3;
/// That time where a reset follows at once, s: the crystal need not start again.
const AT_ONCE: std::ops::RangeInclusive<f64> = 0.0..=0.1;

/// A start after a fault.
struct Restart {
    /// Time from the fault to its first line, s.
    after: f64,
    /// What came meanwhile, and its lines until it levels, on log and link.
    lines: Vec<String>,
}

impl Restart {
    /// Lets a vehicle work for some seconds, stops its core, and waits for the next start.
    fn after(stop: impl FnOnce(&mut Board)) -> Self {
        let mut board = Board::new(Platform::Vehicle);
        board.until("keeping: level", 5.0);
        board.run(2.0);
        let fault = board.seconds();
        stop(&mut board);
        let start = board.until("board: started by", 10.0);
        board.until("keeping: level", 2.0);
        let (log, link) = (board.lines(fault, f64::INFINITY), board.sent(fault, f64::INFINITY));
        let lines = log.into_iter().chain(link).map(str::to_owned).collect();
        Self { after: start - fault, lines }
    }

    /// Lines that contain one of these words.
    fn telling(&self, words: &[&str]) -> f64 {
        let tells = |line: &&String| words.iter().any(|word| line.contains(word));
        self.lines.iter().filter(tells).count() as f64
    }
}

/// The address of a function in the vehicle's image.
fn function(name: &str) -> u32 {
    image(Platform::Vehicle).address_of(name).expect("the image has it")
}

/// Whether the core handles a hard fault.
fn handles_fault(board: &Board) -> bool {
    board.controller(|controller| controller.exceptions.active.has(HARD_FAULT))
}

/// `CFSR` and `HFSR`.
fn causes(board: &Board) -> [u32; 2] {
    board.controller(|controller| [0, 1].map(|register| controller.system.faults[register]))
}

/// A task that never returns. Interrupts are still served, those of the clock among them, and wake tasks that are never
/// polled.
static STUCK: LazyLock<Restart> = LazyLock::new(|| {
    Restart::after(|board| {
        // The image has no endless loop but those of its handlers.
        board.execution.processor.jump(function("HardFault_"));
        let before = board.execution.processor.counts().exceptions;
        board.run(1.0);
        assert!(!handles_fault(board));
        let taken = board.execution.processor.counts().exceptions - before;
        assert!((30..60).contains(&taken), "{taken} interrupts are served in a second");
    })
});

/// `panic-probe` is built without a way to print, and executes an undefined instruction with interrupts off.
static PANIC: LazyLock<Restart> = LazyLock::new(|| {
    Restart::after(|board| {
        board.execution.processor.jump(function("core::panicking::panic_fmt"));
        board.run(0.001);
        assert!(handles_fault(board), "{}", board.execution.processor.place());
        // An undefined instruction (CFSR, UNDEFINSTR), whose fault is not enabled either.
        assert_eq!(causes(board), [1 << 16, 1 << 30]);
    })
});

/// A jump to where nothing is.
static FAULT: LazyLock<Restart> = LazyLock::new(|| {
    Restart::after(|board| {
        board.execution.processor.jump(NOWHERE);
        board.run(0.001);
        assert!(handles_fault(board), "{}", board.execution.processor.place());
        // An instruction could not be fetched (CFSR, IBUSERR). The fault of the bus is not enabled, and becomes a hard
        // fault (HFSR, FORCED).
        assert_eq!(causes(board), [1 << 8, 1 << 30]);
    })
});

#[test]
fn a_stuck_task_is_reset_by_the_watchdog() {
    assert!(WATCHDOG.contains(&STUCK.after), "{} s", STUCK.after);
    assert!(STUCK.lines[0].starts_with("board: started by Watchdog"), "{:?}", STUCK.lines);
}

#[test]
#[should_panic(expected = "exactly 0 lines of log and link tell of a stuck task after its reset")]
fn the_start_after_a_stuck_task_tells_which_task_it_was() {
    let words = "lines of log and link tell of a stuck task after its reset";
    hold(STUCK.telling(&["task", "stuck"]), 1.0..=9.0, 0.0..=0.0, words);
}

#[test]
#[should_panic(expected = "between 7.1 and 8.3 s a panic is mute until the watchdog resets")]
fn a_panic_resets_at_once() {
    hold(PANIC.after, AT_ONCE, WATCHDOG, "s a panic is mute until the watchdog resets");
}

#[test]
#[should_panic(expected = "exactly 0 lines of log and link tell of a panic after its reset")]
fn the_start_after_a_panic_tells_its_message_and_its_place() {
    let words = "lines of log and link tell of a panic after its reset";
    hold(PANIC.telling(&["panic"]), 1.0..=9.0, 0.0..=0.0, words);
}

#[test]
#[should_panic(
    expected = "between 7.1 and 8.3 s a fault of the core is mute until the watchdog resets"
)]
fn a_fault_of_the_core_resets_at_once() {
    hold(FAULT.after, AT_ONCE, WATCHDOG, "s a fault of the core is mute until the watchdog resets");
}

#[test]
#[should_panic(
    expected = "exactly 0 lines of log and link tell of a fault of the core after its reset"
)]
fn the_start_after_a_fault_of_the_core_tells_its_registers_and_its_place() {
    let words = "lines of log and link tell of a fault of the core after its reset";
    hold(FAULT.telling(&["fault ", "Fault", "CFSR"]), 1.0..=9.0, 0.0..=0.0, words);
}

/// Nothing but the watchdog can end it.
#[test]
fn a_fault_in_the_handler_of_faults_locks_the_core_up_until_the_watchdog_resets_it() {
    let restart = Restart::after(|board| {
        for _ in 0..2 {
            board.execution.processor.jump(NOWHERE);
            board.run(0.001);
        }
    });
    assert!(WATCHDOG.contains(&restart.after), "{} s", restart.after);
    assert!(restart.lines[0].starts_with("board: started by Watchdog"), "{:?}", restart.lines);
}

/// After the reset the motor driver still turns, and is first not ready: it is started again.
#[test]
#[should_panic(expected = "between 57 and 87 °/s a platform turns seven seconds after a panic")]
fn a_panic_switches_the_motors_off() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let panic = image(Platform::Turntable)
        .address_of("core::panicking::panic_fmt")
        .expect("the image has it");
    board.execution.processor.jump(panic);
    board.run(7.0);
    let rate = turning(&board).abs();
    board.until("board: started by Watchdog", 2.0);
    board.until("stage: not ready in time: starting it again", 3.0);
    board.until("stage: identity and self-test passed", 1.0);
    hold(rate, 0.0..=1.0, 57.0..=87.0, "°/s a platform turns seven seconds after a panic");
}
