//! From dwell averages to an azimuth with its standard deviation.

pub mod etalon;
