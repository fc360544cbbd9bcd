//! The chips of the orientation board, one folder a chip: registers, a pure codec, a thin async shell.
//!
//! ```text
//!  fibre-optic gyro ─volts─▶ ads1262 ─▶ rate        stage ─▶ mt6835  ─▶ angle
//!  platform ─────────force─▶ adxl355 ─▶ force       motor ◀─ tmc5160 ◀─ position
//!  base ─────rates, forces─▶ lsm6dsl ─▶ sway
//! ```
//!
//! The instrument reaches a chip by a port, which `chips.rs` of the crate `firmware` makes of its driver.
//!
//! A codec converts bytes to units and back without a bus, so it can be tested alone; a shell makes
//! the transfers on [`embedded_hal_async`] and nothing else. Every reading is either valid or a
//! [`Fault`](fault::Fault) that names its remedy. A driver never blocks for ever and never repeats
//! by itself: repetitions are limited by the instrument's retry budget.
#![no_std]
#![forbid(unsafe_code)]

pub mod ads1262;
pub mod adxl355;
pub mod data_ready;
pub mod fault;
pub mod lsm6dsl;
pub mod mt6835;
pub mod pause;
pub mod tmc5160;
