//! The two-frame mount: kinematics against rotation matrices, the gimbal against the same, the fit with
//! elevation, and the whole instrument on simulated chips.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "mount/fit.rs"]
mod fit;
#[path = "mount/instrument.rs"]
mod instrument;
#[path = "mount/kinematics.rs"]
mod kinematics;
#[path = "mount/oracle.rs"]
mod oracle;
#[path = "mount/plant.rs"]
mod plant;
