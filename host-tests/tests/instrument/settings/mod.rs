//! Records of settings in a store: what was saved is loaded, and nothing else is ever taken for settings. The layouts
//! of both versions are frozen by bytes that were written down from postcard's specification of its format.

use firmware::calibration::Harmonics;
use firmware::platform::Platform;
use firmware::settings::{
    Analogue, BYTES, CarrierSchedule, Felt, Format, FramesCalibration, Geometry, Gyro, Item,
    Output, PlatformCalibration, SLOT, Serial, Settings, SettingsError, SpinCalibration,
    SpinSchedule, StageSchedule, TurntableCalibration, TurntableSchedule, TwoFrameSchedule,
    VERSION, VehicleCalibration, VehicleSchedule, load, save,
};
use orientation::alignment::setup::SetupError;
use orientation::alignment::stepwise::setting::Half;
use orientation::attitude;
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use orientation::units::{
    GSensitivity, MetresPerSecondSquared, Radians, RadiansPerRootSecond, RadiansPerSecond,
    RateRamp, RateRandomWalk, Seconds, TURN,
};
use proptest::prelude::*;

mod first;
mod layout;
mod names;
mod stored;

pub(crate) use first::stopping as first_record_of_stops;

/// Bytes of the checksum at the end.
const CHECKSUM: usize = 4;
/// Bytes of version, carrier and serial number.
const HEADER: usize = 14;

/// Serial number of a board.
pub(crate) const SERIAL: Serial = Serial([1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]);

/// What a link sends that is all but usual.
fn output() -> Output {
    let rates = [0, 1, 2, 5, 10, 0, 1, 2, 10, 5];
    Output { format: Format::Mavlink, baud: 921_600, system: 254, rates }
}

/// A carrier with a calibration whose numbers all differ.
pub(crate) trait Calibrated: CarrierSchedule {
    fn calibration() -> Self::Calibration;
}

fn felt() -> Felt {
    Felt {
        g_sensitivity: [1.0 / 1024.0, -1.0 / 2048.0].map(GSensitivity),
        g_sensitivity_sigma: GSensitivity(1.0 / 4096.0),
        force_bias_sigma: MetresPerSecondSquared(1.0 / 16.0),
    }
}

impl Calibrated for StageSchedule {
    fn calibration() -> PlatformCalibration {
        let first = [1.0 / 64.0, -1.0 / 128.0];
        let encoder = Harmonics { first, second: first.map(|part| part / 4.0) };
        PlatformCalibration { felt: felt(), encoder, encoder_sigma: Radians(1.0 / 64.0) }
    }
}

impl Calibrated for TwoFrameSchedule {
    fn calibration() -> FramesCalibration {
        let first = [1.0 / 1024.0, 1.0 / 2048.0];
        FramesCalibration {
            platform: StageSchedule::calibration(),
            inner: Harmonics { first, second: first.map(|part| part / 4.0) },
            geometry: Geometry {
                azimuth: 1.0 / 64.0,
                pitch: -1.0 / 64.0,
                frames: 1.0 / 128.0,
                gyro: -1.0 / 128.0,
                outer_zero: 1.0 / 256.0,
                inner_zero: -1.0 / 256.0,
            },
            orthogonality_sigma: Radians(1.0 / 1024.0),
        }
    }
}

impl Calibrated for TurntableSchedule {
    fn calibration() -> TurntableCalibration {
        TurntableCalibration {
            platform: StageSchedule::calibration(),
            encoder_zero_sigma: Radians(1.0 / 128.0),
            index: [0.5, 0.75].map(Radians),
            is_molecular: true,
        }
    }
}

impl Calibrated for VehicleSchedule {
    fn calibration() -> VehicleCalibration {
        VehicleCalibration(felt())
    }
}

impl Calibrated for SpinSchedule {
    fn calibration() -> SpinCalibration {
        let of = |[scale, limit]: [f64; 2]| Analogue { scale, limit };
        SpinCalibration {
            gyros: [[1.0 / 1024.0, 1024.0], [1.0 / 16.0, 32.0], [-1.0 / 8.0, 16.0]].map(of),
            forces: [[1.0 / 4096.0, 8192.0], [-1.0 / 8192.0, 16_384.0]].map(of),
            angle_random_walk: RadiansPerRootSecond(1.0 / 8192.0),
            scale_sigma: 1.0 / 2048.0,
            bias_sigma: RadiansPerSecond(1.0 / 1024.0),
        }
    }
}

