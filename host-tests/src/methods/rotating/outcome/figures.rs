//! The figures: the profile of the rate-modulated turn, as in MET 2018, its spectra, and the phasors of each turn.

use rustfft::num_complex::Complex;

use super::TurnDetails;
use crate::median::median;
use crate::methods::rotating::part::Part;
use crate::methods::rotating::turns::{Signal, phasors, spectrum, turn_hz};
use crate::output::degrees_per_hour;
use crate::recording::RotatingRow;
use crate::report::{Axis, Figure, Point, Series, Style};

/// Multiples of the turn's frequency that a spectrum shows.
const MULTIPLES: f64 = 6.0;

/// How the platform's rate went over time.
pub(crate) fn profile(part: &Part<'_>) -> Figure {
    let of = |row: &RotatingRow| (row.time_s, row.stage_rate_rad_s);
    let series = [Series::of("encoder", Style::Line, part.rows, of)];
    Figure::over_time(format!("Rate of the platform, {part}"), ["rate", "rad/s"], series)
}

/// The spectrum of a signal around the turn's frequency: over multiples of it, in °/h.
fn lines(name: &str, style: Style, part: &Part<'_>, signal: Signal<'_>) -> Series {
    let turn = turn_hz(part.rows).abs();
    let near = spectrum(part.rows, signal)
        .into_iter()
        .map(move |line| (line.frequency_hz / turn, degrees_per_hour(line.amplitude)));
    Series::new(name, style, near.filter(|(multiple, _)| *multiple <= MULTIPLES))
}

/// The sensor's spectrum before and after what it feels of the platform's rate is taken off it, and that
/// part itself; `freed` has the rows after it.
pub(crate) fn spectra(part: &Part<'_>, freed: &Part<'_>) -> Figure {
    let felt: Vec<RotatingRow> = part.rows.iter().zip(freed.rows).map(difference).collect();
    let felt = Part { is_even: part.is_even, rows: &felt };
    let turn = turn_hz(part.rows).abs();
    let shown: Signal<'_> = &|row| row.rate_rad_s;
    let series = [
        lines("sensor, before", Style::Line, part, shown),
        lines("platform's rate as the axis misalignment shows it", Style::Dashed, &felt, shown),
        lines("sensor, after that is taken off", Style::LineAndPoints, freed, shown),
    ];
    over_turns(format!("Amplitude spectra, {part}"), turn, series)
}

/// Amplitudes over the frequency in turns, each of so many hertz.
fn over_turns(title: String, turn: f64, series: impl IntoIterator<Item = Series>) -> Figure {
    let x = format!("frequency in turns, of {turn:.4} Hz each");
    Figure::new(title, [&x, ""], Axis::logarithmic("amplitude", "°/h"), series)
}

/// A row whose rate is what it is less in the other.
fn difference((row, other): (&RotatingRow, &RotatingRow)) -> RotatingRow {
    RotatingRow { rate_rad_s: row.rate_rad_s - other.rate_rad_s, ..*row }
}

/// The sensor's spectrum as it comes, of several parts at the same speed.
pub(crate) fn compared(parts: &[Part<'_>], names: &[String]) -> Figure {
    let turn = parts.first().map_or(0.0, |part| turn_hz(part.rows).abs());
    let of = |(part, name): (&Part<'_>, &String)| {
        lines(name, Style::LineAndPoints, part, &|row| row.rate_rad_s)
    };
    let series = parts.iter().zip(names).map(of);
    over_turns("Amplitude spectra of the sensor".to_owned(), turn, series)
}

/// The spectrum of the platform's rate alone, in Hz.
pub(crate) fn platform(parts: &[Part<'_>]) -> Figure {
    let of = |part: &Part<'_>| {
        let lines = spectrum(part.rows, &|row| row.stage_rate_rad_s);
        let points = lines.into_iter().map(|line| (line.frequency_hz, line.amplitude));
        Series::new(&part.to_string(), Style::Line, points)
    };
    let series = parts.iter().map(of);
    let title = "Amplitude spectrum of the platform's rate";
    let (x, y) = (Axis::logarithmic("frequency", "Hz"), Axis::logarithmic("amplitude", "rad/s"));
    Figure::new(title, x, y, series)
}

/// The phasor of each turn of each even part in the complex plane.
pub(crate) fn plane(parts: &[Part<'_>]) -> Figure {
    let of = |part: &Part<'_>| {
        let points = near(part).into_iter().map(|at| (at.re, at.im));
        Series::new(&part.to_string(), Style::Points, points)
    };
    let series = parts.iter().filter(|part| part.is_even).map(of);
    let title = "Phasor of the sensor's signal in each turn, the axis misalignment taken off";
    Figure::new(title, ["in step with cos θ", "°/h"], ["in step with −sin θ", "°/h"], series)
}

/// What the median of its stretch leaves of each turn, with the 1σ of white noise.
pub(crate) fn residuals(turns: &[TurnDetails]) -> Figure {
    let mut series = Vec::new();
    for stretch in turns.chunk_by(|a, b| a.sense == b.sense && a.middle_s < b.middle_s) {
        let speed = stretch[0].speed_hz;
        for (part, name) in [(0, "cos θ"), (1, "sin θ")] {
            let points = stretch.iter().map(|turn| {
                Point::within(turn.middle_s, turn.residual_deg_h[part], turn.sigma_deg_h)
            });
            let name = format!("{name}, {} at {speed:.3} Hz", stretch[0].sense);
            series.push(Series::new(&name, Style::LineAndPoints, points));
        }
    }
    let title = "Phasor of each turn less the median of its stretch, with 1σ";
    Figure::new(title, ["time since the stretch began", "s"], ["residual", "°/h"], series)
}

/// Distances from the middle, in the median of all, beyond which a turn would hide the others.
const FAR: f64 = 20.0;

/// Phasors of a part's turns, °/h, without those that lie far from the others.
fn near(part: &Part<'_>) -> Vec<Complex<f64>> {
    let turns = phasors(part.rows, &|row| row.rate_rad_s).into_iter();
    let mut all: Vec<_> = turns.map(|(_, at)| at * degrees_per_hour(1.0)).collect();
    let median_of = |of: &dyn Fn(Complex<f64>) -> f64| median(all.iter().map(|at| of(*at)));
    let middle = Complex::new(median_of(&|at| at.re), median_of(&|at| at.im));
    let usual = median_of(&|at| (at - middle).norm());
    all.retain(|at| (at - middle).norm() <= FAR * usual);
    all
}
