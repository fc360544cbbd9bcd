//! What is known is kept: an azimuth through the time after its alignment.

pub mod stored;
