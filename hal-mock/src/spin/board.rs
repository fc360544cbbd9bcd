//! The board of a spinning body: the converters of three gyros and two accelerometers on one bus.

use super::plant::{CHANNELS, SpinPlant};
use crate::chip::Select;
use crate::converters::ConverterBoard;

/// The converters, in the order in which they act at equal times: of the gyros about x, y (up at roll
/// zero) and z (right there), of the accelerometers along y and z.
pub const CHIPS: [Select; CHANNELS] =
    [Select::Gyro, Select::GyroUp, Select::GyroRight, Select::ForceUp, Select::ForceRight];

/// The body with its chips.
pub type SpinBoard<'a> = ConverterBoard<'a, SpinPlant<'a>, CHANNELS>;
