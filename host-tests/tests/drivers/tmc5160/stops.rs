//! The simulated chip's switches, stalls and flags, as sections 6.3.2 and 13.4 of the data sheet say.

use embassy_time::Duration;

use super::plant::Bus;

const STOP_L: u32 = 1;
const STOP_R: u32 = 2;
const POL_R: u32 = 8;
const SWAP: u32 = 1 << 4;
const LATCH_R_ACTIVE: u32 = 1 << 7;
const LATCH_R_INACTIVE: u32 = 1 << 8;
const SG_STOP: u32 = 1 << 10;
const SOFT: u32 = 1 << 11;

/// A chip that runs with 100 000 microsteps/s, either way.
fn running(mode: u32, switch_mode: u32) -> Bus {
    let mut bus = Bus::new();
    for (address, value) in [
        (0x14, 240),
        (0x26, 6414),
        (0x28, 6414),
        (0x2A, 9774),
        (0x2B, 1000),
        (0x34, switch_mode),
        (0x27, 139_810),
        (0x20, mode),
    ] {
        bus.write(address, value);
    }
    bus.pass(Duration::from_millis(500));
    bus.read(0x22);
    bus
}

fn speed(bus: &mut Bus) -> i32 {
    bus.read(0x22).cast_signed() << 8 >> 8
}

#[test]
fn a_hard_stop_is_at_once_and_ends_with_the_switch() {
    let mut bus = running(1, STOP_R | LATCH_R_ACTIVE);
    assert_eq!(speed(&mut bus), 139_810);
    bus.single.environment.right = true;
    bus.pass(Duration::from_millis(1));
    assert_eq!(speed(&mut bus), 0);
    let state = bus.read(0x35);
    assert_eq!(state & 0x2A, 0x2A, "touched, latched, stopped");
    assert_eq!(bus.read(0x36), bus.read(0x21), "XLATCH is XACTUAL");
    bus.single.environment.right = false;
    assert_eq!(speed(&mut bus), 0, "now the chip has seen it");
    bus.pass(Duration::from_millis(100));
    assert!(speed(&mut bus) > 0, "the motor restarts where the switch is released");
    bus.write(0x35, 1 << 3);
    assert_eq!(bus.read(0x35) & 0x2A, 0);
    assert_eq!(bus.misuses(), []);
}

#[test]
fn a_soft_stop_takes_the_deceleration_and_leaves_the_other_way_open() {
    let mut bus = running(1, STOP_R | SOFT);
    bus.single.environment.right = true;
    bus.pass(Duration::from_millis(50));
    let slower = speed(&mut bus);
    assert!((1000..139_000).contains(&slower), "{slower}");
    assert_ne!(bus.read(0x35) & 1 << 5, 0);
    bus.pass(Duration::from_millis(500));
    assert_eq!(speed(&mut bus), 0);
    bus.write(0x20, 3);
    assert_eq!(bus.read(0x35) & 1 << 5, 0, "hold mode ends the event");
    bus.write(0x20, 2);
    bus.pass(Duration::from_millis(50));
    assert!(speed(&mut bus) < 0);
}

#[test]
fn polarity_and_swapping_are_obeyed() {
    let mut bus = Bus::new();
    bus.write(0x34, POL_R);
    assert_eq!(bus.read(0x35) & 3, 2, "an open switch is active");
    bus.single.environment.right = true;
    assert_eq!(bus.read(0x35) & 3, 0);
    bus.write(0x34, SWAP);
    assert_eq!(bus.read(0x35) & 3, 1);
    assert_eq!(bus.read(0x04) & 3, 2, "the pin itself");
    assert_eq!(bus.datagram(0x04_0000_0000).0 & 0xC0, 0x40, "and the status byte");
}

#[test]
fn an_inactive_edge_is_latched_where_it_is_asked_for() {
    let mut bus = running(1, LATCH_R_INACTIVE);
    bus.single.environment.right = true;
    assert_eq!(bus.read(0x35) & 8, 0);
    bus.single.environment.right = false;
    let state = bus.read(0x35);
    assert_eq!(state & 8, 8);
    assert_ne!(bus.read(0x36), 0);
}

