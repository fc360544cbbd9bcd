//! The devices that an alignment depends on, and the permanent failures that end it. A device fails
//! for good only after the retries and restarts of its retry budget are used up; what a retry mends
//! is logged and never becomes a [`Trouble`].

use crate::units::Degrees;
use crate::words::Rounded;

/// A sensor, actuator or sensor group of the board, as it is named in logs and refusals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Device {
    /// The precise gyro.
    Gyro,
    /// Gyro about the longitudinal (forward, x) axis of a three-gyro set in a vehicle.
    ForwardGyro,
    /// Gyro about the transverse (right, y) axis of a three-gyro set in a vehicle.
    RightGyro,
    /// Gyro about the vertical (down, z) axis of a three-gyro set in a vehicle.
    DownGyro,
    /// Gyro of a spinning body about the transverse axis that points up at roll zero.
    UpGyro,
    /// Accelerometer of a spinning body along the axis that points up at roll zero.
    UpAccelerometer,
    /// Accelerometer of a spinning body along the axis that points right at roll zero.
    RightAccelerometer,
    /// Precise accelerometer: on the platform beside the gyro, or fixed to the vehicle.
    Accelerometer,
    /// Angle encoder of the rotary stage.
    Encoder,
    /// Motor and motor driver of the stage; on a two-frame mount, the mount as a whole.
    Stage,
    /// Angle encoder of the outer frame of a two-frame mount.
    OuterEncoder,
    /// Angle encoder of the inner frame of a two-frame mount.
    InnerEncoder,
    /// Motor and motor driver of the outer frame.
    OuterFrame,
    /// Motor and motor driver of the inner frame.
    InnerFrame,
    /// Coarse gyros and accelerometers on the base, which measure its sway.
    Base,
}

impl Device {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Gyro,
        Self::ForwardGyro,
        Self::RightGyro,
        Self::DownGyro,
        Self::UpGyro,
        Self::UpAccelerometer,
        Self::RightAccelerometer,
        Self::Accelerometer,
        Self::Encoder,
        Self::Stage,
        Self::OuterEncoder,
        Self::InnerEncoder,
        Self::OuterFrame,
        Self::InnerFrame,
        Self::Base,
    ];
}

/// The gyros about the axes forward, right, down of a body.
pub const TRIAD: [Device; 3] = [Device::ForwardGyro, Device::RightGyro, Device::DownGyro];

crate::words! { Device:
    Self::Gyro => "gyro";
    Self::ForwardGyro => "forward gyro";
    Self::RightGyro => "right gyro";
    Self::DownGyro => "down gyro";
    Self::UpGyro => "up gyro";
    Self::UpAccelerometer => "up accelerometer";
    Self::RightAccelerometer => "right accelerometer";
    Self::Accelerometer => "accelerometer";
    Self::Encoder => "encoder";
    Self::Stage => "stage";
    Self::OuterEncoder => "outer encoder";
    Self::InnerEncoder => "inner encoder";
    Self::OuterFrame => "outer frame";
    Self::InnerFrame => "inner frame";
    Self::Base => "base";
}

/// Permanent failure of a device, one that neither repeated transfers nor a restart of the device
/// cured. Angles are in degrees, ready to print.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Trouble {
    /// Transfers on the device's bus fail.
    Bus,
    /// The device's readings fail their checksum.
    Checksum,
    /// The device restarts again and again, for example because its supply is too weak.
    Resets,
    /// The identity register answers with another chip's value, or with none.
    Identity,
    /// The device's built-in self-test fails.
    SelfTest,
    /// Registers read back differ from the values written to them.
    NotAsWritten,
    /// The device delivers no more data.
    Silent,
    /// Transfers with the device repeatedly exceed their time limit.
    Slow,
    /// The device reports a bad supply, reference, magnet or output driver.
    Alarm,
    /// The device repeats one identical reading, without the noise that a live sensor shows.
    Stuck,
    /// The device's reading stays at the limit of its range.
    Saturated,
    /// The gyro does not convert synchronously with the other gyros of its set.
    OutOfStep,
    /// The mechanism moves and does not come to rest within its time limit.
    Restless,
    /// The mechanism does not turn beyond this angle.
    Stalled(Degrees),
    /// Commanded motor position and encoder angle differ by this angle.
    Disagrees(Degrees),
    /// No index (zero) mark of the encoder was found in a full search.
    NoIndex,
    /// The mechanism was commanded to this angle, which lies outside its travel.
    BeyondTravel(Degrees),
    /// The mechanism came to rest this far from the commanded angle.
    NotThere(Degrees),
}

crate::words! { Trouble:
    Self::Bus => "its bus fails";
    Self::Checksum => "its readings fail their checksum";
    Self::Resets => "it restarts again and again: check its supply";
    Self::Identity => "another chip answers, or none: check the wiring";
    Self::SelfTest => "its self-test fails";
    Self::NotAsWritten => "it does not keep its configuration";
    Self::Silent => "it gives no more data";
    Self::Slow => "its bus hangs again and again";
    Self::Alarm => "it reports a bad supply, reference or magnet";
    Self::Stuck => "it gives the same reading for ever";
    Self::Saturated => "it stays at the limit of its range";
    Self::OutOfStep => "it falls out of step with the others: check its clock";
    Self::Restless => "it does not come to rest";
    Self::Stalled(angle) => "it is blocked at {}°", Rounded::<1>(angle.0);
    Self::Disagrees(angle) => "motor and encoder disagree by {}°", Rounded::<2>(angle.0);
    Self::NoIndex => "its index was not found";
    Self::BeyondTravel(angle) => "{}° is beyond its travel", Rounded::<2>(angle.0);
    Self::NotThere(angle) => "it stands {}° from where it was sent", Rounded::<3>(angle.0);
}
