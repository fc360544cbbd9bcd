//! The converter of the gyro: first the simulated chip against the data sheet and public start-up
//! sequences, then the codec and scale alone, then the driver on the simulated chip.

mod chip;
mod chip_misuse;
mod codec;
mod configuration;
mod driver;
mod driver_faults;
mod rig;
mod scale;
