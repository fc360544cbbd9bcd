//! What the command line is made of: recordings, replay, campaigns, the emulator, and their output.
//!
//! It drives the same session and cores that the board runs; only files, threads and the terminal
//! are its own.
#![forbid(unsafe_code)]

pub mod allan;
pub mod angle;
mod assumptions;
pub mod campaign;
pub mod cause;
pub mod criterion;
pub mod doctor;
pub mod emulate;
pub mod instrument;
pub mod interrupt;
pub mod link;
mod median;
pub mod methods;
pub mod new_file;
pub mod outcome;
pub mod output;
pub mod packed;
pub mod planning;
pub mod recording;
mod reference;
pub mod refused;
pub mod report;
mod setting;
pub mod settings;
pub mod simulate;
pub mod spectrum;
pub mod virtual_time;
pub mod work;

/// Name and version of the program, with its commit where that is known.
pub const VERSION: &str = concat!("meridian ", env!("MERIDIAN_VERSION"));
