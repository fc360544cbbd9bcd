//! The pages that `--report` writes for a plan or a campaign.

pub mod burov;
pub mod keep;
pub mod plan;
pub mod rotating;
pub mod spin;
pub mod stops;
