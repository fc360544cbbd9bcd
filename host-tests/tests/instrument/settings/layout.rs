//! The layout of version 1, byte by byte. An `f64` is its eight bytes, little-endian; an integer of more than a byte
//! goes by seven bits, the least first, with the high bit where more follow; an option is 0, or 1 before its value; a
//! choice is its index; a list is its length before its values; a structure is its fields.

use firmware::settings::{
    BYTES, CarrierSchedule, Settings, SettingsError, SpinSchedule, StageSchedule,
    TurntableSchedule, TwoFrameSchedule, VehicleSchedule,
};
use orientation::alignment::setup::SetupError;

use super::{CHECKSUM, read, record, sealed, settings, spin, stage, turntable, two_frame, vehicle};

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

/// The record of version 1 for the carrier with this index, with this schedule.
fn by_hand(carrier: u8, schedule: &[u8]) -> [u8; BYTES] {
    let written = [&[1, carrier][..], &COMMON, schedule].concat();
    let mut bytes = [0; BYTES];
    bytes[..written.len()].copy_from_slice(&written);
    sealed(bytes)
}

/// A record of settings that are not checked, without a version, a carrier and a checksum.
pub fn content<C: CarrierSchedule>(settings: &Settings<C>) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    postcard::to_slice(settings, &mut bytes[2..BYTES - CHECKSUM]).expect("it fits");
    bytes
}

#[test]
fn records_of_version_1_have_the_bytes_that_were_written_down() {
    assert_eq!(record(&settings(stage())), by_hand(0, &STAGE));
    assert_eq!(record(&settings(two_frame())), by_hand(1, &TWO_FRAME));
    assert_eq!(record(&settings(turntable())), by_hand(2, &TURNTABLE));
    assert_eq!(record(&settings(vehicle())), by_hand(3, &VEHICLE));
    assert_eq!(record(&settings(spin())), by_hand(4, &SPIN));
}

#[test]
fn the_bytes_that_were_written_down_are_read() {
    assert_eq!(read::<StageSchedule>(&by_hand(0, &STAGE)), Ok(settings(stage())));
    assert_eq!(read::<TwoFrameSchedule>(&by_hand(1, &TWO_FRAME)), Ok(settings(two_frame())));
    assert_eq!(read::<TurntableSchedule>(&by_hand(2, &TURNTABLE)), Ok(settings(turntable())));
    assert_eq!(read::<VehicleSchedule>(&by_hand(3, &VEHICLE)), Ok(settings(vehicle())));
    assert_eq!(read::<SpinSchedule>(&by_hand(4, &SPIN)), Ok(settings(spin())));
}

/// The checksum of the record of a vehicle, as `crc32` of Python's zlib has it.
#[test]
fn the_checksum_is_that_of_zlib() {
    let [.., a, b, c, d] = by_hand(3, &VEHICLE);
    assert_eq!(u32::from_le_bytes([a, b, c, d]), 0xAC6D_6617);
}

/// The longest content is that of a stage: all later versions must fit the same size.
#[test]
fn a_record_of_version_1_leaves_room_for_more_fields() {
    let longest = [&STAGE[..], &TWO_FRAME, &TURNTABLE, &VEHICLE, &SPIN].map(<[u8]>::len);
    let longest = longest.into_iter().max().expect("there are five");
    assert_eq!((BYTES, 2 + COMMON.len() + longest + CHECKSUM), (192, 124));
}

#[test]
fn bytes_behind_the_content_or_no_such_choice_are_refused_though_the_checksum_is_right() {
    let sound = by_hand(0, &STAGE);
    let with = |at: usize, byte: u8| {
        let mut changed = sound;
        changed[at] = byte;
        read::<StageSchedule>(&sealed(changed))
    };
    let (holds, half, behind) = (2 + 88, 2 + 89 + 28, 2 + 89 + 29);
    assert_eq!(with(behind, 0), Ok(settings(stage())));
    for (at, byte) in [(holds, 2), (half, 2), (behind, 1), (BYTES - CHECKSUM - 1, 1)] {
        assert_eq!(with(at, byte), Err(SettingsError::Layout), "byte {at}");
    }
}

#[test]
fn three_speeds_or_a_number_of_turns_without_end_are_refused() {
    let third = [&[3][..], &TURNTABLE[1..17], &TURNTABLE[9..17], &[2, 0]].concat();
    assert_eq!(read::<TurntableSchedule>(&by_hand(2, &third)), Err(SettingsError::Layout));
    let endless = [&TURNTABLE[..17], &[0xFF; 6]].concat();
    assert_eq!(read::<TurntableSchedule>(&by_hand(2, &endless)), Err(SettingsError::Layout));
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