#[test]
fn a_left_switch_does_not_stop_a_motion_to_the_right() {
    let mut bus = running(1, STOP_L | STOP_R);
    bus.single.environment.left_at = Some(f64::INFINITY);
    bus.pass(Duration::from_millis(10));
    assert_eq!(speed(&mut bus), 139_810);
    assert_eq!(bus.read(0x35) & 0x31, 1);
}

#[test]
fn a_stall_is_held_until_its_flag_is_written_and_then_the_motor_restarts() {
    let mut bus = running(2, SG_STOP);
    bus.single.environment.blocked = true;
    bus.pass(Duration::from_millis(1));
    assert_eq!(speed(&mut bus), 0);
    assert_eq!(bus.read(0x35) & 0x2040, 0x2040);
    let driver = bus.read(0x6F);
    assert_eq!((driver & 0x3FF, driver >> 24 & 1), (0, 1), "SG_RESULT and StallGuard");
    bus.single.environment.blocked = false;
    bus.write(0x27, 100_000);
    bus.pass(Duration::from_millis(100));
    assert_eq!(speed(&mut bus), 0, "a new velocity does not release it");
    bus.write(0x35, 0x40);
    bus.pass(Duration::from_millis(20));
    assert!(speed(&mut bus) < 0, "13.4: the motor restarts");
    assert_eq!(bus.read(0x35) & 0x2040, 0);
}

#[test]
fn taking_the_stall_stop_back_releases_the_motor() {
    let mut bus = running(1, SG_STOP);
    bus.single.environment.blocked = true;
    bus.pass(Duration::from_millis(1));
    assert_eq!(speed(&mut bus), 0);
    bus.write(0x34, 0);
    bus.pass(Duration::from_millis(20));
    assert!(speed(&mut bus) > 0);
    assert_eq!(bus.read(0x35) & 0x40, 0x40, "the event stays latched");
}

/// TCOOLTHRS 240 is 50 000 microsteps/s, and the hysteresis of 1/16 makes it 53 571 on the way up.
#[test]
fn stalls_are_reported_above_the_threshold_only() {
    let mut bus = running(1, SG_STOP);
    bus.write(0x27, 75_000);
    bus.pass(Duration::from_millis(500));
    bus.single.environment.blocked = true;
    assert_ne!(bus.read(0x35) & 0x40, 0, "53 644 microsteps/s");
    let mut bus = running(1, 0);
    bus.write(0x27, 69_000);
    bus.pass(Duration::from_millis(500));
    bus.write(0x34, SG_STOP);
    bus.single.environment.blocked = true;
    assert_eq!(bus.read(0x35) & 0x2040, 0, "49 353 microsteps/s");
}

#[test]
fn the_coils_follow_the_sine_of_the_data_sheet_and_the_current_falls_after_a_motion() {
    let mut bus = Bus::new();
    // 6.5: round(248·sin(2π·i/1024 + π/1024)) − 1 at i = 0 and i = 256.
    assert_eq!((bus.read(0x6A), bus.read(0x6B)), (0, 247 << 16));
    bus.write(0x10, 0x0006_1F0A);
    for (address, value) in [(0x26, 6414), (0x2A, 9774), (0x28, 6414), (0x27, 100_000)] {
        bus.write(address, value);
    }
    bus.write(0x2D, 256);
    assert_eq!(bus.read(0x6F) >> 16 & 0x1F, 31, "IRUN");
    assert_eq!(bus.read(0x6F) >> 31, 0);
    bus.pass(Duration::from_millis(500));
    assert_eq!((bus.read(0x6A), bus.read(0x6B) & 0x1FF), (256, 247));
    assert_eq!(bus.read(0x6F) >> 31, 1, "standstill");
    bus.pass(Duration::from_millis(500));
    assert_eq!(bus.read(0x6F) >> 16 & 0x1F, 10, "IHOLD");
}
