//! The core does not go on: a stuck task, a panic, faults of the core.
//!
//! A reset follows a panic or a fault at once, with the motors off; a task that is stuck is ended by the watchdog, which
//! was last fed up to a second before, after 8.2 s at the latest. The reason, and where it was, outlast the reset in RAM;
//! the next start logs it and sends it. The alignment begins anew.

use std::sync::LazyLock;

use emulated_board::exceptions::HARD_FAULT;
use emulated_board::time::Time;
use firmware::platform::Platform;

use crate::board::Board;
use crate::images::image;
use crate::sentences::words;
use crate::turning::TurningBoard;

/// Where there is nothing.
const NOWHERE: u32 = 0x6000_0000;
/// The beginning of the program.
const MAIN: &str = "board::__cortex_m_rt_main";
/// The end of SRAM2, which the image does not use.
const UNUSED: u32 = 0x1000_7FF0;
/// The exception of the interrupt TSC (position 77 of the vector table of RM0351), which polls motors and keeper.
const CONTROL: u32 = 16 + 77;
/// That of the interrupt SWPMI1, which polls acquisition, above it.
const ACQUISITION: u32 = CONTROL - 1;
/// A branch to itself.
const ENDLESS: u16 = 0xE7FE;
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
        let log = board.lines(fault, f64::INFINITY).into_iter().map(str::to_owned);
        // The link has a semicolon for each comma.
        let link = words(board.sent(fault, f64::INFINITY)).into_iter();
        let lines = log.chain(link.map(|words| words.replace(';', ","))).collect();
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

/// Whether motors or keeper are being polled, with interrupts on.
fn polls_control(board: &Board) -> bool {
    let is_at_work = board.controller(|controller| {
        let active = &controller.exceptions.active;
        active.has(CONTROL) && !active.has(ACQUISITION)
    });
    is_at_work && !board.execution.processor.is_masked()
}

/// A task of motors and keeper that never returns. Interrupts are still served, and acquisition above it goes on.
static STUCK: LazyLock<Restart> = LazyLock::new(|| {
    Restart::after(|board| {
        // The keeper is polled every ten milliseconds, for more than the length of a step.
        for _ in 0..1000 {
            if !polls_control(board) {
                board.run(2e-5);
            }
        }
        assert!(polls_control(board), "{board}");
        // The image has no endless loop: it is put where nothing is kept.
        assert!(board.execution.processor.poke(UNUSED, &ENDLESS.to_le_bytes()));
        board.execution.processor.jump(UNUSED);
        let before = board.execution.processor.counts().exceptions;
        board.run(1.0);
        assert!(!handles_fault(board));
        let taken = board.execution.processor.counts().exceptions - before;
        assert!((1500..4000).contains(&taken), "{taken} interrupts are served in a second");
    })
});

/// Whether the thread's executor polls nothing.
fn idles(board: &Board) -> bool {
    board.controller(|controller| controller.exceptions.active.is_empty())
        && board.execution.processor.place().contains("thread::Executor::run")
}

/// The thread never returns, outside of any part. Motors, keeper and acquisition above it go on until the watchdog, and the
/// keeper has no motion that it lacks.
#[test]
fn a_thread_that_is_stuck_outside_of_any_part_is_told_and_the_keeper_goes_on() {
    let restart = Restart::after(|board| {
        for _ in 0..1000 {
            if !idles(board) {
                board.run(2e-5);
            }
        }
        assert!(idles(board), "{}", board.execution.processor.place());
        assert!(board.execution.processor.poke(UNUSED, &ENDLESS.to_le_bytes()));
        board.execution.processor.jump(UNUSED);
        let stuck = board.seconds();
        board.run(6.5);
        let lines = board.lines(stuck, f64::INFINITY);
        assert!(!lines.iter().any(|line| line.contains("keeping")), "{board}");
    });
    assert!(WATCHDOG.contains(&restart.after), "{} s", restart.after);
    let words = ["last reset: stuck task in the thread, outside of any part"];
    assert_eq!(restart.telling(&words), 2.0, "log and link: {:?}", restart.lines);
}

/// The program begins once more, and panics since its first task runs already.
static PANIC: LazyLock<Restart> =
    LazyLock::new(|| Restart::after(|board| board.execution.processor.jump(function(MAIN))));

/// A panic of Rust's own library, with its place in the registers as a division by zero has it.
fn divide_by_zero(board: &mut Board) {
    let [place, file] = [UNUSED - 0xE0, UNUSED - 0xC0];
    // ldr r0, [pc, #4]; ldr r1, [pc, #8]; bx r1; nop: what follows is the address of the place, and the function.
    let code: [u32; 2] = [0x4902_4801, 0xBF00_4708];
    let called = function("panic_const_div_by_zero") | 1;
    let words = [code[0], code[1], place + 0x10, called, file, 10, 7, 1];
    let bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
    assert!(board.execution.processor.poke(place, &bytes));
    assert!(board.execution.processor.poke(file, b"src/end.rs"));
    board.execution.processor.jump(place);
}

/// A jump to where nothing is.
static FAULT: LazyLock<Restart> =
    LazyLock::new(|| Restart::after(|board| board.execution.processor.jump(NOWHERE)));

