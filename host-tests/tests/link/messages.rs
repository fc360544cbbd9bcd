//! Messages of MAVLink 2, read by the library's own parser for a whole dialect, and by what autopilots do with them.

use mavlink::dialects::common::{MavMessage, MavSeverity, MavState, MavSysStatusSensor};
use mavlink::{MavlinkVersion, Message, MessageData};
use orientation::alignment::Azimuth;
use orientation::device::Device;
use orientation::units::{Instant, Radians, RadiansPerSecond};
use protocol::mavlink::{
    Sender, attitude_quaternion, heartbeat, statustext, sys_status, vision_position_estimate,
};
use protocol::report::{Degradation, Level, Report, State};
use protocol::words::Words;

/// 1σ of azimuth and of level, rad.
const SIGMAS: [f64; 2] = [0.7e-3, 0.2e-3];

/// A report of an instrument that is ready, its azimuth 200°.
fn ready() -> Report {
    let [pitch, roll] = [5.0, -3.0].map(Radians::from_degrees);
    Report {
        time: Instant(12_345_678),
        state: State::Ready,
        azimuth: Some(Azimuth { angle: Radians::from_degrees(200.0), sigma: Radians(SIGMAS[0]) }),
        level: Some(Level { pitch, roll, sigma: Radians(SIGMAS[1]) }),
        rates: Some([0.01, -0.02, 0.03].map(RadiansPerSecond)),
        resets: 3,
        faults: 70_000,
        ..Report::default()
    }
}

/// All states, and whether an autopilot may fuse the azimuth of a report that has one.
const STATES: [(State, bool); 7] = [
    (State::Waiting, false),
    (State::Aligning, false),
    (State::Ready, true),
    (State::Degraded(Degradation::Recalled), false),
    (State::Degraded(Degradation::Coasting), true),
    (State::Degraded(Degradation::Uncertain), false),
    (State::Failed, false),
];

/// What another reads of a frame with a message: its header's system, component and sequence, and the message.
fn read<M: MessageData>(sender: &mut Sender, message: &M) -> ([u8; 3], MavMessage) {
    let frame = sender.frame(message);
    let bytes = frame.raw_bytes();
    assert_eq!((bytes[0], usize::from(bytes[1]) + 12), (0xFD, bytes.len()));
    assert!(frame.has_valid_crc::<MavMessage>(), "its checksum is right");
    let message = MavMessage::parse(MavlinkVersion::V2, frame.message_id(), frame.payload());
    ([bytes[5], bytes[6], bytes[4]], message.expect("the dialect has it"))
}

#[test]
fn frames_are_of_an_inertial_measurement_unit_and_are_counted() {
    let mut sender = Sender::of_system(7);
    for sequence in (0..=255).chain(0..3) {
        let (header, message) = read(&mut sender, &heartbeat(&ready()));
        assert_eq!(header, [7, 200, sequence]);
        assert_eq!(message.message_name(), "HEARTBEAT");
    }
}

#[test]
fn the_heartbeat_has_the_state() {
    let expected = [
        MavState::MAV_STATE_STANDBY,
        MavState::MAV_STATE_CALIBRATING,
        MavState::MAV_STATE_ACTIVE,
        MavState::MAV_STATE_CRITICAL,
        MavState::MAV_STATE_CRITICAL,
        MavState::MAV_STATE_CRITICAL,
        MavState::MAV_STATE_EMERGENCY,
    ];
    for ((state, _), expected) in STATES.into_iter().zip(expected) {
        assert_eq!(heartbeat(&Report { state, ..ready() }).system_status, expected, "{state:?}");
    }
}

/// Neither an autopilot nor its ground station can tell a valid azimuth from another by the message alone.
#[test]
fn nothing_that_can_be_fused_is_sent_before_the_azimuth_is_valid() {
    for (state, is_fused) in STATES {
        let report = Report { state, ..ready() };
        assert_eq!(vision_position_estimate(&report).is_some(), is_fused, "{state:?}");
        for lacking in [Report { azimuth: None, ..report }, Report { level: None, ..report }] {
            assert_eq!(vision_position_estimate(&lacking), None);
            assert_eq!(attitude_quaternion(&lacking), None);
        }
    }
    let impossible = Some(Azimuth { angle: Radians(f64::NAN), sigma: Radians(1e-3) });
    assert_eq!(vision_position_estimate(&Report { azimuth: impossible, ..ready() }), None);
}

