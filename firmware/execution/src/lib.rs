//! What `meridian emulate` and the program `emulated-board` share, since nothing links that program.
//!
//! Both have images [`built`] by cargo, and hold an image to its [`carrier`]; one hands [`options`] on to the other, and
//! reads its [`report`]. What a board has [`kept`] of its log is decoded for both.
#![forbid(unsafe_code)]

pub mod built;
pub mod carrier;
pub mod kept;
pub mod options;
pub mod report;
