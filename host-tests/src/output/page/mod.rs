//! The pages that `--report` writes: figures and tables of an alignment, a plan, a campaign.

pub mod alignment;
pub mod burov;
pub mod keep;
pub mod plan;
pub mod rotating;
pub mod spin;
pub mod stops;
pub mod vertical;

use orientation::align::budget::Budget;

use super::{degrees, parts};
use crate::report::Table;

/// Where σ comes from.
fn budget(budget: &Budget) -> Table {
    let row = |(source, part): (_, f64)| -> Vec<String> {
        let share = 100.0 * (part / budget.sigma()).powi(2);
        vec![format!("{source}"), format!("{:.4}", degrees(part)), format!("{share:.1}")]
    };
    Table {
        title: "Error budget (1σ of the azimuth)".to_owned(),
        head: ["source", "part, °", "share of the variance, %"].map(str::to_owned).to_vec(),
        rows: parts(budget).map(row).collect(),
    }
}
