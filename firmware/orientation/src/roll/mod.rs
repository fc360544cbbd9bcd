//! Roll of a body that spins rapidly about its longitudinal axis (Nekrasova 2017).
//!
//! ```text
//!  x-gyro ─▶ angle ─────────────────┬─────────────────────────────▶ roll ± σ ─▶ attitude: course, pitch
//!  y, z forces ─▶ extrema ─γ := γₑ──▲   or   ─▶ sums of a turn ─▶ phase, scale ─▲
//! ```
//!
//! The lift q supports the body. With the roll γ, the rate ω and the distances `ρ_y` and `ρ_z` of the
//! accelerometers from the axis, they measure
//!
//! ```text
//!        y ▲ ↖ lift q     a_y =  q cos γ − ρ_y ω²
//!          │╲γ            a_z = −q sin γ − ρ_z ω²
//!          ●───▶ z
//! ```
//!
//! The gyro alone loses the angle by its scale error δk, which makes `δγ = δk ∫ω dt`: at 100 turns a
//! second and 0.1 %, 36° in a second. The forces correct it. At an extremum of either force the roll
//! is a multiple of 90°, as Nekrasova 2017 uses it; the phase of both forces over a turn uses every
//! sample, and from turn to turn shows δk, which then holds where the lift fades.
//!
//! Axes are those of Nekrasova 2017: x forward, y up and z right at roll zero, roll clockwise seen from behind.
//! On the axes of the rest of this crate the force to the right is `a_z`, the force down `−a_y`.

pub(crate) mod attitude;
mod circle;
mod extrema;
mod fit;
mod flight;
mod harmonics;
mod lock;
mod phase_accumulator;
mod plausibility;
pub(crate) mod progress;
mod setting;
mod spin;
mod state;

pub use self::extrema::Signal;
pub use self::flight::Flight;
pub use self::progress::Progress;
pub use self::setting::{Method, Setting};
pub use self::spin::Spin;
pub use self::state::{Accelerometer, Condition, State};
