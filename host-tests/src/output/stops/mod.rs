//! What the user sees of a vehicle that stopped: result block, JSON object, campaign.

pub mod campaign;
pub mod json;
pub mod text;

use crate::stops::Replay;

/// The names of what a solution finds, all of it together.
fn columns(replay: &Replay) -> Vec<&'static str> {
    let setting = replay.session.setting();
    let common = &setting.common;
    let parts = [
        (true, "azimuth"),
        (true, "level"),
        (setting.bias_sigma() > 0.0, "gyro biases"),
        (common.scale_sigma > 0.0, "gyro scale factors"),
        (common.accelerometer_bias_sigma > 0.0, "accelerometer biases"),
        (common.latitude_sigma > 0.0, "latitude"),
        (replay.session.stops().len() > 1, "displacement"),
    ];
    parts.into_iter().filter_map(|(is_there, name)| is_there.then_some(name)).collect()
}
