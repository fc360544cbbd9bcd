//! The outcome of a run, where there is an alignment and where an azimuth is only kept.

use super::run::{KeptDetails, RunDetails};
use super::{Finished, NoDetails, Outcome, Source};
use crate::recording::Truth;

/// A run whose azimuth is kept while no alignment's conclusion stands: it came from outside, or the session was begun
/// anew at a stop. The azimuth is the one that is kept at the end.
#[derive(Clone, Copy, Debug)]
pub struct KeptAzimuth;

impl Finished for KeptAzimuth {
    fn outcome(&self, _: &Truth) -> Outcome {
        Outcome::new("kept", NoDetails {})
    }

    fn titles(&self) -> [&'static str; 2] {
        ["Azimuth kept in", "No azimuth kept in"]
    }
}

impl Outcome {
    /// The outcome with what only a run has; what was kept stands for an alignment where there is none.
    #[must_use]
    pub fn of_run(self, seed: u64, run: RunDetails) -> Self {
        let this = Self { source: Some(Source::Seed(seed)), ..self };
        if this.details::<NoDetails>().is_none() {
            return Self { run: Some(run), ..this };
        }
        let of = |value: fn(&KeptDetails) -> Option<f64>| run.kept.as_ref().and_then(value);
        let azimuth_deg = of(|kept| kept.azimuth_deg);
        let reason = azimuth_deg.is_none().then(|| "the azimuth is not known any more".to_owned());
        Self {
            azimuth_deg,
            sigma_deg: of(|kept| kept.sigma_deg),
            error_deg: of(|kept| kept.error_deg),
            pitch_deg: of(|kept| Some(kept.pitch_deg)),
            roll_deg: of(|kept| Some(kept.roll_deg)),
            seconds: of(|kept| Some(kept.seconds)).unwrap_or_default(),
            run: Some(run),
            ..this
        }
        .settled(reason)
    }
}
