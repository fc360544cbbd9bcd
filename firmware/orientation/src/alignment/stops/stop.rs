//! A stop of the vehicle: attitude and sensitivities at its beginning and end, and statistics of
//! its motion.

use crate::math::rotation::{Vector, dot, sum, transposed, turned};
use crate::signal::strapdown::{Carried, Rough};
use crate::units::{AngleIncrement, Metres, Seconds};

/// Greatest number of stops of a session.
pub const STOPS: usize = 8;

/// Fewest seconds whose force changes are compared.
const LEAST_CHANGES: u32 = 20;
/// Least change of the force within a second by a sway, m/s²: ten times that by the Earth's
/// rotation.
const LEAST_CHANGE: f32 = 4e-3;

/// Sums and sums of squares of three quantities.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scatter {
    /// Sums.
    sum: Vector,
    /// Sums of squares.
    squares: Vector,
    /// Number of values.
    count: f64,
}

impl Scatter {
    /// Adds a value of each quantity.
    pub(crate) fn push(&mut self, values: &Vector) {
        for ((sum, square), value) in self.sum.iter_mut().zip(&mut self.squares).zip(values) {
            *sum += value;
            *square += value * value;
        }
        self.count += 1.0;
    }

    /// Means; zero without values.
    #[must_use]
    pub fn mean(&self) -> Vector {
        self.sum.map(|sum| sum / self.count.max(1.0))
    }

    /// Variances; zero with fewer than two values.
    #[must_use]
    pub fn variance(&self) -> Vector {
        let mean = self.mean();
        let free = (self.count - 1.0).max(1.0);
        core::array::from_fn(|axis| {
            ((self.squares[axis] - self.sum[axis] * mean[axis]) / free).max(0.0)
        })
    }
}

/// What is carried on from second to second of a stop.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Course {
    /// Squared angles of back-and-forth motion within the first second, rad².
    first: [f32; 3],
    /// Specific force along and across in the latest second, m/s²: as measured, and rotated to the
    /// attitude at the beginning of the stop.
    latest: Option<[[f32; 2]; 2]>,
}

/// Interval in which the vehicle stood.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stop {
    /// Beginning of the stop.
    pub from: Seconds,
    /// End of the stop, or the present end while it lasts.
    pub to: Seconds,
    /// Attitude and sensitivities at the beginning.
    pub begin: Carried,
    /// Attitude and sensitivities at the end.
    pub end: Carried,
    /// Displacement north and east from the first stop, where it was reported.
    pub displacement: Option<[Metres; 2]>,
    /// Mean rates of the seconds about the body's axes, rad/s.
    pub turned: Scatter,
    /// Sum of the squared angles of back-and-forth motion within each second, rad².
    pub swung: [f32; 3],
    /// Sum of the squared angles of back-and-forth motion within the first second and the latest, rad².
    pub ends: [f32; 3],
    /// Mean specific force on the body's axes in each second, m/s².
    pub force: Scatter,
    /// Sums of the squared changes of the force along and across from second to second, (m/s²)²: as
    /// measured, and rotated to the attitude at the beginning of the stop; and the number of
    /// changes. A sway that the gyros measure correctly shows in the first alone.
    pub changes: ([[f32; 2]; 2], u32),
    /// Number of seconds excluded for a shock or a saturated accelerometer.
    pub left_out: u32,
}

impl Stop {
    /// Length of the stop.
    pub fn seconds(&self) -> Seconds {
        Seconds(self.to.0 - self.from.0)
    }

    /// Middle of the stop, s.
    pub(crate) fn middle(&self) -> f64 {
        0.5 * (self.from.0 + self.to.0)
    }

