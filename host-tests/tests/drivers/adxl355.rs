//! ADXL355: the simulated chip against transcripts from other hands, then the driver on it.

use std::cell::RefCell;
use std::time::Duration;

use drivers::adxl355::registers::OutputRate;
use drivers::adxl355::{
    ATTEMPTS, Adxl355, BUS_HERTZ, BYTES_PER_CHECK, BYTES_PER_SAMPLE, READS_UNCHECKED, Reading,
    TIME_PER_SAMPLE, codec,
};
use drivers::fault::Fault;
use embassy_time::{Delay, Instant, Timer};
use embedded_hal_async::digital::Wait;
use embedded_hal_async::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use hal_mock::adxl355::{Adxl355 as Chip, POWER_UP, RESET_TIME};
use hal_mock::chip::{Rig as _, Select, Single};
use hal_mock::environment::ForceInput;
use hal_mock::spi::{ReadyPin, SpiPort};
use hal_mock::violation::Misuse;
use orientation::units::{SpecificForce, Temperature};
use proptest::prelude::*;

use crate::support::rig::{run, violations};

/// Constant force, constant temperature, and how often it was felt.
struct Table {
    force: [f64; 3],
    temperature: f64,
    samples: u32,
}

impl ForceInput for Table {
    fn force_g(&mut self, _: Instant) -> [f64; 3] {
        self.samples += 1;
        self.force
    }

    fn temperature_c(&mut self, _: Instant) -> f64 {
        self.temperature
    }
}

type Rig = RefCell<Single<Chip, Table>>;
type Accelerometer<'a> = Adxl355<SpiPort<'a>, Delay>;

fn rig_with(force: [f64; 3]) -> Rig {
    let environment = Table { force, temperature: 25.0, samples: 0 };
    RefCell::new(Single { chip: Chip::new(Instant::from_ticks(0)), environment })
}

fn accelerometer(rig: &Rig, rate: OutputRate) -> Accelerometer<'_> {
    let port = SpiPort::new(rig, Select::Accelerometer, BUS_HERTZ);
    Adxl355::new(port, Delay, rate)
}

async fn started(rig: &Rig, rate: OutputRate) -> Accelerometer<'_> {
    let mut accelerometer = accelerometer(rig, rate);
    accelerometer.start().await.expect("the chip is well");
    accelerometer
}

fn power_cycle(rig: &Rig) {
    rig.borrow_mut().power_cycle(Select::Accelerometer, Instant::now());
}

async fn exchange(rig: &Rig, hertz: u32, sent: &[u8]) -> Vec<u8> {
    let mut bytes = sent.to_vec();
    let mut port = SpiPort::new(rig, Select::Accelerometer, hertz);
    port.transfer_in_place(&mut bytes).await.expect("the bus is well");
    bytes
}

async fn transcript(rig: &Rig, rows: &[(&[u8], &[u8])]) {
    for (sent, expected) in rows {
        assert_eq!(exchange(rig, 1_000_000, sent).await, *expected, "{sent:02x?}");
    }
}

