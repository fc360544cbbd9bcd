//! Recordings: what is read and what is refused, and their replay by each method against truth and independent solutions.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]
#![allow(clippy::format_push_string, reason = "a test may allocate")]

#[path = "../support/mod.rs"]
mod support;

mod allan_host;
mod inputs;
mod laser_gyro;
mod pages;
mod recording;
mod replay;
mod rotating_figures;
mod rotating_replay;
mod spin_faults;
mod stops_replay;
mod vehicle_faults;
mod vertical_replay;
