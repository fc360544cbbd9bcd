//! What an instrument does from power-on: it aligns, then holds azimuth, pitch and roll, and aligns
//! anew where its policy says so.
//!
//! ```text
//!  samples ──▶ Aligner (a method) ──┬─▶ request ─▶ mechanism
//!                ▲ order    azimuth │
//!                │                  ▼
//!  motion ────▶ Navigator (keeper) ─┴─▶ report, heading to be saved
//! ```
//!
//! Both halves are pure: time is in their events, so that a recording replays what an instrument
//! did. The navigator is bounded per event and never waits; the aligner computes plans and
//! conclusions in calls of their own.

pub mod aligner;
pub mod navigator;
pub(crate) mod policy;
pub mod progress;
mod rates;

pub use aligner::Aligner;
pub use navigator::{Input, Motion, Navigator, Output};
pub use policy::{Policy, Realignment};
pub use progress::Progress;

use crate::alignment::Refusal;

/// Order to the aligner.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Order {
    /// End the alignment in progress, because the instrument has failed or the vehicle has set off.
    Fail(Refusal),
    /// Skip the alignment in progress, because the azimuth is known otherwise.
    Skip,
    /// Begin another alignment.
    Restart,
}
