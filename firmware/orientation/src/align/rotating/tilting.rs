//! A base that tilts slowly, by the forces of its turns: it turns the gyro as the Earth does, 1 °/h of it by 6° at
//! 50° of latitude.

use heapless::Vec;

use super::change::{MARKS, Mark, Record, Shape};
use super::level::Lean;
use super::turn::{Sense, Stretch};
use crate::align::regression::Column;
use crate::math::Complex;
use crate::units::DEGREE_PER_HOUR;

/// 1σ of what both senses' forces may differ by, g.
const SENSES: f64 = 2e-6;
/// 1σ of an accelerometer's delay, s: it turns the force with the sense.
const DELAY: f64 = 5e-3;
/// Least scatter of a turn's force that is believed, g.
const LEAST_SCATTER: f64 = 1e-8;
/// Gain of chi-square from which a tilt rate is believed (two parts, p = 0.0001).
const BELIEVED: f64 = 18.4;
/// The same of a step, for each place at which it may be (p = 0.0003 over all of them).
const STEP_BELIEVED: f64 = 16.0;
/// Gain from which it is doubtful whether a base stands (two parts, p = 0.01).
const DOUBTFUL: f64 = 9.21;
/// Part of the bases that tilt, before their forces are looked at: where these speak for it, and where not.
const TILTING: [f64; 2] = [0.02, 0.0003];
/// 1σ of how fast a base tilts that does, 1/s: 3 °/h.
const FASTEST: f64 = 3.0 * DEGREE_PER_HOUR;

/// σ of a change of the tilt's size within which it is none.
const ALIKE: f64 = 3.0;

/// How a base tilts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tilting {
    /// How fast the force's phasor changes, g/s, as far as that is believed.
    pub rate: Complex,
    /// Variance of either part of the true rate about that one, (g/s)².
    pub variance: f64,
    /// Likeliest rate where none is believed, g/s, and how probable it is that there is one.
    doubted: Complex,
    probability: f64,
    /// From the first turn to the last, s.
    seconds: f64,
    /// Middle of the turns, s: the mean force is that of this time.
    since: f64,
    /// What a changing tilt multiplies in the gyro, rad/s per g.
    per_tilt: Complex,
    /// By how much the force's phasor is another one from some time on, g, where that is believed.
    pub step: Option<f64>,
}

impl Tilting {
    /// From the forces of all turns, for gravity in m/s² and what a tilt makes of the gyro's phasor, rad/s per g.
    #[must_use]
    #[inline(never)]
    pub fn of(stretches: &[Stretch], gravity: f64, per_tilt: Complex) -> Self {
        let mut marks = marks(stretches, gravity);
        // Along the force, and across it, where a delay shows.
        let along = direction(&marks);
        let mut size: f64 = 0.0;
        for mark in &mut marks {
            let [re, im] = mark.value.map(f64::from);
            let turned = Complex::new(re, im) * along.conjugate();
            mark.value = [turned.re as f32, turned.im as f32];
            size = size.max(turned.re);
        }
        let speed = stretches.iter().map(Stretch::speed).fold(0.0, f64::max);
        let delayed = libm::hypot(SENSES, DELAY * speed * size);
        let odd = [SENSES, delayed].map(Column::Prior);
        let record = Record::of_phasors(marks, odd, LEAST_SCATTER);
        let (seconds, since) = (record.seconds(), record.middle());
        let standing = Self { seconds, since, per_tilt, ..Self::default() };
        let Some(steady) = record.steady() else { return standing };
        let Some(found) = record.changing(Shape::Rate, &steady) else { return standing };
        let step = record.likeliest_step().and_then(|shape| record.changing(shape, &steady));
        let step =
            step.filter(|step| step.gain > (STEP_BELIEVED + record.places()).max(found.gain));
        if let Some([re, im]) = step.map(|step| step.change) {
            return Self { step: Some(libm::hypot(re, im)), ..standing };
        }
        let rate = Complex::new(found.change[0], found.change[1]) * along;
        if found.gain > BELIEVED {
            return Self { rate, variance: found.change_variance, ..standing };
        }
        let prior = TILTING[usize::from(found.gain < DOUBTFUL)];
        let odds = prior * libm::exp(0.5 * found.gain);
        let possible = 1.0 / (1.0 + found.change_variance / (FASTEST * FASTEST));
        let probability = odds / (1.0 + odds) * possible;
        Self { doubted: rate, variance: found.change_variance, probability, ..standing }
    }

