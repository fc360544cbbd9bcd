//! What came of an alignment, as data: the keys that all methods share, once each, and what a method adds.
//!
//! Every method hands over a [`Finished`] analysis, of a recording or of a simulated run. From it come
//! the JSON object, the text and the page; text and page are one [`Report`](crate::report::Report), whose figures only the page
//! shows.

mod figures;
pub mod kept;
pub mod keys;
pub mod run;
mod summary;

use orientation::alignment::Azimuth;
use orientation::alignment::budget::Budget;
use orientation::alignment::budget::Source as Part;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise;
use orientation::units::Radians;
use serde::{Serialize, Serializer};

pub(crate) use self::summary::of_site_and_time;
pub use self::summary::report;

use self::keys::Keys;
use self::run::RunDetails;
use crate::cause::Cause;
use crate::methods::asked::Question;
use crate::methods::vertical::Moment;
use crate::output::{azimuth_error, in_number, signed};
use crate::recording::{Body, Truth};
use crate::report::{Grade, Part as ReportPart};

/// Version of the JSON object. A key that changes its meaning or its unit, or goes, raises it; a further key does not.
pub const SCHEMA: u32 = 1;

/// What is shown of what was interrupted.
const SO_FAR: &str = "what was done until then is shown";

/// A finished analysis of a recording or of a simulated run, whatever the method.
pub trait Finished {
    /// What was found. The truth is for errors alone.
    fn outcome(&self, truth: &Truth) -> Outcome;

    /// How texts and pages begin, before the name of what was analysed: with a result, and without one.
    fn titles(&self) -> [&'static str; 2] {
        ["True north found in", "No azimuth from"]
    }

    /// Figures and the timeline of the page. The truth is for errors alone; `body` holds the rows that were analysed,
    /// where there are any.
    fn figures(&self, _outcome: &Outcome, _truth: &Truth, _body: Option<&Body>) -> Vec<ReportPart> {
        Vec::new()
    }

    /// The attitude after each sample, of a method that keeps one.
    fn attitude(&self) -> Option<&[Moment]> {
        None
    }

    /// What a refusal of a recording is likely to come from, with its remedy; `None` where nothing points
    /// to a cause.
    fn cause(&self, _of: &Question) -> Option<Cause> {
        None
    }
}

/// Where the samples came from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Source {
    /// A recording, by the name that the user gave.
    File(String),
    /// A simulated run, by its seed.
    Seed(u64),
}

/// The result of any method on a recording or on a simulated run, as its JSON object has it.
#[must_use]
#[derive(Debug, Default, Serialize)]
pub struct Outcome {
    /// Version of the object, [`SCHEMA`].
    pub schema: u32,
    /// The recording's `file`, or the run's `seed`.
    #[serde(flatten)]
    pub source: Option<Source>,
    /// Name of the method on the command line.
    pub method: &'static str,
    /// `ok`, `refused` or `interrupted`; `failed` on the command line where a file could not be written.
    pub status: Grade,
    /// Why the result is refused, or where it was interrupted; not with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// How that reason ends where it names the usual remedy, which a likelier cause takes the place of.
    #[serde(skip)]
    pub remedy: &'static str,
    /// Azimuth of body x at the end of the recording, from true north, clockwise from above, [0, 360) °; only
    /// with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth_deg: Option<f64>,
    /// 1σ, °, of what the method finds: the azimuth, the roll of a spinning body, either angle of the level; only with
    /// `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_deg: Option<f64>,
    /// Found less true, within ±180 °, where the truth is known; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_deg: Option<f64>,
    /// Cramér–Rao bound of `sigma_deg`, °: for the columns of `model` and all samples at rest that took part;
    /// null where the noise is not stated, or where there is no fit.
    pub limit_deg: Option<f64>,
    /// Pitch of the body at the end, nose up positive, °; null where it was not measured.
    pub pitch_deg: Option<f64>,
    /// Roll of the body at the end, right side down positive, °; null where it was not measured.
    pub roll_deg: Option<f64>,
    /// Time that took part, s: of dwells, whole turns or stops, or the whole recording.
    pub seconds: f64,
    /// What an azimuth rests on; only of methods that give one.
    #[serde(flatten)]
    pub fit: Option<FitDetails>,
    /// What the method adds: further keys.
    #[serde(flatten)]
    pub details: Keys,
    /// What was found in words, quantity and value, of a method that looks for no azimuth; only with `ok`.
    #[serde(skip)]
    pub found: Option<[String; 2]>,
    /// What else is said first of it: label and value.
    #[serde(skip)]
    pub facts: Vec<[String; 2]>,
    /// What takes from the result, in words.
    #[serde(skip)]
    pub degradations: Vec<String>,
    /// Place, instrument and time in words: label and value.
    #[serde(skip)]
    pub circumstances: Vec<[String; 2]>,
    /// Lines and tables of the report beyond those that every method has.
    #[serde(skip)]
    pub parts: Vec<ReportPart>,
    /// What only a simulated run has.
    #[serde(flatten)]
    pub run: Option<RunDetails>,
    /// What was assumed where nothing states it.
    pub assumed: Vec<String>,
}

