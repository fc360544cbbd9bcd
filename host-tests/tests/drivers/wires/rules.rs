//! Every rule of an SPI bus: what breaks it is recorded with its chips, and does what it does on a real bus.

use embassy_time::Instant;
use embedded_hal::spi::{MODE_0, MODE_1, MODE_2, MODE_3, Mode};
use hal_mock::ads1262::Ads1262;
use hal_mock::adxl355::Adxl355;
use hal_mock::board::{StageBoard, StageChips};
use hal_mock::chip::Select;
use hal_mock::mt6835::Mt6835;
use hal_mock::plant::{Plant, PlantConfiguration};
use hal_mock::tmc5160::{Oscillator, Tmc5160};
use hal_mock::violation::Misuse;
use hal_mock::wires::{Clock, SpiRule, SpiWires, Wait};

use super::bench::byte_ns;

type Board = StageBoard<'static, Ads1262, Adxl355, Mt6835, Tmc5160>;

/// A stage's board on one bus, all of whose chips are up.
struct Bus {
    board: Board,
    wires: SpiWires,
    /// The end of the latest doing, ns.
    at: u64,
}

/// When all chips are up, ns.
const UP: u64 = 100_000_000;

/// A wait that is long enough for every chip, ns.
const LONG: u64 = 1000;

/// Bus clock, Hz.
const HERTZ: u32 = 1_000_000;

impl Bus {
    fn new() -> Self {
        let start = Instant::from_micros(0);
        let oscillator = Oscillator::Internal { hertz: 12_000_000 };
        let board = StageBoard {
            plant: Plant::new(&PlantConfiguration::default(), 1),
            chips: StageChips {
                gyro: Ads1262::default(),
                accelerometer: Adxl355::new(start),
                encoder: Mt6835::new(start),
                actuator: Tmc5160::new(oscillator, start),
            },
            blackouts: &[],
        };
        Self { board, wires: SpiWires::new(), at: UP }
    }

    /// Moves a select line so many ns after the latest doing.
    fn select(&mut self, select: Select, is_low: bool, after: u64) {
        self.at += after;
        self.wires.set_select(&mut self.board, select, is_low, self.at);
    }

    /// Clocks bytes in a mode, so many ns after the latest doing; what the controller reads.
    fn clock(&mut self, mode: Mode, hertz: u32, sent: &[u8], after: u64) -> Vec<u8> {
        self.at += after;
        let clock = Clock { mode, hertz };
        let mut byte = |sent: &u8| {
            let reply = self.wires.exchange(&mut self.board, *sent, clock, self.at);
            self.at += byte_ns(hertz);
            reply
        };
        sent.iter().map(&mut byte).collect()
    }

    /// A whole transaction with waits that are long enough.
    fn transact(&mut self, select: Select, mode: Mode, sent: &[u8]) -> Vec<u8> {
        self.select(select, true, LONG);
        let reply = self.clock(mode, HERTZ, sent, LONG);
        self.select(select, false, LONG);
        reply
    }

    /// The rules that were broken, with the chips.
    fn broken(&self) -> Vec<(SpiRule, Select)> {
        self.wires.faults().first.iter().map(|fault| (fault.rule, fault.select)).collect()
    }

    /// What a chip's data sheet forbids and was done to it.
    fn misuses(&mut self, select: Select) -> Vec<Misuse> {
        let found = self.board.violations(select).expect("it is on the board");
        found.first.iter().map(|violation| violation.misuse).collect()
    }
}

/// Each chip with its own mode, a read of what identifies it, and the last byte of the answer.
const CHIPS: [(Select, Mode, &[u8], u8); 4] = [
    (Select::Gyro, MODE_1, &[0x22, 0, 0], 0x05),
    (Select::Accelerometer, MODE_0, &[0x01, 0], 0xAD),
    (Select::Encoder, MODE_3, &[0x30, 0x0D, 0], 0xA7),
    (Select::Actuator, MODE_3, &[0x04, 0, 0, 0, 0], 0x00),
];

#[test]
fn every_chip_answers_in_its_own_mode_and_nothing_is_recorded() {
    let mut bus = Bus::new();
    for (select, mode, sent, answer) in CHIPS {
        assert_eq!(bus.transact(select, mode, sent).last(), Some(&answer), "{select:?}");
        assert_eq!(bus.misuses(select), []);
    }
    // The motor driver answers with its next datagram.
    assert_eq!(bus.transact(Select::Actuator, MODE_3, &[0x04, 0, 0, 0, 0])[1], 0x30);
    assert_eq!(bus.broken(), []);
}