/// The byte sequence of `adxl355_setup` in Linux' `adxl355_core.c`: identity, shadow registers, reset,
/// 5 ms, shadow registers again, data-ready pin off, measuring; then temperature and axes in a row.
#[test]
fn the_chip_starts_as_the_linux_driver_starts_it() {
    let rig = rig_with([0.0, -1.0, 1.0]);
    run(async {
        Timer::after(POWER_UP).await;
        transcript(
            &rig,
            &[(&[0x01, 0], &[0, 0xAD]), (&[0x03, 0], &[0, 0x1D]), (&[0x05, 0], &[0, 0xED])],
        )
        .await;
        let shadow = exchange(&rig, 1_000_000, &[0xA1, 0, 0, 0, 0, 0]).await;
        transcript(&rig, &[(&[0x5E, 0x52], &[0, 0])]).await;
        Timer::after(RESET_TIME).await;
        assert_eq!(exchange(&rig, 1_000_000, &[0xA1, 0, 0, 0, 0, 0]).await, shadow);
        transcript(
            &rig,
            &[
                (&[0x5B, 0], &[0, 0x01]),
                (&[0x5A, 0x05], &[0, 0]),
                (&[0x5B, 0], &[0, 0x05]),
                (&[0x5A, 0x04], &[0, 0]),
            ],
        )
        .await;
        Timer::after_micros(1000).await;
        // 1885 counts at 25 °C; one g is 256 000 counts, 0x3E800 left-justified in 24 bits.
        let burst: [u8; 12] = [0x0D, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        let answer = [0, 0x07, 0x5D, 0x00, 0x00, 0x00, 0xC1, 0x80, 0x00, 0x3E, 0x80, 0x00];
        transcript(&rig, &[(&burst, &answer)]).await;
    });
    assert_eq!(violations(&rig), []);
}

/// Reset values of no-OS' adxl355.h, which carries one beside each address.
#[test]
fn a_chip_holds_the_documented_values_after_power_up() {
    let rig = rig_with([0.0; 3]);
    run(async {
        Timer::after(POWER_UP).await;
        for (register, value) in [
            (0x00, 0xAD),
            (0x01, 0x1D),
            (0x02, 0xED),
            (0x03, 0x01),
            (0x04, 0x00),
            (0x05, 0x00),
            (0x24, 0x00),
            (0x27, 0x01),
            (0x28, 0x00),
            (0x29, 0x60),
            (0x2A, 0x00),
            (0x2B, 0x00),
            (0x2C, 0x81),
            (0x2D, 0x01),
            (0x2E, 0x00),
        ] {
            transcript(&rig, &[(&[register << 1 | 1, 0], &[0, value])]).await;
        }
    });
    assert_eq!(violations(&rig), []);
}

/// The data sheet's section "Interrupts": the status clears on a read, the FIFO marks x, tells full and
/// overrun, and answers with bit 1 where it is empty.
#[test]
fn status_and_fifo_follow_the_data_sheet() {
    let rig = rig_with([0.5, 0.0, -1.0]);
    run(async {
        Timer::after(POWER_UP).await;
        exchange(&rig, 1_000_000, &[0x5A, 0x00]).await;
        Timer::after_micros(260).await;
        transcript(
            &rig,
            &[
                (&[0x09, 0, 0], &[0, 0x01, 3]),
                (&[0x09, 0], &[0, 0x00]),
                (
                    &[0x23, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
                    &[0, 0x1F, 0x40, 0x01, 0, 0, 0, 0xC1, 0x80, 0x00, 0, 0, 0x02],
                ),
            ],
        )
        .await;
        Timer::after_micros(32 * 250).await;
        transcript(&rig, &[(&[0x09, 0, 0], &[0, 0x03, 96])]).await;
        Timer::after_micros(250).await;
        transcript(&rig, &[(&[0x09, 0, 0], &[0, 0x07, 96]), (&[0x09, 0], &[0, 0x02])]).await;
    });
}

#[test]
fn samples_come_exactly_at_the_output_rate() {
    let rig = rig_with([0.0; 3]);
    run(async {
        Timer::after(POWER_UP).await;
        exchange(&rig, 1_000_000, &[0x50, 0x0A]).await;
        let begin = Instant::now();
        exchange(&rig, 1_000_000, &[0x5A, 0x00]).await;
        let mut pin = ReadyPin::new(&rig, Select::Accelerometer);
        for count in 1..=3 {
            pin.wait_for_falling_edge().await.expect("it cannot fail");
            assert_eq!((Instant::now() - begin).as_micros(), count * 256_000);
        }
        // Unread, the pin falls half a period later.
        assert!(rig.borrow_mut().ready_line(Select::Accelerometer, Instant::now()).active);
        Timer::after_millis(129).await;
        assert!(!rig.borrow_mut().ready_line(Select::Accelerometer, Instant::now()).active);
    });
    assert_eq!(rig.borrow().environment.samples, 3);
}

#[test]
fn every_kind_of_misuse_is_recorded() {
    let rig = rig_with([0.0; 3]);
    run(async {
        exchange(&rig, 1_000_000, &[0x01, 0]).await;
        Timer::after(POWER_UP).await;
        exchange(&rig, 10_000_001, &[0x01, 0]).await;
        exchange(&rig, 99_999, &[0x01, 0]).await;
        exchange(&rig, 1_000_000, &[0x01]).await;
        exchange(&rig, 1_000_000, &[0x25, 0]).await;
        exchange(&rig, 1_000_000, &[0x5F, 0]).await;
        exchange(&rig, 1_000_000, &[0x04, 0]).await;
        exchange(&rig, 1_000_000, &[0x58, 0x85]).await;
        exchange(&rig, 1_000_000, &[0x58, 0x80]).await;
        exchange(&rig, 1_000_000, &[0x5A, 0x00]).await;
        // Range and rate may not change while the chip measures; the high-pass corner may.
        exchange(&rig, 1_000_000, &[0x58, 0x82]).await;
        exchange(&rig, 1_000_000, &[0x50, 0x01]).await;
        exchange(&rig, 1_000_000, &[0x50, 0x10]).await;
        exchange(&rig, 1_000_000, &[0x5E, 0x52]).await;
        exchange(&rig, 1_000_000, &[0x09, 0x00]).await;
        exchange(&rig, 1_000_000, &[0x01, 0x00]).await;
    });
    let expected = [
        Misuse::TooEarly,
        Misuse::ClockTooFast,
        Misuse::ForbiddenValue,
        Misuse::Length,
        Misuse::UnknownRegister,
        Misuse::WriteOnly,
        Misuse::ReadOnly,
        Misuse::ReservedBits,
        Misuse::ForbiddenValue,
        Misuse::ForbiddenValue,
        Misuse::ForbiddenValue,
        Misuse::TooEarly,
    ];
    assert_eq!(violations(&rig), expected);
}

#[test]
fn the_budget_is_that_of_the_documentation() {
    assert_eq!(BYTES_PER_SAMPLE, 16);
    assert_eq!(BYTES_PER_CHECK, 18);
    assert_eq!(TIME_PER_SAMPLE, Duration::from_nanos(25_600));
    let rig = rig_with([0.0; 3]);
    run(async {
        let mut accelerometer = started(&rig, OutputRate::Hz125).await;
        fresh(&mut accelerometer).await;
        Timer::after_millis(8).await;
        let begin = Instant::now();
        fresh(&mut accelerometer).await;
        // Both transactions round up to whole microseconds.
        assert!((Instant::now() - begin).as_micros() <= 26 + 1);
    });
}

async fn fresh(accelerometer: &mut Accelerometer<'_>) -> Reading {
    let reading = accelerometer.read().await.expect("the chip is well");
    assert!(reading.is_fresh);
    reading
}

#[test]
fn every_count_becomes_the_nearest_micrometre() {
    for count in -0x8_0000_i32..0x8_0000 {
        // 9 806 650 / 256 000 = 196 133 / 5120; ties go towards zero.
        let numerator = i64::from(count.unsigned_abs()) * 196_133;
        let nearest = (2 * numerator + 5120 - 1).div_euclid(2 * 5120);
        let expected = if count < 0 { -nearest } else { nearest };
        assert_eq!(i64::from(codec::force(count).0), expected, "{count}");
    }
}

#[test]
fn the_scale_is_that_of_the_data_sheet() {
    assert_eq!(codec::force(256_000), SpecificForce(9_806_650));
    assert_eq!(codec::force(-256_000), SpecificForce(-9_806_650));
    assert_eq!(codec::temperature(1885), Temperature(25_000));
    // −9.05 LSB/°C: 181 counts are 20 °C.
    assert_eq!(codec::temperature(1885 - 181), Temperature(45_000));
    assert_eq!(codec::temperature(1885 + 362), Temperature(-15_000));
    for count in 0..4096_u16 {
        let exact = 25.0 + (1885.0 - f64::from(count)) / 9.05;
        let error = f64::from(codec::temperature(count).0) - exact * 1000.0;
        assert!(error.abs() <= 0.5 + 1e-6, "{count}: {error}");
    }
}

#[test]
fn the_driver_reads_force_and_temperature_and_leaves_no_violation() {
    let rates = [
        OutputRate::Hz4000,
        OutputRate::Hz2000,
        OutputRate::Hz1000,
        OutputRate::Hz500,
        OutputRate::Hz250,
        OutputRate::Hz125,
        OutputRate::Hz62,
        OutputRate::Hz31,
        OutputRate::Hz15,
        OutputRate::Hz7,
        OutputRate::Hz3,
    ];
    for rate in rates {
        let rig = rig_with([0.25, -0.5, -1.0]);
        rig.borrow_mut().environment.temperature = -15.0;
        let reading = run(async {
            let mut accelerometer = started(&rig, rate).await;
            fresh(&mut accelerometer).await
        });
        // A quarter of 9 806 650 is a tie, which goes towards zero.
        let force = [2_451_662, -4_903_325, -9_806_650].map(SpecificForce);
        let temperature = Temperature(-15_000);
        assert_eq!(reading, Reading { force, temperature, is_fresh: true, is_clipped: false });
        assert_eq!(violations(&rig), []);
    }
}

#[test]
fn a_start_takes_the_time_that_it_states() {
    let rig = rig_with([0.0, 0.0, -1.0]);
    let milliseconds = run(async {
        started(&rig, OutputRate::Hz4000).await;
        Instant::now().as_millis()
    });
    assert!((70..=85).contains(&milliseconds), "{milliseconds} ms");
}

#[test]
fn no_sample_is_lost_or_reported_twice() {
    let rig = rig_with([0.0; 3]);
    run(async {
        let mut accelerometer = started(&rig, OutputRate::Hz1000).await;
        fresh(&mut accelerometer).await;
        let before = rig.borrow().environment.samples;
        let mut count = 0;
        for _ in 0..4000 {
            Timer::after_micros(70).await;
            count += u32::from(accelerometer.read().await.expect("the chip is well").is_fresh);
        }
        let taken = rig.borrow().environment.samples - before;
        assert!(taken.abs_diff(count) <= 1, "{taken} {count}");
    });
    assert_eq!(violations(&rig), []);
}

/// The chip inverts what is clocked out after a sample has landed; sweeping the burst over the moment
/// of landing, nothing of that may be seen.
#[test]
fn a_sample_that_lands_within_a_burst_does_not_tear_it() {
    for early in 0..40 {
        let rig = rig_with([0.3, -0.2, 1.0]);
        run(async {
            let mut accelerometer = started(&rig, OutputRate::Hz1000).await;
            fresh(&mut accelerometer).await;
            ReadyPin::new(&rig, Select::Accelerometer)
                .wait_for_falling_edge()
                .await
                .expect("it cannot fail");
            Timer::after_micros(1000 - early).await;
            let reading = fresh(&mut accelerometer).await;
            assert_eq!(reading.force, [76_800, -51_200, 256_000].map(codec::force), "{early}");
            assert_eq!(reading.temperature, Temperature(25_000));
        });
    }
}

#[test]
fn too_slow_a_bus_is_reported_instead_of_torn_samples() {
    let rig = rig_with([0.0; 3]);
    let fault = run(async {
        let port = SpiPort::new(&rig, Select::Accelerometer, 100_000);
        Adxl355::new(port, Delay, OutputRate::Hz1000).start().await
    });
    assert_eq!(fault, Err(Fault::NotReady));
    assert_eq!(ATTEMPTS, 3);
}

#[test]
fn the_self_test_is_not_spoiled_by_gravity() {
    for force in
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8]]
    {
        let rig = rig_with(force);
        run(started(&rig, OutputRate::Hz125));
    }
}

