//! The link to an instrument from the other side: commands go out as sentences, and their answers are found among all that
//! the instrument sends meanwhile.
//!
//! ```text
//!  address ─▶ port ─bytes─▶ hearing ─answers─▶ conversation ─▶ reply
//!                              └─▶ heard: what else came, which says why nothing was answered
//! ```

pub mod address;
pub mod conversation;
pub mod heard;
pub mod hearing;
pub mod port;
pub mod records;
pub mod words;
