//! Any sequence of transactions gives the same replies, registers, violations and lines byte by byte as by
//! transaction, however often the chip is looked at between the bytes.

use std::fmt::Debug;

use embassy_time::Instant;
use embedded_hal::spi::{MODE_0, MODE_1, MODE_3, Mode};
use hal_mock::ads1262::Ads1262;
use hal_mock::adxl355::Adxl355;
use hal_mock::chip::{ReadyLine, Rig, Select, Single, SpiChip, Transaction};
use hal_mock::mt6835::Mt6835;
use hal_mock::tmc5160::{Oscillator, Tmc5160};
use hal_mock::wires::{Clock, SpiWires};
use proptest::collection::vec;
use proptest::prelude::*;

use super::bench::{Bench, byte_ns};

/// The line of the one chip.
const CHIP: Select = Select::Gyro;

/// A transaction after a pause.
#[derive(Clone, Debug)]
struct Step {
    pause_us: u64,
    hertz: u32,
    sent: Vec<u8>,
}

/// What a transaction left behind, the chip as it prints itself.
#[derive(Debug, PartialEq)]
struct After {
    reply: Vec<u8>,
    chip: String,
    bench: Bench,
    line: ReadyLine,
}

fn after<C: Debug + SpiChip<Bench>>(
    single: &mut Single<C, Bench>,
    reply: Vec<u8>,
    us: u64,
) -> After {
    let line = single.ready_line(CHIP, Instant::from_micros(us));
    After { reply, chip: format!("{:?}", single.chip), bench: single.environment.clone(), line }
}

/// Whether a conversion or a sample ends by a time within a transaction, be it one that a part of its bytes begins and
/// the rest ends.
fn ends_within<C: Clone + SpiChip<Bench>>(
    single: &Single<C, Bench>,
    transaction: &Transaction,
    end: Instant,
) -> bool {
    let ends = |chip: &C| chip.next_event().is_some_and(|at| at <= end);
    let after = |bytes: usize| {
        let mut single = single.clone();
        let part = Transaction { sent: &transaction.sent[..bytes], ..*transaction };
        single.transact(CHIP, &part, &mut vec![0; bytes]);
        single.chip
    };
    ends(&single.chip) || (1..=transaction.sent.len()).any(|bytes| ends(&after(bytes)))
}

/// Up to the first transaction that may change a register or a conversion while a conversion or sample ends: which of them comes first,
/// bytes alone tell.
fn by_transaction<C: Clone + Debug + SpiChip<Bench>>(
    chip: C,
    steps: &[Step],
    may_change: fn(&[u8]) -> bool,
) -> Vec<After> {
    let mut single = Single { chip, environment: Bench::default() };
    let mut us = 0;
    let mut transact = |Step { pause_us, hertz, sent }: &Step| {
        us += pause_us;
        let mut reply = vec![0; sent.len()];
        let transaction = Transaction { now: Instant::from_micros(us), hertz: *hertz, sent };
        single.ready_line(CHIP, transaction.now);
        us += (byte_ns(*hertz) * sent.len() as u64).div_ceil(1000);
        if may_change(sent) && ends_within(&single, &transaction, Instant::from_micros(us)) {
            return None;
        }
        single.transact(CHIP, &transaction, &mut reply);
        Some(after(&mut single, reply, us))
    };
    steps.iter().map_while(&mut transact).collect()
}

fn by_byte<C: Debug + SpiChip<Bench>>(
    chip: C,
    mode: Mode,
    steps: &[Step],
    looks: bool,
) -> Vec<After> {
    let mut single = Single { chip, environment: Bench::default() };
    let (mut wires, mut us) = (SpiWires::new(), 0);
    let mut transact = |Step { pause_us, hertz, sent }: &Step| {
        us += pause_us;
        wires.set_select(&mut single, CHIP, true, us * 1000);
        let mut at = us * 1000;
        let mut reply = Vec::new();
        for byte in sent {
            wires.begin(&mut single, *byte, Clock { mode, hertz: *hertz }, at);
            at += byte_ns(*hertz);
            if looks {
                single.ready_line(CHIP, Instant::from_micros(at / 1000));
            }
            reply.push(wires.finish(&mut single));
        }
        wires.set_select(&mut single, CHIP, false, at);
        us = at.div_ceil(1000);
        after(&mut single, reply, us)
    };
    let all = steps.iter().map(&mut transact).collect();
    assert!(!wires.faults().first.iter().any(|fault| fault.to_string().contains("Mode")));
    all
}

/// Holds a chip to its own answers by transaction.
fn hold<C: Clone + Debug + SpiChip<Bench>>(
    chip: &C,
    mode: Mode,
    steps: &[Step],
    may_change: fn(&[u8]) -> bool,
) {
    let expected = by_transaction(chip.clone(), steps, may_change);
    for looks in [false, true] {
        let found = by_byte(chip.clone(), mode, steps, looks);
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "step {index} of {:02x?}", &steps[..=index]);
        }
    }
}

