//! LSM6DSL: the simulated chip against transcripts from other hands, the codec, the driver on the chip.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod chip;
mod codec;
mod driver;
mod rig;
