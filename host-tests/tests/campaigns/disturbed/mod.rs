//! Recordings with faults of any severity: what must not get past, and what must not be refused. A tenth of what
//! `.ci/full` draws by `meridian campaign disturbed`.

mod spin;
mod stage;
mod turning;
mod vehicle;

/// Runs of each class.
const RUNS: usize = 20;
