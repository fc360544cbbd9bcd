//! The outcome of a run, where there is an alignment and where an azimuth is only kept.

use orientation::alignment::site::Site;

use super::keys::Keys;
use super::run::RunDetails;
use super::summary::of_site;
use super::{Finished, Outcome, Source};
use crate::instrument::kept::Point;
use crate::output::fixed;
use crate::recording::Truth;

/// A run whose azimuth is kept while no alignment's conclusion stands: it came from outside, or the session was begun
/// anew at a stop. The azimuth is the one that is kept at the end.
#[derive(Clone, Debug)]
pub struct KeptAzimuth {
    /// Place and gyro, in words.
    circumstances: Vec<[String; 2]>,
}

/// What an alignment at a site found, or that its azimuth was kept where none of a run stands.
#[must_use]
pub fn finished(
    is_aligned: bool,
    site: &Site,
    alignment: impl Finished + 'static,
) -> Box<dyn Finished> {
    if is_aligned {
        return Box::new(alignment);
    }
    Box::new(KeptAzimuth { circumstances: of_site(site).lines })
}

impl Finished for KeptAzimuth {
    fn outcome(&self, _: &Truth) -> Outcome {
        let circumstances = self.circumstances.clone();
        Outcome { circumstances, ..Outcome::new("kept", Keys::default(), Vec::new()) }
    }

    fn titles(&self) -> [&'static str; 2] {
        ["Azimuth kept in", "No azimuth kept in"]
    }
}

impl Outcome {
    /// The outcome with what only a run has; what was kept stands for an alignment where there is none. An azimuth that
    /// the board withdrew, because it and what was kept disagree, is no result; nor is one of an alignment that was cut
    /// short.
    pub fn of_run(self, source: Source, run: RunDetails) -> Self {
        let (cut_short, interruption) = (run.cut_short.clone(), run.interruption.clone());
        let this = self.with_run(source, run);
        match (cut_short, interruption) {
            (Some(why), _) => this.cut_short(why),
            (None, Some(why)) => this.interrupted(&why),
            (None, None) => this,
        }
    }

    fn with_run(self, source: Source, run: RunDetails) -> Self {
        let this = Self { source: Some(source), ..self };
        if !this.details.is_empty() {
            let this = match run.disagreement.filter(|_| this.has_result()) {
                Some(sigmas) => this.disagreeing(sigmas),
                None => this,
            };
            return Self { run: Some(run), ..this };
        }
        this.keeping(run)
    }

    /// The outcome of a run that only kept an azimuth.
    fn keeping(self, mut run: RunDetails) -> Self {
        // The reason tells it.
        run.degradations.retain(|remark| Some(remark) != run.lost.as_ref());
        let last = run.kept.as_ref();
        let azimuth = last.and_then(Point::azimuth_deg);
        // For how long one was kept that is lost, the reason tells.
        let since = last.filter(|_| azimuth.is_some()).map(|last| last.report.seconds.0);
        let time = since.map(|seconds| format!("kept for {} s", fixed(seconds, 1)));
        let mut circumstances = self.circumstances;
        circumstances.extend(time.map(|time| ["time".to_owned(), time]));
        let refused = run.refused.as_ref();
        let unknown = || match refused {
            Some(why) => format!("no alignment found it: the latest was refused {why}"),
            None => "the azimuth is not known yet".to_owned(),
        };
        let reason = azimuth.is_none().then(|| run.lost.clone().unwrap_or_else(unknown));
        Self {
            azimuth_deg: azimuth.map(|[azimuth, ..]| azimuth),
            sigma_deg: azimuth.map(|[_, sigma, _]| sigma),
            error_deg: azimuth.map(|[.., error]| error).filter(|error| !error.is_nan()),
            pitch_deg: last.map(|last| last.report.pitch.degrees()),
            roll_deg: last.map(|last| last.report.roll.degrees()),
            seconds: last.map_or(0.0, |last| last.report.seconds.0),
            run: Some(run),
            circumstances,
            ..self
        }
        .settled(reason)
    }

    /// The outcome of an alignment whose azimuth disagrees by so many σ with what was kept.
    fn disagreeing(self, sigmas: f64) -> Self {
        let reason = format!(
            "the azimuth found disagrees with what was kept, by {sigmas:.1} σ: neither is believed"
        );
        self.withdrawn(reason)
    }
}
