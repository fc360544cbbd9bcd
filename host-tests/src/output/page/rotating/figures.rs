//! The figures: papers/004's profile of the uneven turn, its spectra, and the phasors of each turn.

use rustfft::num_complex::Complex;

use crate::output::degrees_per_hour;
use crate::recording::RotatingRow;
use crate::report::{Axis, Figure, Series, Style};
use crate::rotating::part::Part;
use crate::rotating::turns::{Signal, phasors, spectrum, turn_hz};

/// Points of a profile; more would not be told apart.
const PROFILE_POINTS: usize = 1500;
/// Multiples of the turn's frequency that a spectrum shows.
const MULTIPLES: f64 = 6.0;

/// How the platform's rate went over time.
pub fn profile(part: &Part<'_>) -> Figure {
    let step = part.rows.len().div_ceil(PROFILE_POINTS).max(1);
    let points = part.rows.iter().step_by(step).map(|row| (row.time_s, row.stage_rate_rad_s));
    Figure {
        title: format!("Rate of the platform, {part}"),
        x: Axis::linear("time", "s"),
        y: Axis::linear("rate", "rad/s"),
        series: vec![Series::new("encoder", Style::Line, points)],
    }
}

/// The spectrum of a signal around the turn's frequency: over multiples of it, in °/h.
fn lines(name: &str, style: Style, part: &Part<'_>, signal: Signal<'_>) -> Series {
    let turn = turn_hz(part.rows).abs();
    let near = spectrum(part.rows, signal)
        .into_iter()
        .map(move |line| (line.frequency_hz / turn, degrees_per_hour(line.amplitude)));
    Series::new(name, style, near.filter(|(multiple, _)| *multiple <= MULTIPLES))
}

/// The sensor's spectrum before and after the platform's rate is taken off it with this coupling, and
/// what the coupling makes of that rate.
pub fn spectra(part: &Part<'_>, coupling: f64) -> Figure {
    let before = |row: &RotatingRow| row.rate_rad_s;
    let platform = |row: &RotatingRow| coupling * row.stage_rate_rad_s;
    let after = |row: &RotatingRow| before(row) - platform(row);
    let turn = turn_hz(part.rows).abs();
    Figure {
        title: format!("Amplitude spectra, {part}"),
        x: Axis::linear(&format!("frequency in turns, of {turn:.4} Hz each"), ""),
        y: Axis::logarithmic("amplitude", "°/h"),
        series: vec![
            lines("sensor, before", Style::Line, part, &before),
            lines("platform's rate times the coupling", Style::Dashed, part, &platform),
            lines("sensor, after the coupling is taken off", Style::LineAndPoints, part, &after),
        ],
    }
}

/// The spectrum of the platform's rate alone, in Hz.
pub fn platform(parts: &[Part<'_>]) -> Figure {
    let of = |part: &Part<'_>| {
        let lines = spectrum(part.rows, &|row| row.stage_rate_rad_s);
        let points = lines.into_iter().map(|line| (line.frequency_hz, line.amplitude));
        Series::new(&part.to_string(), Style::Line, points)
    };
    Figure {
        title: "Amplitude spectrum of the platform's rate".to_owned(),
        x: Axis::logarithmic("frequency", "Hz"),
        y: Axis::logarithmic("amplitude", "rad/s"),
        series: parts.iter().map(of).collect(),
    }
}

/// The phasor of each turn of each even stretch in the complex plane, the coupling taken off.
pub fn plane(parts: &[Part<'_>], coupling: f64) -> Figure {
    let even = parts.iter().filter(|part| part.is_even);
    let of = |part: &Part<'_>| {
        let points = of_turns(part, coupling).into_iter().map(|(_, at)| (at.re, at.im));
        Series::new(&part.to_string(), Style::Points, points)
    };
    Figure {
        title: "Phasor of the sensor's signal in each turn, the coupling taken off".to_owned(),
        x: Axis::linear("in step with cos θ", "°/h"),
        y: Axis::linear("in step with −sin θ", "°/h"),
        series: even.map(of).collect(),
    }
}

/// By how much each turn's phasor differs from the mean of its part.
pub fn residuals(parts: &[Part<'_>], coupling: f64) -> Figure {
    let even = parts.iter().filter(|part| part.is_even);
    let of = |part: &Part<'_>| {
        let turns = of_turns(part, coupling);
        let mean = turns.iter().map(|(_, at)| at).sum::<Complex<f64>>() / turns.len().max(1) as f64;
        let side = |name: &str, of: fn(Complex<f64>) -> f64| {
            let points = turns.iter().map(|(time, at)| (*time, of(at - mean)));
            Series::new(&format!("{name}, {part}"), Style::LineAndPoints, points)
        };
        [side("cos θ", |at| at.re), side("−sin θ", |at| at.im)]
    };
    Figure {
        title: "Phasor of each turn less the mean of its stretch".to_owned(),
        x: Axis::linear("time", "s"),
        y: Axis::linear("residual", "°/h"),
        series: even.flat_map(of).collect(),
    }
}

/// Times and phasors of a stretch's turns, °/h.
fn of_turns(part: &Part<'_>, coupling: f64) -> Vec<(f64, Complex<f64>)> {
    let after = |row: &RotatingRow| row.rate_rad_s - coupling * row.stage_rate_rad_s;
    let turns = phasors(part.rows, &after).into_iter();
    turns.map(|(time, at)| (time, at * degrees_per_hour(1.0))).collect()
}
