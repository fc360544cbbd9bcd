//! What `meridian emulate` and the program `emulated-board` share, since nothing links that program.
//!
//! Both have images [`built`] by cargo, and hold an image to its [`carrier`]; [`options`] are those that one hands on to
//! the other.
#![forbid(unsafe_code)]

pub mod built;
pub mod carrier;
pub mod options;
