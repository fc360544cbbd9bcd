//! The program as it is started: its options, its errors, the client of its link, and the images that are built for it.

#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "../support/angles.rs"]
mod angles;
mod building;
#[allow(dead_code, reason = "these tests need the files of images alone")]
#[path = "../support/images.rs"]
mod images;
mod link;
mod options;
mod setting_up;
mod started;
