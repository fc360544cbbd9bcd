//! The sensors' noise.
