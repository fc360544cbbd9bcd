//! Code that is interrupted with a select line low, and faults of the chips themselves over the wires.

use embassy_time::Instant;
use embedded_hal::spi::{MODE_0, MODE_1, MODE_3, Mode};
use hal_mock::ads1262::Ads1262;
use hal_mock::adxl355::Adxl355;
use hal_mock::board::{StageBoard, StageChips};
use hal_mock::chip::{Rig, Select, Single, SpiChip};
use hal_mock::fault::Blackout;
use hal_mock::mt6835::Mt6835;
use hal_mock::plant::{Plant, PlantConfiguration, StageFault};
use hal_mock::tmc5160::{ChipFault, Oscillator, Tmc5160};
use hal_mock::wires::{Clock, SpiWires};

use super::bench::{Bench, byte_ns};

/// Bus clock, Hz.
const HERTZ: u32 = 1_000_000;

/// How long the code is interrupted, ns.
const INTERRUPTION: u64 = 200_000_000;

/// A rig on wires that are right, from 100 ms on.
struct Wired<R> {
    rig: R,
    wires: SpiWires,
    at: u64,
}

impl<R: Rig> Wired<R> {
    fn new(rig: R) -> Self {
        Self { rig, wires: SpiWires::new(), at: 100_000_000 }
    }

    fn select(&mut self, select: Select, is_low: bool) {
        self.at += 1000;
        self.wires.set_select(&mut self.rig, select, is_low, self.at);
        self.at += 1000;
    }

    fn clock(&mut self, mode: Mode, sent: &[u8]) -> Vec<u8> {
        let mut byte = |sent: &u8| {
            let reply =
                self.wires.exchange(&mut self.rig, *sent, Clock { mode, hertz: HERTZ }, self.at);
            self.at += byte_ns(HERTZ);
            reply
        };
        sent.iter().map(&mut byte).collect()
    }

    fn transact(&mut self, select: Select, mode: Mode, sent: &[u8]) -> Vec<u8> {
        self.select(select, true);
        let reply = self.clock(mode, sent);
        self.select(select, false);
        reply
    }
}

fn alone<C: SpiChip<Bench>>(chip: C) -> Wired<Single<C, Bench>> {
    Wired::new(Single { chip, environment: Bench::default() })
}

fn start() -> Instant {
    Instant::from_micros(0)
}

fn micros(nanoseconds: u64) -> Instant {
    Instant::from_micros(nanoseconds / 1000)
}

/// The newest conversion is there after the transaction, and all before it are lost.
#[test]
fn conversions_that_end_while_a_read_is_interrupted_are_lost_but_for_the_newest() {
    let mut wired = alone(Ads1262::default());
    wired.transact(Select::Gyro, MODE_1, &[0x44, 1, 0x60, 0x08]);
    wired.transact(Select::Gyro, MODE_1, &[0x08]);
    wired.at += 10_000_000;
    wired.select(Select::Gyro, true);
    let begun = wired.clock(MODE_1, &[0x12, 0, 0]);
    wired.at += INTERRUPTION;
    let line = wired.rig.ready_line(Select::Gyro, micros(wired.at));
    assert!(line.active, "the line falls at its time");
    let ended = wired.clock(MODE_1, &[0; 4]);
    wired.select(Select::Gyro, false);
    assert_ne!(begun[1], 0, "the status byte of the conversion from before");
    assert_eq!(ended.len(), 4);
    let lost = wired.rig.chip.overwritten;
    assert!((77..=84).contains(&lost), "{lost} of 80 conversions at 400 Hz");
    let newest = wired.transact(Select::Gyro, MODE_1, &[0x12, 0, 0, 0, 0, 0, 0]);
    assert_ne!(newest[1] & 0x40, 0, "the newest is new");
    assert_eq!(SpiChip::<Bench>::violations(&wired.rig.chip).count, 0);
    assert_eq!(wired.wires.faults().count, 0);
}

/// Measuring begins when its bit is written, and the first sample comes a period after that.
#[test]
fn an_accelerometer_that_is_started_late_measures_from_then_on() {
    let mut wired = alone(Adxl355::new(start()));
    wired.select(Select::Accelerometer, true);
    wired.clock(MODE_0, &[0x5A]);
    wired.at += INTERRUPTION;
    let resumed = wired.at;
    wired.clock(MODE_0, &[0x00]);
    wired.select(Select::Accelerometer, false);
    let first = SpiChip::<Bench>::next_event(&wired.rig.chip).expect("it measures");
    assert!(first > micros(resumed) && first <= micros(resumed + 300_000), "{first:?}");
}

