//! The simulated chip against transcripts from elsewhere: the data sheet's own examples and what
//! public drivers send.

use embassy_time::Duration;
use hal_mock::violation::Misuse;

use super::plant::Bus;

/// Data sheet, section 4.1.1, table of the example. Its 0x00ABCDEF does not fit VMAX, which has 23
/// bits (6.3.1): the reply mirrors it all the same.
#[test]
fn the_reply_is_that_of_the_access_before() {
    let mut bus = Bus::new();
    bus.write(0x20, 3);
    bus.write(0x21, 0x1234_5678);
    bus.datagram(0x21_0000_0000);
    assert_eq!(bus.datagram(0x21_0000_0000).1, 0x1234_5678);
    assert_eq!(bus.datagram(0xA7_00AB_CDEF).1, 0x1234_5678);
    assert_eq!(bus.datagram(0xA7_0012_3456).1, 0x00AB_CDEF);
    assert_eq!(bus.datagram(0x21_0000_0000).1, 0x0012_3456);
    assert_eq!(bus.misuses(), [Misuse::ReservedBits]);
}

/// Data sheet, section 23.1: one turn to the left by the ramp generator, every byte as printed. The
/// ramp's length follows by hand from section 12.1: up 50 000²/1000/2⁸ + (200 000² − 50 000²)/500/2⁸,
/// which is more than half of the way, so that the peak is never reached.
#[test]
fn the_data_sheets_example_moves_one_turn_to_the_left() {
    let mut bus = Bus::new();
    for datagram in [
        0xEC_0001_00C3,
        0x90_0006_1F0A,
        0x91_0000_000A,
        0xA4_0000_03E8,
        0xA5_0000_C350,
        0xA6_0000_01F4,
        0xA7_0003_0D40,
        0xA8_0000_02BC,
        0xAA_0000_0578,
        0xAB_0000_000A,
        0xA0_0000_0000,
    ] {
        bus.datagram(datagram);
    }
    let start = bus.now;
    bus.datagram(0xAD_FFFF_3800);
    bus.pass(Duration::from_millis(300));
    bus.datagram(0x21_0000_0000);
    let (status, position) = bus.datagram(0x21_0000_0000);
    assert!((-51_199..0).contains(&position.cast_signed()), "{}", position.cast_signed());
    assert_eq!(status, 0x01, "reset is not yet acknowledged, nothing reached, not standing");
    bus.come_to_rest(start);
    assert_eq!((bus.read(0x21).cast_signed(), bus.read(0x22)), (-51_200, 0));
    assert!(bus.single.environment.fastest < 200_000.0 * 0.715);
    assert_eq!(bus.misuses(), []);
}

/// Data sheet, chapter 6, and TMC-API (tmc/ic/TMC5160/TMC5160.h, sample presets), which agree on these;
/// they disagree on CHOPCONF (0x10410150 and 0x00410153) and `IHOLD_IRUN` (0 and 0x00070A03), where the
/// data sheet is followed.
#[test]
fn registers_wake_with_their_reset_values() {
    let mut bus = Bus::new();
    assert_eq!(bus.read(0x00), 0x0000_0008, "GCONF");
    assert_eq!(bus.read(0x01), 0x0000_0001, "GSTAT");
    assert_eq!(bus.read(0x04) >> 24, 0x30, "VERSION");
    assert_eq!(bus.read(0x6C), 0x1041_0150, "CHOPCONF");
    assert_eq!(bus.read(0x12), 0x000F_FFFF, "TSTEP at rest");
    // 16.2: event_pos_reached is active upon reset.
    assert_eq!(bus.read(0x35), 0x0000_0780, "RAMP_STAT");
    for (address, preset) in [
        (0x09, 0x0001_0606),
        (0x0A, 0x0008_0400),
        (0x11, 0x0000_000A),
        (0x2B, 0x0000_0001),
        (0x3A, 0x0001_0000),
        (0x60, 0xAAAA_B554),
        (0x69, 0x00F7_0000),
        (0x70, 0xC40C_001E),
    ] {
        assert_eq!(bus.single.chip.register(address), preset, "{address:#04x}");
    }
    assert_eq!(bus.misuses(), []);
}

/// Klipper's defaults for this chip (`klippy/extras/tmc5160.py`: toff 3, hstrt 5, hend 2, tbl 2, tpfd 4;
/// IHOLDDELAY 6; TPOWERDOWN 10; `pwm_freq` 1, `PWM_REG` 4, `PWM_LIM` 12), packed by hand into registers.
#[test]
fn a_printers_driver_is_accepted() {
    let mut bus = Bus::new();
    assert_eq!(bus.datagram(0x80_0000_0000).0 & 1, 1, "it has been reset");
    bus.datagram(0xEC_0041_0153);
    bus.datagram(0xED_0000_0000);
    bus.datagram(0x90_0006_1013);
    bus.datagram(0xF0_C40D_001E);
    bus.datagram(0x91_0000_000A);
    assert_eq!(bus.read(0x6C), 0x0041_0153);
    bus.datagram(0x81_0000_0001);
    assert_eq!(bus.read(0x01), 0);
    assert_eq!(bus.datagram(0x01_0000_0000).0, 0x38, "standing, position and velocity reached");
    assert_eq!(bus.misuses(), []);
}

/// TMC-API's `tmc5160_rotateMotor`: VMAX, then RAMPMODE 1 or 2; here with the data sheet's AMAX and
/// VMAX of the last example in section 23.1 (5000 and 20 000). 20 000 units are 14 305 microsteps/s.
#[test]
fn a_rotating_motor_reaches_its_velocity() {
    let mut bus = Bus::new();
    for datagram in [0xEC_0001_00C5, 0xA6_0000_1388, 0xA7_0000_4E20, 0xA0_0000_0002] {
        bus.datagram(datagram);
    }
    bus.pass(Duration::from_millis(100));
    assert_eq!(bus.read(0x22), 0x0100_0000 - 20_000, "VACTUAL, 24 bits, signed");
    assert_eq!(bus.read(0x12), (1 << 24) / 20_000, "TSTEP");
    assert!((bus.single.environment.microsteps_per_s + 14_305.115).abs() < 0.001);
    assert_eq!(bus.misuses(), []);
}

#[test]
fn every_misuse_is_recorded() {
    let fast = |bus: &mut Bus| bus.send(4_000_001, &[0; 5]);
    let short = |bus: &mut Bus| bus.send(2_000_000, &[0; 4]);
    let mut bus = Bus::new();
    fast(&mut bus);
    short(&mut bus);
    bus.read(0x10);
    bus.write(0x12, 0);
    bus.write(0x6C, 1 << 17);
    bus.write(0x2E, 0);
    bus.write(0x0B, 31);
    bus.write(0x34, 0xC00);
    bus.write(0x27, 1 << 22);
    bus.write(0x2D, 100);
    let expected = [
        Misuse::ClockTooFast,
        Misuse::Length,
        Misuse::WriteOnly,
        Misuse::WriteOnly,
        Misuse::ReadOnly,
        Misuse::ReservedBits,
        Misuse::UnknownRegister,
        Misuse::ForbiddenValue,
        Misuse::ForbiddenValue,
        Misuse::ForbiddenValue,
    ];
    assert_eq!(bus.misuses(), expected);
}

#[test]
fn an_access_before_the_end_of_reset_is_recorded() {
    let mut bus = Bus::new();
    bus.now = embassy_time::Instant::from_micros(5);
    assert_eq!(bus.datagram(0x04_0000_0000), (0, 0));
    assert_eq!(bus.misuses(), [Misuse::TooEarly]);
}
