//! The `meridian` program as a user meets it: output, exit codes, mistakes, pages, what `emulate` makes of its images, and what
//! the documents say of it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

mod angles;
mod command_line;
mod doctor;
mod documents;
mod emulate;
mod help;
mod interrupted;
mod link;
mod log;
mod many;
mod measured_again;
mod numbers;
mod program;
mod realigned;
mod records;
mod refused;
mod report;
mod rotating_run;
mod stops_run;
mod terminal;
mod verbosity;
