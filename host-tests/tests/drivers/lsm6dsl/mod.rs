//! LSM6DSL: the simulated chip against transcripts from other hands, the codec, the driver on the chip.

mod chip;
mod codec;
mod driver;
mod rig;
