//! Recordings of a platform that turns all the time: replay through the session, and what figures need.

pub mod part;
pub mod turns;
