//! The layout of version 1, byte by byte, which is read for ever: no board that has such a record may lose its settings by a
//! new image. The record of that version had no serial number, no output, and no calibrations.

use firmware::settings::{
    Calibration, FIRST_BYTES, Output, Settings, SettingsError, SpinSchedule, StageSchedule,
    TurntableSchedule, TwoFrameSchedule, VehicleSchedule,
};
use orientation::alignment::setup::SetupError;

use super::{
    CHECKSUM, Calibrated, SERIAL, crc32, read, record, settings, spin, stage, turntable, two_frame,
    vehicle,
};

/// What every carrier has, before its schedule.
#[rustfmt::skip]
const COMMON: [u8; 89] = [
    0x18, 0x2D, 0x44, 0x54, 0xFB, 0x21, 0xE9, 0x3F, // latitude: 45°, π/4
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xC0, // scale factor: −2 V per rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xFC, 0x3F, // limit: 1.75 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xD0, 0x3F, // Q: 0.25 rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0x3F, // N: 0.5 rad/√s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE8, 0x3F, // B: 0.75 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x3F, // K: 1 rad/s/√s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF4, 0x3F, // R: 1.25 rad/s²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF8, 0x3F, // σ of the bias: 1.5 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3F, // σ of the scale factor: 2⁻¹⁰
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xC0, 0x3F, // required σ: 0.125 rad
    0x01,                                           // holds
];

#[rustfmt::skip]
const STAGE: [u8; 29] = [
    24,                                                   // positions
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x10, 0x40,       // dwell: 4 s
    0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x40, // survey: 64 s
    0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x60, 0x40, // allowed: 128 s
    0x01, 0x01,                                           // half: the western one
];

#[rustfmt::skip]
const TWO_FRAME: [u8; 10] = [
    16,                                             // passes
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x20, 0x40, // dwell: 8 s
    0x00,                                           // half: unknown
];

#[rustfmt::skip]
const TURNTABLE: [u8; 20] = [
    2,                                              // speeds
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0x3F, // 0.5 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x3F, // 1 rad/s
    0xAC, 0x02,                                     // turns: 300 = 2 · 128 + 44
    12,                                             // rate-modulated turns
];

#[rustfmt::skip]
const VEHICLE: [u8; 10] = [
    3,                                              // stops
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x40, // a stop: 16 s
    0x01,                                           // realigns
];

#[rustfmt::skip]
const SPIN: [u8; 16] = [
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, // course: 2 rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0xBF, // pitch: −0.5 rad
];

/// A record of this version with the right checksum for what it holds.
fn sealed(mut record: [u8; FIRST_BYTES]) -> [u8; FIRST_BYTES] {
    let checksum = crc32(&record[..FIRST_BYTES - CHECKSUM]);
    record[FIRST_BYTES - CHECKSUM..].copy_from_slice(&checksum.to_le_bytes());
    record
}

/// The record of version 1 for the carrier with this index, with this schedule.
fn by_hand(carrier: u8, schedule: &[u8]) -> [u8; FIRST_BYTES] {
    let written = [&[1, carrier][..], &COMMON, schedule].concat();
    let mut bytes = [0; FIRST_BYTES];
    bytes[..written.len()].copy_from_slice(&written);
    sealed(bytes)
}

/// The record of a vehicle.
pub fn of_a_vehicle() -> [u8; FIRST_BYTES] {
    by_hand(3, &VEHICLE)
}

/// The record of a vehicle with stops of so many seconds.
pub fn stopping(seconds: f64) -> [u8; FIRST_BYTES] {
    let mut schedule = VEHICLE;
    schedule[1..9].copy_from_slice(&seconds.to_le_bytes());
    by_hand(3, &schedule)
}

/// The vehicle of the record: its images aligned at every start.
pub fn aligning() -> VehicleSchedule {
    VehicleSchedule { aligns_known: true, ..vehicle() }
}

/// What a record of version 1 states, and for the rest what its images did.
pub fn migrated<C: Calibrated>(schedule: C) -> Settings<C> {
    Settings {
        output: Output::default(),
        starts: true,
        calibration: C::Calibration::default(),
        ..settings(schedule)
    }
}

#[test]
fn the_bytes_that_were_written_down_are_read() {
    assert_eq!(read::<StageSchedule>(&by_hand(0, &STAGE)), Ok(migrated(stage())));
    assert_eq!(read::<TwoFrameSchedule>(&by_hand(1, &TWO_FRAME)), Ok(migrated(two_frame())));
    assert_eq!(read::<TurntableSchedule>(&by_hand(2, &TURNTABLE)), Ok(migrated(turntable())));
    assert_eq!(read::<VehicleSchedule>(&of_a_vehicle()), Ok(migrated(aligning())));
    assert_eq!(read::<SpinSchedule>(&by_hand(4, &SPIN)), Ok(migrated(spin())));
}

