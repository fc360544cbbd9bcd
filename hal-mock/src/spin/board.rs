//! The board of a spinning body: the converters of three gyros and two accelerometers on one bus.

use super::plant::{CHANNELS, SpinPlant};
use crate::converters::ConverterBoard;

/// The body with its chips.
pub type SpinBoard<'a> = ConverterBoard<'a, SpinPlant<'a>, CHANNELS>;