#[test]
fn a_stuck_task_is_reset_by_the_watchdog() {
    assert!(WATCHDOG.contains(&STUCK.after), "{} s", STUCK.after);
    assert!(STUCK.lines[0].starts_with("board: started by Watchdog"), "{:?}", STUCK.lines);
}

#[test]
fn the_start_after_a_stuck_task_tells_which_task_it_was() {
    // Which part the core is in is what the moment meets: the executor may be between two.
    let parts = ["keeper", "aligner"].map(|part| format!("last reset: stuck task in {part}"));
    let told = parts.map(|words| STUCK.telling(&[&words]));
    assert!(told.contains(&2.0), "log and link: {:?}", STUCK.lines);
}

#[test]
fn a_panic_resets_at_once() {
    assert!(AT_ONCE.contains(&PANIC.after), "{} s", PANIC.after);
}

#[test]
fn the_start_after_a_panic_tells_its_message_and_its_place() {
    for begin in ["board: panicked at ", "last reset: panic in "] {
        let tells = |line: &String| {
            let is_place = line.contains("firmware/board-b-l475e-iot01a/src/main.rs:");
            line.starts_with(begin) && is_place && line.contains("called `Result::unwrap()`")
        };
        assert!(PANIC.lines.iter().any(tells), "{begin}: {:?}", PANIC.lines);
    }
}

/// What a probe does not see: the log has no words of it.
#[test]
fn the_start_after_a_panic_of_the_library_tells_its_message_and_its_place() {
    let restart = Restart::after(divide_by_zero);
    assert!(AT_ONCE.contains(&restart.after), "{} s", restart.after);
    // Which part it was in is what the moment meets.
    for begin in ["board: panicked at ", "last reset: panic in "] {
        let tells = |line: &String| {
            line.starts_with(begin) && line.ends_with(" at src/end.rs:7: attempt to divide by zero")
        };
        assert!(restart.lines.iter().any(tells), "{:?}", restart.lines);
    }
}

#[test]
fn a_fault_of_the_core_resets_at_once() {
    assert!(AT_ONCE.contains(&FAULT.after), "{} s", FAULT.after);
}

#[test]
fn the_start_after_a_fault_of_the_core_tells_its_registers_and_its_place() {
    // On log and link, and what is on the log alone.
    for words in ["PC 0x60000000, LR 0x", "CFSR 0x00000100, HFSR 0x40000000"] {
        assert_eq!(FAULT.telling(&[words]), 2.0, "{words}: {:?}", FAULT.lines);
    }
    assert_eq!(FAULT.telling(&["board: called from 0x0800"]), 1.0, "{:?}", FAULT.lines);
    assert_eq!(FAULT.telling(&["last reset: fault of the core"]), 2.0, "{:?}", FAULT.lines);
}

/// Below the stack nothing is written, and its registers are those that it had.
#[test]
fn the_start_after_a_stack_overflow_tells_that_it_was_one() {
    let restart = Restart::after(|board| {
        // push {r0-r7, lr}, and again.
        let code = [0xFF, 0xB5, 0xFD, 0xE7];
        assert!(board.execution.processor.poke(UNUSED, &code));
        board.execution.processor.jump(UNUSED);
    });
    assert!(AT_ONCE.contains(&restart.after), "{} s", restart.after);
    assert!(restart.telling(&["last reset: stack overflow"]) > 0.0, "{:?}", restart.lines);
}

/// Nothing but the watchdog can end it.
#[test]
fn a_fault_in_the_handler_of_faults_locks_the_core_up_until_the_watchdog_resets_it() {
    let restart = Restart::after(|board| {
        board.execution.processor.jump(NOWHERE);
        let handling = board.execution.processor.now() + Time::microseconds(20);
        board.execution.processor.run(handling).expect("the handler is executed");
        assert!(handles_fault(board), "{}", board.execution.processor.place());
        // An instruction could not be fetched (CFSR, IBUSERR). The fault of the bus is not enabled, and becomes a hard
        // fault (HFSR, FORCED).
        assert_eq!(causes(board), [1 << 8, 1 << 30]);
        board.execution.processor.jump(NOWHERE);
    });
    assert!(WATCHDOG.contains(&restart.after), "{} s", restart.after);
    assert!(restart.lines[0].starts_with("board: started by Watchdog"), "{:?}", restart.lines);
}

/// Without current it rings out within half a second. It gets it again once its driver's ramp rests, a little beside where it
/// stands; a second later the alignment that begins anew turns it again.
#[test]
fn a_panic_takes_the_motors_their_current_until_their_ramps_rest() {
    let TurningBoard { mut board, turning } = TurningBoard::new();
    let panic = image(Platform::Turntable).address_of(MAIN).expect("the image has it");
    let (panicked, before) = (board.seconds(), turning(&board).abs());
    board.execution.processor.jump(panic);
    while board.seconds() < panicked + 2.7 {
        board.run(0.01);
        let (after, rate) = (board.seconds() - panicked, turning(&board).abs());
        let most = if after < 0.5 { before } else { 3.0 };
        assert!(rate <= most, "{rate} °/s {after} s after a panic at {before} °/s: {board}");
    }
    let lines = board.lines(panicked, f64::INFINITY);
    assert!(lines.contains(&"stage: identity and self-test passed, configured"), "{board}");
}
