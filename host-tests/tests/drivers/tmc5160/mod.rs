//! The stage's motor driver: the simulated chip against its data sheet, then the driver on it.

mod codecs;
mod driver;
mod driver_stops;
mod driver_turning;
mod golden;
mod plant;
mod ramps;
mod stops;
