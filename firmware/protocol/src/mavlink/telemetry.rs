//! What is sent of a report.

use core::f64::consts::PI;
use mavlink::dialects::common::{
    ATTITUDE_QUATERNION_DATA, HEARTBEAT_DATA, MavAutopilot, MavModeFlag, MavSeverity, MavState,
    MavSysStatusSensor as Sensors, MavSysStatusSensorExtended, MavType, STATUSTEXT_DATA,
    SYS_STATUS_DATA, VISION_POSITION_ESTIMATE_DATA,
};
use orientation::device::Device;
use orientation::math::quaternion::quaternion;
use orientation::units::wrapped;

use crate::report::{Degradation, Report, State};
use crate::words::Words;

/// Version of the protocol that a heartbeat states: that of all dialects with `common`.
const VERSION: u8 = 3;

/// The component, its kind and its state, once a second: no autopilot acts on it.
#[must_use]
pub fn heartbeat(report: &Report) -> HEARTBEAT_DATA {
    HEARTBEAT_DATA {
        custom_mode: mode(report.state),
        mavtype: MavType::MAV_TYPE_IMU,
        autopilot: MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: MavModeFlag::empty(),
        system_status: match report.state {
            State::Waiting => MavState::MAV_STATE_STANDBY,
            State::Aligning => MavState::MAV_STATE_CALIBRATING,
            State::Ready => MavState::MAV_STATE_ACTIVE,
            State::Degraded(_) => MavState::MAV_STATE_CRITICAL,
            State::Failed => MavState::MAV_STATE_EMERGENCY,
        },
        mavlink_version: VERSION,
    }
}

/// The state as a number: 0 waiting, 1 aligning, 2 ready, 3 degraded, 4 failed; above its lowest byte why an azimuth is to be
/// used with care, 1 recalled, 2 coasting, 3 uncertain, 4 unwatched.
const fn mode(state: State) -> u32 {
    match state {
        State::Waiting => 0,
        State::Aligning => 1,
        State::Ready => 2,
        State::Degraded(Degradation::Recalled) => 0x103,
        State::Degraded(Degradation::Coasting) => 0x203,
        State::Degraded(Degradation::Uncertain) => 0x303,
        State::Degraded(Degradation::Unwatched) => 0x403,
        State::Failed => 4,
    }
}

/// The gyros, those of the coarse unit on the base included.
const GYROS: [Device; 6] = [
    Device::Gyro,
    Device::ForwardGyro,
    Device::RightGyro,
    Device::DownGyro,
    Device::UpGyro,
    Device::Base,
];
/// The accelerometers, those of the coarse unit on the base included.
const ACCELEROMETERS: [Device; 4] =
    [Device::Accelerometer, Device::UpAccelerometer, Device::RightAccelerometer, Device::Base];

/// Which sensors work, whether the azimuth is valid (the bit of the attitude reference system), and how many readings have
/// failed (`errors_count1`).
#[must_use]
pub fn sys_status(report: &Report) -> SYS_STATUS_DATA {
    let bits = [
        (Sensors::MAV_SYS_STATUS_SENSOR_3D_GYRO, !report.failed.contains_any(&GYROS)),
        (Sensors::MAV_SYS_STATUS_SENSOR_3D_ACCEL, !report.failed.contains_any(&ACCELEROMETERS)),
        (Sensors::MAV_SYS_STATUS_AHRS, report.valid_azimuth().is_some()),
    ];
    let all = bits.iter().fold(Sensors::empty(), |all, (bit, _)| all | *bit);
    let healthy = bits.iter().filter(|(_, is_healthy)| *is_healthy);
    let none = MavSysStatusSensorExtended::empty();
    SYS_STATUS_DATA {
        onboard_control_sensors_present: all,
        onboard_control_sensors_enabled: all,
        onboard_control_sensors_health: healthy.fold(Sensors::empty(), |all, (bit, _)| all | *bit),
        load: 0,
        // Voltage, current and charge are not measured.
        voltage_battery: u16::MAX,
        current_battery: -1,
        battery_remaining: -1,
        drop_rate_comm: 0,
        errors_comm: 0,
        errors_count1: u16::try_from(report.faults).unwrap_or(u16::MAX),
        errors_count2: 0,
        errors_count3: 0,
        errors_count4: 0,
        onboard_control_sensors_present_extended: none,
        onboard_control_sensors_enabled_extended: none,
        onboard_control_sensors_health_extended: none,
    }
}