#[test]
fn a_bus_without_a_selected_chip_reads_as_its_pull_up_and_nothing_happens() {
    let mut bus = Bus::new();
    assert_eq!(bus.clock(MODE_1, HERTZ, &[0x06, 0x12, 0], LONG), [0xFF; 3]);
    assert_eq!(bus.broken(), []);
    for (select, ..) in CHIPS {
        assert_eq!(bus.misuses(select), []);
    }
}

#[test]
fn a_select_line_of_no_chip_reads_as_the_pull_up() {
    let mut bus = Bus::new();
    assert_eq!(bus.transact(Select::GyroDown, MODE_1, &[0x22, 0, 0]), [0xFF; 3]);
    assert_eq!(bus.broken(), []);
}

#[test]
fn two_chips_selected_at_once_are_a_fault_and_their_bytes_collide() {
    let mut bus = Bus::new();
    bus.select(Select::Encoder, true, LONG);
    bus.select(Select::Actuator, true, LONG);
    let both = bus.clock(MODE_3, HERTZ, &[0x30, 0x0D, 0], LONG);
    bus.select(Select::Encoder, false, LONG);
    bus.select(Select::Actuator, false, LONG);
    let other = SpiRule::TwoSelected { other: Select::Encoder };
    assert_eq!(bus.broken(), [(other, Select::Actuator)]);
    // The motor driver's third byte is zero, the encoder's 0xA7.
    assert_eq!(both[2], 0);
    assert_eq!(bus.misuses(Select::Encoder), [], "it has heard three bytes");
    assert_eq!(bus.misuses(Select::Actuator), [Misuse::Length], "it wants five");
    assert_eq!(
        bus.wires.faults().first[0].to_string(),
        "TwoSelected { other: Encoder } of Actuator after 100002000 ns"
    );
}

#[test]
fn a_mode_that_a_chip_does_not_have_is_a_fault_and_its_bytes_come_a_bit_late() {
    for (select, own, sent, answer) in CHIPS {
        for mode in [MODE_0, MODE_1, MODE_2, MODE_3].into_iter().filter(|mode| *mode != own) {
            let mut bus = Bus::new();
            let found = bus.transact(select, mode, sent);
            let expected = vec![(SpiRule::WrongMode(mode), select); sent.len()];
            assert_eq!(bus.broken(), expected);
            assert!(
                answer == 0 || found.last() != Some(&answer),
                "{select:?} {mode:?} {found:02x?}"
            );
        }
    }
}

/// The identity 0xAD of an accelerometer that hears 0x02 as 0x01, and is heard a bit late.
#[test]
fn a_bit_late_means_half_of_each_byte_and_a_bit_of_the_one_before() {
    let mut bus = Bus::new();
    let found = bus.transact(Select::Accelerometer, MODE_1, &[0x02, 0, 0]);
    assert_eq!(found, [0x00, 0xAD >> 1, 0x80 | 0x1D >> 1]);
}

#[test]
fn a_clock_beyond_a_chips_limit_is_a_violation_of_the_chip() {
    let limits = [8_000_000, 10_000_000, 16_000_000, 4_000_000];
    for ((select, mode, sent, _), limit) in CHIPS.into_iter().zip(limits) {
        for (hertz, expected) in [(limit, &[][..]), (limit + 1, &[Misuse::ClockTooFast])] {
            let mut bus = Bus::new();
            bus.select(select, true, LONG);
            bus.clock(mode, hertz, sent, LONG);
            bus.select(select, false, LONG);
            assert_eq!(bus.misuses(select), expected);
            assert_eq!(bus.broken(), []);
        }
    }
}

/// Least waits of each chip, ns: select to clock, clock to select, between selects (ADS1262: SBAS661C section
/// 7.6; ADXL355: SPI characteristics; MT6835: SPI timing; TMC5160: section 4.3 with 12 MHz).
const WAITS: [[u64; 3]; 4] = [[50, 40, 30], [20, 20, 40], [100, 0, 150], [10, 10, 177]];

#[test]
fn waits_shorter_than_a_chip_allows_are_faults() {
    for ((select, mode, sent, _), waits) in CHIPS.into_iter().zip(WAITS) {
        let half_bit = 500;
        let first_edge = if mode == MODE_0 { half_bit } else { 0 };
        for wait in 0..3 {
            for short in [0, 1] {
                let mut used = [LONG; 3];
                used[wait] = waits[wait].saturating_sub(short);
                let mut bus = Bus::new();
                bus.select(select, true, LONG);
                // A clock whose first edge comes later begins so much earlier; below that no wait is too short.
                bus.clock(mode, HERTZ, sent, used[0].saturating_sub(first_edge));
                // The last edge of the other phase comes half a bit before the byte's end.
                bus.at -= half_bit - first_edge;
                bus.select(select, false, used[1]);
                bus.select(select, true, used[2]);
                let is_short = short == 1 && waits[wait] > 0 && !(wait == 0 && first_edge > 0);
                let wait = [Wait::SelectToClock, Wait::ClockToDeselect, Wait::Deselected][wait];
                let broken = bus.broken();
                assert_eq!(broken.len(), usize::from(is_short), "{select:?} {wait:?} {broken:?}");
                assert!(broken.iter().all(|(rule, whose)| *whose == select
                    && matches!(rule, SpiRule::TooShort { wait: found, .. } if *found == wait)));
                assert_eq!(bus.misuses(select), []);
            }
        }
    }
}

