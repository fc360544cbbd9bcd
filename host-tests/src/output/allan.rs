//! What `meridian allan` shows: the text, the JSON object, the page.

mod page;

use orientation::noise::fit::{Estimate, FitError, NoiseFit};
use orientation::units::{DEGREE_PER_HOUR, Seconds};
use serde_json::{Value, json};

use super::{degrees_per_hour, places_of, printable, significant, to_sigma};
use crate::allan::analysis::{Analysis, Confident};
use crate::allan::rest::Rest;
use crate::outcome::SCHEMA;
use crate::outcome::keys::Keys;
use crate::planning::Planned;
use crate::recording::Gap;
use crate::report::{Grade, Lines, Report, Summary};

/// χ² over its degrees of freedom beyond which the model does not fit.
const MISFIT: f64 = 3.0;

/// What is to be shown.
pub struct Shown<'a> {
    /// The file's name.
    pub name: &'a str,
    /// The record.
    pub rest: &'a Rest,
    /// Noise that the record shows, or why it shows none.
    pub analysis: &'a Result<Analysis, FitError>,
    /// The schedule that suits this noise, and in words, where one is planned.
    pub schedule: Option<(Planned, String)>,
}

/// A coefficient of the noise.
struct Coefficient {
    name: &'static str,
    unit: &'static str,
    key: &'static str,
    /// Its place among the terms of the variance.
    term: usize,
    /// In SI units.
    si: Estimate,
    /// In the unit of data sheets.
    estimate: Estimate,
}

/// N, B, K, R and Q: what is asked for first stands first. With each its place among [`orientation::noise::allan::terms`].
fn coefficients(fit: &NoiseFit) -> [Coefficient; 5] {
    let names = [
        (1, "N angle random walk", "°/√h", "n_deg_sqrt_h"),
        (2, "B bias instability", "°/h", "b_deg_h"),
        (3, "K rate random walk", "°/h/√h", "k_deg_h_sqrt_h"),
        (4, "R rate ramp", "°/h²", "r_deg_h2"),
        (0, "Q quantisation", "arcsec", "q_arcsec"),
    ];
    let in_field_units = fit.in_field_units();
    names.map(|(term, name, unit, key)| {
        let (si, (_, estimate)) = (fit.estimates[term], in_field_units[term]);
        Coefficient { name, unit, key, term, si, estimate }
    })
}

impl Coefficient {
    /// Adds the coefficient, with its 1σ or what it is at most.
    fn add(&self, keys: Keys) -> Keys {
        let key = self.key;
        match self.estimate {
            Estimate::Found { value, sigma } => {
                keys.with(key, value).with(&format!("{key}_sigma"), sigma)
            }
            Estimate::NotObservable { at_most } => {
                keys.with(key, ()).with(&format!("{key}_at_most"), at_most)
            }
        }
    }

    /// The value with its unit, or that there is none.
    fn text(&self) -> String {
        let unit = self.unit;
        match self.estimate {
            Estimate::Found { value, sigma } => {
                let [value, sigma] = to_sigma(value, sigma);
                format!("{value} ± {sigma} {unit}")
            }
            Estimate::NotObservable { at_most } => {
                let decimals = places_of(at_most);
                format!("not observable in this record (at most {at_most:.decimals$} {unit})")
            }
        }
    }
}

