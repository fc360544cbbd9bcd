//! The wires of an I²C bus, and the one chip on it.

use embassy_time::Instant;
use hal_mock::chip::Single;
use hal_mock::i2c::{I2cChip, Transfer};
use hal_mock::lsm6dsl::Lsm6dsl;
use hal_mock::violation::Misuse;
use hal_mock::wires::{I2cRule, I2cWires};
use proptest::collection::vec;
use proptest::prelude::*;

use super::bench::Bench;

/// Bus clock of these tests, Hz, and what a bit takes, ns.
const HERTZ: u32 = 400_000;
const BIT: u64 = 2500;

/// The chip's address.
const ADDRESS: u8 = 0x6A;

type Imu = Single<Lsm6dsl, Bench>;

fn imu() -> Imu {
    Single {
        chip: Lsm6dsl::new(Instant::from_micros(0), ADDRESS, 1.0),
        environment: Bench::default(),
    }
}

/// Lets the chip do what is due until `us`, as a look at it does.
fn look(imu: &mut Imu, us: u64) {
    while I2cChip::<Bench>::next_event(&imu.chip).is_some_and(|at| at.as_micros() <= us) {
        imu.chip.event(&mut imu.environment);
    }
}

/// A transfer after a pause.
#[derive(Clone, Debug)]
struct Step {
    pause_us: u64,
    address: u8,
    sent: Vec<u8>,
    wanted: usize,
}

/// What a transfer left behind: whether it was acknowledged, what was read, the chip as it prints itself.
type After = (bool, Vec<u8>, String);

fn by_transfer(steps: &[Step]) -> Vec<After> {
    let (mut imu, mut us) = (imu(), 0);
    let mut transfer = |step: &Step| {
        us += step.pause_us;
        look(&mut imu, us);
        let mut reply = vec![0; step.wanted];
        let Step { address, sent, .. } = step;
        let transfer =
            Transfer { now: Instant::from_micros(us), hertz: HERTZ, address: *address, sent };
        let is_acknowledged = imu.chip.transfer(&mut imu.environment, &transfer, &mut reply);
        us += 1000;
        look(&mut imu, us);
        (is_acknowledged, reply, format!("{:?}", imu.chip))
    };
    steps.iter().map(&mut transfer).collect()
}

/// One transfer over the wires from a time in ns on; where `looks`, the chip is looked at before each byte.
fn over_wires(
    wires: &mut I2cWires,
    imu: &mut Imu,
    step: &Step,
    from: u64,
    looks: bool,
) -> (bool, Vec<u8>) {
    let mut at = from;
    let mut next = |imu: &mut Imu, bits: u64| {
        if looks {
            look(imu, at / 1000);
        }
        let begin = at;
        at += bits * BIT;
        begin
    };
    let mut reply = vec![0; step.wanted];
    let mut is_acknowledged = true;
    if !step.sent.is_empty() || step.wanted == 0 {
        let begin = next(imu, 10);
        is_acknowledged = wires.start(imu, step.address, false, HERTZ, begin);
        for byte in &step.sent {
            if is_acknowledged {
                let begin = next(imu, 9);
                is_acknowledged = wires.write(imu, *byte, begin);
            }
        }
    }
    if is_acknowledged && step.wanted > 0 {
        let begin = next(imu, 10);
        is_acknowledged = wires.start(imu, step.address, true, HERTZ, begin);
    }
    if is_acknowledged {
        for (index, byte) in reply.iter_mut().enumerate() {
            let begin = next(imu, 9);
            *byte = wires.read(imu, index + 1 < step.wanted, begin);
        }
    }
    let begin = next(imu, 1);
    wires.stop(imu, begin);
    (is_acknowledged, reply)
}

fn by_byte(steps: &[Step], looks: bool) -> Vec<After> {
    let (mut imu, mut us, mut wires) = (imu(), 0, I2cWires::new());
    let mut transfer = |step: &Step| {
        us += step.pause_us;
        look(&mut imu, us);
        let (is_acknowledged, reply) = over_wires(&mut wires, &mut imu, step, us * 1000, looks);
        us += 1000;
        look(&mut imu, us);
        (is_acknowledged, reply, format!("{:?}", imu.chip))
    };
    let all = steps.iter().map(&mut transfer).collect();
    assert_eq!(wires.faults().count, 0);
    all
}

