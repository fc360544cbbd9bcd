//! The report on an outcome: what was found at its head, then its parts and figures.

use orientation::alignment::budget::Source as Part;
use orientation::alignment::site::Site;
use orientation::units::Radians;

use super::{Excluded, Finished, FitDetails, Outcome, shown};
use crate::methods;
use crate::output::{
    azimuth as in_circle, counted, degrees, fixed, noise_in_words, positive_zero, signed,
};
use crate::recording::GIVEN;
use crate::report::{Lines, Part as ReportPart, Report, Rose, Share, Shares, Summary, Timeline};

/// The report on an outcome of what `name` names: what was found, the figures, then lines and tables.
pub fn report(
    name: &str,
    outcome: &Outcome,
    finished: &dyn Finished,
    figures: Vec<ReportPart>,
) -> Report {
    let budget = outcome.fit.as_ref().and_then(|fit| shares(fit, outcome.sigma_deg));
    let mut parts = figures;
    add_lanes(&mut parts, outcome);
    parts.extend(budget.map(ReportPart::from));
    parts.extend(outcome.parts.iter().cloned());
    parts.push(ReportPart::from(assumed(outcome)).detail());
    parts.extend(outcome.run.iter().flat_map(|run| run.parts.iter().cloned()));
    let [found, refused] = finished.titles();
    let title = match (outcome.has_result(), outcome.reason.is_some()) {
        (true, false) => format!("{found} {name}"),
        (true, true) => format!("{found} {name}, which was interrupted"),
        (false, _) => format!("{refused} {name}"),
    };
    Report::new(title, parts).headed(summary(outcome))
}

/// Adds what only a run knows of the time to the method's timeline, or makes one of it.
fn add_lanes(parts: &mut Vec<ReportPart>, outcome: &Outcome) {
    let Some(run) = &outcome.run else { return };
    let of_method = parts.iter_mut().find_map(|part| match part {
        ReportPart::Timeline(timeline) => Some(timeline),
        _ => None,
    });
    match of_method {
        Some(timeline) => timeline.lanes.extend(run.lanes.iter().cloned()),
        None => parts.push(Timeline::of(run.lanes.clone()).into()),
    }
}

/// What is said first of an outcome.
fn summary(outcome: &Outcome) -> Summary {
    let remarks = degradations(outcome);
    Summary {
        grade: outcome.grade(remarks.is_empty()),
        reasons: outcome.reason.iter().cloned().collect(),
        remarks,
        found: found(outcome),
        facts: facts(outcome).lines.into_iter().chain(more_facts(outcome)).collect(),
        circumstances: circumstances(outcome).lines,
        rose: rose(outcome),
    }
}

/// What takes from a result: what was left out, and what the board reports.
pub(super) fn degradations(outcome: &Outcome) -> Vec<String> {
    let excluded = outcome.fit.iter().flat_map(|fit| &fit.excluded);
    let left_out =
        excluded.map(|Excluded { words, reason, .. }| format!("left out: {words}{reason}"));
    let run = outcome.run.iter().flat_map(|run| run.degradations.iter().cloned());
    run.chain(left_out).chain(outcome.degradations.iter().cloned()).collect()
}

/// What was looked for, and what it is.
fn found(outcome: &Outcome) -> Option<[String; 2]> {
    let azimuth = outcome.azimuth_deg.zip(outcome.sigma_deg);
    let azimuth = azimuth.map(|(azimuth, sigma)| {
        ["azimuth of body x".to_owned(), format!("{}° ± {sigma:.4}° (1σ)", in_circle(azimuth, 4))]
    });
    azimuth.or_else(|| outcome.found.clone())
}

/// The azimuth for a compass.
fn rose(outcome: &Outcome) -> Option<Rose> {
    let (azimuth_deg, sigma_deg) = outcome.azimuth_deg.zip(outcome.sigma_deg)?;
    let truth_deg = outcome.error_deg.map(|error| (azimuth_deg - error).rem_euclid(360.0));
    Some(Rose { azimuth_deg, sigma_deg, limit_deg: outcome.limit_deg, truth_deg })
}

/// What every method says beside the result: the truth, the limit, the level.
fn facts(outcome: &Outcome) -> Lines {
    let found = outcome.azimuth_deg.zip(outcome.sigma_deg);
    let lines = Lines::default().with_found("truth", found.zip(outcome.error_deg).map(error));
    let Some(fit) = &outcome.fit else { return lines };
    lines
        .with_found("limit", limit(outcome))
        .with_found("pitch, roll", level(outcome))
        .with_found("Earth rate", earth_rate(fit))
}

/// What a method and a run add to that.
fn more_facts(outcome: &Outcome) -> impl Iterator<Item = [String; 2]> {
    let of_run = outcome.run.iter().flat_map(|run| &run.facts);
    outcome.facts.iter().chain(of_run).cloned()
}

/// Of what it was found: method, place, instrument, time, model.
fn circumstances(outcome: &Outcome) -> Lines {
    let method = methods::named(outcome.method).map(|method| method.meaning);
    let model = outcome.fit.as_ref().map(|fit| fit.model.join(", "));
    let mut lines = Lines::default().with_found("method", method);
    lines.lines.extend(outcome.circumstances.iter().cloned());
    lines.with_found("model", model.filter(|model| !model.is_empty()))
}

