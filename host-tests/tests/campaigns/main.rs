//! Campaigns: a tenth of each in `.ci/run`, the whole of it, with the figures of `ACCURACY.md`, in `.ci/full`.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/mod.rs"]
mod support;

mod burov;
mod disturbed;
mod instrument;
mod interrupted;
mod keep;
mod rotating;
mod sokolov;
mod spin;
mod szymanowski;
