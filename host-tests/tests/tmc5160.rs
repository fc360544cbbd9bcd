//! The stage's motor driver: the simulated chip against its data sheet, then the driver on it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "tmc5160/codecs.rs"]
mod codecs;
#[path = "tmc5160/driver.rs"]
mod driver;
#[path = "tmc5160/driver_stops.rs"]
mod driver_stops;
#[path = "tmc5160/driver_turning.rs"]
mod driver_turning;
#[path = "tmc5160/golden.rs"]
mod golden;
#[path = "tmc5160/plant.rs"]
mod plant;
#[path = "tmc5160/ramps.rs"]
mod ramps;
#[path = "tmc5160/stops.rs"]
mod stops;
