//! The board's image with a fault: how it ends, and what tells of it.
//!
//! An image is built for each carrier that is needed, unless `MERIDIAN_IMAGES` names a folder that has them, as
//! `board-stage.elf`.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/board.rs"]
mod board;
mod changing;
#[path = "../support/figure.rs"]
mod figure;
mod held;
mod hung;
#[path = "../support/images.rs"]
mod images;
mod kept;
mod power;
mod readme;
mod saving;
#[path = "../../../../host-tests/tests/support/sentences.rs"]
mod sentences;
mod silent;
mod stopped;
mod store;
mod supply;
mod turning;
