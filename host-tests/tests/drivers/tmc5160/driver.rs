//! The driver on the simulated chip.

use std::cell::{Cell, RefCell};

use drivers::fault::Fault;
use drivers::tmc5160::Tmc5160;
use drivers::tmc5160::codec::{DriverError, Status};
use drivers::tmc5160::configuration::{Configuration, MICROSTEPS_PER_TURN};
use drivers::tmc5160::units::Velocity;
use embassy_time::{Delay, Duration, Instant, Timer};
use embedded_hal_async::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use hal_mock::chip::{Rig as _, Select, Single, SpiChip};
use hal_mock::noise::Generator;
use hal_mock::spi::SpiPort;
use hal_mock::tmc5160::{ChipFault, Tmc5160 as Chip};
use host::virtual_time::run;

use super::plant::{Motor, NOMINAL};

pub type Rig = RefCell<Single<Chip, Motor>>;

/// Which datagram, and what is combined by exclusive or into it and into its reply.
type Damage = (usize, [u8; 5], [u8; 5]);

/// A wire that counts datagrams and damages one of them.
#[derive(Default)]
pub struct Wire {
    datagrams: Cell<usize>,
    /// Counted from zero.
    damage: Cell<Option<Damage>>,
    broken: Cell<bool>,
    /// The level at which the chip's answers are stuck.
    stuck: Cell<Option<u8>>,
    /// Chooses the bit that is wrong in every answer.
    pub noise: RefCell<Option<Generator>>,
}

impl Wire {
    /// Damages the datagram that comes after so many others.
    fn damage(&self, after: usize, sent: [u8; 5], reply: [u8; 5]) {
        self.damage.set(Some((self.datagrams.get() + after, sent, reply)));
    }
}

pub struct Tap<'a>(SpiPort<'a>, &'a Wire);

impl ErrorType for Tap<'_> {
    type Error = ErrorKind;
}

impl SpiDevice for Tap<'_> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let Self(port, wire) = self;
        if wire.broken.get() {
            return Err(ErrorKind::Overrun);
        }
        let [Operation::TransferInPlace(bytes)] = operations else {
            panic!("one datagram at a time")
        };
        let number = wire.datagrams.replace(wire.datagrams.get() + 1);
        let damage = wire.damage.get().filter(|(at, ..)| *at == number);
        let flip = |bytes: &mut [u8], flips: [u8; 5]| {
            bytes.iter_mut().zip(flips).for_each(|(byte, flip)| *byte ^= flip);
        };
        if let Some((_, sent, _)) = damage {
            flip(bytes, sent);
        }
        port.transfer_in_place(bytes).await?;
        if let Some((_, _, reply)) = damage {
            flip(bytes, reply);
        }
        if let Some(noise) = wire.noise.borrow_mut().as_mut() {
            let bit = noise.next_u64() % 40;
            bytes[(bit / 8) as usize] ^= 1 << (bit % 8);
        }
        if let Some(level) = wire.stuck.get() {
            bytes.fill(level);
        }
        Ok(())
    }
}

pub type Driver<'a> = Tmc5160<Tap<'a>, Delay>;

/// Runs a test on a driver that is not yet started; the chip must have nothing to complain of.
fn on_a_chip(test: impl AsyncFnOnce(&mut Driver, &Rig, &Wire)) {
    let wire = Wire::default();
    let chip = Chip::new(NOMINAL, Instant::from_micros(0));
    let rig = RefCell::new(Single { chip, environment: Motor::default() });
    let port = SpiPort::new(&rig, Select::Actuator, drivers::tmc5160::BUS_HERTZ);
    let mut driver = Tmc5160::new(Tap(port, &wire), Delay, Configuration::default());
    run(test(&mut driver, &rig, &wire)).expect("it ends");
    let violations = SpiChip::<Motor>::violations(&rig.borrow().chip).clone();
    assert_eq!(violations.count, 0);
}

/// Runs a test on a started driver.
pub fn on_a_stage(test: impl AsyncFnOnce(&mut Driver, &Rig, &Wire)) {
    on_a_chip(async |driver, rig, wire| {
        driver.start().await.expect("it starts");
        test(driver, rig, wire).await;
    });
}

/// Waits for rest; the status there and the time it took, s.
pub async fn rest(driver: &mut Driver<'_>) -> (Status, f64) {
    let start = Instant::now();
    loop {
        let status = driver.status().await.expect("it is well");
        if status.standing {
            return (status, (Instant::now() - start).as_micros() as f64 * 1e-6);
        }
        Timer::after(Duration::from_micros(500)).await;
    }
}

