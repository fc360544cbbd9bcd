//! MT6835: the simulated chip against transcripts from other hands, then the driver on it.

use std::cell::RefCell;
use std::time::Duration;

use drivers::fault::Fault;
use drivers::mt6835::registers::{Bandwidth, Hysteresis, OVERSPEED, UNDERVOLTAGE, WEAK_MAGNET};
use drivers::mt6835::{
    BUS_HERTZ, BYTES_PER_READING, Configuration, Mt6835, TIME_PER_READING, codec,
};
use embassy_time::{Delay, Instant, Timer};
use embedded_hal_async::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use hal_mock::chip::{Rig as _, Select, Single};
use hal_mock::environment::ShaftAngle;
use hal_mock::mt6835::Mt6835 as Chip;
use hal_mock::spi::SpiPort;
use hal_mock::violation::Misuse;
use orientation::units::Angle;
use proptest::prelude::*;

use crate::support::rig::{run, violations};

/// A shaft that turns evenly, and a magnet that can be taken away.
struct Shaft {
    turns: f64,
    turns_per_s: f64,
    has_magnet: bool,
}

impl ShaftAngle for Shaft {
    fn shaft_turns(&mut self, now: Instant) -> f64 {
        self.turns + self.turns_per_s * now.as_micros() as f64 * 1e-6
    }

    fn magnet_is_present(&self) -> bool {
        self.has_magnet
    }
}

type Rig = RefCell<Single<Chip, Shaft>>;
type Encoder<'a> = Mt6835<SpiPort<'a>, Delay>;

fn bench_at(turns: f64) -> Rig {
    let environment = Shaft { turns, turns_per_s: 0.0, has_magnet: true };
    RefCell::new(Single { chip: Chip::new(Instant::from_ticks(0)), environment })
}

fn encoder(rig: &Rig, configuration: Configuration) -> Encoder<'_> {
    Mt6835::new(SpiPort::new(rig, Select::Encoder, BUS_HERTZ), Delay, configuration)
}

async fn started(rig: &Rig) -> Encoder<'_> {
    let mut encoder = encoder(rig, Configuration::default());
    encoder.start().await.expect("the chip is well");
    encoder
}

fn power_cycle(rig: &Rig) {
    rig.borrow_mut().power_cycle(Select::Encoder, Instant::now());
}

/// Sends bytes and gives the answer.
async fn exchange<const N: usize>(rig: &Rig, hertz: u32, sent: [u8; N]) -> [u8; N] {
    let mut bytes = sent;
    let mut port = SpiPort::new(rig, Select::Encoder, hertz);
    port.transfer_in_place(&mut bytes).await.expect("the bus is well");
    bytes
}

/// Sends rows of bytes and compares all answers.
async fn transcript<const N: usize>(rig: &Rig, rows: &[([u8; N], [u8; N])]) {
    for (sent, expected) in rows {
        assert_eq!(exchange(rig, 1_000_000, *sent).await, *expected, "{sent:02x?}");
    }
}

const READY: embassy_time::Duration = embassy_time::Duration::from_millis(64);

/// Bytes of the public driver `nagi_mt6835` (burst as 0xA0 0x03 and four more), checksums by its
/// table: T[T[T[0x80]]] = T[T[0x89]] = T[0xB6] = 0x0B; T[0x08] = 0x38; T[T[0x01]] = T[0x07] = 0x15.
#[test]
fn a_burst_carries_the_checksum_of_the_public_table() {
    for (turns, frame) in [
        (0.5, [0x80, 0x00, 0x00, 0x0B]),
        (1.0 / 2_097_152.0, [0x00, 0x00, 0x08, 0x38]),
        (32.0 / 2_097_152.0, [0x00, 0x01, 0x00, 0x15]),
        (0.0, [0x00, 0x00, 0x00, 0x00]),
    ] {
        let rig = bench_at(turns);
        run(async {
            Timer::after(READY).await;
            let [a, b, c, d] = frame;
            transcript(&rig, &[([0xA0, 0x03, 0, 0, 0, 0], [0, 0, a, b, c, d])]).await;
        });
        assert_eq!(violations(&rig), []);
    }
}

