//! The instrument: the same application on the board, in the emulator and on the host.
//!
//! ```text
//!  gyro ──────┐
//!  encoder ───┼─▶ acquire ─sample─▶ runner (filter, dwell, session) ─▶ azimuth ± σ ─▶ link
//!  force ─────┘      │ angle           │ command                    └▶ observer (log)
//!                    └────────────▶ stage ─▶ motor
//! ```
//!
//! A two-frame mount has two encoders and two motors: [`pointing`] and [`gimbal`] stand for encoder and
//! stage then. On a platform that turns all the time, the [`turntable`] stands for the stage, and commands
//! are rates. In a vehicle nothing turns the gyros: three of them and the accelerometer make the samples, and
//! the session tells who drives when to stop and go. On a [`spin`]ning body nothing looks for north: its roll
//! is followed.
//!
//! [`run::acquire`] samples, [`run::run`] joins the other parts in fixed order; they know no pin, no
//! bus and no clock but `embassy-time`'s. What they need from the outside are the traits of [`ports`];
//! [`chips`] gives them to the drivers of the `drivers` crate. What happens is told once, as an
//! [`event::Event`].
#![no_std]
#![forbid(unsafe_code)]

pub mod ports;

pub mod chips;

pub mod acquire;
pub mod calibration;
pub mod guarded;
pub mod pointing;
pub mod retry_budget;
pub mod steady;
pub mod timeline;

pub mod gimbal;
pub mod keep;
pub mod motor;
pub mod runner;
pub mod stage;
pub mod turntable;

pub mod date;
pub mod event;
pub mod health;
pub mod link;

pub mod configuration;
pub mod run;
pub mod shared;
pub mod spin;
pub mod storage;

#[cfg(feature = "defmt")]
pub mod log;

#[cfg(feature = "simulated")]
pub mod simulated;
