//! What the gyro's noise is, how it is measured, and how a fit is weighted for it.

pub mod allan;
pub mod fit;
pub mod model;
pub mod whitener;
