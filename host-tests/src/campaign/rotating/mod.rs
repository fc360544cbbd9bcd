//! Dynamic north finding by simulation: papers/004 with the figures of equations.md §4.

pub mod world;
