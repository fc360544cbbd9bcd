//! A stop: what the gyros had carried when it began and when it ended, and how quiet it was.

use crate::math::rotation::{Vector, dot, sum, transposed, turned};
use crate::signal::strapdown::{Carried, Rough};
use crate::units::AngleIncrement;

/// Most stops of a session.
pub const STOPS: usize = 8;

/// Fewest seconds that can be compared.
const LEAST_CHANGES: u32 = 20;
/// Least change in a second that a sway makes, m/s²: ten times that of the Earth's turn.
const LEAST_CHANGE: f32 = 4e-3;

/// Sum and sum of squares of three quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scatter {
    sum: Vector,
    squares: Vector,
    count: f64,
}

impl Scatter {
    /// Takes a value of each.
    pub fn push(&mut self, values: &Vector) {
        for ((sum, square), value) in self.sum.iter_mut().zip(&mut self.squares).zip(values) {
            *sum += value;
            *square += value * value;
        }
        self.count += 1.0;
    }

    /// Their means; zero of none.
    #[must_use]
    pub fn mean(&self) -> Vector {
        self.sum.map(|sum| sum / self.count.max(1.0))
    }

    /// Their variances; zero of fewer than two.
    #[must_use]
    pub fn variance(&self) -> Vector {
        let mean = self.mean();
        let free = (self.count - 1.0).max(1.0);
        core::array::from_fn(|axis| {
            ((self.squares[axis] - self.sum[axis] * mean[axis]) / free).max(0.0)
        })
    }
}

/// The vehicle stood from a time to a time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stop {
    /// When it began and ended, s.
    pub from: f64,
    /// When it ended, or until when it lasts, s.
    pub to: f64,
    /// What was carried when it began.
    pub begin: Carried,
    /// What was carried when it ended.
    pub end: Carried,
    /// Displacement north and east from the first stop, m, where somebody told it.
    pub displacement: Option<[f64; 2]>,
    /// Angles turned in each second, rad.
    pub turned: Scatter,
    /// Sum of the squares of the angles over which each second swung there and back, rad².
    pub swung: [f32; 3],
    /// Mean specific force on the body's axes in each second, m/s².
    pub force: Scatter,
    /// Squares of what the force along and across changed from second to second, (m/s²)², as felt, and as
    /// felt by a body that stays as it stood when the stop began; and how often. A sway that the gyros feel
    /// rightly shows in the first alone.
    pub changes: ([[f32; 2]; 2], u32),
    /// Both forces of the last second, m/s².
    pub latest: Option<[[f32; 2]; 2]>,
    /// Seconds that were left out, because something blew or the accelerometer was at its limit.
    pub left_out: u32,
}

impl Stop {
    /// Length, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.to - self.from
    }

    /// Middle, s.
    #[must_use]
    pub fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }

    /// Takes a second of it into account that ends with what is carried now.
    pub fn take(&mut self, second: &Second) {
        self.to = second.to;
        self.end = second.end;
        let rates = second.turned.map(|sum| sum as f64 * AngleIncrement::STEP / second.seconds());
        self.turned.push(&rates);
        self.swung = sum(&self.swung, &second.swung.map(|angle| angle * angle));
        if let Some(force) = second.force {
            self.force.push(&force);
        }
        self.left_out += u32::from(second.block_force().is_none());
        self.compare(second);
    }

    /// Mean square of the angles over which a second swung there and back, rad².
    #[must_use]
    pub fn swinging(&self) -> Vector {
        self.swung.map(|sum| f64::from(sum) / self.turned.count.max(1.0))
    }

    /// Compares how the forces change as felt and as turned.
    fn compare(&mut self, second: &Second) {
        let forces = second.block_force().zip(second.force).map(|(start, felt)| {
            let stays = turned(&transposed(&self.begin.attitude.rough_matrix()), &start);
            [[felt[0] as f32, felt[1] as f32], [stays[0], stays[1]]]
        });
        if let (Some(before), Some(now)) = (self.latest, forces) {
            let (sums, count) = &mut self.changes;
            let parts = before.as_flattened().iter().zip(now.as_flattened());
            for (sum, (before, now)) in sums.as_flattened_mut().iter_mut().zip(parts) {
                *sum += (now - before) * (now - before);
            }
            *count += 1;
        }
        self.latest = forces;
    }

    /// How much more the forces along or across change when they are turned by what the gyros show, in power;
    /// zero where there is no sway to tell.
    #[must_use]
    pub fn disagreement(&self) -> f64 {
        let ([felt, stays], count) = self.changes;
        let least = LEAST_CHANGE * LEAST_CHANGE * count as f32;
        let ratio = |axis: usize| {
            let is_seen = count >= LEAST_CHANGES && felt[axis] > least;
            if is_seen { stays[axis] / felt[axis] } else { 0.0 }
        };
        f64::from(ratio(0).max(ratio(1)))
    }
}

/// About a second of samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct Second {
    /// When it began, s.
    pub from: f64,
    /// When it ended, s.
    pub to: f64,
    /// Sums of the angle increments.
    pub turned: [i64; 3],
    /// By how much more than it turned in all it swung there and back, rad.
    pub swung: [f32; 3],
    /// Mean specific force on the body's axes, m/s², where there was one.
    pub force: Option<Vector>,
    /// Mean specific force on the start's axes, m/s².
    pub start_force: [f32; 3],
    /// Whether a blow made it meaningless.
    pub is_blown: bool,
    /// Whether it belongs to a stop.
    pub is_rest: bool,
    /// What was carried when it began.
    pub begin: Carried,
    /// What was carried when it ended.
    pub end: Carried,
    /// Rate then, on the body's axes, rad/s.
    pub rate: [f32; 3],
}

impl Second {
    /// Velocity at its end of a point that stands a metre off along each axis of the body, as columns, on the start's axes,
    /// 1/s.
    #[must_use]
    pub fn swing(&self) -> Rough {
        let [x, y, z] = self.rate;
        let columns = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
        self.end.attitude.rough_matrix().map(|row| columns.map(|column| dot(&row, &column)))
    }

    /// Length, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        self.to - self.from
    }

    /// Mean specific force on the start's axes, m/s², where it means something.
    #[must_use]
    pub fn block_force(&self) -> Option<[f32; 3]> {
        (self.force.is_some() && !self.is_blown).then_some(self.start_force)
    }
}
