//! The two-frame mount: kinematics against rotation matrices, the gimbal against the same, the fit with
//! elevation, and the whole instrument on simulated chips.

mod fit;
mod instrument;
mod kinematics;
mod oracle;
mod plant;
