//! The host's runs in the worlds of the images that are executed.

use embassy_time::Instant;
use firmware::event::Event;
use firmware::platform::Platform;
use orientation::alignment::Progress;
use simulated::executed;

use crate::instrument::{Run, Trial};

/// The azimuth that the instrument finds on the host in the world of a carrier, °; none where it finds none, as on a
/// spinning body.
///
/// # Errors
/// What keeps the run from beginning.
pub fn azimuth_deg(carrier: Platform, seed: u64) -> Result<Option<f64>, String> {
    let failed = |error: crate::instrument::RunError| format!("the host's run: {error}");
    Ok(match carrier {
        Platform::Stage => first(&Trial::of(&executed::stage(seed)).run().map_err(failed)?),
        Platform::TwoFrame => first(&Trial::of(&executed::two_frames(seed)).run().map_err(failed)?),
        Platform::Turntable => first(&Trial::of(&executed::turntable(seed)).run().map_err(failed)?),
        Platform::Vehicle => first(&Trial::of(&executed::vehicle(seed)).run().map_err(failed)?),
        Platform::Spin => None,
    })
}

/// The azimuth of the first alignment that has ended, °.
fn first<R, T>(run: &Run<R, T>) -> Option<f64> {
    run.events.iter().find_map(|(_, event): &(Instant, Event)| match event {
        Event::Alignment(Progress::Concluded(solution)) => Some(solution.azimuth.angle.degrees()),
        _ => None,
    })
}