/// Settings whose numbers all differ.
pub(crate) fn settings<C: Calibrated>(schedule: C) -> Settings<C> {
    let noise = GyroNoise {
        quantisation: Radians(0.25),
        angle_random_walk: RadiansPerRootSecond(0.5),
        bias_instability: RadiansPerSecond(0.75),
        rate_random_walk: RateRandomWalk(1.0),
        rate_ramp: RateRamp(1.25),
    };
    let errors =
        attitude::Gyro { noise, bias_sigma: RadiansPerSecond(1.5), scale_sigma: 1.0 / 1024.0 };
    Settings {
        output: output(),
        latitude: Latitude::from_degrees(45.0),
        starts: false,
        gyro: Gyro { volts_per_rad_per_s: -2.0, limit: RadiansPerSecond(1.75), errors },
        required_sigma: Radians(0.125),
        holds: true,
        schedule,
        calibration: C::calibration(),
    }
}

fn stage() -> StageSchedule {
    let (survey, allowed) = (Some(Seconds(64.0)), Some(Seconds(128.0)));
    StageSchedule { positions: 24, dwell: Seconds(4.0), survey, allowed, half: Some(Half::West) }
}

fn two_frame() -> TwoFrameSchedule {
    TwoFrameSchedule { passes: 16, dwell: Seconds(8.0), half: None }
}

fn turntable() -> TurntableSchedule {
    let speeds = [0.5, 1.0].map(RadiansPerSecond).into_iter().collect();
    TurntableSchedule { speeds, turns: 300, modulated_turns: 12 }
}

pub(crate) fn vehicle() -> VehicleSchedule {
    let (realigns, aligns_known) = (true, false);
    VehicleSchedule { stops: 3, stop: Seconds(16.0), realigns, aligns_known }
}

fn spin() -> SpinSchedule {
    SpinSchedule { course: Radians(2.0), pitch: Radians(-0.5) }
}

/// CRC-32 bit by bit, from its definition in IEEE 802.3.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            (crc >> 1) ^ if crc & 1 == 1 { 0xEDB8_8320 } else { 0 }
        })
    })
}

/// A record with the right checksum for what it holds.
fn sealed(mut record: [u8; BYTES]) -> [u8; BYTES] {
    let checksum = crc32(&record[..BYTES - CHECKSUM]);
    record[BYTES - CHECKSUM..].copy_from_slice(&checksum.to_le_bytes());
    record
}

fn record<C: CarrierSchedule>(settings: &Settings<C>) -> [u8; BYTES] {
    settings.to_record(&SERIAL).expect("they are in range")
}

fn read<C: CarrierSchedule>(record: &[u8]) -> Result<Settings<C>, SettingsError> {
    Settings::from_record(record, &SERIAL)
}

fn time(range: std::ops::RangeInclusive<f64>) -> impl Strategy<Value = Seconds> {
    range.prop_map(Seconds)
}

fn half() -> impl Strategy<Value = Option<Half>> {
    proptest::option::of(prop_oneof![Just(Half::East), Just(Half::West)])
}

prop_compose! {
    fn any_gyro()(
        volts in 1e-6..1e6_f64, reversed: bool, limit in 1e-3..2.1,
        [q, n, b, k, r] in [0.0..1e9, 0.0..1e9, 0.0..1e9, 0.0..1e9, 0.0..1e9],
        bias in 0.0..2.1, scale_sigma in 0.0..1.0,
    ) -> Gyro {
        let noise = GyroNoise {
            quantisation: Radians(q),
            angle_random_walk: RadiansPerRootSecond(n),
            bias_instability: RadiansPerSecond(b),
            rate_random_walk: RateRandomWalk(k),
            rate_ramp: RateRamp(r),
        };
        let errors = attitude::Gyro { noise, bias_sigma: RadiansPerSecond(bias), scale_sigma };
        let volts_per_rad_per_s = if reversed { -volts } else { volts };
        Gyro { volts_per_rad_per_s, limit: RadiansPerSecond(limit), errors }
    }
}

