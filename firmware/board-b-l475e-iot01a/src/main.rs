//! The instrument on the board B-L475E-IOT01A (STM32L475VG, Cortex-M4F, 64 MHz).
//!
//! `cargo board` flashes it through the board's own ST-LINK and shows the log; the status lines are
//! sent by the virtual COM port, 115 200 baud. The carrier is chosen by a feature, as in `cargo board
//! --features vehicle`; latitude, gyro and schedule are in `firmware/stm32/src/settings.rs`, unless a record in
//! the flash states them, the rest of the configuration in `configuration.rs` beside it.
//!
//! | connector | pin | controller | signal |
//! |---|---|---|---|
//! | Arduino CN1 | 6, D13 | PA5 | SPI1 clock: ADS1262 SCLK, ADXL355 SCLK (LED1 flickers with it) |
//! | | 5, D12 | PA6 | SPI1 data in: ADS1262 DOUT/DRDY, ADXL355 MISO |
//! | | 4, D11 | PA7 | SPI1 data out: ADS1262 DIN, ADXL355 MOSI |
//! | | 3, D10 | PA2 | ADS1262 CS |
//! | | 2, D9 | PA15 | ADXL355 CS |
//! | | 1, D8 | PB2 | in a vehicle: right ADS1262 CS; with two frames: inner MT6835 CSN |
//! | Arduino CN3 | 3, D2 | PD14 | ADS1262 DRDY |
//! | | 4, D3 | PB0 | in a vehicle: right ADS1262 DRDY |
//! | | 5, D4 | PA3 | on a spinning body: CS of the ADS1262 of the accelerometer up |
//! | | 6, D5 | PB4 | on a spinning body: CS of that of the accelerometer to the right |
//! | | 7, D6 | PB1 | in a vehicle: down ADS1262 DRDY |
//! | | 8, D7 | PA4 | in a vehicle: down ADS1262 CS; with two frames: inner TMC5160 CSN |
//! | Arduino CN4 | 2, A1 | PC4 | on a spinning body: DRDY of the accelerometer up |
//! | | 3, A2 | PC3 | on a spinning body: DRDY of the accelerometer to the right |
//! | Arduino CN2 | 4, 5, 6 | | 3.3 V, 5 V, ground |
//! | PMOD CN10 | 4 | PD1 | SPI2 clock: MT6835 SCK, TMC5160 SCK |
//! | | 3 | PD3 | SPI2 data in: MT6835 MISO, TMC5160 SDO |
//! | | 2 | PD4 | SPI2 data out: MT6835 MOSI, TMC5160 SDI |
//! | | 1 | PD5 | TMC5160 CSN |
//! | | 8 | PD0 | MT6835 CSN |
//! | | 7 | PD2 | TMC5160 `DRV_ENN`, with a pull-up at the driver |
//! | | 5, 6 | | ground, 3.3 V |
//! | on the board | | PB10, PB11 | I2C2: LSM6DSL, on a platform that turns the gyro |
//! | ST-LINK CN7 | USB | PB6 | status lines (USART1) |
//!
//! Connectors after UM2153 rev. 5: Table 4 (Arduino), Table 10 (PMOD, solder bridges as delivered:
//! SB14, 15, 18, 21 closed, SB12, 16, 19, 20 open), section 7.10 (virtual COM port). At the chips:
//! ADS1262 START and CLKIN low, RESET/PWDN high, gyro between AIN0 and AIN1; TMC5160 CLK and
//! `SD_MODE` low, `SPI_MODE` high, the index a normally open switch from `REFL_STEP` to its supply. In a
//! vehicle there is no PMOD side; the ADS1262 on D10 has the forward gyro, and one oscillator of 7.3728 MHz
//! is at the CLKIN of all three, so that they convert in step. On a spinning body there are five so: those
//! of a vehicle for the gyros forward, right and up (in the place of down), and two for accelerometers, each
//! sensor between AIN0 and AIN1 of its own; up and right are those of the body at roll zero. With two
//! frames the PMOD side is that of the outer one; the inner one shares clock, data and `DRV_ENN` with it.
//! On a stage, two frames or a turntable the board is fixed to the base, the LSM6DSL's x axis forward, y to
//! the right, z down.
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
use firmware::link;
use firmware::platform::Platform;
use firmware::ports::Observer as _;
use firmware::postmortem::{Last, Line};
use heapless::String;
use stm32::watchdog::Reason;
use stm32::wiring::{Clock, Link};
use stm32::{
    BoardLog, Executors, PLATFORM, brown_out, once, spinning, stepwise, stops, turning, watchdog,
};

use crash::RUN;
use pins::Board;

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

/// Executor of acquisition.
static ACQUISITION: InterruptExecutor = InterruptExecutor::new();
/// Executor of motors and keeper.
static CONTROL: InterruptExecutor = InterruptExecutor::new();

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

/// Starts the executors above the thread.
fn executors() -> Executors {
    let [acquisition, control] = priorities::EXECUTORS;
    Executors { acquisition: ACQUISITION.start(acquisition), control: CONTROL.start(control) }
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
    let (mut words, mut registers) = ([""; 9], String::<REGISTERS>::new());
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
        words = ["last reset: ", what, " in ", part, place, text, &registers, "\r\n", ""];
    }
    if records > 0 {
        defmt::info!("board: {} records of the log in flash", records);
        words[8] = "log in flash\r\n";
    }
    link::say(link, &words).await;
}

/// Runs the program of the carrier.
fn run(spawner: Spawner, board: Board, link: Link) {
    let above = executors();
    // Tasks that are never spawned are not in the image.
    match PLATFORM {
        Platform::Stage => {
            spawner.spawn(once(stepwise::on_a_stage(above, board.axis(), link)));
        }
        Platform::TwoFrame => {
            spawner.spawn(once(stepwise::on_two_frames(above, board.two_frames(), link)));
        }
        Platform::Turntable => {
            spawner.spawn(once(turning::align(above, board.axis(), link)));
        }
        Platform::Vehicle => {
            spawner.spawn(once(stops::align(above, board.vehicle(), link)));
        }
        Platform::Spin => {
            spawner.spawn(once(spinning::follow(above, board.spinning_body(), link)));
        }
    }
}
