//! The board of a vehicle: the converters of three gyros and an accelerometer on one bus.

use super::plant::VehiclePlant;
use crate::chip::Select;
use crate::converters::ConverterBoard;

/// The select lines of the gyros' converters: forward, right, down.
pub const GYROS: [Select; 3] = [Select::Gyro, Select::GyroRight, Select::GyroDown];

/// The chips of the board, in the order in which they act at equal times: the converters of [`GYROS`],
/// then the accelerometer, its axes forward, right, down.
pub const CHIPS: [Select; 4] = [GYROS[0], GYROS[1], GYROS[2], Select::Accelerometer];

/// The vehicle with its chips.
pub type VehicleBoard<'a> = ConverterBoard<'a, VehiclePlant<'a>, 3>;
