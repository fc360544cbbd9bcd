//! The layout of version 2, byte by byte. An `f64` is its eight bytes and an `f32` its four, little-endian; an integer of
//! more than a byte goes by seven bits, the least first, with the high bit where more follow; an option is 0, or 1 before
//! its value; a choice is its index; a list is its length before its values; a structure or an array is its fields.

use firmware::settings::{
    Analogue, BYTES, CarrierSchedule, Output, Settings, SettingsError, SpinSchedule, StageSchedule,
    TurntableSchedule, TwoFrameSchedule, VehicleSchedule,
};
use orientation::alignment::setup::SetupError;
use orientation::units::{RadiansPerSecond, Seconds, TURN};

use super::{
    CHECKSUM, SERIAL, output, read, record, sealed, settings, spin, stage, turntable, two_frame,
    vehicle,
};

/// Bytes before the settings: version, carrier and serial number.
const HEADER: usize = 14;

/// What every carrier has, before its schedule.
#[rustfmt::skip]
const COMMON: [u8; 106] = [
    1,                                                    // output: MAVLink
    0x80, 0xA0, 0x38,                                     // 921 600 baud = 56 · 128² + 32 · 128
    254,                                                  // system
    0, 1, 2, 5, 10, 0, 1, 2, 10, 5,                       // rates
    0x01, 0x18, 0x2D, 0x44, 0x54, 0xFB, 0x21, 0xE9, 0x3F, // latitude: 45°, π/4
    0x00,                                                 // waits for an order
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xC0,       // scale factor: −2 V per rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xFC, 0x3F,       // limit: 1.75 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xD0, 0x3F,       // Q: 0.25 rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0x3F,       // N: 0.5 rad/√s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE8, 0x3F,       // B: 0.75 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x3F,       // K: 1 rad/s/√s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF4, 0x3F,       // R: 1.25 rad/s²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF8, 0x3F,       // σ of the bias: 1.5 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3F,       // σ of the scale factor: 2⁻¹⁰
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xC0, 0x3F,       // required σ: 0.125 rad
    0x01,                                                 // holds
];

/// What gravity does to the sensors.
#[rustfmt::skip]
const FELT: [u8; 32] = [
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3F, // g-sensitivity along: 2⁻¹⁰ rad/s/g
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, 0xBF, // across: −2⁻¹¹
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x3F, // σ: 2⁻¹²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xB0, 0x3F, // σ of the accelerometer's biases: 2⁻⁴ m/s²
];

