//! Gyro noise: its model, its measurement by Allan variance, and the whitening of dwells for a
//! weighted fit.
//!
//! ```text
//!  log σ │╲ Q, −1             record at rest ─▶ allan ─σ(τ)─▶ fit ─▶ Q N B K R
//!        │ ╲ N, −½     R, +1 ╱                                        │
//!        │  ╲__    K, +½ __╱                 dwells ─▶ whitener ◀─────┤
//!        │     ╲__ B, 0 _╱                              └─▶ rows ─▶ fit of a method
//!        └──────────────────── log τ                                  └─▶ planner
//! ```
//!
//! The Allan variance at the averaging time τ is the sum of five noises, each with a slope of its own:
//!
//! ```text
//! σ²(τ) = 3 Q²/τ² + N²/τ + (2 ln 2/π) B² + K² τ/3 + R² τ²/2
//! ```
//!
//! with quantisation Q, angle random walk N, bias instability B, rate random walk K and rate ramp R
//! (IEEE Std 952-1997).

pub mod allan;
pub mod fit;
pub mod model;
pub mod whitener;

pub(crate) use model::{GyroNoise, StatedNoise};
