//! What the user sees of a vehicle that stopped: result block, JSON object, campaign.

pub mod campaign;
pub mod json;
pub mod text;

use crate::stops::core::Conclusion;

/// The names of what a solution found.
fn columns(conclusion: &Conclusion) -> Vec<&'static str> {
    let mut names = vec!["azimuth"];
    if conclusion.biases.is_some() {
        names.push("gyro biases");
    }
    names
}
