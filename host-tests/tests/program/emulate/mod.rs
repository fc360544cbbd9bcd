//! What `meridian emulate` makes of a log, a table, an image and a budget, against handmade ones.
//! The emulator itself runs in `.ci/run`.

mod cores;
mod executed;
pub mod handmade;
mod limits;
mod log;
mod programs;
mod runs;
mod stream;
