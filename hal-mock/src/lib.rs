//! The simulated world that feeds the orientation board.
#![no_std]
#![forbid(unsafe_code)]
