//! Allan variance on the host: estimators against NIST's values, recordings at rest, and the
//! command.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "allan_host/estimators.rs"]
mod estimators;
#[path = "allan_host/recordings.rs"]
mod recordings;