/// ArduPilot drops a message with a coordinate that is not a number, and raises an internal error for one variance among
/// others; PX4 uses variances only where all three are finite.
#[test]
fn an_estimate_has_the_angles_their_variances_and_no_number_that_is_none() {
    let sent = vision_position_estimate(&ready()).expect("it is sent");
    let (_, MavMessage::VISION_POSITION_ESTIMATE(estimate)) =
        read(&mut Sender::of_system(1), &sent)
    else {
        panic!("it is another message")
    };
    assert_eq!((estimate.usec, estimate.reset_counter), (12_345_678, 3));
    assert_eq!([estimate.x, estimate.y, estimate.z], [0.0; 3]);
    let angles = [estimate.roll, estimate.pitch, estimate.yaw].map(f32::to_degrees);
    for (angle, expected) in angles.into_iter().zip([-3.0, 5.0, -160.0]) {
        assert!((angle - expected).abs() < 1e-4, "{angle}° instead of {expected}°");
    }
    let mut expected = [0.0; 21];
    let [heading, level] = SIGMAS.map(|sigma| (sigma * sigma) as f32);
    let variances = [(0, 1e4), (6, 1e4), (11, 1e4), (15, level), (18, level), (20, heading)];
    for (place, variance) in variances {
        expected[place] = variance;
    }
    for (found, expected) in estimate.covariance.into_iter().zip(expected) {
        assert!((found - expected).abs() <= 1e-6 * expected, "{found} instead of {expected}");
    }
}

/// By the closed form of the rotation about down, right and forward, in this order.
#[test]
fn a_quaternion_turns_the_body_as_its_angles_do() {
    let attitude = attitude_quaternion(&ready()).expect("it is sent");
    let [w, x, y, z] = [attitude.q1, attitude.q2, attitude.q3, attitude.q4].map(f64::from);
    let forward = [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)];
    let [azimuth, pitch, roll] = [200.0, 5.0, -3.0].map(f64::to_radians);
    let expected = [azimuth.cos() * pitch.cos(), azimuth.sin() * pitch.cos(), -pitch.sin()];
    for (found, expected) in forward.into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6, "{forward:?}");
    }
    let down_of_right = 2.0 * (y * z + w * x);
    assert!((down_of_right - roll.sin() * pitch.cos()).abs() < 1e-6, "{down_of_right}");
    let rates = [attitude.rollspeed, attitude.pitchspeed, attitude.yawspeed];
    assert_eq!((rates, attitude.time_boot_ms), ([0.01, -0.02, 0.03], 12_345));
}

#[test]
fn the_status_says_which_sensors_work_and_whether_the_azimuth_is_valid() {
    use MavSysStatusSensor as Bits;
    let all = Bits::MAV_SYS_STATUS_SENSOR_3D_GYRO
        | Bits::MAV_SYS_STATUS_SENSOR_3D_ACCEL
        | Bits::MAV_SYS_STATUS_AHRS;
    let health = |report: &Report| sys_status(report).onboard_control_sensors_health;
    assert_eq!(health(&ready()), all);
    let aligning = Report { state: State::Aligning, ..ready() };
    assert_eq!(health(&aligning), all - Bits::MAV_SYS_STATUS_AHRS);
    let mut failed = ready();
    failed.failed.insert(Device::RightGyro);
    assert_eq!(health(&failed), all - Bits::MAV_SYS_STATUS_SENSOR_3D_GYRO);
    let status = sys_status(&ready());
    assert_eq!(
        (status.errors_count1, status.voltage_battery, status.battery_remaining),
        (u16::MAX, u16::MAX, -1)
    );
    // ArduSub takes bits of the extended words for a leak.
    assert!(status.onboard_control_sensors_present_extended.is_empty());
}

#[test]
fn words_of_fifty_bytes_are_whole_and_longer_ones_go_in_parts() {
    let text = |words: &str, part: u8| {
        let sent = statustext(MavSeverity::MAV_SEVERITY_NOTICE, [0, part], Words(&words));
        let (_, MavMessage::STATUSTEXT(read)) = read(&mut Sender::of_system(1), &sent) else {
            panic!("it is another message")
        };
        read.text.to_str().expect("it is text").to_owned()
    };
    assert_eq!(text("azimuth found", 0), "azimuth found");
    assert_eq!(text(&"x".repeat(50), 0), "x".repeat(50));
    assert_eq!([0, 1].map(|part| text(&"x".repeat(51), part)), ["x".repeat(50), "x".to_owned()]);
}