/// The byte sequences of `SimpleFOC`: `setHysteresis` and `setBandwidth` (read, change the field,
/// write) and `setZeroFromCurrentPosition`, with the registers' factory fields as stated in a public
/// STM32G4 driver: hysteresis 7, bandwidth 5.
#[test]
fn registers_are_read_changed_and_written_in_three_bytes() {
    let rig = bench_at(0.25);
    run(async {
        Timer::after(READY).await;
        let held = exchange(&rig, 1_000_000, [0x30, 0x0D, 0]).await[2];
        assert_eq!(held & 0x0F, 0x07);
        let changed = held & 0xF8 | 0x04;
        transcript(&rig, &[([0x60, 0x0D, changed], [0; 3]), ([0x30, 0x0D, 0], [0, 0, changed])])
            .await;
        let bandwidth = exchange(&rig, 1_000_000, [0x30, 0x11, 0]).await[2];
        assert_eq!(bandwidth & 0x07, 0x05);
        // A quarter turn is 1024 of the zero position's 4096 steps.
        transcript(
            &rig,
            &[
                ([0x50, 0x00, 0], [0, 0, 0x55]),
                ([0x30, 0x09, 0], [0, 0, 0x40]),
                ([0x30, 0x0A, 0], [0, 0, 0x00]),
            ],
        )
        .await;
        transcript(&rig, &[([0xA0, 0x03, 0, 0, 0, 0], [0; 6])]).await;
    });
    assert_eq!(violations(&rig), []);
}

#[test]
fn a_power_cycle_brings_back_what_the_eeprom_holds() {
    let rig = bench_at(0.0);
    run(async {
        Timer::after(READY).await;
        exchange(&rig, 1_000_000, [0x60, 0x01, 0x11]).await;
        assert_eq!(exchange(&rig, 1_000_000, [0xC0, 0x00, 0x00]).await[2], 0x55);
        Timer::after_secs(6).await;
        exchange(&rig, 1_000_000, [0x60, 0x01, 0x22]).await;
        power_cycle(&rig);
        Timer::after(READY).await;
        assert_eq!(exchange(&rig, 1_000_000, [0x30, 0x01, 0x00]).await[2], 0x11);
    });
    assert_eq!(rig.borrow().chip.programmings, 1);
    assert_eq!(violations(&rig), []);
}

#[test]
fn every_kind_of_misuse_is_recorded() {
    let rig = bench_at(0.0);
    run(async {
        exchange(&rig, 1_000_000, [0x30, 0x01, 0]).await;
        Timer::after(READY).await;
        exchange(&rig, 16_000_001, [0x30, 0x01, 0]).await;
        exchange(&rig, 1_000_000, [0x30, 0x01]).await;
        exchange(&rig, 1_000_000, [0xA0, 0x03, 0, 0, 0]).await;
        exchange(&rig, 1_000_000, [0x30, 0x02, 0]).await;
        exchange(&rig, 1_000_000, [0x60, 0x12, 0]).await;
        exchange(&rig, 1_000_000, [0x60, 0x05, 0]).await;
        // The direction at bit 7, as one public driver has it.
        exchange(&rig, 1_000_000, [0x60, 0x0D, 0x27]).await;
        exchange(&rig, 1_000_000, [0xA0, 0x04, 0, 0, 0, 0]).await;
        exchange(&rig, 1_000_000, [0xB0, 0x00, 0]).await;
    });
    let expected = [
        Misuse::TooEarly,
        Misuse::ClockTooFast,
        Misuse::Length,
        Misuse::Length,
        Misuse::UnknownRegister,
        Misuse::UnknownRegister,
        Misuse::ReadOnly,
        Misuse::ReservedBits,
        Misuse::ForbiddenValue,
        Misuse::UnknownCommand,
    ];
    assert_eq!(violations(&rig), expected);
}

