//! What the gyro's noise is, and how a fit is weighted for it.

pub mod model;
pub mod whitener;