#[test]
fn what_they_do_not_state_is_what_images_of_that_version_had() {
    let found = read::<StageSchedule>(&by_hand(0, &STAGE)).expect("it is sound");
    assert_eq!((found.output, found.starts), (Output::default(), true));
    let felt = found.calibration.felt().expect("a stage has an accelerometer");
    // 8.3 mg, and 0.1 °/h/g in rad/s.
    assert!((felt.force_bias_sigma.0 - 0.0083 * 9.80665).abs() < 1e-9, "{felt:?}");
    assert!((felt.g_sensitivity_sigma.0 - 0.1 * 4.848_136_8e-6).abs() < 1e-13, "{felt:?}");
    let found = read::<VehicleSchedule>(&of_a_vehicle()).expect("it is sound");
    assert!(found.schedule.aligns_known, "it aligned at every start");
    let felt = found.calibration.felt().expect("a vehicle has an accelerometer");
    assert!((felt.force_bias_sigma.0 - 1e-4 * 9.80665).abs() < 1e-9, "{felt:?}");
}

/// The checksum of the record of a vehicle, as `crc32` of Python's zlib has it.
#[test]
fn the_checksum_is_that_of_zlib() {
    let [.., a, b, c, d] = of_a_vehicle();
    assert_eq!(u32::from_le_bytes([a, b, c, d]), 0xAC6D_6617);
}

#[test]
fn what_was_read_is_written_as_a_record_of_the_version_of_today() {
    let found = read::<VehicleSchedule>(&of_a_vehicle()).expect("it is sound");
    assert_eq!(read(&record(&found)), Ok(found));
}

#[test]
fn every_flipped_bit_is_refused() {
    let sound = by_hand(0, &STAGE);
    for bit in 0..8 * FIRST_BYTES {
        let mut flipped = sound;
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(read::<StageSchedule>(&flipped), Err(SettingsError::Damaged), "bit {bit}");
    }
}

#[test]
fn a_record_of_this_length_is_refused_where_it_states_another_version() {
    for version in (0..=u8::MAX).filter(|version| *version != 1) {
        let mut other = by_hand(4, &SPIN);
        other[0] = version;
        // One of version 2 has another length.
        let reason = match version {
            2 => SettingsError::Layout,
            _ => SettingsError::UnknownVersion(version),
        };
        assert_eq!(read::<SpinSchedule>(&sealed(other)), Err(reason));
    }
}

#[test]
fn the_record_of_another_carrier_is_refused() {
    let refused = read::<VehicleSchedule>(&by_hand(0, &STAGE));
    assert!(matches!(refused, Err(SettingsError::OtherCarrier { .. })), "{refused:?}");
    assert_eq!(read::<StageSchedule>(&by_hand(5, &STAGE)), Err(SettingsError::Layout));
}

#[test]
fn bytes_behind_the_content_or_no_such_choice_are_refused_though_the_checksum_is_right() {
    let with = |sound: [u8; FIRST_BYTES], at: usize, byte: u8| {
        let mut changed = sound;
        changed[at] = byte;
        sealed(changed)
    };
    let stage = |at, byte| read::<StageSchedule>(&with(by_hand(0, &STAGE), at, byte));
    let (holds, half, behind) = (2 + 88, 2 + 89 + 28, 2 + 89 + 29);
    assert!(stage(behind, 0).is_ok());
    for (at, byte) in [(holds, 2), (half, 2), (behind, 1), (FIRST_BYTES - CHECKSUM - 1, 1)] {
        assert_eq!(stage(at, byte), Err(SettingsError::Layout), "byte {at}");
    }
    // Where the schedule of a vehicle has another choice today.
    let behind = 2 + 89 + VEHICLE.len();
    let refused = read::<VehicleSchedule>(&with(of_a_vehicle(), behind, 1));
    assert_eq!(refused, Err(SettingsError::Layout));
}

#[test]
fn a_latitude_that_is_no_number_is_refused_by_name() {
    let mut bytes = by_hand(4, &SPIN);
    bytes[2..10].copy_from_slice(&f64::NAN.to_le_bytes());
    let refused = read::<SpinSchedule>(&sealed(bytes)).expect_err("it is no number");
    let SettingsError::OutOfRange(SetupError::OutOfRange(quantity)) = refused else {
        panic!("refused for another reason: {refused}");
    };
    assert_eq!(quantity.name, "latitude");
}

#[test]
fn it_does_not_say_what_the_link_is_to_send() {
    assert_eq!(Output::from_record(&of_a_vehicle()), None);
    assert!(Settings::<VehicleSchedule>::from_record(&of_a_vehicle(), &SERIAL).is_ok());
}
