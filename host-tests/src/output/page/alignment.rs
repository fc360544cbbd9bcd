//! The page of an alignment: the dwells against the fitted Earth rate, what is left of them, where σ
//! comes from.

use orientation::align::conclusion::Conclusion;
use orientation::align::stepwise::Fit;

use super::super::{degrees, degrees_per_hour};
use super::budget;
use crate::replay::Replay;
use crate::report::{Axis, Figure, Part, Report, Series, Style};

/// Places along the fitted curve.
const PLACES: u32 = 180;

/// The page for an alignment of `name`.
#[must_use]
pub fn report(name: &str, replay: &Replay, conclusion: &Conclusion) -> Report {
    let mut subtitle = vec![match &conclusion.verdict {
        Ok(azimuth) => format!(
            "azimuth of body x {:.4}° ± {:.4}° (1σ)",
            degrees(azimuth.angle),
            degrees(azimuth.sigma)
        ),
        Err(reason) => format!("no azimuth: {reason}"),
    }];
    let mut parts: Vec<Part> = Vec::new();
    if let Some(fit) = &conclusion.fit {
        subtitle.push(format!(
            "limit {:.4}° (Cramér–Rao); χ² {:.1} for {} degrees of freedom",
            degrees(fit.limit),
            fit.chi_square,
            fit.degrees
        ));
        parts.push(rates(replay, conclusion, fit).into());
        parts.push(residuals(replay, conclusion).into());
        parts.push(budget(&fit.budget).into());
    }
    Report { title: format!("Alignment: {name}"), subtitle, parts }
}

/// The rates over the stage angle, with what the fit makes of them.
fn rates(replay: &Replay, conclusion: &Conclusion, fit: &Fit) -> Figure {
    let points = |is_kept: bool| {
        let dwells = replay.session.dwells().iter().zip(&conclusion.disturbances);
        let chosen = dwells.filter(move |(_, why)| why.is_none() == is_kept);
        chosen.map(|(dwell, _)| (degrees(dwell.stage.rad()), degrees_per_hour(dwell.rate)))
    };
    let left_out = points(false).collect::<Vec<_>>();
    let mut series = vec![
        Series::new("Earth rate of the fit", Style::Line, fitted(replay, conclusion, fit)),
        Series::new("dwells", Style::Points, points(true)),
    ];
    if !left_out.is_empty() {
        series.push(Series::new("left out", Style::Points, left_out));
    }
    Figure {
        title: "Mean rate of each dwell".to_owned(),
        x: Axis::linear("stage angle", "°"),
        y: Axis::linear("rate", "°/h"),
        series,
    }
}

/// The fitted sinusoid on a level stage, with the mean of the dwells for its constant.
fn fitted(replay: &Replay, conclusion: &Conclusion, fit: &Fit) -> Vec<(f64, f64)> {
    let horizontal = degrees_per_hour(replay.setting.latitude.horizontal_rate());
    let azimuth = fit.direction.azimuth;
    let at = |angle: f64| horizontal * fit.direction.amplitude * (azimuth + angle).cos();
    let kept = replay.session.dwells().iter().zip(&conclusion.disturbances);
    let offsets: Vec<f64> = kept
        .filter(|(_, why)| why.is_none())
        .map(|(dwell, _)| degrees_per_hour(dwell.rate) - at(dwell.stage.rad()))
        .collect();
    let constant = offsets.iter().sum::<f64>() / offsets.len().max(1) as f64;
    let place = |i| f64::from(i) / f64::from(PLACES) * std::f64::consts::TAU;
    (0..=PLACES).map(place).map(|angle| (degrees(angle), at(angle) + constant)).collect()
}

/// What the fit leaves of each dwell, over time.
fn residuals(replay: &Replay, conclusion: &Conclusion) -> Figure {
    let dwells = replay.session.dwells().iter().zip(&conclusion.residuals);
    let kept = dwells.zip(&conclusion.disturbances).filter(|(_, why)| why.is_none());
    let points = kept.map(|((dwell, residual), _)| {
        let rate = degrees_per_hour(residual.rate);
        let sigma = if residual.studentised == 0.0 { 0.0 } else { rate / residual.studentised };
        (dwell.middle, rate, [rate - sigma.abs(), rate + sigma.abs()])
    });
    Figure {
        title: "Residuals, drift included, with what their studentised size makes of 1σ".to_owned(),
        x: Axis::linear("time", "s"),
        y: Axis::linear("residual", "°/h"),
        series: vec![Series::new("measured less fitted", Style::LineAndPoints, points)],
    }
}