#[test]
fn a_chip_outside_its_self_test_limits_is_refused() {
    for (response, passes) in [
        ([0.0, 0.0, 0.0], false),
        ([0.09, 0.3, 1.5], false),
        ([0.3, 0.61, 1.5], false),
        ([0.3, 0.3, 0.49], false),
        ([0.3, 0.3, 3.01], false),
        ([-0.3, 0.3, 1.5], false),
        ([0.1, 0.1, 0.5], true),
        ([0.6, 0.6, 3.0], true),
    ] {
        let rig = rig_with([0.0, 0.0, 1.0]);
        rig.borrow_mut().chip.self_test_response = response;
        let result = run(accelerometer(&rig, OutputRate::Hz125).start());
        let expected = if passes { Ok(()) } else { Err(Fault::SelfTest) };
        assert_eq!(result, expected, "{response:?}");
    }
}

#[test]
fn an_accelerometer_whose_start_failed_gives_no_force() {
    let rig = rig_with([0.0, 0.0, 1.0]);
    run(async {
        let mut accelerometer = started(&rig, OutputRate::Hz1000).await;
        let starting = embassy_time::with_timeout(
            embassy_time::Duration::from_millis(40),
            accelerometer.start(),
        );
        starting.await.expect_err("it is in its self-test");
        for _ in 0..3 {
            Timer::after_millis(1).await;
            // The first register that differs is the rate, still that of the self-test.
            assert_eq!(accelerometer.read().await, Err(Fault::NotAsWritten { register: 0x28 }));
        }
        accelerometer.start().await.expect("the chip is well");
        assert_eq!(fresh(&mut accelerometer).await.force[2], SpecificForce(9_806_650));
    });
}

