//! The driver on the simulated chip: identity, resets, no chip there, stuck lines, saturation, recovery.

use drivers::fault::Fault;
use drivers::lsm6dsl::registers::{ADDRESS_HIGH, ADDRESS_LOW, ForceRange, OutputRate, RateRange};
use drivers::lsm6dsl::{Configuration, Lsm6dsl, READS_UNCHECKED, Reading};
use embassy_time::{Delay, Instant, Timer};
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, Operation};
use hal_mock::i2c::I2cChip;
use orientation::units::Temperature;

use super::rig::{Imu, Table, imu, level, port, rig_with, run, started, violations};

const USUAL: Configuration =
    Configuration { output: OutputRate::Hz208, rate: RateRange::Dps125, force: ForceRange::G2 };

async fn fresh(imu: &mut Imu<'_>) -> Reading {
    for _ in 0..100 {
        if let Some(reading) = imu.read().await.expect("the chip is well") {
            return reading;
        }
        Timer::after_millis(1).await;
    }
    panic!("no new sample came");
}

#[test]
fn the_driver_reads_rates_and_forces_and_leaves_no_violation() {
    let (rates, forces) = (
        [RateRange::Dps125, RateRange::Dps250, RateRange::Dps500, RateRange::Dps1000],
        [ForceRange::G2, ForceRange::G4, ForceRange::G8, ForceRange::G16],
    );
    for output in [
        OutputRate::Hz12,
        OutputRate::Hz26,
        OutputRate::Hz52,
        OutputRate::Hz104,
        OutputRate::Hz208,
        OutputRate::Hz416,
    ] {
        for (rate, force) in rates.into_iter().zip(forces) {
            let rig = rig_with([0.25, -0.5, -1.0], [1.0, -20.0, 100.0]);
            rig.borrow_mut().environment.temperature = -15.0;
            let configuration = Configuration { output, rate, force };
            let reading = run(async {
                let mut imu = started(&rig, configuration).await;
                fresh(&mut imu).await
            });
            for (shown, truth) in reading.rate.iter().zip([1.0_f64, -20.0, 100.0]) {
                assert!((shown.rad_per_s().to_degrees() - truth).abs() < 0.036 / 2.0);
            }
            for (shown, truth) in reading.force.iter().zip([0.25, -0.5, -1.0]) {
                assert!((shown.m_per_s2() / 9.806_65 - truth).abs() < 0.49e-3 / 2.0);
            }
            assert_eq!(reading.temperature, Temperature(-15_000));
            assert!(!reading.is_rate_clipped && !reading.is_force_clipped);
            assert_eq!(violations(&rig), []);
        }
    }
}

#[test]
fn a_start_takes_the_time_that_it_states() {
    let rig = level();
    let milliseconds = run(async {
        started(&rig, USUAL).await;
        Instant::now().as_millis()
    });
    assert!((700..=800).contains(&milliseconds), "{milliseconds} ms");
}

#[test]
fn no_sample_is_reported_twice_and_none_is_lost() {
    let rig = level();
    run(async {
        let mut imu = started(&rig, USUAL).await;
        let (begin, mut count) = (Instant::now(), 0_u32);
        while (Instant::now() - begin).as_millis() < 2000 {
            count += u32::from(imu.read().await.expect("the chip is well").is_some());
            Timer::after_millis(1).await;
        }
        assert!(count.abs_diff(416) <= 2, "{count}");
    });
    assert_eq!(violations(&rig), []);
}

#[test]
fn another_chip_or_none_is_refused() {
    let rig = level();
    run(async {
        let mut absent = Lsm6dsl::new(port(&rig), Delay, ADDRESS_HIGH, USUAL);
        assert_eq!(absent.start().await, Err(Fault::Bus), "no chip acknowledges");
        rig.borrow_mut().chip.registers[0x0F] ^= 1;
        let other = imu(&rig, USUAL).start().await;
        assert_eq!(other, Err(Fault::Identity { found: 0x6B }));
    });
}

/// A bus on which every read gives one byte, or which fails.
struct Stuck(Option<u8>);

impl ErrorType for Stuck {
    type Error = ErrorKind;
}

impl I2c for Stuck {
    async fn transaction(
        &mut self,
        _: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        let byte = self.0.ok_or(ErrorKind::Bus)?;
        for operation in operations {
            if let Operation::Read(bytes) = operation {
                bytes.fill(byte);
            }
        }
        Ok(())
    }
}

