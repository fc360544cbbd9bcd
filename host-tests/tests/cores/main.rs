//! The cores: numbers, noise, alignment, keeping and sessions against closed forms, independent oracles and simulated signals.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

mod alignment;
mod allan;
mod butterworth;
mod configurations;
mod dwell;
mod etalon;
mod foundations;
mod integrity;
mod planner;
mod positions;
mod refusals;
mod roll;
mod rotating;
mod session;
mod spectrum;
mod stops;
mod timebase;
mod vertical;
