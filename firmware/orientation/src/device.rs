//! The devices that an alignment depends on, and what can go wrong with them for good.

use crate::words;
use crate::words::Rounded;

/// A device of the board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Device {
    /// The precise gyro.
    Gyro,
    /// Of three gyros in a vehicle, the one about its longitudinal axis.
    ForwardGyro,
    /// The one about its transverse axis.
    RightGyro,
    /// The one about its vertical axis.
    DownGyro,
    /// Of three gyros on a spinning body, the one about the axis that is up at roll zero.
    UpGyro,
    /// The accelerometer along that axis.
    UpAccelerometer,
    /// The one along the axis that is right there.
    RightAccelerometer,
    /// The accelerometer on the platform, or in the vehicle.
    Accelerometer,
    /// The encoder of the stage.
    Encoder,
    /// The stage's motor and its driver; the mount as a whole where it has two frames.
    Stage,
    /// The encoder of a mount's outer frame.
    OuterEncoder,
    /// The encoder of its inner frame.
    InnerEncoder,
    /// The outer frame's motor and its driver.
    OuterFrame,
    /// The inner frame's.
    InnerFrame,
    /// The coarse sensors on the base.
    Base,
}

words! { Device:
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

/// What is wrong with a device, where repeating and restarting did not mend it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trouble {
    /// Its bus fails.
    Bus,
    /// Its readings fail their checksum.
    Checksum,
    /// It restarts again and again.
    Resets,
    /// Another chip answers, or none.
    Identity,
    /// Its self-test fails.
    SelfTest,
    /// It does not keep what is written to it.
    NotAsWritten,
    /// It gives no more data.
    Silent,
    /// Its bus takes far too long, again and again.
    Slow,
    /// It reports a bad supply, reference, magnet or driver.
    Alarm,
    /// It gives the same reading for ever.
    Stuck,
    /// It stays at the limit of its range.
    Saturated,
    /// It does not convert in step with the other gyros.
    OutOfStep,
    /// It moves and does not come to rest.
    Restless,
    /// It does not turn on from this angle, °.
    Stalled(f64),
    /// Motor and encoder disagree, by this angle, °.
    Disagrees(f64),
    /// The index was not found.
    NoIndex,
    /// It was sent beyond its travel, to this angle, °.
    BeyondTravel(f64),
    /// It stands elsewhere than it was sent, by this angle, °.
    NotThere(f64),
}

words! { Trouble:
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
    Self::Stalled(angle) => "it is blocked at {}°", Rounded::<1>(angle);
    Self::Disagrees(angle) => "motor and encoder disagree by {}°", Rounded::<2>(angle);
    Self::NoIndex => "its index was not found";
    Self::BeyondTravel(angle) => "{}° is beyond its travel", Rounded::<2>(angle);
    Self::NotThere(angle) => "it stands {}° from where it was sent", Rounded::<3>(angle);
}
