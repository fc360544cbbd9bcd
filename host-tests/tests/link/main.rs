//! What goes over the link: sentences and messages as others read them.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod answers;
mod commands;
mod hearing;
mod messages;
mod positions;
mod receiver;
mod sentences;
