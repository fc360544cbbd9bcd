//! What `meridian emulate` makes of a log, a table, an image and a budget, against handmade ones.
//! The emulator itself runs in `.ci/run`.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "emulate/cores.rs"]
mod cores;
#[path = "emulate/handmade.rs"]
mod handmade;
#[path = "emulate/limits.rs"]
mod limits;
#[path = "emulate/log.rs"]
mod log;
#[path = "emulate/programs.rs"]
mod programs;
#[path = "emulate/runs.rs"]
mod runs;
#[path = "emulate/stream.rs"]
mod stream;
