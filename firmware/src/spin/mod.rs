//! The instrument on a body in fast rotation. There is no alignment: the roll angle is tracked for
//! as long as the body flies.
//!
//! ```text
//!  three gyros ───────┬─▶ acquire ─sample─▶ flight: roll from the extrema, by phase lock ─▶ roll ± σ ─▶ link
//!  two accelerometers ┘                         └─▶ attitude: course and pitch by the gyros
//! ```

pub mod budget;
pub mod configuration;