    /// Adds a second to the stop, which then ends with that second.
    pub(super) fn take(&mut self, second: &Second, course: &mut Course) {
        self.to = Seconds(second.to);
        self.end = second.end;
        let rates = second.turned.map(|sum| sum as f64 * AngleIncrement::STEP / second.seconds());
        self.turned.push(&rates);
        let swung = second.swung.map(|angle| angle * angle);
        self.swung = sum(&self.swung, &swung);
        if self.turned.count <= 1.0 {
            *course = Course { first: swung, latest: None };
        }
        self.ends = sum(&course.first, &swung);
        if let Some(force) = second.force {
            self.force.push(&force);
        }
        self.left_out += u32::from(second.block_force().is_none());
        self.compare(second, course);
    }

    /// Mean square of the angles of back-and-forth motion within a second, rad².
    pub(super) fn swinging(&self) -> Vector {
        self.swung.map(|sum| f64::from(sum) / self.turned.count.max(1.0))
    }

    /// Sum of the squared angles of back-and-forth motion within the first second and the latest, rad².
    pub(super) fn swinging_at_ends(&self) -> Vector {
        self.ends.map(f64::from)
    }

    /// Accumulates the changes of the force as measured and as rotated.
    fn compare(&mut self, second: &Second, course: &mut Course) {
        let forces = second.block_force().zip(second.force).map(|(start, felt)| {
            let stays = turned(&transposed(&self.begin.attitude.rough_matrix()), &start);
            [[felt[0] as f32, felt[1] as f32], [stays[0], stays[1]]]
        });
        if let (Some(before), Some(now)) = (course.latest, forces) {
            let (sums, count) = &mut self.changes;
            let parts = before.as_flattened().iter().zip(now.as_flattened());
            for (sum, (before, now)) in sums.as_flattened_mut().iter_mut().zip(parts) {
                *sum += (now - before) * (now - before);
            }
            *count += 1;
        }
        course.latest = forces;
    }

    /// Ratio of the power of the force changes after rotation by the gyros' angles to that before,
    /// the greater of both axes; zero without sufficient sway.
    pub(super) fn disagreement(&self) -> f64 {
        let ([felt, stays], count) = self.changes;
        let least = LEAST_CHANGE * LEAST_CHANGE * count as f32;
        let ratio = |axis: usize| {
            let is_seen = count >= LEAST_CHANGES && felt[axis] > least;
            if is_seen { stays[axis] / felt[axis] } else { 0.0 }
        };
        f64::from(ratio(0).max(ratio(1)))
    }
}

/// Averages of about one second of samples.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Second {
    /// Beginning, s.
    pub from: f64,
    /// End, s.
    pub to: f64,
    /// Sums of the angle increments, in steps of [`AngleIncrement`].
    pub turned: [i64; 3],
    /// Angle of back-and-forth motion beyond the net rotation, rad.
    pub swung: [f32; 3],
    /// Mean specific force on the body's axes, m/s²; none without force readings.
    pub force: Option<Vector>,
    /// Mean specific force on the frozen start axes, m/s².
    pub start_force: [f32; 3],
    /// Whether a shock made the force unusable.
    pub is_blown: bool,
    /// Whether the second belongs to a stop.
    pub is_rest: bool,
    /// Attitude and sensitivities at the beginning.
    pub begin: Carried,
    /// Attitude and sensitivities at the end.
    pub end: Carried,
    /// Angular rate at the end, on the body's axes, rad/s.
    pub rate: [f32; 3],
}

impl Second {
    /// Velocity at the end per metre of lever arm along each axis of the body, as columns, on the
    /// start's axes, 1/s.
    pub(super) fn swing(&self) -> Rough {
        let [x, y, z] = self.rate;
        let columns = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
        self.end.attitude.rough_matrix().map(|row| columns.map(|column| dot(&row, &column)))
    }

    /// Length, s.
    pub(crate) fn seconds(&self) -> f64 {
        self.to - self.from
    }

    /// Mean specific force on the start's axes, m/s²; `None` where it is not usable.
    pub(super) fn block_force(&self) -> Option<[f32; 3]> {
        (self.force.is_some() && !self.is_blown).then_some(self.start_force)
    }
}
