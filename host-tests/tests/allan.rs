//! The Allan variance on the target, and what is concluded from it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "allan/covariance.rs"]
mod covariance;
#[path = "allan/gyros.rs"]
mod gyros;
#[path = "allan/records.rs"]
mod records;
#[path = "allan/simulated.rs"]
mod simulated;
#[path = "allan/streaming.rs"]
mod streaming;