fn inject(rig: &Rig, chip_fault: ChipFault) {
    rig.borrow_mut().chip.inject(chip_fault);
}

fn power_cycle(rig: &Rig) {
    rig.borrow_mut().power_cycle(Select::Actuator, Instant::now());
}

#[test]
fn a_started_chip_stands_at_zero() {
    on_a_stage(async |driver, rig, _| {
        let status = driver.status().await.expect("it is well");
        assert!(status.standing && status.reached && !status.stalled);
        assert_eq!((status.position, status.velocity, status.driver_error), (0, Velocity(0), None));
        assert_eq!(rig.borrow().chip.register(0x34), 0x821, "a soft left stop");
        assert_eq!(rig.borrow().chip.register(0x14), 12_000_000 / 51_200);
    });
}

#[test]
fn a_step_and_a_turn_take_the_stated_times_and_end_exactly() {
    on_a_stage(async |driver, rig, _| {
        let step = MICROSTEPS_PER_TURN / 24;
        for (target, way, seconds) in [
            (step, step, 1.20),
            (step + MICROSTEPS_PER_TURN, MICROSTEPS_PER_TURN, 18.41),
            (MICROSTEPS_PER_TURN, step, 1.20),
        ] {
            driver.go_to(target).await.expect("it goes");
            let (status, took) = rest(driver).await;
            assert!((took - seconds).abs() < 0.01, "{took} s");
            let reported = Configuration::default().ramp.time(way.unsigned_abs()).as_secs_f64();
            assert!((took - reported).abs() < 0.01, "{took} s, reported {reported} s");
            assert!(status.reached);
            assert_eq!(status.position, target);
            assert_eq!(rig.borrow().environment.microsteps, f64::from(target));
        }
        assert!(rig.borrow().environment.fastest <= 256_686.0);
    });
}

#[test]
fn a_target_can_be_changed_on_the_way() {
    on_a_stage(async |driver, rig, _| {
        driver.go_to(500_000).await.expect("it goes");
        Timer::after(Duration::from_millis(900)).await;
        driver.go_to(-20_000).await.expect("it goes");
        assert_eq!(rest(driver).await.0.position, -20_000);
        assert!(rig.borrow().environment.highest < 400_000.0);
    });
}

#[test]
fn a_foreign_or_disabled_chip_is_refused() {
    on_a_chip(async |driver, rig, _| {
        for (chip_fault, fault) in [
            (ChipFault::Foreign, Fault::Identity { found: 0x1100_0000 }),
            (ChipFault::StepMode, Fault::Identity { found: 0x3000_0040 }),
            (ChipFault::Disabled, Fault::NotReady),
            (ChipFault::Short, Fault::SelfTest),
            (ChipFault::Overheated, Fault::Alarm { status: 2 }),
            (ChipFault::ChargePumpLow, Fault::Alarm { status: 4 }),
        ] {
            inject(rig, chip_fault);
            assert_eq!(driver.start().await, Err(fault), "{chip_fault:?}");
        }
        inject(rig, ChipFault::None);
        assert_eq!(driver.start().await, Ok(()));
    });
}

#[test]
fn a_chip_that_was_never_started_is_noticed() {
    on_a_chip(async |driver, _, _| {
        Timer::after(Duration::from_millis(1)).await;
        assert_eq!(driver.status().await, Err(Fault::Reset));
        assert_eq!(driver.go_to(1).await, Err(Fault::Reset));
    });
}

#[test]
fn a_chip_that_was_reset_on_the_way_is_noticed_and_started_again() {
    on_a_stage(async |driver, rig, _| {
        driver.go_to(500_000).await.expect("it goes");
        Timer::after(Duration::from_millis(700)).await;
        power_cycle(rig);
        Timer::after(Duration::from_millis(1)).await;
        assert_eq!(driver.status().await, Err(Fault::Reset));
        assert_eq!(driver.go_to(0).await, Err(Fault::Reset));
        assert_eq!(driver.run(Velocity(1)).await, Err(Fault::Reset));
        assert_eq!(driver.stop().await, Err(Fault::Reset));
        assert_eq!(driver.start().await, Ok(()));
        let status = driver.status().await.expect("it is well");
        assert!(status.standing && status.position == 0);
        assert!(rig.borrow().environment.microsteps > 50_000.0, "the stage has not gone back");
        driver.go_to(1000).await.expect("it goes");
        assert_eq!(rest(driver).await.0.position, 1000);
    });
}

