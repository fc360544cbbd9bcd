//! The host's bench: recordings, replay, campaigns and their output.
#![forbid(unsafe_code)]

pub mod recording;
