//! The pages that `--report` writes: figures and tables of an alignment, a plan, a campaign.

pub mod alignment;
pub mod burov;
pub mod plan;
pub mod rotating;
