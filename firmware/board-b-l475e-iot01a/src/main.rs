//! The instrument on the board B-L475E-IOT01A (STM32L475VG, Cortex-M4F, 80 MHz).
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
mod pins;
mod priorities;
mod unmaskable;

use defmt_rtt as _;
use embassy_executor::{InterruptExecutor, Spawner};
use embassy_stm32::interrupt;
use embassy_time::Instant;
use firmware::platform::Platform;
use panic_probe as _;
use stm32::{Executors, PLATFORM, spinning, stepwise, stops, turning, watchdog};

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

#[embassy_executor::main]
async fn main(spawner: Spawner) {
    let reason = watchdog::reason();
    let has_crystal = !watchdog::crystal_failed(reason);
    watchdog::arm();
    let peripherals = clock::start(has_crystal);
    priorities::set();
    defmt::info!("board: started by {}, clock follows its crystal: {}", reason, has_crystal);
    spawner.spawn(defmt::unwrap!(watchdog::feed()));
    let board = defmt::unwrap!(Board::new(peripherals));
    let executors = executors();
    // Tasks that are never spawned are not in the image.
    match PLATFORM {
        Platform::Stage => {
            spawner.spawn(defmt::unwrap!(stepwise::on_a_stage(executors, board.axis())));
        }
        Platform::TwoFrame => {
            spawner.spawn(defmt::unwrap!(stepwise::on_two_frames(executors, board.two_frames())));
        }
        Platform::Turntable => {
            spawner.spawn(defmt::unwrap!(turning::align(executors, board.axis())));
        }
        Platform::Vehicle => {
            spawner.spawn(defmt::unwrap!(stops::align(executors, board.vehicle())));
        }
        Platform::Spin => {
            spawner.spawn(defmt::unwrap!(spinning::follow(executors, board.spinning_body())));
        }
    }
}
