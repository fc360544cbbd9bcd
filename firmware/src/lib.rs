//! The application of the instrument, the same on the board, in the emulator and on the host.
//!
//! ```text
//!  gyro ──────┐
//!  encoder ───┼─▶ acquire ─sample─▶ aligner (method) ─azimuth─▶ navigator ─▶ link, flash
//!  force ─────┘   │    │ angle        │ request          ▲ │ order  ▲
//!  base ──────────┴────┼──────────────┼──────── motion ──┴─┼────────┘ aiding
//!                      └────────────▶ mechanism ◀──────────┘      all ─▶ observer (log)
//! ```
//!
//! A two-frame mount has two encoders and two motors; [`pointing`] and [`gimbal`] take the place of
//! encoder and stage then. On a platform in continuous rotation, the [`turntable`] takes the place
//! of the stage, and the requests are rates. In a vehicle the gyros are fixed to the body: three
//! gyros and the accelerometer give the samples, and the method asks the driver to stop and to
//! drive on. On a [`spin`]ning body there is no alignment; its roll angle is tracked.
//!
//! [`acquire::acquire`] samples, and [`run`] joins the other parts in fixed order: the
//! aligner ([`align`]), the navigator ([`mod@keep`]), the [`mechanism`], and beside them the
//! conversation over the link, a crate of its own. They know no pin, no bus, and no clock other
//! than `embassy-time`'s. The traits of [`ports`] describe what they need from outside; [`chips`]
//! implements them by the drivers of the `drivers` crate.
//! Whatever happens is reported once, as an [`event::Event`].
#![no_std]
#![forbid(unsafe_code)]
#![expect(
    async_fn_in_trait,
    reason = "a future stays in the executor that polls it first: none needs to be Send"
)]

pub mod ports;

pub mod chips;

pub mod acquire;
pub mod align;
pub mod budget;
pub mod calibration;
pub mod guarded;
pub mod output_clock;
pub mod pointing;
mod repeat_counter;
pub mod retry_budget;
pub mod timeline;

pub mod gimbal;
pub mod keep;
pub mod mechanism;
pub mod motor;
pub mod stage;
pub mod sway;
pub mod turntable;

pub mod check_ins;
pub mod date;
pub mod event;
pub mod health;
pub mod kept_lines;
pub mod not_begun;
pub mod remembered;
pub mod status;
pub mod watch;

pub mod configuration;
pub mod crossing;
pub mod platform;
pub mod postmortem;
pub mod run;
pub mod settings;
pub mod shared;
pub mod spin;
pub mod storage;

#[cfg(feature = "defmt")]
pub mod log;
