//! Bytes that the other side of a link sends.

/// Bytes that 115 200 baud bring in a millisecond, at most.
pub const MILLISECOND: usize = 11;
/// When a board that is powered hears commands, ms.
pub const HEARS: usize = 2100;
