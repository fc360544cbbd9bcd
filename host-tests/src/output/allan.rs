//! What `meridian allan` shows: the text, the JSON object, the page.

mod page;

use std::fmt::{self, Write};

use orientation::noise::fit::{Estimate, FitError, NoiseFit};
use orientation::units::DEGREE_PER_HOUR;
use serde_json::{Map, Value, json};

use super::degrees_per_hour;
use super::line;
use crate::allan::analysis::{Analysis, Confident, Rest};
use crate::allan::speed::Comparison;
use crate::planning::Suggestion;

/// χ² over its degrees of freedom beyond which the model does not fit.
const MISFIT: f64 = 3.0;

/// What is to be shown.
pub struct Shown<'a> {
    /// The file's name.
    pub name: &'a str,
    /// The record.
    pub rest: &'a Rest,
    /// What it says, or why it says nothing.
    pub analysis: &'a Result<Analysis, FitError>,
    /// How both estimators did, where it says something.
    pub comparison: Option<Comparison>,
    /// The schedule that suits this noise, where one is planned.
    pub schedule: Option<Suggestion>,
}

/// A coefficient of the noise.
struct Coefficient {
    name: &'static str,
    unit: &'static str,
    key: &'static str,
    /// In SI units.
    si: Estimate,
    /// In the unit of data sheets.
    estimate: Estimate,
}

/// Q, N, B, K and R, in the order of [`orientation::noise::allan::terms`].
fn coefficients(fit: &NoiseFit) -> [Coefficient; 5] {
    let [q, n, b, k, r] = fit.in_field_units().map(|(_, estimate)| estimate);
    [
        ("Q quantisation", "arcsec", "q_arcsec", fit.quantisation, q),
        ("N angle random walk", "°/√h", "n_deg_sqrt_h", fit.angle_random_walk, n),
        ("B bias instability", "°/h", "b_deg_h", fit.bias_instability, b),
        ("K rate random walk", "°/h/√h", "k_deg_h_sqrt_h", fit.rate_random_walk, k),
        ("R rate ramp", "°/h²", "r_deg_h2", fit.rate_ramp, r),
    ]
    .map(|(name, unit, key, si, estimate)| Coefficient { name, unit, key, si, estimate })
}

impl Coefficient {
    /// The value with its unit, or that there is none.
    fn told(&self) -> String {
        let unit = self.unit;
        match self.estimate {
            Estimate::Found { value, sigma } => {
                // Two digits of σ.
                let decimals = (1.0 - sigma.log10().floor()).clamp(0.0, 12.0) as usize;
                format!("{value:.decimals$} ± {sigma:.decimals$} {unit}")
            }
            Estimate::NotObservable { at_most } => {
                let decimals = (1.0 - at_most.log10().floor()).clamp(0.0, 12.0) as usize;
                format!("not observable in this record (at most {at_most:.decimals$} {unit})")
            }
        }
    }
}

impl Shown<'_> {
    /// Writes the result for people.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn text(&self, out: &mut impl Write) -> fmt::Result {
        match self.analysis {
            Ok(_) => writeln!(out, "\nNoise of {} in {}\n", self.rest.column, self.name)?,
            Err(reason) => {
                writeln!(out, "\nNo noise from {} in {}\n", self.rest.column, self.name)?;
                line(out, "reason", format_args!("{reason}"))?;
            }
        }
        line(out, "record", format_args!("{}", self.record()))?;
        for note in self.notes() {
            line(out, "noted", format_args!("{note}"))?;
        }
        if let Ok(analysis) = self.analysis {
            of_analysis(out, analysis)?;
        }
        if let Some(comparison) = &self.comparison {
            speed(out, comparison)?;
        }
        match &self.schedule {
            Some(schedule) => line(out, "schedule", format_args!("{schedule}")),
            None => Ok(()),
        }
    }

    /// What is to be known of the record, and of what the fit leaves open.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let fit = self.analysis.as_ref().ok().map(|analysis| &analysis.fit);
        let seconds = self.rest.rates.len() as f64 * self.rest.spacing.period_s;
        let misfit = fit.filter(|fit| fit.chi_square > MISFIT * fit.degrees as f64).map(|_| {
            "the Allan variance does not follow the noise model: something else moves the rate, and the \
             coefficients say little"
                .to_owned()
        });
        let hidden = fit.filter(|fit| fit.rate_ramp.value().is_some());
        let hidden = hidden.and_then(|fit| fit.hidden_slope(seconds)).map(|slope| {
            let slope = slope / DEGREE_PER_HOUR * 3600.0;
            format!("a random walk that is not observable may hide beside the ramp: ± {slope:.3} °/h² then")
        });
        self.rest.notes().into_iter().chain(misfit).chain(hidden).collect()
    }

    /// How much there is of it.
    fn record(&self) -> String {
        let (samples, period) = (self.rest.rates.len(), self.rest.spacing.period_s);
        let segments = self.rest.spacing.gaps.len() + 1;
        let plural = if segments == 1 { "" } else { "s" };
        let (rate, seconds) = (1.0 / period, samples as f64 * period);
        let rate = short(rate);
        format!("{samples} samples at {rate} Hz, {seconds:.1} s in {segments} segment{plural}")
    }

    /// The same as one object.
    #[must_use]
    pub fn object(&self) -> Value {
        let reason = self.analysis.as_ref().err().map(ToString::to_string);
        let mut object = Map::new();
        let mut set = |key: &str, value: Value| object.insert(key.to_owned(), value);
        set("status", if reason.is_none() { "ok" } else { "refused" }.into());
        if let Some(reason) = reason {
            set("reason", reason.into());
        }
        set("column", self.rest.column.into());
        set("samples", self.rest.rates.len().into());
        set("rate_hz", (1.0 / self.rest.spacing.period_s).into());
        set("gaps", self.gaps());
        set("notes", self.notes().into());
        if let Ok(analysis) = self.analysis {
            object.extend(deviations(analysis));
            object.extend(coefficients(&analysis.fit).iter().flat_map(entries));
            object.extend(quality(analysis, self.comparison.as_ref()));
        }
        object.insert("schedule".to_owned(), json!(self.schedule.map(|s| s.0)));
        object.insert("schedule_angles".to_owned(), "at the equator; times sec φ elsewhere".into());
        object.into()
    }

    fn gaps(&self) -> Value {
        let gaps = self.rest.spacing.gaps.iter();
        gaps.map(|gap| json!({"line": gap.line, "from_s": gap.from_s, "seconds": gap.seconds}))
            .collect()
    }
}

