//! From raw samples to the average of one dwell.

pub mod butterworth;