/// Azimuth, pitch and roll, rad, the azimuth within ±π: while the azimuth is valid, and where the gyros alone carry the level
/// of one that is; never else, since no message that has them has a sign of their validity.
fn angles(report: &Report) -> Option<[f64; 3]> {
    let is_sound = matches!(report.state, State::Ready | State::Degraded(Degradation::Coasting));
    let azimuth = report.usable_azimuth().filter(|_| is_sound)?;
    let level = report.usable_level()?;
    Some([wrapped(azimuth.angle.0 + PI) - PI, level.pitch.0, level.roll.0])
}

/// Attitude from the body to north, east, down, and the body's rates, under the same conditions as
/// [`vision_position_estimate`].
#[must_use]
pub fn attitude_quaternion(report: &Report) -> Option<ATTITUDE_QUATERNION_DATA> {
    let [q1, q2, q3, q4] = quaternion(angles(report)?).map(|part| part as f32);
    let [rollspeed, pitchspeed, yawspeed] = report.rates?.map(|rate| rate.0 as f32);
    let time_boot_ms = (report.time.0 / 1000) as u32;
    let repr_offset_q = [0.0; 4];
    Some(ATTITUDE_QUATERNION_DATA {
        time_boot_ms,
        q1,
        q2,
        q3,
        q4,
        rollspeed,
        pitchspeed,
        yawspeed,
        repr_offset_q,
    })
}

/// Variance of each coordinate of a position that is none, m²: greater than that of any that could be used.
const NO_POSITION: f32 = 1e4;
/// Places of the variances of x, y, z, roll, pitch and yaw in the upper right triangle of a covariance of six by six.
const VARIANCES: [usize; 6] = [0, 6, 11, 15, 18, 20];

/// Azimuth, pitch and roll for an autopilot to fuse, with their variances. It is sent while the azimuth is valid, and where
/// the gyros alone carry the level of one that is; never else.
///
/// The position is zero with a variance of 10⁴ m²: ArduPilot drops a message whose position is not a number, and PX4
/// before its commit 648e730c takes its yaw for one from an unknown direction.
#[must_use]
pub fn vision_position_estimate(report: &Report) -> Option<VISION_POSITION_ESTIMATE_DATA> {
    let [yaw, pitch, roll] = angles(report)?.map(|angle| angle as f32);
    let (heading, level) = (report.azimuth?.sigma.0 as f32, report.level?.sigma.0 as f32);
    let variances =
        [NO_POSITION, NO_POSITION, NO_POSITION, level * level, level * level, heading * heading];
    let mut covariance = [0.0; 21];
    VARIANCES.iter().zip(variances).for_each(|(place, variance)| covariance[*place] = variance);
    let (usec, reset_counter) = (report.time.0, report.resets);
    Some(VISION_POSITION_ESTIMATE_DATA {
        usec,
        x: 0.0,
        y: 0.0,
        z: 0.0,
        roll,
        pitch,
        yaw,
        covariance,
        reset_counter,
    })
}

/// Most bytes of words in a message.
pub const WORDS: usize = 50;

/// The part of this number from zero of words for people, which are a text of this identity, or, where they are whole, none:
/// zero.
#[must_use]
pub fn statustext(
    severity: MavSeverity,
    [identity, part]: [u8; 2],
    words: Words<'_>,
) -> STATUSTEXT_DATA {
    let mut text = [0; WORDS];
    text.iter_mut().zip(words.part::<WORDS>(part).bytes()).for_each(|(place, byte)| *place = byte);
    STATUSTEXT_DATA { severity, text: text.into(), id: identity.into(), chunk_seq: part }
}