fn of_analysis(out: &mut impl Write, analysis: &Analysis) -> fmt::Result {
    let fit = &analysis.fit;
    let (chi, degrees) = (fit.chi_square, fit.degrees);
    line(out, "residuals", format_args!("χ² {chi:.1} for {degrees} degrees of freedom"))?;
    writeln!(out, "\n  coefficients (± 1σ)")?;
    for coefficient in coefficients(fit) {
        writeln!(out, "    {:<22} {}", coefficient.name, coefficient.told())?;
    }
    writeln!(out, "\n  overlapping Allan deviation with its limits of 68.3 %")?;
    writeln!(
        out,
        "    {:>10} {:>13} {:>13} {:>13} {:>10}",
        "τ, s", "σ, °/h", "lower, °/h", "upper, °/h", "freedom"
    )?;
    for row in rows(analysis) {
        let [tau, deviation, lower, upper, degrees] = row;
        writeln!(out, "    {tau:>10} {deviation:>13} {lower:>13} {upper:>13} {degrees:>10}")?;
    }
    writeln!(out)
}

/// The points, ready to print: τ, deviation, limits, degrees of freedom.
fn rows(analysis: &Analysis) -> impl Iterator<Item = [String; 5]> {
    analysis.points.iter().map(|point| {
        let [deviation, lower, upper] =
            [point.deviation, point.limits[0], point.limits[1]].map(|rate| {
                let rate = degrees_per_hour(rate);
                let decimals = (4.0 - rate.log10().floor()).clamp(0.0, 9.0) as usize;
                format!("{rate:.decimals$}")
            });
        [short(point.seconds), deviation, lower, upper, format!("{:.1}", point.degrees)]
    })
}

/// A number with six decimal places but without zeros at the end.
fn short(number: f64) -> String {
    format!("{number:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn speed(out: &mut impl Write, comparison: &Comparison) -> fmt::Result {
    let Comparison { streaming, batch, points, difference } = comparison;
    let [streaming, batch] = [streaming, batch].map(|rate| rate / 1e6);
    line(
        out,
        "streaming",
        format_args!("{streaming:.2} million samples/s, the board's estimator on this machine"),
    )?;
    line(out, "batch", format_args!("{batch:.2} million samples/s, every window"))?;
    line(
        out,
        "agreement",
        format_args!(
            "variances of the same windows differ by at most {difference:.1e} at {points} τ"
        ),
    )
}

/// The curve as arrays.
fn deviations(analysis: &Analysis) -> Map<String, Value> {
    let rates = |rate: fn(&Confident) -> f64| -> Value {
        analysis.points.iter().map(|point| degrees_per_hour(rate(point))).collect()
    };
    let arrays = [
        ("tau_s", analysis.points.iter().map(|point| point.seconds).collect()),
        ("adev_deg_h", rates(|point| point.deviation)),
        ("lower", rates(|point| point.limits[0])),
        ("upper", rates(|point| point.limits[1])),
        ("terms", analysis.points.iter().map(|point| point.terms).collect()),
        ("degrees_of_freedom", analysis.points.iter().map(|point| point.degrees).collect()),
    ];
    arrays.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// A coefficient with its deviation, or nothing with what it does not exceed.
fn entries(coefficient: &Coefficient) -> [(String, Value); 2] {
    let key = coefficient.key;
    match coefficient.estimate {
        Estimate::Found { value, sigma } => {
            [(key.to_owned(), value.into()), (format!("{key}_sigma"), sigma.into())]
        }
        Estimate::NotObservable { at_most } => {
            [(key.to_owned(), Value::Null), (format!("{key}_at_most"), at_most.into())]
        }
    }
}

/// How well the fit and the estimators did.
fn quality(analysis: &Analysis, comparison: Option<&Comparison>) -> [(String, Value); 5] {
    let fit = &analysis.fit;
    [
        ("chi_square", fit.chi_square.into()),
        ("fit_degrees", fit.degrees.into()),
        ("streaming_samples_s", comparison.map(|both| both.streaming).into()),
        ("batch_samples_s", comparison.map(|both| both.batch).into()),
        ("streaming_difference", comparison.map(|both| both.difference).into()),
    ]
    .map(|(key, value)| (key.to_owned(), value))
}