/// Place and gyro of a site.
pub(super) fn of_site(site: &Site) -> Lines {
    let noise = noise_in_words(site.noise.model(), site.noise.is_white_known());
    Lines::default()
        .with("place", format!("latitude {}°", fixed(degrees(site.latitude.rad()), 4)))
        .with("gyro", noise)
}

/// Place and gyro of a site, and the time that took part: of so many steps of this name, where there are any.
pub(crate) fn of_site_and_time(site: &Site, seconds: f64, (count, step): (usize, &str)) -> Lines {
    let time = || format!("{} s in {}", fixed(seconds, 1), counted(count, step));
    of_site(site).with_found("time", (count > 0).then(time))
}

/// The true azimuth, and what one that was found with its 1σ is off, °.
fn error(((azimuth, sigma), error): ((f64, f64), f64)) -> String {
    let truth = in_circle(azimuth - error, 4);
    format!("{truth}°: the error is {}°, {} σ", signed(error, 4), signed(error / sigma, 2))
}

fn limit(outcome: &Outcome) -> Option<String> {
    match outcome.limit_deg {
        Some(limit) => Some(format!("{limit:.4}° (Cramér–Rao for the stated noise)")),
        None => {
            outcome.has_result().then(|| "none: the noise is estimated from the data".to_owned())
        }
    }
}

fn level(outcome: &Outcome) -> Option<String> {
    let Some((pitch, roll)) = outcome.pitch_deg.zip(outcome.roll_deg) else {
        return outcome.has_result().then(|| "not measured".to_owned());
    };
    let [pitch, roll] = [pitch, roll].map(|angle| positive_zero(angle, 5e-5));
    Some(format!("{pitch:.4}°, {roll:.4}°"))
}

fn earth_rate(fit: &FitDetails) -> Option<String> {
    match fit.earth_rate_ratio.zip(fit.earth_rate_ratio_sigma) {
        Some((ratio, sigma)) => Some(format!("{ratio:.4} ± {sigma:.4} of that expected")),
        None => fit.budget.map(|_| "taken for granted: the data do not show it".to_owned()),
    }
}

/// What was assumed, one thing a line; that a board was given the rest is known of every run.
fn assumed(outcome: &Outcome) -> Lines {
    let all = outcome.assumed.iter().filter(|what| *what != GIVEN).enumerate();
    let number = |index: usize| (index + 1).to_string();
    all.fold(Lines::new("What was assumed where nothing states it"), |lines, (index, what)| {
        lines.with(&number(index), what.clone())
    })
}

/// Part of σ that must be left beside the budget of the fit to be told.
const BESIDE: f64 = 1e-3;

/// The parts of σ with each part's share of the variance; none without a fit. The budget is that of maximum likelihood: what
/// another criterion loses beside it is a part of its own.
fn shares(fit: &FitDetails, sigma_deg: Option<f64>) -> Option<Shares> {
    let details = fit.budget.as_ref()?;
    let budget = &details.0;
    let (all_deg, excess) = (budget.sigma().degrees(), fit.excess.unwrap_or(1.0));
    let sigma_deg = sigma_deg.unwrap_or(all_deg).max(all_deg);
    let share = |name: String, part_deg: f64| Share {
        name,
        value: format!("{part_deg:.4}"),
        percent: 100.0 * (part_deg / sigma_deg) * (part_deg / sigma_deg),
    };
    let of_source = |(source, part): (Part, Radians)| {
        let name = match fit.more_noise.filter(|_| source == Part::Noise) {
            Some(more) => format!("{source}, {more}"),
            None => source.to_string(),
        };
        share(name, part.degrees())
    };
    let lost_deg = (sigma_deg * sigma_deg - all_deg * all_deg).sqrt();
    let lost = (sigma_deg > (1.0 + BESIDE) * all_deg)
        .then(|| share("criterion, beside maximum likelihood".to_owned(), lost_deg));
    let dominant =
        budget.dominant(excess).map(|source| format!(": {source} dominates{}", remedy(source)));
    Some(Shares {
        title: format!("Error budget (1σ of the azimuth){}", dominant.unwrap_or_default()),
        head: ["source", "part, °", "share of the variance, %"].map(str::to_owned),
        rows: shown(budget.parts_of(excess)).map(of_source).chain(lost).collect(),
        sum: ["root sum of squares".to_owned(), format!("{sigma_deg:.4}")],
    })
}

/// What helps against a part that dominates.
fn remedy(source: Part) -> &'static str {
    match source {
        Part::GSensitivity => {
            ": level the platform mechanically, or calibrate the g-sensitivity at two tilts"
        }
        Part::Accelerometer => ": turn a full circle, or calibrate the accelerometer",
        Part::Scale => ": turn a longer arc, or calibrate the scale factor",
        Part::Drift | Part::Temperature => ": let the gyro settle, or repeat the circle faster",
        _ => "",
    }
}
