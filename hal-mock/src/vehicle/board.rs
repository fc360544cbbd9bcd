//! The board of a vehicle: the converters of three gyros and an accelerometer on one bus.

use super::plant::VehiclePlant;
use crate::converters::ConverterBoard;

/// The vehicle with its chips.
pub type VehicleBoard<'a> = ConverterBoard<'a, VehiclePlant<'a>, 3>;
