//! Campaigns: a tenth of each with every `cargo test`, the whole of it, with the README's figures, in `.ci/full`.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod burov;
mod campaign;
mod disturbed;
mod keep_campaign;
mod keep_readme;
mod rotating_campaign;
mod rotating_readme;
mod spin_readme;
mod stops_campaign;
mod stops_readme;
mod turning_faults;
