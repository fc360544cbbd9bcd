//! The rate of a turning sensor, folded over the stage angle: what all turns of a stretch show at each angle, and what the
//! solution makes of it.

use std::f64::consts::TAU;

use orientation::alignment::rotating::average::Average;
use orientation::alignment::rotating::conclusion::Conclusion;

use crate::methods::rotating::part::Part;
use crate::methods::rotating::turns::{each_turn, turn_hz};
use crate::output::degrees_per_hour;
use crate::recording::RotatingRow;
use crate::report::{Axis, Figure, Point, Series, Shape, Style};

/// Sectors of a turn.
const SECTORS: usize = 48;
/// What the axis shows beyond a turn at either end, °.
const BEYOND: f64 = 4.0;

/// What the samples of a sector have in common.
#[derive(Clone, Copy, Default)]
struct Sector {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Sector {
    fn take(&mut self, rate: f64) {
        self.count += 1.0;
        self.sum += rate;
        self.squares += rate * rate;
    }

    /// Mean, and its 1σ by the scatter about it; none of fewer than two samples.
    fn mean(&self) -> Option<[f64; 2]> {
        let Self { count, sum, squares } = *self;
        let mean = sum / count;
        let variance = (squares / count - mean * mean).max(0.0) / (count - 1.0);
        (count > 1.0).then(|| [mean, variance.sqrt()])
    }
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
    /// The rows of a part, each turn less its own mean, and less the drift within it.
    fn of(part: &Part<'_>, average: &'a Average) -> Option<Self> {
        let turns: Vec<&[RotatingRow]> = each_turn(part.rows).collect();
        let means: Vec<[f64; 2]> = turns.iter().map(|turn| mean(turn)).collect();
        let [[begin, first], [end, last]] = [*means.first()?, *means.last()?];
        let slope = if end > begin { (last - first) / (end - begin) } else { 0.0 };
        let mut sectors = [Sector::default(); SECTORS];
        for (turn, [time_s, rate]) in turns.iter().zip(&means) {
            for row in *turn {
                let left = row.rate_rad_s - rate - slope * (row.time_s - time_s);
                sectors[sector(row)].take(left);
            }
        }
        let point = |(index, sector): (usize, &Sector)| {
            let [mean, sigma] = sector.mean()?.map(degrees_per_hour);
            Some(Point::within((index as f64 + 0.5) * 360.0 / SECTORS as f64, mean, sigma))
        };
        let points = sectors.iter().enumerate().filter_map(point).collect();
        Some(Self { name: part.to_string(), points, average })
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

/// The even parts folded with the solution, and what it leaves; `parts` are freed of the axis misalignment.
pub(super) fn figures(conclusion: &Conclusion, parts: &[Part<'_>]) -> [Figure; 2] {
    let even = parts.iter().filter(|part| part.is_even);
    let folded: Vec<Folded> = even
        .filter_map(|part| Folded::of(part, nearest(conclusion, part)?))
        .collect();
    let angle = || Axis::from(["stage angle", "°"]).between([-BEYOND, 360.0 + BEYOND]);
    let fits = folded.iter().map(Folded::curve).chain(folded.iter().map(Folded::measured));
    let left = folded.iter().map(Folded::left);
    [
        Figure::new("The rate folded over the stage angle", angle(), ["rate less its mean", "°/h"], fits),
        Figure::new("What the solution leaves", angle(), ["residual", "°/h"], left)
            .shaped(Shape::Low),
    ]
}

/// The average of the stretch that turns as a part does.
fn nearest<'a>(conclusion: &'a Conclusion, part: &Part<'_>) -> Option<&'a Average> {
    let speed = TAU * turn_hz(part.rows);
    let off = |average: &Average| (average.sense.signed(average.speed) - speed).abs();
    super::averages(conclusion).min_by(|a, b| off(a).total_cmp(&off(b)))
}
