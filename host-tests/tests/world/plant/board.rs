//! The board: the order of its chips' events.

use embassy_time::Instant;
use hal_mock::board::{StageBoard, StageChips};
use hal_mock::chip::{Exchange, ReadyLine, Rig, Select, SpiChip, Transaction};
use hal_mock::environment::{Mechanics, ShaftAngle};
use hal_mock::fault::Blackout;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::violation::{Misuse, Violations};

use super::{EXACT, assert_near, at};

/// A chip that acts every so often and writes down when and where the stage was.
#[derive(Default)]
struct Metronome {
    period: u64,
    next: u64,
    turns_per_s: f64,
    seen: Vec<(u64, f64)>,
    restarts: Vec<u64>,
    command: Option<u8>,
    violations: Violations,
}

impl Metronome {
    fn every(period: u64) -> Self {
        Self { period, next: period, ..Self::default() }
    }
}

impl SpiChip<Plant<'_>> for Metronome {
    fn next_event(&self) -> Option<Instant> {
        (self.period > 0).then(|| Instant::from_micros(self.next))
    }

    fn event(&mut self, plant: &mut Plant) {
        let now = Instant::from_micros(self.next);
        if self.turns_per_s > 0.0 {
            let microsteps = 4_608_000.0 * self.turns_per_s;
            plant.drive(now, microsteps * self.next as f64 * 1e-6, microsteps);
        }
        self.seen.push((self.next, plant.shaft_turns(now)));
        self.next += self.period;
    }

    fn select(&mut self, _: &mut Plant, _: Instant) {
        self.command = None;
    }

    fn exchange(&mut self, plant: &mut Plant, exchange: &Exchange) -> u8 {
        self.command.get_or_insert(exchange.sent);
        (plant.shaft_turns(exchange.since) * 100.0).round() as u8
    }

    fn deselect(&mut self, _: &mut Plant, since: Instant, _: bool) {
        self.violations.record(Misuse::Length, self.command.unwrap_or(0), since);
    }

    fn ready_line(&self) -> ReadyLine {
        ReadyLine { active: !self.seen.is_empty(), next: self.next_event(), ..ReadyLine::default() }
    }

    fn power_cycle(&mut self, now: Instant) {
        self.restarts.push(now.as_micros());
        self.turns_per_s = 0.0;
    }

    fn violations(&self) -> &Violations {
        &self.violations
    }
}

fn board(blackouts: &[Blackout]) -> StageBoard<'_, Metronome, Metronome, Metronome, Metronome> {
    StageBoard {
        plant: Plant::new(&PlantConfiguration::default(), 1),
        chips: StageChips {
            gyro: Metronome::every(1000),
            accelerometer: Metronome::every(8000),
            encoder: Metronome::default(),
            actuator: Metronome { turns_per_s: 0.01, ..Metronome::every(250_000) },
        },
        blackouts,
    }
}

#[test]
fn every_chip_acts_in_order_of_time_and_sees_the_stage_of_that_moment() {
    let mut board = board(&[]);
    board.advance(at(2.0));
    assert_eq!(board.chips.gyro.seen.len(), 2000);
    assert_eq!(board.chips.accelerometer.seen.len(), 250);
    assert_eq!(board.chips.actuator.seen.len(), 8);
    for (now, turns) in board.chips.gyro.seen.iter().chain(&board.chips.accelerometer.seen) {
        // The motor begins at the actuator's first event with a jump that takes the rotor to the
        // nearest of its equal positions.
        let jump = (4_608_000.0 * 0.01 * 0.25_f64).rem_euclid(1024.0) / 4_608_000.0;
        let seconds = *now as f64 * 1e-6 - 0.25;
        let expected = if seconds < 0.0 { 0.0 } else { jump + 0.01 * seconds };
        assert_near(*turns, expected, EXACT);
    }
}

#[test]
fn a_transaction_comes_after_everything_that_was_due() {
    let mut board = board(&[]);
    let transaction = Transaction { now: at(1.25), hertz: 1_000_000, sent: &[7, 0] };
    let mut reply = [0; 2];
    board.transact(Select::Encoder, &transaction, &mut reply);
    assert_eq!(reply, [1, 1]);
    assert_eq!(board.chips.gyro.seen.len(), 1250);
    assert_eq!(board.ready_line(Select::Gyro, at(1.5)).next, Some(at(1.501)));
    assert!(board.ready_line(Select::Gyro, at(1.5)).active);
    assert!(!board.ready_line(Select::Encoder, at(1.5)).active);
    board.transact(Select::Gyro, &transaction, &mut reply);
    board.transact(Select::Gyro, &transaction, &mut reply);
    let recorded: Vec<_> =
        board.recorded().map(|(select, found)| (select, found.address)).collect();
    assert_eq!(recorded, [(Select::Gyro, 7), (Select::Gyro, 7), (Select::Encoder, 7)]);
    assert_eq!(board.violations(Select::Gyro).map(|found| found.count), Some(2));
}

#[test]
fn blackouts_happen_in_their_time_and_a_motor_without_driver_stands() {
    let blackouts = [
        Blackout { select: Select::Gyro, at: at(0.5) },
        Blackout { select: Select::Actuator, at: at(1.1) },
        Blackout { select: Select::Gyro, at: at(1.2) },
    ];
    let mut board = board(&blackouts);
    board.advance(at(0.499_999));
    assert!(board.chips.gyro.restarts.is_empty());
    board.advance(at(2.0));
    assert_eq!(board.chips.gyro.restarts, [500_000, 1_200_000]);
    assert_eq!(board.chips.actuator.restarts, [1_100_000]);
    let stood: Vec<f64> = board
        .chips
        .gyro
        .seen
        .iter()
        .filter(|(now, _)| *now >= 1_100_000)
        .map(|(_, turns)| *turns)
        .collect();
    assert!(stood.iter().all(|turns| *turns == stood[0]));
    board.power_cycle(Select::Encoder, at(2.5));
    assert_eq!(board.chips.encoder.restarts, [2_500_000]);
    assert_eq!(board.chips.gyro.seen.len(), 2500);
}
