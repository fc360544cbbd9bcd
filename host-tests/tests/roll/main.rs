//! Holds the roll of a spinning body (equations.md §6) to closed forms and to what may go wrong.
#![allow(missing_docs)]
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

mod faults;
mod lock;
mod world;
