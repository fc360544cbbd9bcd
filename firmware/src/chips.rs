//! The drivers as ports.
