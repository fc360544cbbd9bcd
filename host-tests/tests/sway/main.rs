//! The base's sway: its estimate against closed forms, and the instrument on a base that sways.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod command;
mod estimator;
mod instrument;
mod whitening;