/// What an azimuth rests on.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FitDetails {
    /// The 1σ parts of σ, °; null where there is no fit.
    pub budget: Option<BudgetDetails>,
    /// What the part of the noise holds beside the gyro's.
    #[serde(skip)]
    pub more_noise: Option<&'static str>,
    /// Factor on noise and drift of the budget, because what was fitted scatters more than both; none without a fit.
    #[serde(skip)]
    pub excess: Option<f64>,
    /// The greatest part beside noise, where it makes up more than half of the variance.
    pub dominant: Option<String>,
    /// Dwells, whole turns or stops that took part.
    pub positions: usize,
    /// Earth rate found over that expected, `Ω̂_h/Ω_h`; null where it is taken for granted.
    pub earth_rate_ratio: Option<f64>,
    /// 1σ of the ratio.
    pub earth_rate_ratio_sigma: Option<f64>,
    /// Columns of the model that was fitted.
    pub model: Vec<&'static str>,
    /// What was left out, and why.
    pub excluded: Vec<Excluded>,
}

/// An outcome as its object has it, with what takes from the result in words.
#[derive(Debug, Serialize)]
pub struct Noted<'o> {
    #[serde(flatten)]
    outcome: &'o Outcome,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    noted: Vec<String>,
}

/// The 1σ parts of σ, serialised in degrees under the names of their sources.
#[derive(Clone, Copy, Debug)]
pub struct BudgetDetails(Budget);

/// These parts of a budget; a displacement only where a vehicle drove, and what scatters beyond noise and drift only where
/// something does.
fn shown<const N: usize>(parts: [(Part, Radians); N]) -> impl Iterator<Item = (Part, Radians)> {
    let is_rare = |source| matches!(source, Part::Displacement | Part::Scatter);
    parts.into_iter().filter(move |(source, part)| !is_rare(*source) || part.0 > 0.0)
}

impl Serialize for BudgetDetails {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(shown(self.0.parts()).map(|(source, part)| (source, part.degrees())))
    }
}

/// A dwell, turns, or part of a stop that took no part.
#[derive(Clone, Debug, Serialize)]
pub struct Excluded {
    /// What it is.
    #[serde(flatten)]
    pub place: Keys,
    /// The beginning of the sentence that the reason ends, with what it is.
    #[serde(skip)]
    pub words: String,
    /// Why it took no part.
    pub reason: String,
}

impl FitDetails {
    /// What an azimuth rests on, of the budget of its fit, where there is one.
    /// `excess` is the factor on its noise and drift.
    pub fn of(budget: Option<&Budget>, excess: f64, positions: usize) -> Self {
        let dominant = budget.and_then(|budget| budget.dominant(excess));
        Self {
            budget: budget.copied().map(BudgetDetails),
            dominant: dominant.map(|source| source.to_string()),
            excess: Some(excess),
            positions,
            ..Self::default()
        }
    }
}

impl Outcome {
    /// An outcome of a method, with nothing found yet.
    pub fn new(method: &'static str, details: Keys, parts: Vec<ReportPart>) -> Self {
        Self { schema: SCHEMA, method, status: Grade::Refused, details, parts, ..Self::default() }
    }

    /// The outcome of a session that was not given its end.
    pub fn unfinished(method: &'static str) -> Self {
        let this = Self::new(method, Keys::default(), Vec::new());
        this.settled(Some("the session did not end".to_owned()))
    }

    /// The outcome with the verdict of an alignment; `truth_deg` is for its error alone.
    pub fn judged(self, verdict: &Result<Azimuth, Refusal>, truth_deg: Option<f64>) -> Self {
        let azimuth = verdict.as_ref().ok();
        let found = azimuth.map(|azimuth| azimuth.angle.degrees());
        let has_north = !matches!(verdict, Err(Refusal::LatitudeTooHigh { .. }));
        let this = if has_north { self } else { self.without_north() };
        Self {
            azimuth_deg: found,
            sigma_deg: azimuth.map(|azimuth| azimuth.sigma.degrees()),
            error_deg: found.zip(truth_deg).map(|(azimuth, truth)| azimuth_error(azimuth, truth)),
            remedy: verdict.as_ref().err().map_or("", Refusal::remedy),
            ..this.settled(verdict.as_ref().err().map(in_words))
        }
    }