fn steps(
    hertz: &'static [u32],
    sent: impl Strategy<Value = Vec<u8>>,
) -> impl Strategy<Value = Vec<Step>> {
    let pause_us = prop_oneof![0_u64..20, 20_u64..3000, Just(100_000)];
    let step = (pause_us, prop::sample::select(hertz), sent)
        .prop_map(|(pause_us, hertz, sent)| Step { pause_us, hertz, sent });
    vec(step, 1..40).prop_map(|mut steps| {
        // After power-up, more often than not.
        steps[0].pause_us *= 100;
        steps
    })
}

/// Any bytes, few enough that one event falls into their time at most.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    vec(any::<u8>(), 1..12)
}

fn converter() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        4 => Just(vec![0; 6]),
        4 => Just(vec![0x12, 0, 0, 0, 0, 0, 0]),
        2 => Just(vec![0x08]),
        1 => prop::sample::select(vec![0x06_u8, 0x0A]).prop_map(|command| vec![command]),
        2 => (0_u8..16).prop_map(|rate| vec![0x45, 0, rate]),
        2 => (1_u8..8, any::<u8>()).prop_map(|(address, value)| vec![0x40 | address, 0, value]),
        2 => (0_u8..22, 0_u8..6).prop_map(|(address, left)| {
            let mut sent = vec![0x20 | address, left];
            sent.resize(3 + usize::from(left), 0);
            sent
        }),
        2 => bytes(),
    ]
}

/// Whether a converter may take a command from these bytes that changes registers or conversions: reset, start, stop,
/// and the writing of registers.
fn may_change(sent: &[u8]) -> bool {
    sent.iter().any(|byte| (0x06..0x0C).contains(byte) || byte & 0xE0 == 0x40)
}

fn accelerometer() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        4 => Just(vec![0x11, 0, 0, 0, 0, 0, 0, 0, 0, 0]),
        4 => Just(vec![0x23, 0, 0, 0, 0, 0, 0]),
        3 => prop::sample::select(vec![0x00_u8, 0x00, 0x01]).prop_map(|power| vec![0x5A, power]),
        2 => Just(vec![0x09, 0]),
        2 => Just(vec![0x0D, 0, 0, 0]),
        1 => Just(vec![0x5E, 0x52]),
        1 => (0_u8..11).prop_map(|rate| vec![0x50, rate]),
        1 => (0_u8..4).prop_map(|test| vec![0x5C, test]),
        2 => bytes(),
    ]
}

fn encoder() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        6 => Just(vec![0xA0, 0x03, 0, 0, 0, 0]),
        3 => (0_u8..0x14).prop_map(|address| vec![0x30, address, 0]),
        3 => (0_u8..0x14, any::<u8>()).prop_map(|(address, value)| vec![0x60, address, value]),
        1 => Just(vec![0x50, 0, 0]),
        1 => Just(vec![0xC0, 0, 0]),
        2 => bytes(),
    ]
}

/// Slopes are steep and VSTOP stays small: a ramp that hunts for its target clock by clock takes long.
fn motor() -> impl Strategy<Value = Vec<u8>> {
    let ramp = vec![0x26_u8, 0x27, 0x28, 0x2A, 0x2D];
    let flags = vec![0x00_u8, 0x01, 0x20, 0x22, 0x34, 0x35];
    let datagram = |(address, value, is_write): (u8, u32, bool)| {
        let [a, b, c, d] = value.to_be_bytes();
        vec![address | u8::from(is_write) << 7, a, b, c, d]
    };
    prop_oneof![
        4 => (prop::sample::select(ramp), 1000_u32..60_000, any::<bool>()).prop_map(datagram),
        4 => (prop::sample::select(flags), 0_u32..5, any::<bool>()).prop_map(datagram),
        2 => Just(datagram((0x2D, 200_000, true))),
        2 => Just(datagram((0x27, 100_000, true))),
        2 => Just(datagram((0x2B, 10, true))),
        2 => bytes().prop_map(|mut sent| {
            // Registers are read at random, not written.
            sent[0] &= 0x7F;
            sent
        }),
    ]
}

const NOMINAL: Oscillator = Oscillator::Internal { hertz: 12_000_000 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_converter_answers_byte_by_byte_as_by_transaction(steps in steps(&[4_000_000, 8_000_000], converter())) {
        hold(&Ads1262::default(), MODE_1, &steps, may_change);
    }

    #[test]
    fn an_accelerometer_answers_byte_by_byte_as_by_transaction(
        steps in steps(&[1_000_000, 2_000_000, 8_000_000, 10_000_000], accelerometer()),
    ) {
        hold(&Adxl355::new(Instant::from_micros(0)), MODE_0, &steps, |_| false);
    }

    #[test]
    fn an_encoder_answers_byte_by_byte_as_by_transaction(
        steps in steps(&[1_000_000, 4_000_000, 16_000_000, 20_000_000], encoder()),
    ) {
        hold(&Mt6835::new(Instant::from_micros(0)), MODE_3, &steps, |_| false);
    }

    #[test]
    fn a_motor_driver_answers_byte_by_byte_as_by_transaction(
        steps in steps(&[1_000_000, 4_000_000, 8_000_000], motor()),
    ) {
        hold(&Tmc5160::new(NOMINAL, Instant::from_micros(0)), MODE_3, &steps, |_| false);
    }
}
