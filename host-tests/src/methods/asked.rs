//! What a user asks of a replay, whatever the method.

use orientation::align::criterion::Criterion;
use orientation::align::setting::Half;
use orientation::earth::Latitude;

/// What a user asks of a replay, whatever the method.
#[derive(Clone, Debug)]
pub struct Asked {
    /// Latitude instead of the header's.
    pub latitude: Option<Latitude>,
    /// How the azimuth is found; of a stage that stops.
    pub criterion: Criterion,
    /// The half of the circle in which the azimuth lies, where that is known; of a stage that stops.
    pub half: Option<Half>,
    /// Displacements of the stops, north and east, m, instead of the header's; of a vehicle.
    pub displacements_m: Option<Vec<[f64; 2]>>,
    /// Greatest accepted 1σ, rad.
    pub required_sigma: Option<f64>,
}

impl Default for Asked {
    fn default() -> Self {
        let criterion = Criterion::MaximumLikelihood;
        let (latitude, half, displacements_m, required_sigma) = (None, None, None, None);
        Self { latitude, criterion, half, displacements_m, required_sigma }
    }
}
