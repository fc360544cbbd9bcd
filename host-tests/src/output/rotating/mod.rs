//! What the user sees of a platform that turns all the time: result block, JSON object, campaign.

pub mod campaign;
pub mod json;
pub mod text;

use orientation::align::rotating::average::Average;
use orientation::align::rotating::conclusion::Conclusion;
use orientation::align::rotating::solution::Fit;

use crate::rotating::Replay;

/// The averages of a conclusion, clockwise and counter-clockwise at each speed.
fn averages(conclusion: &Conclusion) -> impl Iterator<Item = &Average> {
    conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter])
}

/// Pitch and roll of the base, rad, from the tilt's phasor F = sin pitch + j sin roll cos pitch.
fn pitch_and_roll(fit: &Fit) -> [f64; 2] {
    let pitch = fit.tilt.re.clamp(-1.0, 1.0).asin();
    [pitch, (fit.tilt.im / pitch.cos()).clamp(-1.0, 1.0).asin()]
}

/// The tilt of the platform's axis, rad.
fn tilt(fit: &Fit) -> f64 {
    fit.tilt.size().min(1.0).asin()
}

/// Whether the sensor may have a g-sensitivity that integrates acceleration.
fn is_molecular(replay: &Replay) -> bool {
    replay.session.setting().sensor.molecular_sigma > 0.0
}

/// The names of the columns that the fits used.
fn columns(replay: &Replay, conclusion: &Conclusion) -> Vec<&'static str> {
    let mut names = vec!["cos", "sin", "1", "t"];
    if conclusion.couplings.is_empty() {
        return names;
    }
    names.extend(["stage rate", "stage acceleration"]);
    if is_molecular(replay) {
        names.extend(["sensor's gain and lag", "g-sensitivity over speed"]);
    }
    names
}