#[test]
fn factory_settings_that_load_wrongly_are_loaded_again() {
    let rig = rig_with([0.0, 0.0, -1.0]);
    run(async {
        rig.borrow_mut().chip.spoiled_resets = 3;
        let mut accelerometer = started(&rig, OutputRate::Hz125).await;
        assert_eq!(fresh(&mut accelerometer).await.force[2], SpecificForce(-9_806_650));
        rig.borrow_mut().chip.spoiled_resets = 4;
        assert_eq!(accelerometer.start().await, Err(Fault::NotReady));
        accelerometer.start().await.expect("the chip is well again");
        assert_eq!(fresh(&mut accelerometer).await.force[2], SpecificForce(-9_806_650));
    });
    assert_eq!(violations(&rig), []);
}

#[test]
fn a_chip_that_reset_itself_is_noticed_at_once_and_brought_back() {
    for pause in [1, 5_000, 9_900, 10_000, 50_000] {
        let rig = rig_with([0.0, 0.0, -1.0]);
        run(async {
            let mut accelerometer = started(&rig, OutputRate::Hz125).await;
            fresh(&mut accelerometer).await;
            power_cycle(&rig);
            Timer::after_micros(pause).await;
            assert_eq!(accelerometer.read().await, Err(Fault::Reset), "after {pause} µs");
            accelerometer.start().await.expect("the chip is well again");
            assert_eq!(fresh(&mut accelerometer).await.force[2], SpecificForce(-9_806_650));
        });
    }
}