impl Shown<'_> {
    /// The report for terminal and page: the record, the noise that it shows, and the schedule that suits it.
    pub fn report(&self) -> Report {
        let analysis = self.analysis.as_ref();
        let parts = analysis.into_iter().flat_map(page::parts);
        let found = if self.analysis.is_ok() { "Noise of" } else { "No noise from" };
        let title = printable(&format!("{found} {} in {}", self.rest.column, self.name));
        Report::new(title, parts).headed(self.summary())
    }

    /// The coefficients, the record that shows them, and the schedule that they suggest; or why there are none.
    fn summary(&self) -> Summary {
        let analysis = self.analysis.as_ref();
        let coefficients = analysis.ok().map(|analysis| coefficients(&analysis.fit));
        let mut all: Vec<[String; 2]> = coefficients
            .iter()
            .flatten()
            .map(|coefficient| [coefficient.name.to_owned(), coefficient.text()])
            .collect();
        let is_found = |at: &Coefficient| matches!(at.estimate, Estimate::Found { .. });
        let first = coefficients.iter().flatten().position(is_found);
        let found = first.map(|first| all.remove(first));
        let residuals = |Analysis { fit: NoiseFit { chi_square, degrees, .. }, .. }: &Analysis| {
            format!("χ² {chi_square:.1} for {degrees} degrees of freedom")
        };
        let record = Lines::default()
            .with_found("schedule", self.schedule.as_ref().map(|(_, words)| words))
            .with("record", self.record())
            .with_found("noted", self.notes())
            .with_found("residuals", analysis.ok().map(residuals));
        all.extend(record.lines);
        Summary {
            grade: self.grade(),
            reasons: analysis.err().map(ToString::to_string).into_iter().collect(),
            found,
            facts: all,
            ..Summary::default()
        }
    }

    /// What came of it; a doubt takes from the coefficients, what is left out does not.
    fn grade(&self) -> Grade {
        match (self.analysis.is_ok(), self.rest.interruption()) {
            (_, Some(_)) => Grade::Interrupted,
            (false, None) => Grade::Refused,
            (true, None) if self.doubts().is_empty() => Grade::Found,
            (true, None) => Grade::Degraded,
        }
    }

    /// What is to be known of the record, and of what the fit leaves open.
    pub(crate) fn notes(&self) -> Vec<String> {
        let fit = self.analysis.as_ref().ok().map(|analysis| &analysis.fit);
        let seconds = self.rest.samples as f64 * self.rest.spacing.period_s;
        let hidden = fit.filter(|fit| matches!(fit.estimates, [.., Estimate::Found { .. }]));
        let hidden = hidden.and_then(|fit| fit.hidden_slope(Seconds(seconds))).map(|slope| {
            let slope = slope.0 / DEGREE_PER_HOUR * 3600.0;
            format!("a random walk that is not observable may hide beside the ramp: ± {slope:.3} °/h² then")
        });
        self.rest.notes().into_iter().chain(self.misfit()).chain(hidden).collect()
    }

    /// Why the coefficients may be wrong.
    #[must_use]
    pub fn doubts(&self) -> Vec<String> {
        self.rest.unit_notes().into_iter().chain(self.misfit()).collect()
    }

    /// That the noise model does not fit.
    fn misfit(&self) -> Option<String> {
        let fit = &self.analysis.as_ref().ok()?.fit;
        (fit.chi_square > MISFIT * fit.degrees as f64).then(|| {
            "the Allan variance does not follow the noise model: something else moves the rate, and the \
             coefficients say little"
                .to_owned()
        })
    }

    /// How much there is of it.
    fn record(&self) -> String {
        let (samples, period) = (self.rest.samples, self.rest.spacing.period_s);
        let segments = self.rest.spacing.gap_count + 1;
        let plural = if segments == 1 { "" } else { "s" };
        let (rate, seconds) = (1.0 / period, samples as f64 * period);
        let rate = short(rate);
        let mean = significant(degrees_per_hour(self.rest.mean()), 3);
        format!(
            "{samples} samples at {rate} Hz, {seconds:.1} s in {segments} segment{plural}; read in s and rad/s: mean rate \
             {mean} °/h"
        )
    }

    /// The analysis as one JSON object.
    pub fn object(&self) -> Keys {
        let reason = self.analysis.as_ref().err().map(ToString::to_string);
        let rest = self.rest;
        let gap =
            |gap: &Gap| json!({"line": gap.line, "from_s": gap.from_s, "seconds": gap.seconds});
        Keys::default()
            .with("schema", SCHEMA)
            .with("file", self.name)
            .with("status", self.grade().status())
            .with_found("reason", reason)
            .with("column", &rest.column)
            .with("samples", rest.samples)
            .with("rate_hz", 1.0 / rest.spacing.period_s)
            .with("gaps", rest.spacing.gaps.iter().map(gap).collect::<Value>())
            .with("notes", self.notes())
            .with_all(self.analysis.as_ref().ok().map(found).as_ref())
            .with("schedule", self.schedule.as_ref().map(|(planned, _)| planned))
            .with("schedule_angles", "at the equator; times sec φ elsewhere")
    }
}

/// The Allan deviations and what was fitted to them.
fn found(analysis: &Analysis) -> Keys {
    let coefficients = coefficients(&analysis.fit).into_iter();
    coefficients
        .fold(deviations(&analysis.points), |keys, it| it.add(keys))
        .with("chi_square", analysis.fit.chi_square)
        .with("fit_degrees", analysis.fit.degrees)
}

/// A number with six decimal places but without zeros at the end.
fn short(number: f64) -> String {
    format!("{number:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The curve as arrays.
fn deviations(points: &[Confident]) -> Keys {
    let column = |of: fn(&Confident) -> f64| points.iter().map(of).collect::<Vec<_>>();
    Keys::default()
        .with("tau_s", column(|point| point.seconds))
        .with("adev_deg_h", column(|point| degrees_per_hour(point.deviation)))
        .with("lower", column(|point| degrees_per_hour(point.limits[0])))
        .with("upper", column(|point| degrees_per_hour(point.limits[1])))
        .with("terms", points.iter().map(|point| point.terms).collect::<Vec<_>>())
        .with("degrees_of_freedom", column(|point| point.degrees))
}