prop_compose! {
    fn any_output()(
        is_mavlink: bool, baud in 100_000_u32..=921_600, system in 1_u8..=254,
        rates in proptest::array::uniform10(proptest::sample::select(&[0_u8, 1, 2, 5][..])),
        vision in proptest::sample::select(&[0_u8, 10][..]),
    ) -> Output {
        let format = if is_mavlink { Format::Mavlink } else { Format::Nmea };
        let mut rates = rates;
        rates[Item::Vision as usize] = vision;
        Output { format, baud, system, rates }
    }
}

/// Settings with any schedule of a carrier.
fn any_settings<C: Calibrated>(
    schedule: impl Strategy<Value = C>,
) -> impl Strategy<Value = Settings<C>> {
    let latitude = proptest::option::of(-84.9..84.9);
    let common = (any_output(), latitude, any_gyro(), 1e-4..3.1, any::<[bool; 2]>(), schedule);
    common.prop_map(|(output, latitude, gyro, sigma, [holds, starts], schedule)| {
        let latitude = latitude.and_then(Latitude::from_degrees);
        let required_sigma = Radians(sigma);
        let calibration = C::calibration();
        Settings { output, latitude, starts, gyro, required_sigma, holds, schedule, calibration }
    })
}

prop_compose! {
    fn any_stage()(
        positions in 2_u8..=64, dwell in time(0.5..=600.0),
        survey in proptest::option::of(time(60.0..=36_000.0)),
        allowed in proptest::option::of(time(60.0..=36_000.0)), half in half(),
    ) -> StageSchedule {
        // Two positions require it, unless others are planned.
        let half = if positions == 2 && survey.is_none() { half.or(Some(Half::East)) } else { half };
        StageSchedule { positions, dwell, survey, allowed, half }
    }
}

prop_compose! {
    fn any_two_frame()(passes in 1_u8..=16, dwell in time(0.5..=600.0), half in half()) -> TwoFrameSchedule {
        TwoFrameSchedule { passes, dwell, half }
    }
}

prop_compose! {
    fn any_turntable()(
        speeds in proptest::collection::vec(0.02 * TURN..0.5 * TURN, 1..=2), turns in 2_u32..=1000,
        modulated_turns in prop_oneof![Just(0_u32), 4_u32..=1000],
    ) -> TurntableSchedule {
        let speeds = speeds.into_iter().map(RadiansPerSecond).collect();
        TurntableSchedule { speeds, turns, modulated_turns }
    }
}

prop_compose! {
    fn any_vehicle()(
        stops in 2_u8..=8, stop in time(10.0..=3600.0), realigns: bool, aligns_known: bool,
    ) -> VehicleSchedule {
        VehicleSchedule { stops, stop, realigns, aligns_known }
    }
}

prop_compose! {
    fn any_spin()(course in -TURN..TURN, pitch in -0.25 * TURN..0.25 * TURN) -> SpinSchedule {
        SpinSchedule { course: Radians(course), pitch: Radians(pitch) }
    }
}

