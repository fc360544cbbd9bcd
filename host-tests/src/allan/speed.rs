//! The board's streaming estimator beside the batch one: how quick both are, and whether they agree.

use std::hint::black_box;
use std::time::{Duration, Instant};

use orientation::noise::allan::{Allan, Point};
use orientation::units::{AngularRate, Seconds};

use super::Record;
use super::analysis::Rest;

/// Each is repeated so long, so that a short record is timed as well as a long one.
const AT_LEAST: Duration = Duration::from_millis(50);

/// Both estimators on the longest segment of a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Samples a second that the streaming estimator takes.
    pub streaming: f64,
    /// Samples a second of the batch estimator: all averaging times, every window.
    pub batch: f64,
    /// How many averaging times were compared.
    pub points: usize,
    /// The greatest relative difference of two variances over the same windows of the same numbers.
    pub difference: f64,
}

/// Runs the streaming and the batch estimator on a record, and times them.
#[must_use]
pub fn compare(rest: &Rest) -> Comparison {
    let rates: Vec<AngularRate> =
        rest.longest().iter().copied().map(AngularRate::from_rad_per_s).collect();
    let period = rest.spacing.period_s;
    let streaming = rate(rates.len(), || streamed(&rates));
    let batch = rate(rates.len(), || {
        let record = Record::new(period, [rest.longest()]);
        let factors = record.factors().into_iter();
        factors.filter_map(|factor| record.strided(factor, 1)).collect::<Vec<_>>()
    });
    let differences = differences(&rates, period);
    let difference = differences.iter().copied().fold(0.0, f64::max);
    Comparison { streaming, batch, points: differences.len(), difference }
}

/// The streaming estimator after these samples.
fn streamed(rates: &[AngularRate]) -> Allan {
    let mut allan = Allan::new();
    for rate in rates {
        allan.push(*rate);
    }
    allan
}

/// The relative differences at every averaging time, over the windows that the streaming one takes.
fn differences(rates: &[AngularRate], period: f64) -> Vec<f64> {
    let exact: Vec<f64> = rates.iter().map(|rate| f64::from(rate.0) * 1e-9).collect();
    let record = Record::new(period, [exact.as_slice()]);
    let points = streamed(rates);
    let samples = |seconds: f64| (seconds / period).round() as usize;
    let difference = |point: Point| {
        let same = record.strided(samples(point.seconds.0), samples(point.stride.0))?;
        let is_same = same.terms == point.terms;
        Some(if is_same { (same.variance / point.variance - 1.0).abs() } else { f64::INFINITY })
    };
    points.points(Seconds(period)).filter_map(difference).collect()
}

/// Samples a second of some work on so many.
fn rate<T>(samples: usize, work: impl Fn() -> T) -> f64 {
    let start = Instant::now();
    let mut taken = 0;
    while taken == 0 || start.elapsed() < AT_LEAST {
        black_box(work());
        taken += samples;
    }
    taken as f64 / start.elapsed().as_secs_f64()
}
