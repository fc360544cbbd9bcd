//! The images of all carriers, executed: what holds today, and every defect that is known, with its figure.
//!
//! `DEFECTS.md` lists the defects, and those of a board with a fault (`tests/faults`); `support::defect` says how a test
//! holds one.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod clocks;
mod conclusion;
mod cost;
mod list;
mod readme;
mod rules;
mod settings;
mod sound;
mod spin;
mod stamps;
mod start;
mod store;
mod support;
mod two_frames;
