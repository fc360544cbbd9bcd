//! The page of an alignment from stops: the figures of Szymanowski 2003, and where σ comes from.

pub mod campaign;
mod figures;

use orientation::align::stops::conclusion::Conclusion;

use super::budget;
use crate::output::stops::json::{Object, Plain, Stop, object};
use crate::output::{degrees, named};
use crate::recording::Truth;
use crate::report::{Part, Report, Table};
use crate::stops::Replay;

/// The page for a replay of `name`.
#[must_use]
pub fn report(name: &str, replay: &Replay, conclusion: &Conclusion) -> Report {
    let object = object(replay, conclusion, &Truth::default());
    let mut parts: Vec<Part> = Vec::new();
    parts.extend(figures::azimuths(&object).map(Part::from));
    if let Some(found) = &conclusion.found {
        let plain = &found.plain;
        parts.extend(figures::inclinations(plain).map(Part::from));
        let latitude = replay.session.setting().common.latitude;
        let drive = seconds(&object.stops).map(|seconds| (plain, seconds));
        parts.push(figures::heading_error(latitude, drive).into());
        parts.extend(object.plain.as_ref().map(of_plain).map(Part::from));
    }
    parts.extend(figures::criteria(replay).into_iter().map(Part::from));
    if let Some(found) = &conclusion.found {
        parts.push(budget(&found.budget).into());
        parts.extend(of_biases(&object).map(Part::from));
    }
    parts.push(of_stops(&object.stops).into());
    Report {
        title: format!("Azimuth from stops: {name}"),
        subtitle: subtitle(&object, conclusion),
        parts,
    }
}

/// From the middle of the first stop to that of the last, s.
fn seconds(stops: &[Stop]) -> Option<f64> {
    let [first, .., last] = stops else { return None };
    Some(0.5 * (last.from_s + last.to_s - first.from_s - first.to_s))
}

fn subtitle(object: &Object, conclusion: &Conclusion) -> Vec<String> {
    let mut lines = vec![match &conclusion.verdict {
        Ok(azimuth) => {
            let [angle, sigma] = [azimuth.angle, azimuth.sigma].map(degrees);
            format!("azimuth of body x at the end {angle:.4}° ± {sigma:.4}° (1σ)")
        }
        Err(reason) => format!("no azimuth: {reason}"),
    }];
    if let Some((angle, sigma)) = object.start_azimuth_deg.zip(object.start_sigma_deg) {
        lines.push(format!("at the start {angle:.4}° ± {sigma:.4}° (1σ)"));
    }
    lines.extend(object.limit_deg.map(|limit| format!("limit {limit:.4}° (Cramér–Rao)")));
    lines
}

fn of_plain(plain: &Plain) -> Table {
    let row = |(form, azimuth): (&str, f64)| vec![form.to_owned(), format!("{azimuth:.7}")];
    let forms = [
        ("closed form", plain.start_azimuth_deg),
        ("least angle, Brent's search", plain.brent_deg),
        ("least √(ΔΘ² + ΔΦ²), Brent's search", plain.euler_deg),
    ];
    Table {
        title: format!("The paper's method: 1σ {:.4}°", plain.sigma_deg),
        head: named(&["form", "azimuth at the start, °"]),
        rows: forms.map(row).to_vec(),
    }
}

fn of_biases(object: &Object) -> Option<Table> {
    let (biases, sigmas) = object.bias_dph.zip(object.bias_sigma_dph)?;
    let row = |(axis, (bias, sigma)): (&str, (f64, f64))| {
        vec![axis.to_owned(), format!("{bias:+.4}"), format!("{sigma:.4}")]
    };
    let axes = ["forward", "right", "down"].into_iter();
    Some(Table {
        title: "Biases of the gyros".to_owned(),
        head: named(&["axis", "bias, °/h", "1σ, °/h"]),
        rows: axes.zip(biases.into_iter().zip(sigmas)).map(row).collect(),
    })
}

fn of_stops(stops: &[Stop]) -> Table {
    let row = |stop: &Stop| {
        let [north, east] = match stop.displacement_m {
            Some(displacement) => displacement.map(|part| format!("{part:.1}")),
            None => ["not known", ""].map(str::to_owned),
        };
        let times = [stop.from_s, stop.to_s].map(|time| format!("{time:.2}"));
        let angles = [stop.pitch_deg, stop.roll_deg].map(|angle| format!("{angle:.4}"));
        times.into_iter().chain(angles).chain([north, east]).collect()
    };
    Table {
        title: "Stops".to_owned(),
        head: named(&["from, s", "to, s", "pitch, °", "roll, °", "north, m", "east, m"]),
        rows: stops.iter().map(row).collect(),
    }
}
