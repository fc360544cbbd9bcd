//! The roll of a spinning body: recordings by all three methods, the Cramér–Rao bound against its closed
//! form, what goes wrong with lift, spin and sensors, the instrument on simulated chips, the times of its
//! samples, and the commands.

mod budget;
mod commands;
mod faults;
mod instrument;
mod limit;
mod recordings;
mod times;