#[test]
fn the_factory_hysteresis_holds_the_angle_and_none_lets_it_follow() {
    let rig = bench_at(0.5);
    run(async {
        Timer::after(READY).await;
        let burst = [0xA0, 0x03, 0, 0, 0, 0];
        let first = exchange(&rig, 1_000_000, burst).await;
        rig.borrow_mut().environment.turns += 0.010 / 360.0;
        assert_eq!(exchange(&rig, 1_000_000, burst).await, first);
        exchange(&rig, 1_000_000, [0x60, 0x0D, 0xA4]).await;
        assert_ne!(exchange(&rig, 1_000_000, burst).await, first);
    });
}

#[test]
fn the_budget_is_that_of_the_documentation() {
    assert_eq!(BYTES_PER_READING, 9);
    assert_eq!(TIME_PER_READING, Duration::from_nanos(14_400));
    let rig = bench_at(0.3);
    run(async {
        let mut encoder = started(&rig).await;
        let begin = Instant::now();
        let _ = encoder.read().await.expect("the chip is well");
        // Both transactions round up to whole microseconds.
        assert!((Instant::now() - begin).as_micros() <= 15 + 1);
    });
}

#[test]
fn the_checksum_is_the_one_of_the_catalogue() {
    assert_eq!(codec::checksum(b"123456789"), 0xF4);
}

#[test]
fn the_driver_shows_the_shaft_exactly_and_leaves_no_violation() {
    for step in [0, 1, 2, 0x0F_FFFF, 0x10_0000, 0x1A_5A5A, 0x1F_FFFF] {
        let rig = bench_at(f64::from(step) / 2_097_152.0 - 3.0);
        let reading = run(async { started(&rig).await.read().await });
        assert_eq!(reading.expect("the chip is well"), Angle(step << 11));
        assert_eq!(violations(&rig), []);
        assert_eq!(rig.borrow().chip.programmings, 0);
    }
}

#[test]
fn the_other_direction_mirrors_the_angle_and_keeps_the_makers_bits() {
    let rig = bench_at(0.125);
    let configuration = Configuration {
        is_reversed: true,
        hysteresis: Hysteresis::Degrees0003,
        bandwidth: Bandwidth::X8,
    };
    run(async {
        let mut encoder = encoder(&rig, configuration);
        encoder.start().await.expect("the chip is well");
        let angle = encoder.read().await.expect("the chip is well");
        assert_eq!(angle, Angle(0xE000_0000));
    });
    assert_eq!(rig.borrow().chip.ram[0x00D], 0xA0 | 0x08 | 0x05);
    assert_eq!(rig.borrow().chip.ram[0x011], 0x90 | 0x03);
    assert_eq!(violations(&rig), []);
}

#[test]
fn a_wrong_checksum_is_reported_once() {
    let rig = bench_at(0.7);
    run(async {
        let mut encoder = started(&rig).await;
        rig.borrow_mut().chip.spoiled = 0x10;
        assert_eq!(encoder.read().await, Err(Fault::Checksum));
        assert!(encoder.read().await.is_ok());
    });
}

#[test]
fn a_chip_that_reset_itself_is_noticed_within_two_readings_and_brought_back() {
    for readings_before in 0..12 {
        let rig = bench_at(0.7);
        run(async {
            let mut encoder = started(&rig).await;
            for _ in 0..readings_before {
                let _ = encoder.read().await.expect("the chip is well");
            }
            power_cycle(&rig);
            Timer::after(READY).await;
            let found = [encoder.read().await, encoder.read().await];
            assert!(found.contains(&Err(Fault::Reset)), "{readings_before}: {found:?}");
            encoder.start().await.expect("the chip is well again");
            assert!(encoder.read().await.is_ok());
        });
        assert_eq!(violations(&rig), []);
    }
}

#[test]
fn a_chip_without_supply_is_noticed_though_zeros_check_as_zero() {
    for readings_before in 0..12 {
        let rig = bench_at(0.7);
        run(async {
            let mut encoder = started(&rig).await;
            for _ in 0..readings_before {
                let _ = encoder.read().await.expect("the chip is well");
            }
            power_cycle(&rig);
            assert_eq!(encoder.read().await, Err(Fault::Reset));
            encoder.start().await.expect("the chip is well again");
        });
    }
}

