//! Monte-Carlo campaigns: many simulated alignments, told as tables.

pub mod sokolov;
pub mod statistics;