/// A sample that lands within the read spoils the bytes after it, as by transaction.
#[test]
fn samples_that_land_while_a_read_is_interrupted_spoil_its_rest() {
    let mut wired = alone(Adxl355::new(start()));
    wired.transact(Select::Accelerometer, MODE_0, &[0x5A, 0x00]);
    wired.at += 1_000_000;
    wired.select(Select::Accelerometer, true);
    wired.clock(MODE_0, &[0x11, 0, 0, 0]);
    wired.at += INTERRUPTION;
    let rest = wired.clock(MODE_0, &[0; 6]);
    wired.select(Select::Accelerometer, false);
    let again = wired.transact(Select::Accelerometer, MODE_0, &[0x11, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    assert_ne!(rest, again[4..], "the lower four bits of each value are not inverted");
    assert_eq!(SpiChip::<Bench>::violations(&wired.rig.chip).count, 0);
}

/// The datagram acts when it is complete, not when it was begun.
#[test]
fn a_motor_that_is_told_late_starts_late() {
    let oscillator = Oscillator::Internal { hertz: 12_000_000 };
    let mut wired = alone(Tmc5160::new(oscillator, start()));
    for (address, value) in [(0xA4_u8, 1000_u16), (0xA6, 1000), (0xA8, 1000), (0xAA, 1000)] {
        let [high, low] = value.to_be_bytes();
        wired.transact(Select::Actuator, MODE_3, &[address, 0, 0, high, low]);
    }
    wired.transact(Select::Actuator, MODE_3, &[0xA7, 0, 1, 0, 0]);
    wired.select(Select::Actuator, true);
    wired.clock(MODE_3, &[0xAD, 0, 1]);
    wired.at += INTERRUPTION;
    let resumed = wired.at;
    wired.clock(MODE_3, &[0, 0]);
    wired.select(Select::Actuator, false);
    let next = SpiChip::<Bench>::next_event(&wired.rig.chip).expect("it moves");
    assert!(next > micros(resumed), "{next:?}");
    assert_eq!(wired.rig.chip.field(), 0);
}

type Board<'a> = StageBoard<'a, Ads1262, Adxl355, Mt6835, Tmc5160>;

fn board<'a>(
    configuration: &PlantConfiguration<'a>,
    blackouts: &'a [Blackout],
) -> Wired<Board<'a>> {
    let oscillator = Oscillator::Internal { hertz: 12_000_000 };
    Wired::new(StageBoard {
        plant: Plant::new(configuration, 1),
        chips: StageChips {
            gyro: Ads1262::default(),
            accelerometer: Adxl355::new(start()),
            encoder: Mt6835::new(start()),
            actuator: Tmc5160::new(oscillator, start()),
        },
        blackouts,
    })
}

#[test]
fn a_supply_that_is_lost_within_a_transaction_takes_its_course_away() {
    let at = Instant::from_micros(100_050);
    let blackouts = [Blackout { select: Select::Encoder, at }];
    let mut wired = board(&PlantConfiguration::default(), &blackouts);
    wired.select(Select::Encoder, true);
    wired.clock(MODE_3, &[0x60, 0x0D]);
    wired.at = 100_060_000;
    wired.clock(MODE_3, &[0xA0]);
    wired.select(Select::Encoder, false);
    assert_eq!(wired.rig.chips.encoder.ram[0x0D], 0xA7, "the value was taken for a command");
    let found = wired.rig.violations(Select::Encoder).expect("it is on the board");
    assert_eq!(found.count, 1, "too early after the loss");
}

#[test]
fn faults_of_a_chip_act_over_the_wires() {
    let mut wired = board(&PlantConfiguration::default(), &[]);
    wired.rig.chips.actuator.inject(ChipFault::Foreign);
    wired.rig.chips.gyro.chip_fault.broken_register = Some(0x02);
    wired.rig.chips.encoder.spoiled = 0x10;
    wired.rig.chips.accelerometer.spoiled_resets = 1;
    wired.transact(Select::Actuator, MODE_3, &[0x04, 0, 0, 0, 0]);
    assert_eq!(wired.transact(Select::Actuator, MODE_3, &[0x04, 0, 0, 0, 0])[1], 0x11);
    wired.transact(Select::Gyro, MODE_1, &[0x42, 0, 0x06]);
    assert_eq!(wired.transact(Select::Gyro, MODE_1, &[0x22, 0, 0])[2], 0x05);
    let burst = [0xA0, 0x03, 0, 0, 0, 0];
    let spoiled = wired.transact(Select::Encoder, MODE_3, &burst);
    let sound = wired.transact(Select::Encoder, MODE_3, &burst);
    assert_eq!(spoiled[5], sound[5] ^ 0x10);
    let shadow = wired.transact(Select::Accelerometer, MODE_0, &[0xA1, 0]);
    wired.transact(Select::Accelerometer, MODE_0, &[0x5E, 0x52]);
    wired.at += 10_000_000;
    assert_ne!(wired.transact(Select::Accelerometer, MODE_0, &[0xA1, 0]), shadow);
    assert_eq!(wired.wires.faults().count, 0);
}

#[test]
fn a_fault_of_the_stage_acts_over_the_wires() {
    let slips = [StageFault::Slip { at: Instant::from_micros(150_000), by_rad: 0.1 }];
    let configuration = PlantConfiguration { faults: &slips, ..PlantConfiguration::default() };
    let mut wired = board(&configuration, &[]);
    let burst = [0xA0, 0x03, 0, 0, 0, 0];
    let before = wired.transact(Select::Encoder, MODE_3, &burst);
    wired.at = 200_000_000;
    assert_ne!(wired.transact(Select::Encoder, MODE_3, &burst), before);
}
