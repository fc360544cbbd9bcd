//! What the instrument sends and takes over its link, as pure codecs: numbers in, bytes out, and back.
//!
//! | module | what it is |
//! |---|---|
//! | [`report`] | the instrument's attitude and state, of which all that is sent is made |
//! | [`nmea`] | sentences of NMEA 0183 |
//! | [`mavlink`] | messages of MAVLink 2 |
//! | [`command`] | commands as lines of text |
//! | [`answer`] | the answers to them |
//! | [`position`] | the latitude that a satellite receiver states |
//! | [`receiver`] | lines and frames among the bytes that are received |
//! | [`words`] | words for people, in parts that a sentence or a message takes |
//!
//! Whatever format is sent: an azimuth that is not ready goes with its sign, the mode of THS, or not at all, but for the
//! messages of one whose level gyros alone carry.
#![no_std]
#![forbid(unsafe_code)]

pub mod answer;
pub mod command;
pub mod mavlink;
pub mod nmea;
pub mod position;
pub mod receiver;
pub mod report;
pub mod words;
