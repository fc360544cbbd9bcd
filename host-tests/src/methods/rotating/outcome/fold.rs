//! The rate of a turning sensor, folded over the stage angle: what all turns of a stretch show at each angle, and what the
//! solution makes of it.

use std::f64::consts::TAU;

use orientation::alignment::rotating::average::Average;
use orientation::alignment::rotating::conclusion::Conclusion;
use orientation::alignment::rotating::misalignment::{self, AxisMisalignment};
use orientation::alignment::rotating::turn::Stretch;

use rustfft::num_complex::Complex;

use crate::methods::rotating::part::Part;
use crate::methods::rotating::turns::each_turn;
use crate::methods::rotating::{Replay, span};
use crate::output::degrees_per_hour;
use crate::recording::RotatingRow;
use crate::report::{Axis, Figure, Point, Series, Shape, Style};

/// Sectors of a turn.
const SECTORS: usize = 48;
/// What the axis shows beyond a turn at either end, °.
const BEYOND: f64 = 4.0;

/// Mean rate of a sector in each turn that has samples there, rad/s: neighbouring samples of a slow sensor share their
/// noise, those of different turns do not.
#[derive(Clone, Default)]
struct Sector(Vec<f64>);

impl Sector {
    fn mean(&self) -> f64 {
        self.0.iter().sum::<f64>() / self.0.len().max(1) as f64
    }

    /// Sum of the squared distances from the mean, and its degrees of freedom.
    fn scatter(&self) -> [f64; 2] {
        let mean = self.mean();
        let squares = self.0.iter().map(|rate| (rate - mean) * (rate - mean)).sum();
        [squares, self.0.len().saturating_sub(1) as f64]
    }
}

/// Variance of a turn's mean in a sector, as all sectors show it, (rad/s)².
fn variance(sectors: &[Sector]) -> f64 {
    let [squares, degrees] = sectors
        .iter()
        .map(Sector::scatter)
        .fold([0.0; 2], |sum, scatter| [sum[0] + scatter[0], sum[1] + scatter[1]]);
    squares / f64::max(degrees, 1.0)
}

/// An even stretch, folded.
struct Folded<'a> {
    name: String,
    /// Mean rate of each sector with its 1σ, °/h, over the sector's middle, °.
    points: Vec<Point>,
    /// What the solution has of the stretch.
    average: &'a Average,
}

impl<'a> Folded<'a> {
    /// The rows of a part without the platform's unevenness, each turn less its own mean, and less the drift within it.
    fn of(part: &Part<'_>, average: &'a Average) -> Option<Self> {
        let turns: Vec<&[RotatingRow]> = each_turn(part.rows).collect();
        let means: Vec<[f64; 2]> = turns.iter().map(|turn| mean(turn)).collect();
        let [[begin, first], [end, last]] = [*means.first()?, *means.last()?];
        let slope = if end > begin { (last - first) / (end - begin) } else { 0.0 };
        let mut sectors = vec![Sector::default(); SECTORS];
        for (turn, [time_s, rate]) in turns.iter().zip(&means) {
            let mut parts = vec![Vec::new(); SECTORS];
            for row in *turn {
                parts[sector(row)].push(*row);
            }
            // Where a turn ends and begins, a sector's rows are not one after the other.
            for (part, sector) in
                parts.iter().zip(&mut sectors).filter(|(part, _)| !part.is_empty())
            {
                let [middle_s, found] = mean(part);
                sector.0.push(found - rate - slope * (middle_s - time_s));
            }
        }
        let variance = variance(&sectors);
        let point = |(index, sector): (usize, &Sector)| {
            let sigma = (variance / sector.0.len() as f64).sqrt();
            let [rate, sigma] = [sector.mean(), sigma].map(degrees_per_hour);
            Point::within((index as f64 + 0.5) * 360.0 / SECTORS as f64, rate, sigma)
        };
        let there = sectors.iter().enumerate().filter(|(_, sector)| !sector.0.is_empty());
        Some(Self { name: part.to_string(), points: there.map(point).collect(), average })
    }

    /// What the solution makes of the rate at an angle, °: the mean over a sector of its phasor.
    fn model(&self, angle_deg: f64) -> f64 {
        let phasor = &self.average.phasor;
        let (sine, cosine) = angle_deg.to_radians().sin_cos();
        let half = TAU / SECTORS as f64 / 2.0;
        degrees_per_hour(phasor.re * cosine - phasor.im * sine) * half.sin() / half
    }

