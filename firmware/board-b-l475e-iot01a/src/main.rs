//! The instrument on the board B-L475E-IOT01A (STM32L475VG, Cortex-M4F, 64 MHz).
//!
//! `cargo board` flashes it through the board's own ST-LINK and shows the log; what the link says is
//! sent by the virtual COM port, 115 200 baud unless its settings state another rate. The carrier is chosen by a feature, as
//! in `cargo board --features vehicle`; what is not soldered is a setting, in a record in the flash, the rest is in
//! `firmware/stm32/src/configuration.rs`.
//!
//! The wiring is in `firmware/README.md`: which pin of which connector has which signal on which carrier, what the chips
//! need beside it, and how the board is mounted. A test holds its pins to those of `pins.rs`.
#![no_std]
#![no_main]

mod clock;
mod crash;
mod critical;
mod log_buffer;
mod pins;
mod priorities;
mod stack;
mod unmaskable;

use core::fmt::{Debug, Write as _};
use core::pin::pin;

use defmt_rtt as _;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_stm32::interrupt;
use embassy_time::{Duration, Instant, block_for};
use firmware::check_ins::{Checked, Part};
use firmware::kept_lines::Weight;
use firmware::platform::Platform;
use firmware::ports::Observer as _;
use firmware::postmortem::{Last, Line};
use heapless::String;
use programs::{Executors, spinning, stepwise, stops, turning};
use stm32::link::Link;
use stm32::watchdog::Reason;
use stm32::wiring::Clock;
use stm32::{BoardLog, PLATFORM, brown_out, once, watchdog};

use crash::RUN;
use pins::Board;

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

/// Executor of acquisition.
static ACQUISITION: InterruptExecutor = InterruptExecutor::new();
/// Executor of motors and keeper.
static CONTROL: InterruptExecutor = InterruptExecutor::new();
/// Executor of the link.
static LINK: InterruptExecutor = InterruptExecutor::new();

/// Polls the tasks of acquisition.
#[interrupt]
fn SWPMI1() {
    #[expect(unsafe_code, reason = "only the interrupt of the executor may poll it")]
    // SAFETY: this is the interrupt that the executor was started with, and that start enables it.
    unsafe {
        ACQUISITION.on_interrupt();
    }
}

/// Polls the tasks of motors and keeper.
#[interrupt]
fn TSC() {
    #[expect(unsafe_code, reason = "only the interrupt of the executor may poll it")]
    // SAFETY: this is the interrupt that the executor was started with, and that start enables it.
    unsafe {
        CONTROL.on_interrupt();
    }
}

/// Polls the task of the link.
#[interrupt]
fn RNG() {
    #[expect(unsafe_code, reason = "only the interrupt of the executor may poll it")]
    // SAFETY: this is the interrupt that the executor was started with, and that start enables it.
    unsafe {
        LINK.on_interrupt();
    }
}

/// The thread's executor, and those above it, which are started.
fn executors(thread: Spawner) -> Executors {
    let [acquisition, control, link] = priorities::EXECUTORS;
    Executors {
        thread,
        acquisition: ACQUISITION.start(acquisition),
        control: CONTROL.start(control),
        link: LINK.start(link),
    }
}

/// Symbols of the linker.
mod symbols {
    #[expect(unsafe_code, reason = "refers to a symbol of the linker's script")]
    // SAFETY: `memory.x` defines it before six words.
    unsafe extern "C" {
        pub safe static _build_id: [u32; 6];
    }
}

/// The log, and where the parts check in.
static LOG: BoardLog =
    BoardLog { run: &RUN, image: &symbols::_build_id, buffer: log_buffer::BUFFER };

