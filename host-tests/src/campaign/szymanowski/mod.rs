//! Azimuth from stops by simulation: Szymanowski's Table 1 over many drives, and vehicles that stand and
//! sway.

pub mod drives;
pub mod parked;
pub mod world;

use serde_json::json;

use super::statistics::Precision;
use super::{Asked, Campaign, Done, Tick, unless};
use crate::output::campaign;

/// Drives between stops, and parked vehicles.
pub(super) const CAMPAIGN: Campaign = Campaign {
    name: "szymanowski",
    meaning: "Azimuth from stops: Szymanowski's Table 1 over many drives, and vehicles that stand and sway",
    runs: 500,
    takes: &[],
    steps: "vehicles",
    count: |asked| (drives::COUNT + parked::COUNT) * asked.runs,
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where none was refused.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let (drives, parked) = (drives::rows(asked.runs, tick), parked::rows(asked.runs, tick));
    let standing = parked.iter().map(|row| &row.precision);
    let mut all = drives.iter().map(|row| &row.precision).chain(standing);
    Done {
        refusal: unless(all.all(Precision::is_complete), "a healthy vehicle was refused"),
        report: campaign::szymanowski::report(&drives, &parked),
        object: json!({ "drives": drives, "parked": parked }),
    }
}