/// An encoder: its error's amplitudes, and their σ.
#[rustfmt::skip]
const ENCODER: [u8; 24] = [
    0x00, 0x00, 0x80, 0x3C,                         // sine: 2⁻⁶ rad
    0x00, 0x00, 0x00, 0xBC,                         // cosine: −2⁻⁷
    0x00, 0x00, 0x80, 0x3B,                         // sine, twice per turn: 2⁻⁸
    0x00, 0x00, 0x00, 0xBB,                         // cosine: −2⁻⁹
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x90, 0x3F, // σ: 2⁻⁶ rad
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

/// Inner encoder and mount.
#[rustfmt::skip]
const FRAMES: [u8; 48] = [
    0x00, 0x00, 0x80, 0x3A,                         // sine: 2⁻¹⁰ rad
    0x00, 0x00, 0x00, 0x3A,                         // cosine: 2⁻¹¹
    0x00, 0x00, 0x80, 0x39,                         // sine, twice per turn: 2⁻¹²
    0x00, 0x00, 0x00, 0x39,                         // cosine: 2⁻¹³
    0x00, 0x00, 0x80, 0x3C,                         // azimuth: 2⁻⁶ rad
    0x00, 0x00, 0x80, 0xBC,                         // pitch: −2⁻⁶
    0x00, 0x00, 0x00, 0x3C,                         // frames: 2⁻⁷
    0x00, 0x00, 0x00, 0xBC,                         // gyro: −2⁻⁷
    0x00, 0x00, 0x80, 0x3B,                         // zero of the outer frame: 2⁻⁸
    0x00, 0x00, 0x80, 0xBB,                         // of the inner one: −2⁻⁸
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3F, // σ of the non-orthogonalities: 2⁻¹⁰ rad
];

#[rustfmt::skip]
const TURNTABLE: [u8; 20] = [
    2,                                              // speeds
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0x3F, // 0.5 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF0, 0x3F, // 1 rad/s
    0xAC, 0x02,                                     // turns: 300 = 2 · 128 + 44
    12,                                             // rate-modulated turns
];

/// What a turntable has beside gyro, accelerometer and encoder.
#[rustfmt::skip]
const INDEX: [u8; 25] = [
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x80, 0x3F, // σ of the encoder's zero: 2⁻⁷ rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0x3F, // index clockwise: 0.5 rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE8, 0x3F, // counter-clockwise: 0.75 rad
    0x01,                                           // a molecular-electronic sensor
];

#[rustfmt::skip]
const VEHICLE: [u8; 11] = [
    3,                                              // stops
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x40, // a stop: 16 s
    0x01,                                           // realigns
    0x00,                                           // does not align where the azimuth is known
];

#[rustfmt::skip]
const SPIN: [u8; 120] = [
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, // course: 2 rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xE0, 0xBF, // pitch: −0.5 rad
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3F, // gyro about x: 2⁻¹⁰ V per rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x90, 0x40, // limit: 1024 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xB0, 0x3F, // about y: 2⁻⁴ V per rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, 0x40, // limit: 32 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xC0, 0xBF, // about z: −2⁻³ V per rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x40, // limit: 16 rad/s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x30, 0x3F, // accelerometer along y: 2⁻¹² V per m/s²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xC0, 0x40, // limit: 8192 m/s²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x20, 0xBF, // along z: −2⁻¹³ V per m/s²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xD0, 0x40, // limit: 16384 m/s²
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x20, 0x3F, // N: 2⁻¹³ rad/√s
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40, 0x3F, // σ of the scale factor: 2⁻¹¹
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x50, 0x3F, // σ of the bias: 2⁻¹⁰ rad/s
];

/// The record of version 2 for the carrier with this index, with these settings behind the common ones.
fn by_hand(carrier: u8, rest: &[&[u8]]) -> [u8; BYTES] {
    let serial = *b"\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0A\x0B\x0C";
    let written = [&[2, carrier], &serial[..], &COMMON, &rest.concat()].concat();
    let mut bytes = [0; BYTES];
    bytes[..written.len()].copy_from_slice(&written);
    sealed(bytes)
}

/// The records of all carriers.
fn all_by_hand() -> [[u8; BYTES]; 5] {
    [
        by_hand(0, &[&STAGE, &FELT, &ENCODER]),
        by_hand(1, &[&TWO_FRAME, &FELT, &ENCODER, &FRAMES]),
        by_hand(2, &[&TURNTABLE, &FELT, &ENCODER, &INDEX]),
        by_hand(3, &[&VEHICLE, &FELT]),
        by_hand(4, &[&SPIN]),
    ]
}

/// A record of settings that are not checked, without a version, a carrier, a serial number and a checksum.
pub fn content<C: CarrierSchedule>(settings: &Settings<C>) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    postcard::to_slice(settings, &mut bytes[HEADER..BYTES - CHECKSUM]).expect("it fits");
    bytes
}

#[test]
fn records_of_version_2_have_the_bytes_that_were_written_down() {
    let [on_stage, on_frames, on_turntable, in_vehicle, spinning] = all_by_hand();
    assert_eq!(record(&settings(stage())), on_stage);
    assert_eq!(record(&settings(two_frame())), on_frames);
    assert_eq!(record(&settings(turntable())), on_turntable);
    assert_eq!(record(&settings(vehicle())), in_vehicle);
    assert_eq!(record(&settings(spin())), spinning);
}

#[test]
fn the_bytes_that_were_written_down_are_read() {
    let [on_stage, on_frames, on_turntable, in_vehicle, spinning] = all_by_hand();
    assert_eq!(read::<StageSchedule>(&on_stage), Ok(settings(stage())));
    assert_eq!(read::<TwoFrameSchedule>(&on_frames), Ok(settings(two_frame())));
    assert_eq!(read::<TurntableSchedule>(&on_turntable), Ok(settings(turntable())));
    assert_eq!(read::<VehicleSchedule>(&in_vehicle), Ok(settings(vehicle())));
    assert_eq!(read::<SpinSchedule>(&spinning), Ok(settings(spin())));
}

/// The checksum of the record of a vehicle, as `crc32` of Python's zlib has it.
#[test]
fn the_checksum_is_that_of_zlib() {
    let [.., a, b, c, d] = by_hand(3, &[&VEHICLE, &FELT]);
    assert_eq!(u32::from_le_bytes([a, b, c, d]), 0x4831_9AA8);
}

