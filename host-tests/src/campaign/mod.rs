//! Monte-Carlo campaigns: many simulated alignments, told as tables.

pub mod burov;
pub mod disturbed;
pub mod faults;
pub mod instrument;
pub mod keep;
pub mod rotating;
pub mod sokolov;
pub mod spin;
pub mod statistics;
pub mod szymanowski;

use rayon::prelude::*;

/// One result for each seed.
fn over<T: Send>(runs: usize, tick: &(impl Fn() + Sync), of: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let of = |seed| {
        let result = of(seed);
        tick();
        result
    };
    (1..=runs as u64).into_par_iter().map(of).collect()
}