#[test]
fn a_select_that_rises_within_a_byte_ends_the_transaction_with_a_wrong_length() {
    for (select, mode, sent, _) in CHIPS {
        let mut bus = Bus::new();
        bus.select(select, true, LONG);
        let (last, whole) = sent.split_last().expect("it sends something");
        bus.clock(mode, HERTZ, whole, LONG);
        bus.wires.begin(&mut bus.board, *last, Clock { mode, hertz: HERTZ }, bus.at);
        bus.select(select, false, 4000);
        assert_eq!(bus.wires.finish(&mut bus.board), 0xFF);
        assert_eq!(bus.broken(), [(SpiRule::MovedInByte, select)]);
        assert_eq!(bus.misuses(select), [Misuse::Length]);
    }
}

/// A chip with its mode, a write of a register, a read of the same, and what it holds after a reset.
type Write = (Select, Mode, &'static [u8], &'static [u8], u8);

#[test]
fn a_write_that_is_cut_within_its_value_is_not_done() {
    let writes: [Write; 3] = [
        (Select::Gyro, MODE_1, &[0x42, 0, 0x07], &[0x22, 0, 0], 0x05),
        (Select::Accelerometer, MODE_0, &[0x50, 0x05], &[0x51, 0], 0x00),
        (Select::Encoder, MODE_3, &[0x60, 0x0D, 0xA0], &[0x30, 0x0D, 0], 0xA7),
    ];
    for (select, mode, write, read, held) in writes {
        let mut bus = Bus::new();
        bus.select(select, true, LONG);
        let (value, whole) = write.split_last().expect("it sends something");
        bus.clock(mode, HERTZ, whole, LONG);
        bus.wires.begin(&mut bus.board, *value, Clock { mode, hertz: HERTZ }, bus.at);
        bus.select(select, false, 4000);
        bus.at += LONG * 10;
        assert_eq!(bus.transact(select, mode, read).last(), Some(&held), "{select:?}");
    }
}

#[test]
fn a_select_that_falls_within_a_byte_of_another_chip_is_a_fault_and_loses_the_byte() {
    let mut bus = Bus::new();
    bus.select(Select::Encoder, true, LONG);
    bus.clock(MODE_3, HERTZ, &[0x30, 0x0D], LONG);
    bus.wires.begin(&mut bus.board, 0, Clock { mode: MODE_3, hertz: HERTZ }, bus.at);
    bus.select(Select::Actuator, true, 4000);
    assert_eq!(
        bus.wires.finish(&mut bus.board),
        0xA7,
        "the other chip has not heard its beginning"
    );
    bus.at += 4000;
    bus.select(Select::Encoder, false, LONG);
    bus.clock(MODE_3, HERTZ, &[0x04, 0, 0, 0, 0], LONG);
    bus.select(Select::Actuator, false, LONG);
    let two = SpiRule::TwoSelected { other: Select::Encoder };
    assert_eq!(bus.broken(), [(SpiRule::MovedInByte, Select::Actuator), (two, Select::Actuator)]);
    assert_eq!(bus.misuses(Select::Encoder), []);
    assert_eq!(bus.misuses(Select::Actuator), [Misuse::Length]);
}

#[test]
fn a_select_that_rises_after_the_last_edge_finds_the_byte_whole() {
    let mut bus = Bus::new();
    bus.select(Select::Encoder, true, LONG);
    bus.clock(MODE_3, HERTZ, &[0x30, 0x0D], LONG);
    bus.wires.begin(&mut bus.board, 0, Clock { mode: MODE_3, hertz: HERTZ }, bus.at);
    // The last edge of this mode comes half a bit before the byte's end.
    bus.select(Select::Encoder, false, 7500);
    assert_eq!(bus.wires.finish(&mut bus.board), 0xA7);
    assert_eq!(bus.broken(), []);
    assert_eq!(bus.misuses(Select::Encoder), []);
}

#[test]
fn only_the_first_faults_are_kept_but_all_are_counted() {
    let mut bus = Bus::new();
    bus.transact(Select::Gyro, MODE_0, &[0; 20]);
    assert_eq!(bus.wires.faults().first.len(), 16);
    assert_eq!(bus.wires.faults().count, 20);
}
