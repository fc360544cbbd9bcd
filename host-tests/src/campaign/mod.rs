//! Monte-Carlo campaigns: many simulated alignments, reported as tables; and their registry.
//!
//! A further campaign is an entry here; its world, its figures and its verdict stand in a folder of their own.

pub mod burov;
mod chance;
mod columns;
pub mod disturbed;
pub mod faults;
pub mod instrument;
pub mod keep;
pub mod rotating;
pub mod sokolov;
pub mod spin;
pub mod statistics;
pub mod szymanowski;

use orientation::alignment::site::Site;
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use serde_json::Value;
use simulated::fault::Platform;

use crate::report::Report;
use crate::work::{Follower, one_by_one, side_by_side};

/// What a user asks of a campaign.
#[derive(Clone, Debug)]
pub struct Asked {
    /// Runs of each row; some rows take a part of it.
    pub runs: usize,
    /// The only platform to run, of faults.
    pub platform: Option<Platform>,
    /// The only class to run, of disturbed.
    pub class: Option<String>,
}

/// Who is told of each step of a campaign, and may end it before the last one.
pub type Tick<'a> = &'a dyn Follower;

/// A campaign.
pub struct Campaign {
    /// Name of the campaign on the command line.
    pub name: &'static str,
    /// What the campaign runs, for the help.
    pub meaning: &'static str,
    /// Runs where no number is asked for.
    pub runs: usize,
    /// What its steps are called.
    pub steps: &'static str,
    /// How many steps it has.
    pub count: fn(&Asked) -> usize,
    /// Runs it; where it is to end early, what it gives rests on the runs that were done, and rows without one are left out.
    pub run: fn(&Asked, Tick<'_>) -> Result<Done, String>,
}

/// What a campaign gave, ready to be shown.
pub struct Done {
    /// JSON object of the campaign but for the status.
    pub object: Value,
    /// Text and page of the campaign.
    pub report: Report,
    /// Why it is no result, where it is none.
    pub refusal: Option<&'static str>,
}

/// The campaigns, in the order of the help.
pub static CAMPAIGNS: [Campaign; 9] = [
    sokolov::report::CAMPAIGN,
    burov::report::CAMPAIGN,
    rotating::report::CAMPAIGN,
    spin::report::CAMPAIGN,
    szymanowski::report::CAMPAIGN,
    keep::report::CAMPAIGN,
    instrument::report::CAMPAIGN,
    faults::report::CAMPAIGN,
    disturbed::report::CAMPAIGN,
];

/// A reason where something is not so.
fn unless(found: bool, reason: &'static str) -> Option<&'static str> {
    (!found).then_some(reason)
}

/// A site whose gyro has N, B, K and R, °/√h, °/h, °/h/√h and °/h².
///
/// # Panics
/// Where the latitude, °, is beyond ±90.
fn site(latitude_deg: f64, [n, b, k, r]: [f64; 4]) -> Site {
    let latitude = Latitude::from_degrees(latitude_deg).unwrap_or_else(|| unreachable!());
    let noise = StatedNoise::Whole(GyroNoise::from_field_units(n, b, k, r));
    Site { noise, ..Site::at(latitude) }
}

/// Golden angle, °.
const GOLDEN_ANGLE_DEG: f64 = 137.507_764;

/// The azimuth of a seed, °: those of successive seeds fill the circle evenly.
fn azimuth_deg(seed: u64) -> f64 {
    (GOLDEN_ANGLE_DEG * seed as f64) % 360.0
}

/// A tenth of the runs, or one.
fn tenth(runs: usize) -> usize {
    (runs / 10).max(1)
}

/// One result for each seed; for the first ones where the campaign ends early.
fn over<T: Send>(runs: usize, tick: Tick<'_>, of: impl Fn(u64) -> T + Send + Sync) -> Vec<T> {
    side_by_side(1..=runs as u64, tick, of)
}
