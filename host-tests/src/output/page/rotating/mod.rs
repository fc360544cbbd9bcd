//! The page of an alignment on a turning platform: papers/004's figures, and where σ comes from.

pub mod campaign;
mod figures;

use orientation::align::rotating::conclusion::Conclusion;

use super::budget;
use crate::output::rotating::json::{Stages, Stretch};
use crate::output::{azimuth_error, degrees, named};
use crate::recording::RotatingRow;
use crate::report::{Part as OfPage, Report, Table};
use crate::rotating::Replay;
use crate::rotating::part::Part;
use crate::rotating::turns::freed;

/// The page for a replay of `name`, whose rows are these.
#[must_use]
pub fn report(
    name: &str,
    replay: &Replay,
    conclusion: &Conclusion,
    rows: &[RotatingRow],
) -> Report {
    let parts = replay.parts(rows);
    let freed = match conclusion.couplings.first() {
        Some(coupling) => freed(rows, coupling.sine, coupling.quadrature),
        None => rows.to_vec(),
    };
    let mut page = tables(conclusion);
    page.extend(of_parts(&parts, &replay.parts(&freed)));
    Report {
        title: format!("Alignment on a turning platform: {name}"),
        subtitle: subtitle(replay, conclusion),
        parts: page,
    }
}

fn subtitle(replay: &Replay, conclusion: &Conclusion) -> Vec<String> {
    let mut lines = vec![match &conclusion.verdict {
        Ok(azimuth) => {
            let [angle, sigma] = [azimuth.angle, azimuth.sigma].map(degrees);
            format!("azimuth of body x {angle:.4}° ± {sigma:.4}° (1σ)")
        }
        Err(reason) => format!("no azimuth: {reason}"),
    }];
    if let Some(fit) = conclusion.fit.as_ref().filter(|_| replay.noise_is_known()) {
        lines.push(format!("limit {:.4}° (Cramér–Rao)", degrees(fit.limit)));
    }
    if let Some(coupling) = conclusion.couplings.first() {
        lines.push(format!("coupling {:.5}°", degrees(coupling.angle())));
    }
    lines
}

fn tables(conclusion: &Conclusion) -> Vec<OfPage> {
    let Some(fit) = &conclusion.fit else { return Vec::new() };
    let pairs = conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter]);
    let stretches: Vec<Stretch> = pairs.map(Stretch::from).collect();
    vec![stages(&fit.into()).into(), of_stretches(&stretches).into(), budget(&fit.budget).into()]
}

/// Spectra of every part as it came and freed of the coupling, then the phasors of its turns.
fn of_parts(parts: &[Part<'_>], freed: &[Part<'_>]) -> Vec<OfPage> {
    let mut page: Vec<OfPage> = Vec::new();
    for (part, freed) in parts.iter().zip(freed) {
        if !part.is_even {
            page.push(figures::profile(part).into());
        }
        page.push(figures::spectra(part, freed).into());
    }
    page.push(figures::platform(parts).into());
    page.push(figures::plane(freed).into());
    page.push(figures::residuals(freed).into());
    page
}

fn stages(stages: &Stages) -> Table {
    let full = stages.full_deg;
    let row = |(stage, azimuth): (&str, f64)| {
        let off = azimuth_error(azimuth, full);
        vec![stage.to_owned(), format!("{azimuth:.4}"), format!("{off:+.4}")]
    };
    Table {
        title: "Azimuth after each stage of compensation".to_owned(),
        head: named(&["stage", "azimuth, °", "from the last, °"]),
        rows: stages.named().map(row).to_vec(),
    }
}

fn of_stretches(stretches: &[Stretch]) -> Table {
    let row = |stretch: &Stretch| {
        vec![
            stretch.sense.clone(),
            format!("{:.5}", stretch.speed_hz),
            stretch.turns.to_string(),
            stretch.left_out.to_string(),
            format!("{:.2}", stretch.seconds),
            format!("{:.4}", 100.0 * stretch.unevenness),
        ]
    };
    Table {
        title: "Even turns".to_owned(),
        head: named(&["sense", "speed, Hz", "turns", "left out", "time, s", "uneven by, %"]),
        rows: stretches.iter().map(row).collect(),
    }
}
