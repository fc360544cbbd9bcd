//! Allan variance on the host: estimators against NIST's values, recordings at rest, and the
//! command.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "allan_host/command.rs"]
mod command;
#[path = "allan_host/confidence.rs"]
mod confidence;
#[path = "allan_host/estimators.rs"]
mod estimators;
#[path = "allan_host/recordings.rs"]
mod recordings;
