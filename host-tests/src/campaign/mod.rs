//! Monte-Carlo campaigns: many simulated alignments, told as tables.

pub mod burov;
pub mod faults;
pub mod instrument;
pub mod rotating;
pub mod sokolov;
pub mod statistics;