proptest! {
    #[test]
    fn what_was_written_on_a_stage_is_read(settings in any_settings(any_stage())) {
        prop_assert_eq!(read(&record(&settings)), Ok(settings));
    }

    #[test]
    fn what_was_written_on_two_frames_is_read(settings in any_settings(any_two_frame())) {
        prop_assert_eq!(read(&record(&settings)), Ok(settings));
    }

    #[test]
    fn what_was_written_on_a_turntable_is_read(settings in any_settings(any_turntable())) {
        prop_assert_eq!(read(&record(&settings)), Ok(settings));
    }

    #[test]
    fn what_was_written_in_a_vehicle_is_read(settings in any_settings(any_vehicle())) {
        prop_assert_eq!(read(&record(&settings)), Ok(settings));
    }

    #[test]
    fn what_was_written_on_a_spinning_body_is_read(settings in any_settings(any_spin())) {
        prop_assert_eq!(read(&record(&settings)), Ok(settings));
    }

    #[test]
    fn bytes_by_chance_are_no_settings(bytes in proptest::collection::vec(any::<u8>(), BYTES)) {
        prop_assert_eq!(read::<StageSchedule>(&bytes), Err(SettingsError::Damaged));
    }

    /// Whatever a record with the right checksum has in the place of some of its bytes.
    #[test]
    fn sound_records_are_settings_in_range_or_are_refused(
        from in HEADER..BYTES - 2 * CHECKSUM, bytes: [u8; CHECKSUM],
    ) {
        let mut changed = record(&settings(turntable()));
        changed[from..from + CHECKSUM].copy_from_slice(&bytes);
        match read::<TurntableSchedule>(&sealed(changed)) {
            Ok(settings) => prop_assert_eq!(settings.check(), Ok(())),
            Err(SettingsError::Layout | SettingsError::OutOfRange(_)) => {}
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}

#[test]
fn every_flipped_bit_is_refused() {
    let sound = record(&settings(stage()));
    for bit in 0..8 * BYTES {
        let mut flipped = sound;
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(read::<StageSchedule>(&flipped), Err(SettingsError::Damaged), "bit {bit}");
    }
}

#[test]
fn every_truncated_or_longer_record_is_refused() {
    let sound = record(&settings(vehicle()));
    let with = |rest: u8, length: usize| {
        let mut torn = [rest; BYTES];
        torn[..length].copy_from_slice(&sound[..length]);
        torn
    };
    for length in 0..BYTES {
        let damaged = Err(SettingsError::Damaged);
        assert_eq!(read::<VehicleSchedule>(&sound[..length]), damaged, "{length} bytes");
        for rest in [0x00, 0xFF] {
            // Zeros after the content are what the record has there, too.
            let torn = with(rest, length);
            if torn != sound {
                assert_eq!(read::<VehicleSchedule>(&torn), damaged, "{length} bytes, then {rest}");
            }
        }
    }
    let longer = [&sound[..], &[0]].concat();
    assert_eq!(read::<VehicleSchedule>(&longer), Err(SettingsError::Damaged));
}

#[test]
fn every_other_version_is_refused_with_that_reason() {
    for version in (0..=u8::MAX).filter(|version| ![1, VERSION].contains(version)) {
        let mut other = record(&settings(spin()));
        other[0] = version;
        let refused = read::<SpinSchedule>(&sealed(other)).expect_err("it is not known");
        assert_eq!(refused, SettingsError::UnknownVersion(version));
        let said =
            format!("the record has version {version}, and this image knows versions 1 to 2 alone");
        assert_eq!(refused.to_string(), said);
    }
    // One of version 1 has another length.
    let mut first = record(&settings(spin()));
    first[0] = 1;
    assert_eq!(read::<SpinSchedule>(&sealed(first)), Err(SettingsError::Layout));
}

/// It has the calibrations of the instrument there.
#[test]
fn the_record_of_another_board_is_refused() {
    let sound = record(&settings(stage()));
    for place in 0..SERIAL.0.len() {
        let mut other = SERIAL;
        other.0[place] ^= 0x10;
        let refused = Settings::<StageSchedule>::from_record(&sound, &other);
        assert_eq!(refused, Err(SettingsError::OtherBoard), "byte {place}");
    }
    let said = "the record is for another board, and has the calibrations of that one";
    assert_eq!(SettingsError::OtherBoard.to_string(), said);
}

#[test]
fn a_record_without_a_latitude_is_read_as_one_that_has_none() {
    let settings = Settings { latitude: None, ..settings(stage()) };
    assert_eq!(read(&record(&settings)), Ok(settings));
}

#[test]
fn the_record_of_another_carrier_is_refused_by_name() {
    let refused = read::<VehicleSchedule>(&record(&settings(stage()))).expect_err("a stage's");
    let (found, own) = (Platform::Stage, Platform::Vehicle);
    assert_eq!(refused, SettingsError::OtherCarrier { found, own });
    let said = "the record is for the carrier stage, and this image for vehicle";
    assert_eq!(refused.to_string(), said);
    let mut unknown = record(&settings(stage()));
    unknown[1] = 5;
    assert_eq!(read::<StageSchedule>(&sealed(unknown)), Err(SettingsError::Layout));
}

/// The name of the quantity for which settings are refused, when they are written as when they are read.
fn refused<C: CarrierSchedule>(settings: &Settings<C>) -> &'static str {
    let error = settings.to_record(&SERIAL).expect_err("they are out of range");
    let SettingsError::OutOfRange(SetupError::OutOfRange(quantity)) = error else {
        panic!("refused for another reason: {error}");
    };
    assert!(error.to_string().starts_with(quantity.name), "{error}");
    let mut forged = layout::content(settings);
    forged[..2].copy_from_slice(&[VERSION, C::PLATFORM as u8]);
    forged[2..HEADER].copy_from_slice(&SERIAL.0);
    // A NaN differs from itself.
    let read = read::<C>(&sealed(forged)).expect_err("they are out of range");
    assert_eq!(read.to_string(), error.to_string());
    quantity.name
}

/// Refuses settings for each of these values of a quantity.
fn out_of_range<C: Calibrated>(
    name: &str,
    usual: &C,
    values: &[f64],
    change: fn(&mut Settings<C>, f64),
) {
    for &value in values {
        let mut settings = settings(usual.clone());
        change(&mut settings, value);
        assert_eq!(refused(&settings), name, "{name} {value}");
    }
}

#[test]
fn a_quantity_of_place_or_gyro_out_of_range_is_refused_by_name() {
    let negative = &[-1.0, f64::NAN, f64::INFINITY];
    let volts = &[0.0, 1e-12, -1e12, f64::NAN, f64::INFINITY];
    out_of_range("magnitude of volts_per_rad_per_s", &stage(), volts, |settings, value| {
        settings.gyro.volts_per_rad_per_s = value;
    });
    out_of_range("latitude", &stage(), &[-85.01, 85.01, 90.0], |settings, value| {
        settings.latitude = Latitude::from_degrees(value);
    });
    out_of_range("limit", &stage(), &[0.0, -1.0, 2.2, f64::NAN], |settings, value| {
        settings.gyro.limit.0 = value;
    });
    out_of_range(
        "bias_sigma",
        &vehicle(),
        &[-1.0, 2.2, f64::NAN, f64::INFINITY],
        |settings, value| {
            settings.gyro.errors.bias_sigma.0 = value;
        },
    );
    out_of_range(
        "scale_sigma",
        &stage(),
        &[-1.0, 1.1, f64::NAN, f64::INFINITY],
        |settings, value| {
            settings.gyro.errors.scale_sigma = value;
        },
    );
    out_of_range("angle_random_walk", &spin(), negative, |settings, value| {
        settings.gyro.errors.noise.angle_random_walk.0 = value;
    });
    out_of_range("bias_instability", &stage(), negative, |settings, value| {
        settings.gyro.errors.noise.bias_instability.0 = value;
    });
    out_of_range("rate_random_walk", &stage(), negative, |settings, value| {
        settings.gyro.errors.noise.rate_random_walk.0 = value;
    });
    out_of_range(
        "required_sigma",
        &turntable(),
        &[-1.0, 0.0, 3.2, f64::NAN, f64::INFINITY],
        |settings, value| {
            settings.required_sigma.0 = value;
        },
    );
}

#[test]
fn a_quantity_of_a_schedule_out_of_range_is_refused_by_name() {
    let dwells = &[0.0, -4.0, 0.49, 601.0, f64::NAN];
    let long = &[59.0, 36_001.0, -60.0, f64::NAN];
    out_of_range("positions", &stage(), &[0.0, 1.0, 65.0, 255.0], |settings, value| {
        settings.schedule.positions = value as u8;
    });
    out_of_range("dwell", &stage(), dwells, |settings, value| {
        settings.schedule.dwell.0 = value;
    });
    out_of_range("survey", &stage(), long, |settings, value| {
        settings.schedule.survey = Some(Seconds(value));
    });
    out_of_range("allowed", &stage(), long, |settings, value| {
        settings.schedule.allowed = Some(Seconds(value));
    });
    out_of_range("passes", &two_frame(), &[0.0, 17.0], |settings, value| {
        settings.schedule.passes = value as u8;
    });
    out_of_range("dwell", &two_frame(), dwells, |settings, value| {
        settings.schedule.dwell.0 = value;
    });
    out_of_range("number of speeds", &turntable(), &[0.0], |settings, _| {
        settings.schedule.speeds.clear();
    });
    out_of_range("speeds", &turntable(), &[0.0, -1.0, 0.12, 3.15, f64::NAN], |settings, value| {
        settings.schedule.speeds[1].0 = value;
    });
    out_of_range("turns", &turntable(), &[0.0, 1.0, 1001.0], |settings, value| {
        settings.schedule.turns = value as u32;
    });
    out_of_range("modulated_turns", &turntable(), &[1.0, 3.0, 1001.0], |settings, value| {
        settings.schedule.modulated_turns = value as u32;
    });
    out_of_range("stops", &vehicle(), &[0.0, 1.0, 9.0], |settings, value| {
        settings.schedule.stops = value as u8;
    });
    out_of_range("stop", &vehicle(), &[0.0, 9.9, 3601.0, f64::NAN], |settings, value| {
        settings.schedule.stop.0 = value;
    });
    out_of_range("course", &spin(), &[-6.3, 6.3, f64::NAN], |settings, value| {
        settings.schedule.course.0 = value;
    });
    out_of_range("pitch", &spin(), &[-1.6, 1.6, f64::NAN], |settings, value| {
        settings.schedule.pitch.0 = value;
    });
}

#[test]
fn a_quantity_of_a_platforms_calibration_out_of_range_is_refused_by_name() {
    let sigma = &[-1e-9, 0.18, f64::NAN, f64::INFINITY];
    let error = &[-0.18, 0.18, f64::NAN];
    out_of_range("g_sensitivity", &vehicle(), &[-0.005, 0.005, f64::NAN], |settings, value| {
        settings.calibration.0.g_sensitivity[1].0 = value;
    });
    out_of_range("g_sensitivity_sigma", &stage(), &[-1e-9, 0.005, f64::NAN], |settings, value| {
        settings.calibration.felt.g_sensitivity_sigma.0 = value;
    });
    out_of_range("force_bias_sigma", &vehicle(), &[9.81], |settings, value| {
        settings.calibration.0.force_bias_sigma.0 = value;
    });
    out_of_range("encoder", &stage(), error, |settings, value| {
        settings.calibration.encoder.second[0] = value as f32;
    });
    out_of_range("encoder", &two_frame(), error, |settings, value| {
        settings.calibration.inner.first[1] = value as f32;
    });
    out_of_range("encoder_sigma", &turntable(), sigma, |settings, value| {
        settings.calibration.platform.encoder_sigma.0 = value;
    });
    out_of_range("outer_zero", &two_frame(), error, |settings, value| {
        settings.calibration.geometry.outer_zero = value as f32;
    });
    out_of_range("orthogonality_sigma", &two_frame(), sigma, |settings, value| {
        settings.calibration.orthogonality_sigma.0 = value;
    });
    out_of_range("encoder_zero_sigma", &turntable(), &[-1.0, 3.2], |settings, value| {
        settings.calibration.encoder_zero_sigma.0 = value;
    });
    out_of_range("index", &turntable(), &[-0.1, 6.3, f64::NAN], |settings, value| {
        settings.calibration.index[0].0 = value;
    });
}

#[test]
fn a_quantity_of_a_spinning_bodys_calibration_out_of_range_is_refused_by_name() {
    let scales = &[0.0, 1e-7, -2e3, f64::NAN, f64::INFINITY];
    out_of_range("magnitude of scale", &spin(), scales, |settings, value| {
        settings.calibration.gyros[0].scale = value;
    });
    out_of_range("magnitude of scale", &spin(), scales, |settings, value| {
        settings.calibration.forces[1].scale = value;
    });
    out_of_range("limit", &spin(), &[0.0, -1.0, 2e6, f64::NAN], |settings, value| {
        settings.calibration.forces[0].limit = value;
    });
    out_of_range("angle_random_walk", &spin(), &[-1e-9, 1.0], |settings, value| {
        settings.calibration.angle_random_walk.0 = value;
    });
    out_of_range("scale_sigma", &spin(), &[-1e-9, 1.1], |settings, value| {
        settings.calibration.scale_sigma = value;
    });
    out_of_range("bias_sigma", &spin(), &[-1e-9, 50.0], |settings, value| {
        settings.calibration.bias_sigma.0 = value;
    });
}

/// Every scale factor and limit in its range can be represented by a channel, whatever the sample rate.
#[test]
fn a_spinning_body_with_settings_in_range_has_a_configuration() {
    for scale in [1e-6, -1e-6, 1e3, -1e3] {
        let sensor = Analogue { scale, limit: 1.0 };
        let calibration = SpinCalibration {
            gyros: [sensor; 3],
            forces: [sensor; 2],
            ..SpinCalibration::default()
        };
        for rate in [2400.0, 14_400.0, 38_400.0] {
            assert!(calibration.configuration(rate).is_some(), "{scale} at {rate} Hz");
        }
    }
}