#[test]
fn a_changed_register_is_noticed_within_ten_readings() {
    for register in [0x00D, 0x011, 0x009, 0x00A, 0x00C] {
        let rig = bench_at(0.7);
        run(async {
            let mut encoder = started(&rig).await;
            rig.borrow_mut().chip.ram[register] ^= 1 << 2;
            let fault = Fault::NotAsWritten { register: register as u8 };
            let mut found = Vec::new();
            for _ in 0..10 {
                found.push(encoder.read().await);
            }
            assert!(found.contains(&Err(fault)), "{register:#x}");
        });
    }
}

#[test]
fn every_warning_is_an_alarm_and_passes() {
    let rig = bench_at(0.7);
    run(async {
        let mut encoder = started(&rig).await;
        rig.borrow_mut().environment.has_magnet = false;
        assert_eq!(encoder.read().await, Err(Fault::Alarm { status: WEAK_MAGNET }));
        assert_eq!(encoder.start().await, Err(Fault::Alarm { status: WEAK_MAGNET }));
        rig.borrow_mut().environment.has_magnet = true;
        rig.borrow_mut().chip.has_undervoltage = true;
        assert_eq!(encoder.read().await, Err(Fault::Alarm { status: UNDERVOLTAGE }));
        rig.borrow_mut().chip.has_undervoltage = false;
        encoder.start().await.expect("the chip is well again");
        rig.borrow_mut().environment.turns_per_s = 2001.0;
        Timer::after_millis(100).await;
        assert_eq!(encoder.read().await, Err(Fault::Alarm { status: OVERSPEED }));
    });
}

#[test]
fn an_encoder_that_was_not_started_gives_no_angle() {
    let rig = bench_at(0.7);
    run(async {
        // The pattern is there: a controller that restarts alone must configure all the same.
        started(&rig).await;
        let mut other =
            encoder(&rig, Configuration { is_reversed: true, ..Configuration::default() });
        assert_eq!(other.read().await, Err(Fault::Reset));
        rig.borrow_mut().chip.calibration = 0b10;
        assert_eq!(other.start().await, Err(Fault::SelfTest));
        assert_eq!(other.read().await, Err(Fault::Reset));
    });
}

#[test]
fn a_calibration_that_runs_or_failed_is_reported() {
    let rig = bench_at(0.7);
    run(async {
        let mut encoder = encoder(&rig, Configuration::default());
        for (state, result) in
            [(0b01, Err(Fault::NotReady)), (0b10, Err(Fault::SelfTest)), (0b11, Ok(()))]
        {
            rig.borrow_mut().chip.calibration = state;
            assert_eq!(encoder.start().await, result);
        }
    });
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
            if let Operation::Read(bytes) | Operation::TransferInPlace(bytes) = operation {
                bytes.fill(byte);
            }
        }
        Ok(())
    }
}

#[test]
fn a_dead_line_is_no_encoder() {
    for (byte, fault) in [
        (Some(0x00), Fault::Identity { found: 0x00 }),
        (Some(0xFF), Fault::Identity { found: 0xFF }),
        (None, Fault::Bus),
    ] {
        let mut encoder = Mt6835::new(Stuck(byte), Delay, Configuration::default());
        assert_eq!(run(encoder.start()), Err(fault));
        assert!(run(encoder.read()).is_err());
    }
}

proptest! {
    #[test]
    fn a_frame_gives_back_angle_and_status(step in 0_u32..1 << 21, status in 0_u32..8) {
        let [_, a, b, c] = (step << 3 | status).to_be_bytes();
        let frame = codec::frame([a, b, c, codec::checksum(&[a, b, c])]).expect("it is right");
        prop_assert_eq!(frame.angle, Angle(step << 11));
        prop_assert_eq!(u32::from(frame.status), status);
    }

    #[test]
    fn up_to_three_wrong_bits_are_found(
        step in 0_u32..1 << 21,
        bits in prop::collection::vec(0_u32..32, 1..4),
    ) {
        let [_, a, b, c] = (step << 3).to_be_bytes();
        let right = u32::from_be_bytes([a, b, c, codec::checksum(&[a, b, c])]);
        let wrong = bits.iter().fold(right, |word, bit| word ^ 1 << bit);
        prop_assert_eq!(codec::frame(wrong.to_be_bytes()).is_err(), wrong != right);
    }
}
