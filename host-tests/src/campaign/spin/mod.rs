//! The roll of a spinning body (Nekrasova 2017): the paper's figures, and what noise, a weak gyro and a lift
//! that fades do to each method.

pub mod cases;
pub mod paper;
pub mod world;

use serde_json::json;

use super::{Asked, Campaign, Done, Tick, unless};
use crate::output::campaign;

/// The paper's second, and flights with noise.
pub(super) const CAMPAIGN: Campaign = Campaign {
    name: "spin",
    meaning: "The roll of a spinning body: the figures of Nekrasova 2017, then noise, and a lift that fades",
    runs: 500,
    takes: &[],
    steps: "flights",
    count: |asked| cases::COUNT * asked.runs,
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where no roll was lost and no turn miscounted.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let (paper, rows) = (paper::paper(), cases::rows(asked.runs, tick));
    let found = rows.iter().all(|row| row.lost == 0 && row.miscounted == 0);
    Done {
        report: campaign::spin::report(&paper, &rows),
        refusal: unless(found, "a roll was lost, or a turn miscounted"),
        object: json!({ "paper": paper, "flights": rows }),
    }
}