#[test]
fn a_stuck_line_is_no_chip() {
    for (byte, started, read) in [
        (Some(0x00), Fault::Identity { found: 0 }, Fault::Reset),
        (Some(0xFF), Fault::Identity { found: 0xFF }, Fault::Reset),
        (None, Fault::Bus, Fault::Bus),
    ] {
        let mut imu = Lsm6dsl::new(Stuck(byte), Delay, ADDRESS_LOW, USUAL);
        assert_eq!(run(imu.start()), Err(started));
        assert_eq!(run(imu.read()), Err(read));
    }
}

#[test]
fn a_chip_outside_its_self_test_limits_is_refused() {
    for (force, rate, passes) in [
        (0.0, 0.0, false),
        (0.5, 100.0, false),
        (0.05, 400.0, false),
        (1.75, 400.0, false),
        (0.5, 720.0, false),
        (-0.5, -400.0, true),
        (0.1, 160.0, true),
        (1.6, 690.0, true),
    ] {
        let rig = rig_with([0.3, 0.2, -0.9], [3.0, -5.0, 2.0]);
        rig.borrow_mut().chip.self_test = (force, rate);
        let expected = if passes { Ok(()) } else { Err(Fault::SelfTest) };
        assert_eq!(run(imu(&rig, USUAL).start()), expected, "{force} g, {rate} °/s");
    }
}

#[test]
fn a_chip_that_reset_itself_is_noticed_by_the_second_reading_and_brought_back() {
    for pause in [16, 100] {
        let rig = level();
        run(async {
            let mut imu = started(&rig, USUAL).await;
            fresh(&mut imu).await;
            I2cChip::<Table>::power_cycle(&mut rig.borrow_mut().chip, Instant::now());
            Timer::after_millis(pause).await;
            assert_eq!(imu.read().await, Ok(None));
            assert_eq!(imu.read().await, Err(Fault::Reset));
            assert_eq!(imu.read().await, Err(Fault::Reset), "until it is started again");
            imu.start().await.expect("the chip is well again");
            fresh(&mut imu).await;
        });
        assert_eq!(violations(&rig), []);
    }
}

#[test]
fn a_changed_register_is_noticed_in_bounded_reads() {
    for (register, bit) in [(0x10, 2), (0x11, 1), (0x12, 6), (0x14, 0), (0x16, 6)] {
        let rig = level();
        run(async {
            let mut imu = started(&rig, USUAL).await;
            rig.borrow_mut().chip.registers[usize::from(register)] ^= 1 << bit;
            let mut reads = 0;
            loop {
                Timer::after_micros(4500).await;
                reads += 1;
                match imu.read().await {
                    Ok(_) => assert!(reads <= 2 * u32::from(READS_UNCHECKED), "{register:#x}"),
                    Err(fault) => break assert_eq!(fault, Fault::NotAsWritten { register }),
                }
            }
        });
    }
}

#[test]
fn what_stands_at_its_limit_is_reported() {
    let rig = level();
    run(async {
        let mut imu = started(&rig, USUAL).await;
        for (force, rate, clipped) in [
            (1.9, 124.0, (true, false)),
            (1.9, 120.0, (false, false)),
            (-2.1, 0.0, (false, true)),
            (0.0, -200.0, (true, false)),
        ] {
            rig.borrow_mut().environment.force[1] = force;
            rig.borrow_mut().environment.rate[2] = rate;
            Timer::after_millis(20).await;
            let reading = fresh(&mut imu).await;
            let found = (reading.is_rate_clipped, reading.is_force_clipped);
            assert_eq!(found, clipped, "{force} g, {rate} °/s");
        }
    });
}

#[test]
fn a_start_that_was_given_up_lets_no_reading_pass() {
    let rig = level();
    run(async {
        let mut imu = started(&rig, USUAL).await;
        let starting =
            embassy_time::with_timeout(embassy_time::Duration::from_millis(300), imu.start());
        starting.await.expect_err("it is in its self-test");
        for _ in 0..3 {
            // The first register that differs is the rate, still that of the self-test.
            assert_eq!(imu.read().await, Err(Fault::NotAsWritten { register: 0x10 }));
        }
        imu.start().await.expect("the chip is well");
        fresh(&mut imu).await;
    });
}