#[test]
fn a_changed_register_is_noticed_in_bounded_reads() {
    for (register, bit) in [(0x1E, 3), (0x2C, 1), (0x28, 4), (0x2E, 1)] {
        let rig = rig_with([0.0; 3]);
        run(async {
            let mut accelerometer = started(&rig, OutputRate::Hz1000).await;
            rig.borrow_mut().chip.registers[usize::from(register)] ^= 1 << bit;
            let mut reads = 0;
            loop {
                Timer::after_millis(1).await;
                reads += 1;
                match accelerometer.read().await {
                    Ok(_) => assert!(reads <= u32::from(READS_UNCHECKED), "{register:#x}"),
                    Err(fault) => break assert_eq!(fault, Fault::NotAsWritten { register }),
                }
            }
        });
    }
}

#[test]
fn an_axis_at_its_limit_is_clipped() {
    for (force, is_clipped) in
        [(2.04, false), (2.05, true), (-2.04, false), (-2.05, true), (5.0, true)]
    {
        let rig = rig_with([0.0; 3]);
        run(async {
            let mut accelerometer = started(&rig, OutputRate::Hz250).await;
            rig.borrow_mut().environment.force[1] = force;
            Timer::after_millis(10).await;
            assert_eq!(fresh(&mut accelerometer).await.is_clipped, is_clipped, "{force}");
        });
    }
}

/// A bus on which every read gives one byte, or which fails.
struct Stuck(Option<u8>);

impl ErrorType for Stuck {
    type Error = ErrorKind;
}

impl SpiDevice for Stuck {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let byte = self.0.ok_or(ErrorKind::Overrun)?;
        for operation in operations {
            if let Operation::TransferInPlace(bytes) = operation {
                bytes.fill(byte);
            }
        }
        Ok(())
    }
}

#[test]
fn a_dead_line_is_no_accelerometer() {
    for (byte, started, read) in [
        (Some(0x00), Fault::Identity { found: 0 }, Fault::Reset),
        (Some(0xFF), Fault::Identity { found: u32::MAX }, Fault::Checksum),
        (None, Fault::Bus, Fault::Bus),
    ] {
        let mut accelerometer = Adxl355::new(Stuck(byte), Delay, OutputRate::default());
        assert_eq!(run(accelerometer.start()), Err(started));
        assert_eq!(run(accelerometer.read()), Err(read));
    }
}

proptest! {
    #[test]
    fn a_burst_gives_back_what_went_in(
        status in 0_u8..0x20,
        temperature in 0_u16..0x1000,
        counts in prop::array::uniform3(-0x8_0000..0x8_0000_i32),
    ) {
        let mut bytes = vec![status, 96];
        bytes.extend(temperature.to_be_bytes());
        for count in counts {
            bytes.extend(&(count << 12).to_be_bytes()[..3]);
        }
        let bytes = bytes.try_into().expect("there are thirteen");
        let frame = codec::frame(&bytes).expect("reserved bits are zero");
        prop_assert_eq!(frame.status.0, status);
        prop_assert_eq!(frame.temperature, temperature);
        prop_assert_eq!(frame.counts, counts);
    }

    #[test]
    fn a_reserved_bit_is_never_accepted(bytes in prop::array::uniform13(any::<u8>())) {
        let reserved = [0xE0, 0x80, 0xF0, 0, 0, 0, 0x0F, 0, 0, 0x0F, 0, 0, 0x0F];
        let is_sound = bytes.iter().zip(reserved).all(|(byte, reserved)| byte & reserved == 0);
        prop_assert_eq!(codec::frame(&bytes).is_ok(), is_sound);
    }
}