#[embassy_executor::main]
async fn main(spawner: Spawner) -> ! {
    stack::guard();
    let reason = watchdog::reason();
    let last = RUN.begin();
    watchdog::arm();
    // Before any is enabled: what a critical section is to hold back must not have the priority of the edges.
    priorities::set();
    let peripherals = clock::start();
    spawner.spawn(once(watchdog::feed(&RUN)));
    // Log and link tell of the last reset once the crystal oscillates, or is known not to.
    let was_dead = last.is_some_and(|last| last.record.is_crystal_dead);
    let has_crystal = clock::follow_crystal(was_dead).await;
    let mut record = RUN.record().unwrap_or_default();
    record.is_crystal_dead = !has_crystal;
    RUN.note(&record);
    priorities::set();
    LOG.keep(Weight::Outcome, || {
        defmt::info!("board: started by {}, clock follows its crystal: {}", reason, has_crystal);
    });
    set_brown_out_level(reason);
    let board = Board::new(peripherals, &LOG, Clock { has_crystal });
    let (board, mut link) = opened(board);
    let ring = board.flash().ring();
    tell(last.as_ref(), reason, ring.found, &mut link).await;
    spawner.spawn(once(stack::watch()));
    run(spawner, board, link);
    Checked::new(LOG.check_ins(), Part::Log, pin!(LOG.write(ring))).await
}

/// The board, whose link has settings that its port takes.
#[expect(clippy::expect_used, reason = "other settings are a mistake of the program")]
fn opened<E: Debug>(board: Result<(Board, Link), E>) -> (Board, Link) {
    board.expect("the port takes the link's settings")
}

/// Has the option bytes hold the level of the supply below which the board is reset: once, for a controller as it is
/// delivered.
fn set_brown_out_level(reason: Reason) {
    if brown_out::is_set() {
        return;
    }
    if reason == Reason::OptionBytes {
        return defmt::error!("board: the option bytes do not take the brown-out level");
    }
    defmt::info!("board: sets its brown-out level, and starts again");
    // The probe takes the line before the reset.
    block_for(Duration::from_millis(10));
    brown_out::set();
}

/// Most characters of the registers at a fault: eight of them, each with its name.
const REGISTERS: usize = 160;

/// Tells log and link how the last run ended, unless it did so on purpose, and how many records of the log the flash holds.
async fn tell(last: Option<&Last>, reason: Reason, records: u32, link: &mut Link) {
    let how = |last: &Last| last.how(reason == Reason::Watchdog, reason == Reason::Supply);
    let mut registers = String::<REGISTERS>::new();
    if let Some(last) = last
        && let Some(how) = how(last)
    {
        for line in last.lines(how).iter().flatten() {
            LOG.keep(Weight::Outcome, || defmt::warn!("board: {}", line));
            if let Line::Place(_) | Line::Cause(_) = line {
                // It takes what fits, and never fails.
                let _ = write!(registers, "; {line}");
            }
        }
        let text = last.record.text.as_str();
        let place = if text.is_empty() { "" } else { " at " };
        let [what, part] = [how.brief(), last.part(how)];
        let words = format_args!("last reset: {what} in {part}{place}{text}{registers}");
        conversation::announce(link, &words).await;
    }
    if records > 0 {
        defmt::info!("board: {} records of the log in flash", records);
        conversation::announce(link, &"log in flash").await;
    }
}

/// Runs the program of the carrier.
fn run(spawner: Spawner, board: Board, link: Link) {
    let executors = executors(spawner);
    // Tasks that are never spawned are not in the image.
    match PLATFORM {
        Platform::Stage => {
            spawner.spawn(once(stepwise::on_a_stage(executors, board.axis(), link)));
        }
        Platform::TwoFrame => {
            spawner.spawn(once(stepwise::on_two_frames(executors, board.two_frames(), link)));
        }
        Platform::Turntable => {
            spawner.spawn(once(turning::align(executors, board.axis(), link)));
        }
        Platform::Vehicle => {
            spawner.spawn(once(stops::align(executors, board.vehicle(), link)));
        }
        Platform::Spin => {
            spawner.spawn(once(spinning::follow(executors, board.spinning_body(), link)));
        }
    }
}
