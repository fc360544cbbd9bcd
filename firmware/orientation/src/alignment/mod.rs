//! Alignment methods: from dwell averages, the turns of a platform or the stops of a vehicle to an
//! azimuth with its standard deviation.

pub mod budget;
pub mod period;
pub mod refusal;
pub mod rotating;
pub mod setup;
pub mod site;
pub mod slow;
pub mod stepwise;
pub mod stops;
pub mod verdict;

pub use verdict::Azimuth;
