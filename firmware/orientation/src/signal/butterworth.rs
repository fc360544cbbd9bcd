//! Butterworth low-pass sections in wide fixed point.
