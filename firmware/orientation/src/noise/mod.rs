//! Gyro noise: its model, its measurement by Allan variance, and the whitening of dwells for a
//! weighted fit.

pub mod allan;
pub mod fit;
pub mod model;
pub mod whitener;

pub(crate) use model::{GyroNoise, StatedNoise};
