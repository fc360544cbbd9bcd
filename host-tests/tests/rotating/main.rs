//! Holds the north finder on a platform that turns all the time to closed forms, to plain arithmetic
//! written here, and to the truth of a simulated platform (equations.md §4).
#![allow(missing_docs)]
#![allow(clippy::unwrap_used, dead_code)]
#![allow(clippy::expect_used, reason = "a test that cannot go on has failed")]

mod integrity;
mod outcome;
mod platform_faults;
mod rig;
mod sensor_faults;
