//! The Allan variance on the target, and what is concluded from it.

mod covariance;
mod gyros;
mod records;
mod simulated;
mod streaming;