    fn curve(&self) -> Series {
        let angles = (0..=180).map(|step| 2.0 * f64::from(step));
        let name = format!("the solution, {}", self.name);
        Series::new(&name, Style::Line, angles.map(|angle| (angle, self.model(angle))))
    }

    fn measured(&self) -> Series {
        Series::new(&format!("{}, with 1σ", self.name), Style::Points, self.points.iter().copied())
    }

    fn left(&self) -> Series {
        let points = self.points.iter().map(|point| {
            let model = self.model(point.x);
            let limits = point.limits.map(|limits| limits.map(|limit| limit - model));
            Point { y: point.y - model, limits, ..*point }
        });
        Series::new(&self.name, Style::Points, points)
    }
}

/// The sector of a row's stage angle.
fn sector(row: &RotatingRow) -> usize {
    let turn = (row.stage_rad / TAU).rem_euclid(1.0);
    ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}

/// Mean time, s, and mean rate, rad/s.
fn mean(rows: &[RotatingRow]) -> [f64; 2] {
    let count = rows.len().max(1) as f64;
    let sum = |of: fn(&RotatingRow) -> f64| rows.iter().map(of).sum::<f64>() / count;
    [sum(|row| row.time_s), sum(|row| row.rate_rad_s)]
}

/// The even stretches folded with the solution, and what it leaves.
pub(super) fn figures(
    replay: &Replay,
    conclusion: &Conclusion,
    rows: &[RotatingRow],
) -> [Figure; 2] {
    let stretches = replay.session.turn_accumulator.stretches.iter();
    let folded = |stretch: &Stretch| {
        let average = nearest(conclusion, stretch)?;
        let (from, to) = used(stretch, average)?;
        let part = Part::between(rows, replay.zero_s + from, replay.zero_s + to, true);
        let speed = stretch.sense.signed(stretch.speed());
        let whole: Vec<RotatingRow> = each_turn(part.rows).flatten().copied().collect();
        let rows = &without_unevenness(&conclusion.misalignments, speed, &whole);
        Folded::of(&Part { rows, ..part }, average)
    };
    let folded: Vec<Folded> = stretches.filter_map(folded).collect();
    let angle = || Axis::from(["stage angle", "°"]).between([-BEYOND, 360.0 + BEYOND]);
    let fits = folded.iter().map(Folded::curve).chain(folded.iter().map(Folded::measured));
    let left = folded.iter().map(Folded::left);
    let rate = ["rate less its mean", "°/h"];
    [
        Figure::new("The rate folded over the stage angle", angle(), rate, fits),
        Figure::new("What the solution leaves", angle(), ["residual", "°/h"], left)
            .shaped(Shape::Low),
    ]
}

/// When the turns began and ended that took part, s.
fn used(stretch: &Stretch, average: &Average) -> Option<(f64, f64)> {
    let [before, after] = average.ends.map(usize::from);
    let turns = stretch.turns.get(before..stretch.turns.len().checked_sub(after)?)?;
    span(turns, stretch.since)
}

/// Harmonics of the platform's unevenness that a sensor shows.
const HARMONICS: u32 = 4;

/// The rows of whole turns at a speed, rad/s, without what the sensor shows of the platform's unevenness: each harmonic of
/// its rate passes the misalignment's response.
fn without_unevenness(
    all: &[AxisMisalignment],
    speed: f64,
    rows: &[RotatingRow],
) -> Vec<RotatingRow> {
    let mut left = rows.to_vec();
    let Some(found) = misalignment::nearest(all, speed) else { return left };
    let count = rows.len().max(1) as f64;
    let even = rows.iter().map(|row| row.stage_rate_rad_s).sum::<f64>() / count;
    for harmonic in 1..=HARMONICS {
        let times = f64::from(harmonic);
        let turned = |row: &RotatingRow| Complex::from_polar(1.0, times * row.stage_rad);
        let part = |row: &RotatingRow| turned(row).conj() * (row.stage_rate_rad_s - even);
        let uneven: Complex<f64> = rows.iter().map(part).sum();
        let response = found.response(times * speed);
        let felt = Complex::new(response.re, response.im) * uneven * (2.0 / count);
        for row in &mut left {
            row.rate_rad_s -= (felt * turned(row)).re;
        }
    }
    left
}

/// The average of a stretch.
pub(super) fn nearest<'a>(conclusion: &'a Conclusion, stretch: &Stretch) -> Option<&'a Average> {
    let speed = stretch.sense.signed(stretch.speed());
    let off = |average: &Average| (average.sense.signed(average.speed) - speed).abs();
    super::averages(conclusion).min_by(|a, b| off(a).total_cmp(&off(b)))
}