#[test]
fn a_start_stops_a_running_motor_and_keeps_its_position() {
    on_a_stage(async |driver, rig, _| {
        driver.run(Velocity(-200_000)).await.expect("it runs");
        Timer::after(Duration::from_millis(1500)).await;
        driver.start().await.expect("it starts");
        let status = driver.status().await.expect("it is well");
        assert!(status.standing && status.position < -100_000);
        assert_eq!(f64::from(status.position), rig.borrow().environment.microsteps);
    });
}

#[test]
fn a_flipped_bit_of_a_target_never_moves_the_motor() {
    // The seventh datagram of a motion writes its target: data on the way in, address, and echo.
    for (sent, reply) in
        [([0, 0, 0x10, 0, 0], [0; 5]), ([0x01, 0, 0, 0, 0], [0; 5]), ([0x80, 0, 0, 0, 0], [0; 5])]
    {
        on_a_stage(async |driver, rig, wire| {
            wire.damage(5, sent, reply);
            let fault = driver.go_to(77).await;
            assert!(matches!(fault, Err(Fault::NotAsWritten { .. })), "{fault:?}");
            Timer::after(Duration::from_millis(50)).await;
            assert_eq!(rig.borrow().environment.fastest, 0.0);
        });
    }
}

#[test]
fn a_flipped_bit_of_a_standing_position_is_noticed_once() {
    on_a_stage(async |driver, _, wire| {
        for number in [2, 3, 7] {
            wire.damage(number, [0; 5], [0, 0, 1, 0, 0]);
            assert_eq!(driver.status().await, Err(Fault::Checksum), "datagram {number}");
            assert!(driver.status().await.is_ok());
        }
    });
}

#[test]
fn dead_lines_are_noticed() {
    on_a_stage(async |driver, _, wire| {
        wire.stuck.set(Some(0x00));
        assert_eq!(driver.status().await, Err(Fault::Identity { found: 0 }));
        assert!(matches!(driver.go_to(5).await, Err(Fault::NotAsWritten { .. })));
        wire.stuck.set(Some(0xFF));
        assert_eq!(driver.status().await, Err(Fault::Reset));
        assert_eq!(driver.start().await, Err(Fault::Identity { found: u32::MAX }));
        wire.broken.set(true);
        assert_eq!(driver.status().await, Err(Fault::Bus));
        assert_eq!(driver.go_to(5).await, Err(Fault::Bus));
    });
}

#[test]
fn the_bus_budget_is_kept() {
    on_a_stage(async |driver, _, wire| {
        let before = wire.datagrams.get();
        driver.status().await.expect("it is well");
        assert_eq!((wire.datagrams.get() - before) * 5, drivers::tmc5160::STATUS_BYTES);
        let before = wire.datagrams.get();
        driver.go_to(10).await.expect("it goes");
        assert_eq!((wire.datagrams.get() - before) * 5, drivers::tmc5160::MOTION_BYTES);
    });
}

#[test]
fn errors_of_the_bridges_are_reported_and_refuse_motions() {
    on_a_stage(async |driver, rig, _| {
        for (chip_fault, error) in [
            (ChipFault::Overheated, DriverError::OverTemperature),
            (ChipFault::Short, DriverError::Short),
        ] {
            inject(rig, chip_fault);
            let status = driver.status().await.expect("the bus is well");
            assert_eq!(status.driver_error, Some(error));
            assert!(
                matches!(driver.go_to(5).await, Err(Fault::Alarm { status }) if status & 2 != 0)
            );
            inject(rig, ChipFault::None);
            assert!(driver.go_to(5).await.is_err(), "the flag is latched");
            driver.start().await.expect("it starts");
        }
        inject(rig, ChipFault::ChargePumpLow);
        let status = driver.status().await.expect("the bus is well");
        assert_eq!(status.driver_error, Some(DriverError::ChargePump));
    });
}

#[test]
fn an_open_coil_is_reported_in_slow_motion() {
    on_a_stage(async |driver, rig, _| {
        inject(rig, ChipFault::OpenLoad);
        driver.run(Velocity(40_000)).await.expect("it runs");
        Timer::after(Duration::from_millis(500)).await;
        let status = driver.status().await.expect("the bus is well");
        assert_eq!(status.driver_error, Some(DriverError::OpenLoad));
        driver.stop().await.expect("it stops");
        assert_eq!(rest(driver).await.0.driver_error, None);
    });
}
