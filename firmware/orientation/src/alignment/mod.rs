//! Alignment methods: from dwell averages, the turns of a platform or the stops of a vehicle to an
//! azimuth with its standard deviation.

pub mod budget;
pub(crate) mod method;
pub mod period;
pub(crate) mod progress;
pub mod refusal;
pub mod rotating;
pub mod setup;
pub mod site;
pub mod slow;
pub mod stepwise;
pub mod stops;
pub(crate) mod verdict;

pub use method::{Input, Method, Request};
pub use progress::{Listener, Progress};
pub(crate) use refusal::refuse_if;
pub use refusal::{Passed, Refusal};
pub(crate) use setup::SetupError;
pub(crate) use slow::SlowMotion;
pub use verdict::{Azimuth, Judged, Solution, Verdict};
