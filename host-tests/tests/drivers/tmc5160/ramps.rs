//! The simulated ramp generator against the closed form of a six-point ramp.

use embassy_time::{Duration, Instant};
use hal_mock::chip::SpiChip;
use proptest::prelude::*;

use super::plant::{Bus, Motor};

/// f/2²⁴ and f²/2⁴¹ at 12 MHz (data sheet, 12.1).
const VELOCITY: f64 = 12e6 / 16_777_216.0;
const ACCELERATION: f64 = 12e6 * 12e6 / 2_199_023_255_552.0;

#[derive(Clone, Copy, Debug)]
struct Ramp {
    first: u32,
    knee: u32,
    acceleration: u32,
    peak: u32,
    deceleration: u32,
    last: u32,
    stop: u32,
}

impl Ramp {
    fn write(self, bus: &mut Bus) {
        let Self { first, knee, acceleration, peak, deceleration, last, stop } = self;
        let values = [first, knee, acceleration, peak, deceleration];
        for (address, value) in (0x24..=0x28).zip(values) {
            bus.write(address, value);
        }
        bus.write(0x2A, last);
        bus.write(0x2B, stop);
    }

    /// Time and way between rest and a speed, with the slope below and above the knee.
    fn leg(self, speed: f64, from: f64, below: u32, above: u32) -> (f64, f64) {
        let knee = (f64::from(self.knee) * VELOCITY).clamp(from, speed.max(from));
        let [below, above] = [below, above].map(|slope| f64::from(slope) * ACCELERATION);
        let time = (knee - from) / below + (speed - knee) / above;
        let way = (knee * knee - from * from) / (2.0 * below)
            + (speed * speed - knee * knee) / (2.0 * above);
        (time, way)
    }

    /// Time for a way, s: the highest speed up to the peak whose two legs fit, by bisection.
    fn time(self, way: f64) -> f64 {
        let stop = f64::from(self.stop) * VELOCITY;
        let legs = |speed: f64| {
            let up = self.leg(speed, 0.0, self.first, self.acceleration);
            let down = self.leg(speed.max(stop), stop, self.last, self.deceleration);
            (up.0 + down.0, up.1 + down.1)
        };
        let (mut low, mut high) = (0.0, f64::from(self.peak) * VELOCITY);
        if legs(high).1 > way {
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if legs(middle).1 > way { high = middle } else { low = middle }
            }
        }
        let (time, used) = legs(high);
        time + (way - used).max(0.0) / high
    }
}

prop_compose! {
    fn ramps()(
        first in 50_u32..40_000, acceleration in 50_u32..40_000,
        deceleration in 50_u32..40_000, last in 50_u32..40_000,
        peak in 5_000_u32..2_000_000, knee in 1_000_u32..500_000, stop in 10_u32..2_000,
    ) -> Ramp {
        Ramp { first, knee, acceleration, peak, deceleration, last, stop }
    }
}

proptest! {
    #[test]
    fn a_ramp_ends_exactly_at_its_target_and_in_its_time(
        ramp in ramps(), target in prop::num::i32::ANY.prop_map(|target| target / 512),
    ) {
        prop_assume!(target.unsigned_abs() > 1000);
        let mut bus = Bus::new();
        ramp.write(&mut bus);
        let start = bus.now;
        bus.write(0x2D, target.cast_unsigned());
        let seconds = bus.come_to_rest(start);
        prop_assert_eq!((bus.read(0x21).cast_signed(), bus.read(0x22)), (target, 0));
        prop_assert_eq!(bus.read(0x35) & 0x1780, 0x0680 | bus.read(0x35) & 0x100);
        let motor = &bus.single.environment;
        prop_assert!(motor.fastest <= f64::from(ramp.peak) * VELOCITY + 1e-6);
        prop_assert!(motor.highest <= f64::from(target.max(0)), "it overshot");
        prop_assert!(motor.lowest >= f64::from(target.min(0)), "it overshot");
        let expected = ramp.time(f64::from(target.unsigned_abs()));
        // One step of a millisecond, and up to one microstep at VSTOP.
        let slack = 0.0011 + 1.0 / (f64::from(ramp.stop) * VELOCITY);
        prop_assert!((seconds - expected).abs() < slack, "{} s instead of {} s", seconds, expected);
        prop_assert!(bus.misuses().is_empty());
    }

    #[test]
    fn a_target_changed_on_the_fly_is_reached_exactly(
        ramp in ramps(), targets in prop::collection::vec(-3_000_000_i32..3_000_000, 2..5),
        pause_ms in 1_u64..3000,
    ) {
        let mut bus = Bus::new();
        ramp.write(&mut bus);
        for target in &targets {
            bus.write(0x2D, target.cast_unsigned());
            bus.pass(Duration::from_millis(pause_ms));
        }
        let since = bus.now;
        bus.come_to_rest(since);
        prop_assert_eq!(bus.read(0x21).cast_signed(), targets[targets.len() - 1]);
        prop_assert_eq!(bus.read(0x22), 0);
        prop_assert!(bus.single.environment.fastest <= f64::from(ramp.peak) * VELOCITY + 1e-6);
    }
}

