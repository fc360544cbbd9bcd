//! The Allan variance on the target, and what is concluded from it.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "allan/streaming.rs"]
mod streaming;
