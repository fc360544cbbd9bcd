//! The images of all carriers, executed: what each holds from power-on through its result to keeping. What a board with a
//! fault does is in `tests/faults`.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod budget;
mod clocks;
mod conclusion;
mod console;
mod cost;
mod course;
mod hearing;
mod load;
mod rules;
mod settings;
mod sound;
mod spin;
mod stamps;
mod start;
mod store;
mod support;
mod two_frames;
