//! The chips: each simulated one against its data sheet and transcripts from other hands, its codec, and its driver on it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

mod ads1262;
mod adxl355;
mod faults_of_the_bus;
mod lsm6dsl;
mod mt6835;
mod tmc5160;
mod wires;
