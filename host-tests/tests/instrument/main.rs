//! The whole instrument on simulated chips, one module for each method and mount.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

mod carriers;
mod catalogue;
mod clocks;
mod console;
mod instrument;
mod instrument_parts;
mod keeping_instrument;
mod kept_lines;
mod link;
mod mount;
mod output_clock;
mod postmortem;
mod recordings;
mod replaying;
mod ring;
mod settings;
mod spin;
mod stops_instrument;
mod stops_instrument_faults;
mod store;
mod sway;
mod turntable_instrument;
mod turntable_instrument_storage;
