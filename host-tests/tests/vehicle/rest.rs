//! A vehicle that stands.
