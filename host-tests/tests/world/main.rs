//! What is simulated around the chips: stage, base, platform that turns, vehicle, spinning body and noise, against closed forms.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

mod flash;
mod plant;
mod spin_world;
mod turntable;
mod vehicle;
mod world;
