//! The board's image with a fault: what happens today, said plainly. Where that is bad, a test says how it should be, and
//! is expected to fail with today's figure (`defect`); `DEFECTS.md` lists it.
//!
//! An image is built for each carrier that is needed, unless `MERIDIAN_IMAGES` names a folder that has them, as
//! `board-stage.elf`.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/board.rs"]
mod board;
#[path = "../support/defect.rs"]
mod defect;
mod hung;
#[path = "../support/images.rs"]
mod images;
mod power;
mod readme;
mod saving;
mod stopped;
mod store;
mod supply;
mod turning;
