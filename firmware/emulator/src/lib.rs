//! What the images for the emulator measure themselves with: instructions and stack.
#![no_std]

pub mod counter;
pub mod stack;