    /// Without what would be counted in a horizontal Earth rate that is none, or next to it.
    fn without_north(self) -> Self {
        let (budget, dominant, earth_rate_ratio, earth_rate_ratio_sigma) = Default::default();
        let fit = self.fit.map(|fit| FitDetails {
            budget,
            dominant,
            earth_rate_ratio,
            earth_rate_ratio_sigma,
            ..fit
        });
        Self { fit, limit_deg: None, ..self }
    }

    /// The outcome with its status: refused where there is a reason.
    pub fn settled(self, reason: Option<String>) -> Self {
        let status = if reason.is_none() { Grade::Found } else { Grade::Refused };
        // A sum of nothing is −0.
        Self { status, reason, seconds: self.seconds + 0.0, ..self }
    }

    /// The outcome of what was interrupted while it measured, as the reason says. A result of a part of what was to be
    /// measured is none, but its 1σ is told; what goes on from sample to sample stands as it was at the last one.
    pub fn cut_short(self, why: String) -> Self {
        let status = Grade::Interrupted;
        match (&self.fit, &self.reason) {
            (None, None) => return self.interrupted(&why),
            (None, Some(reason)) => {
                let reason = Some(format!("{why}; {reason}"));
                return Self { status, reason, remedy: "", ..self };
            }
            _ => {}
        }
        let budget = self.fit.as_ref().and_then(|fit| fit.budget);
        let so_far = budget.map(|BudgetDetails(budget)| {
            format!("; what was measured until then gives 1σ of {:.4}°", budget.sigma().degrees())
        });
        let reason = why + &so_far.unwrap_or_default();
        Self { status, remedy: "", ..self.withdrawn(reason) }
    }

    /// The outcome of what was interrupted after it had its result, as the reason says: what was found is shown as it was
    /// then, but it is no run that came to its end. A refusal stays one.
    pub fn interrupted(self, why: &str) -> Self {
        match self.reason {
            Some(reason) => Self { reason: Some(format!("{reason}; {why}")), ..self },
            None => Self {
                status: Grade::Interrupted,
                reason: Some(format!("{why}: {SO_FAR}")),
                ..self
            },
        }
    }

    /// The outcome without its azimuth, for a reason.
    fn withdrawn(self, reason: String) -> Self {
        let (azimuth_deg, sigma_deg, error_deg) = Default::default();
        Self { azimuth_deg, sigma_deg, error_deg, ..self.settled(Some(reason)) }
    }

    /// The outcome with what takes from the result, as text and page tell it.
    #[must_use]
    pub fn noted(&self) -> Noted<'_> {
        Noted { outcome: self, noted: summary::degradations(self) }
    }

    /// The roll of a spinning body at the last sample, within a turn, °, where it was found.
    #[must_use]
    pub fn roll_end_deg(&self) -> Option<f64> {
        let turned = self.details.number("roll_rad_end")?;
        Some(turned.to_degrees().rem_euclid(360.0))
    }

    /// What came of it, of which status, exit code, heading and badge follow; `is_clean` where nothing takes from it.
    fn grade(&self, is_clean: bool) -> Grade {
        match (self.reason.is_none(), is_clean) {
            (true, true) => Grade::Found,
            (true, false) => Grade::Degraded,
            (false, _) if self.status == Grade::Interrupted => Grade::Interrupted,
            (false, _) => Grade::Refused,
        }
    }

    /// Whether something was found that stands, also where it was interrupted afterwards.
    pub(crate) fn has_result(&self) -> bool {
        let is_found = self.sigma_deg.is_some() || self.found.is_some();
        self.reason.is_none() || self.grade(true) == Grade::Interrupted && is_found
    }
}

/// Why there is no azimuth, with the option that helps, which the core does not know.
fn in_words(refusal: &Refusal) -> String {
    match refusal {
        Refusal::Stepwise(stepwise::Refusal::SignUnknown) => {
            format!("{refusal}: --half east, or --half west")
        }
        _ => in_number(&refusal.to_string()),
    }
}

/// Biases of the gyros forward, right and down, and their 1σ, °/h, in words with so many decimal places.
pub(crate) fn of_biases([biases, sigmas]: [[f64; 3]; 2], places: usize) -> String {
    let both = biases.iter().zip(sigmas);
    let each = both.map(|(bias, sigma)| format!("{} ± {sigma:.places$}", signed(*bias, places)));
    format!("{} °/h forward, right, down", each.collect::<Vec<_>>().join(", "))
}