const RAMP: Ramp = Ramp {
    first: 9774,
    knee: 178_957,
    acceleration: 6414,
    peak: 358_869,
    deceleration: 6414,
    last: 9774,
    stop: 1000,
};

#[test]
fn a_target_that_comes_too_late_is_passed_and_returned_to() {
    let mut bus = Bus::new();
    RAMP.write(&mut bus);
    bus.write(0x2D, 1_000_000);
    bus.pass(Duration::from_millis(1000));
    let here = bus.read(0x21);
    bus.write(0x2D, here + 100);
    let since = bus.now;
    bus.come_to_rest(since);
    assert_eq!(bus.read(0x21), here + 100);
    assert!(bus.single.environment.highest > f64::from(here) + 50_000.0);
    assert_ne!(bus.read(0x35) & 1 << 12, 0, "second_move");
}

#[test]
fn a_standing_motor_has_no_events() {
    let mut bus = Bus::new();
    RAMP.write(&mut bus);
    assert_eq!(SpiChip::<Motor>::next_event(&bus.single.chip), None);
    bus.write(0x2D, 5000);
    assert_eq!(
        SpiChip::<Motor>::next_event(&bus.single.chip),
        Some(bus.now + Duration::from_micros(1000 - 20))
    );
    let since = bus.now;
    bus.come_to_rest(since);
    assert_eq!(SpiChip::<Motor>::next_event(&bus.single.chip), None);
}

#[test]
fn the_position_wraps_around() {
    let mut bus = Bus::new();
    RAMP.write(&mut bus);
    bus.write(0x20, 3);
    bus.write(0x21, 0x7FFF_FF00);
    bus.write(0x2D, 0x8000_0100);
    bus.write(0x20, 0);
    let since = bus.now;
    bus.come_to_rest(since);
    assert_eq!(bus.read(0x21), 0x8000_0100);
    assert_eq!(bus.single.chip.field(), 512, "it went the short way");
}

#[test]
fn hold_mode_keeps_the_velocity() {
    let mut bus = Bus::new();
    RAMP.write(&mut bus);
    bus.write(0x20, 1);
    bus.pass(Duration::from_millis(200));
    bus.write(0x20, 3);
    let before = bus.read(0x22);
    bus.pass(Duration::from_secs(1));
    assert_eq!(bus.read(0x22), before);
    assert!(before > 10_000);
}

#[test]
fn a_reversal_waits_out_its_rest() {
    let mut bus = Bus::new();
    RAMP.write(&mut bus);
    // 2344·512 clocks are 100.01 ms.
    bus.write(0x2C, 2344);
    bus.write(0x20, 1);
    bus.pass(Duration::from_millis(100));
    bus.write(0x20, 2);
    let start = bus.now;
    let mut resting = 0;
    while bus.now < start + Duration::from_millis(400) {
        resting += u32::from(bus.read(0x35) & 1 << 11 != 0);
        bus.pass(Duration::from_micros(960));
    }
    assert!((99..=101).contains(&resting), "{resting} ms");
    assert!(bus.read(0x22).cast_signed() << 8 < 0);
}

#[test]
fn a_faster_oscillator_makes_the_ramp_faster_but_not_longer() {
    let mut bus = Bus::new();
    bus.single.chip = hal_mock::tmc5160::Tmc5160::new(
        hal_mock::tmc5160::Oscillator::Internal { hertz: 12_500_000 },
        Instant::from_micros(0),
    );
    RAMP.write(&mut bus);
    let start = bus.now;
    bus.write(0x2D, 192_000);
    let seconds = bus.come_to_rest(start);
    assert!((seconds - RAMP.time(192_000.0) * 12.0 / 12.5).abs() < 0.003, "{seconds}");
    assert_eq!(bus.read(0x21), 192_000);
}
