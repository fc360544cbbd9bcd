//! Recordings in CSV.