    /// How fast an encoder creeps that lets the tilt's direction drift so, rad/s, for a tilt in g; none where no tilting is
    /// believed, or where the tilt's size changes with it.
    #[must_use]
    pub fn creep(&self, tilt: Complex) -> Option<f64> {
        let turned = self.rate * tilt.conjugate();
        let is_turning = turned.re.abs() < ALIKE * libm::sqrt(self.variance) * tilt.size();
        let is_believed = self.rate != Complex::default();
        (is_believed && is_turning).then(|| turned.im / tilt.power())
    }

    /// By how much the tilt changed in all, g.
    #[must_use]
    pub fn change(&self) -> f64 {
        self.rate.size() * self.seconds
    }

    /// By which angle an encoder slipped whose slip the step is, rad, for a tilt in g: the azimuth may be off by a part
    /// of it. Zero where there is none.
    #[must_use]
    pub fn slip(&self, tilt: f64) -> f64 {
        self.step.map_or(0.0, |change| change / tilt.max(f64::MIN_POSITIVE))
    }

    /// What the gyro feels more at a time in s than in the middle of all turns, rad/s: the vertical Earth rate and its
    /// g-sensitivity through a tilt that is another one.
    #[must_use]
    pub fn vertical_part(&self, time: f64) -> Complex {
        self.per_tilt * self.rate.scaled(time - self.since)
    }

    /// By how much the tilt at a time in s is another one than in the middle of all turns, g.
    #[must_use]
    pub fn tilt_at(&self, time: f64) -> Complex {
        self.rate.scaled(time - self.since)
    }

    /// How far that and all that is felt of it is off for a scale factor of this 1σ, as the azimuth shows it, rad.
    #[must_use]
    pub fn scale(&self, sigma: f64, lean: &Lean, azimuth: f64, horizontal: f64) -> f64 {
        sigma * (self.turning(lean) * Complex::unit(-azimuth)).im.abs() / horizontal
    }

    /// What the tilting itself turns the gyro by, rad/s.
    #[must_use]
    pub fn turning(&self, lean: &Lean) -> Complex {
        lean.turning(self.rate)
    }

    /// Variance of an azimuth in rad for what the forces do not tell, for a horizontal Earth rate in rad/s.
    #[must_use]
    pub fn doubt(&self, lean: &Lean, azimuth: f64, horizontal: f64) -> f64 {
        if self.probability == 0.0 {
            return self.variance / (horizontal * horizontal);
        }
        let across = (lean.turning(self.doubted) * Complex::unit(-azimuth)).im;
        self.probability * (across * across + self.variance) / (horizontal * horizontal)
    }
}

/// Where the mean of all forces points, of size one.
fn direction(marks: &[Mark]) -> Complex {
    let of = |mark: &Mark| {
        let [re, im] = mark.value.map(f64::from);
        Complex::new(re, im).scaled(f64::from(mark.turns))
    };
    Complex::unit(marks.iter().map(of).fold(Complex::default(), |sum, part| sum + part).angle())
}

/// The forces' phasors over gravity, g.
fn marks(stretches: &[Stretch], gravity: f64) -> Vec<Mark, MARKS> {
    let mut marks = Vec::new();
    for stretch in stretches {
        let joined = stretch.count() as f32 / stretch.turns().len().max(1) as f32;
        let since = stretch.since() as f64 * 1e-6;
        let odd = if stretch.sense == Sense::Clockwise { 1.0 } else { -1.0 };
        for turn in stretch.turns() {
            let force = Complex::of_signal(turn.force).scaled(1.0 / gravity);
            let time = (since + f64::from(turn.middle)) as f32;
            let value = [force.re as f32, force.im as f32];
            // There is room for every turn of every stretch.
            let _ = marks.push(Mark { time, odd, is_second: false, turns: joined, value });
        }
    }
    marks
}