/// What the link sends comes first, so that it is found whatever follows.
#[test]
fn what_the_link_sends_is_read_from_a_record_of_any_carrier_and_any_board() {
    for mut record in all_by_hand() {
        assert_eq!(Output::from_record(&record), Some(output()));
        record[2..HEADER].copy_from_slice(&[0xAB; HEADER - 2]);
        assert_eq!(Output::from_record(&record), None, "the checksum is wrong");
        assert_eq!(Output::from_record(&sealed(record)), Some(output()));
    }
    let with = |at: usize, byte: u8| {
        let mut changed = by_hand(4, &[&SPIN]);
        changed[at] = byte;
        Output::from_record(&sealed(changed))
    };
    // The version, the format, and the system, of which there are neither 3, 2 nor 0.
    assert_eq!([with(0, 3), with(HEADER, 2), with(HEADER + 4, 0)], [None; 3]);
    assert_eq!(Output::from_record(&[]), None);
}

/// Each of two kinds of stages, turntables and frames that has the longest variable-length integers, every option and every
/// speed.
#[test]
fn the_longest_content_of_every_carrier_fits() {
    fn length<C: CarrierSchedule>(settings: &Settings<C>) -> usize {
        let record = record(settings);
        assert_eq!(read(&record).as_ref(), Ok(settings));
        let content = &record[..BYTES - CHECKSUM];
        let longest = content.iter().rposition(|byte| *byte != 0).expect("it has a version") + 1;
        assert!(longest <= BYTES - CHECKSUM);
        longest
    }
    let speeds = [0.5, 0.25].map(|hertz| RadiansPerSecond(hertz * TURN)).into_iter().collect();
    let longest = TurntableSchedule { speeds, turns: 1000, modulated_turns: 1000 };
    let two_frame = TwoFrameSchedule { half: Some(super::Half::West), ..two_frame() };
    let stage = StageSchedule { survey: Some(Seconds(60.1)), ..stage() };
    let vehicle = VehicleSchedule { aligns_known: true, ..vehicle() };
    let spin = {
        let mut settings = settings(spin());
        // The last number of the content ends with its sign and exponent.
        settings.calibration.bias_sigma.0 = 1.0 / 3.0;
        settings.calibration.gyros[2] = Analogue { scale: -1.0 / 3.0, limit: 1.0 / 3.0 };
        settings
    };
    let lengths = [
        length(&settings(stage)),
        length(&settings(two_frame)),
        length(&settings(longest)),
        length(&settings(vehicle)),
        length(&spin),
    ];
    // By the tables above: the header, what is common, schedule and calibration. A turntable that turns 1000 times has a
    // byte more, two frames with a half one more.
    assert_eq!(lengths, [205, 235, 222, 163, 240]);
    assert_eq!(BYTES - CHECKSUM, 244);
}

#[test]
fn bytes_behind_the_content_or_no_such_choice_are_refused_though_the_checksum_is_right() {
    let sound = by_hand(0, &[&STAGE, &FELT, &ENCODER]);
    let with = |at: usize, byte: u8| {
        let mut changed = sound;
        changed[at] = byte;
        read::<StageSchedule>(&sealed(changed))
    };
    let (holds, half) = (HEADER + COMMON.len() - 1, HEADER + COMMON.len() + STAGE.len() - 1);
    let behind = half + 1 + FELT.len() + ENCODER.len();
    assert_eq!(with(behind, 0), Ok(settings(stage())));
    let last = BYTES - CHECKSUM - 1;
    for (at, byte) in [(HEADER, 2), (holds, 2), (half, 2), (behind, 1), (last, 1)] {
        assert_eq!(with(at, byte), Err(SettingsError::Layout), "byte {at}");
    }
}

#[test]
fn three_speeds_or_a_number_of_turns_without_end_are_refused() {
    let of = |schedule: &[u8]| {
        read::<TurntableSchedule>(&by_hand(2, &[schedule, &FELT, &ENCODER, &INDEX]))
    };
    assert_eq!(of(&TURNTABLE), Ok(settings(turntable())));
    let third = [&[3][..], &TURNTABLE[1..17], &TURNTABLE[9..17], &[2, 0]].concat();
    assert_eq!(of(&third), Err(SettingsError::Layout));
    let endless = [&TURNTABLE[..17], &[0xFF; 6]].concat();
    assert_eq!(of(&endless), Err(SettingsError::Layout));
}

#[test]
fn a_latitude_that_is_no_number_is_refused_by_name() {
    let mut bytes = by_hand(4, &[&SPIN]);
    let latitude = HEADER + 16;
    bytes[latitude..latitude + 8].copy_from_slice(&f64::NAN.to_le_bytes());
    let refused = Settings::<SpinSchedule>::from_record(&sealed(bytes), &SERIAL);
    let Err(SettingsError::OutOfRange(SetupError::OutOfRange(quantity))) = refused else {
        panic!("not refused for that: {refused:?}");
    };
    assert_eq!(quantity.name, "latitude");
}