fn step() -> impl Strategy<Value = Step> {
    let control = prop::sample::select(vec![
        vec![0x10, 0x60],
        vec![0x11, 0xA0],
        vec![0x10, 0x50, 0x50],
        vec![0x12, 0x44],
        vec![0x12, 0x04],
        vec![0x12, 0x01],
        vec![0x12, 0x84],
        vec![0x14, 0x05],
        vec![0x22, 0x00],
    ]);
    let sent = prop_oneof![
        4 => Just((vec![0x22], 12)),
        2 => Just((vec![0x12], 1)),
        2 => Just((vec![0x1E], 1)),
        4 => control.prop_map(|sent| (sent, 0)),
        2 => (vec(any::<u8>(), 2..5), 0_usize..4),
        1 => (0_u8..0x60, 1_usize..14).prop_map(|(first, wanted)| (vec![first], wanted)),
        1 => (0_usize..3).prop_map(|wanted| (vec![], wanted)),
    ];
    let pause_us = prop_oneof![0_u64..200, 200_u64..5000, Just(40_000)];
    let address = prop_oneof![9 => Just(ADDRESS), 1 => Just(0x6B)];
    (pause_us, address, sent).prop_map(|(pause_us, address, (sent, wanted))| Step {
        pause_us,
        address,
        sent,
        wanted,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn an_inertial_sensor_answers_byte_by_byte_as_by_transfer(
        is_booted in any::<bool>(),
        mut steps in vec(step(), 1..40),
    ) {
        steps[0].pause_us += if is_booted { 15_000 } else { 0 };
        let expected = by_transfer(&steps);
        for looks in [false, true] {
            for (found, expected) in by_byte(&steps, looks).iter().zip(&expected) {
                prop_assert_eq!(found, expected);
            }
        }
    }
}

/// What is recorded of a controller that does this after the chip's boot.
fn broken(act: impl FnOnce(&mut I2cWires, &mut Imu)) -> Vec<I2cRule> {
    let (mut wires, mut imu) = (I2cWires::new(), imu());
    act(&mut wires, &mut imu);
    wires.faults().first.iter().map(|fault| fault.rule).collect()
}

/// When the chip listens, ns.
const BOOTED: u64 = 20_000_000;

#[test]
fn a_byte_or_a_stop_without_a_start_is_a_fault() {
    let rules = broken(|wires, imu| {
        assert!(!wires.write(imu, 0x0F, BOOTED));
        assert_eq!(wires.read(imu, false, BOOTED), 0xFF);
        wires.stop(imu, BOOTED);
    });
    assert_eq!(rules, [I2cRule::NotStarted; 3]);
}

#[test]
fn a_byte_against_the_direction_of_the_address_is_a_fault() {
    let rules = broken(|wires, imu| {
        assert!(wires.start(imu, ADDRESS, false, HERTZ, BOOTED));
        assert_eq!(wires.read(imu, false, BOOTED + 10 * BIT), 0xFF);
        assert!(wires.write(imu, 0x0F, BOOTED + 20 * BIT));
        assert!(wires.start(imu, ADDRESS, true, HERTZ, BOOTED + 30 * BIT));
        assert!(!wires.write(imu, 0x10, BOOTED + 40 * BIT));
        assert_eq!(wires.read(imu, false, BOOTED + 50 * BIT), 0x6A);
        wires.stop(imu, BOOTED + 60 * BIT);
    });
    assert_eq!(rules, [I2cRule::WrongDirection; 2]);
}

#[test]
fn a_byte_after_one_that_was_not_acknowledged_is_a_fault() {
    let rules = broken(|wires, imu| {
        assert!(!wires.start(imu, 0x6B, false, HERTZ, BOOTED));
        assert!(!wires.write(imu, 0x0F, BOOTED + 10 * BIT));
        wires.stop(imu, BOOTED + 20 * BIT);
    });
    assert_eq!(rules, [I2cRule::AfterNoAcknowledge]);
}

#[test]
fn a_stop_after_a_byte_that_was_acknowledged_finds_the_line_driven() {
    let rules = broken(|wires, imu| {
        assert!(wires.start(imu, ADDRESS, false, HERTZ, BOOTED));
        assert!(wires.write(imu, 0x0F, BOOTED + 10 * BIT));
        assert!(wires.start(imu, ADDRESS, true, HERTZ, BOOTED + 20 * BIT));
        wires.read(imu, true, BOOTED + 30 * BIT);
        wires.stop(imu, BOOTED + 40 * BIT);
    });
    assert_eq!(rules, [I2cRule::StillDriven]);
}

/// Wires whose clock has stopped at a bit of the identity, 0x6A, which the chip sends.
fn stopped(bit: u32) -> (I2cWires, Imu) {
    let (mut wires, mut imu) = (I2cWires::new(), imu());
    assert!(wires.start(&mut imu, ADDRESS, false, HERTZ, BOOTED));
    assert!(wires.write(&mut imu, 0x0F, BOOTED + 10 * BIT));
    assert!(wires.start(&mut imu, ADDRESS, true, HERTZ, BOOTED + 19 * BIT));
    wires.stop_clock(&mut imu, bit, BOOTED + 29 * BIT);
    (wires, imu)
}

#[test]
fn a_chip_whose_clock_stops_amid_a_byte_holds_the_line_at_its_bit_until_the_clock_goes_on() {
    for bit in 0..=8 {
        let (mut wires, _) = stopped(bit);
        // The acknowledge is the controller's.
        let mut expected = [0, 1, 1, 0, 1, 0, 1, 0, 1, 1][bit as usize..].to_vec();
        expected.resize(10, 1);
        let found = expected.iter().map(|_| {
            let is_high = !wires.is_data_low();
            wires.clock_falls();
            i32::from(is_high)
        });
        assert_eq!(found.collect::<Vec<_>>(), expected, "bit {bit}");
    }
}

#[test]
fn a_chip_that_holds_the_line_sees_no_condition_and_one_that_does_not_sees_each() {
    let later = BOOTED + 1_000_000;
    let (mut wires, mut imu) = stopped(0);
    wires.stop(&mut imu, later);
    assert!(!wires.start(&mut imu, ADDRESS, false, HERTZ, later));
    let rules = wires.faults().first.iter().map(|fault| fault.rule);
    assert_eq!(rules.collect::<Vec<_>>(), [I2cRule::StillDriven]);
    for stops in [false, true] {
        let (mut wires, mut imu) = stopped(0);
        wires.clock_falls();
        if stops {
            wires.stop(&mut imu, later);
        }
        let step = Step { pause_us: 0, address: ADDRESS, sent: vec![0x0F], wanted: 1 };
        let (is_acknowledged, reply) = over_wires(&mut wires, &mut imu, &step, later, false);
        assert_eq!((is_acknowledged, reply), (true, vec![0x6A]));
        assert_eq!(wires.faults().count, 0);
        assert_eq!(I2cChip::<Bench>::violations(&imu.chip).count, 0);
    }
}

/// The code is interrupted for 200 ms before it writes the value: the outputs count from the value's time.
#[test]
fn a_pause_within_a_transfer_delays_what_it_writes() {
    let (mut wires, mut imu) = (I2cWires::new(), imu());
    assert!(wires.start(&mut imu, ADDRESS, false, HERTZ, BOOTED));
    assert!(wires.write(&mut imu, 0x10, BOOTED + 10 * BIT));
    let resumed = BOOTED + 200_000_000;
    assert!(wires.write(&mut imu, 0x50, resumed));
    wires.stop(&mut imu, resumed + 9 * BIT);
    let first = I2cChip::<Bench>::next_event(&imu.chip).expect("it measures");
    assert!(first.as_micros() * 1000 > resumed, "{first:?}");
    assert_eq!(I2cChip::<Bench>::violations(&imu.chip).count, 0);
}

#[test]
fn a_chip_that_boots_does_not_acknowledge_the_register_and_says_so() {
    let (mut wires, mut imu) = (I2cWires::new(), imu());
    assert!(wires.start(&mut imu, ADDRESS, false, HERTZ, 0));
    assert!(!wires.write(&mut imu, 0x0F, 10 * BIT));
    wires.stop(&mut imu, 19 * BIT);
    let violations = I2cChip::<Bench>::violations(&imu.chip);
    assert_eq!(violations.first.iter().map(|v| v.misuse).collect::<Vec<_>>(), [Misuse::TooEarly]);
}
