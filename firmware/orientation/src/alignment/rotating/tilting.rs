//! Slow tilting of the base, from the forces of the turns: the tilting rate adds to the gyro's
//! signal as the Earth rate does, and 1 °/h of it costs 6° of azimuth at 50° of latitude.

use super::change::{Mark, Marks, Record, Shape};
use super::level::Lean;
use super::turn::{Stretch, Turn};
use crate::math::{Column, Complex};
use crate::units::DEGREE_PER_HOUR;

/// Prior 1σ of the difference between both senses' forces, g.
const SENSES: f64 = 2e-6;
/// Prior 1σ of an accelerometer's delay, s: it rotates the force with the sense.
const DELAY: f64 = 5e-3;
/// Least scatter of a turn's force that is assumed, g.
const LEAST_SCATTER: f64 = 1e-8;
/// Gain of chi-square from which a tilt rate is accepted (two parts, p = 0.0001).
const BELIEVED: f64 = 18.4;
/// Gain of chi-square from which a step is accepted, for each place at which it may be (p = 0.0003
/// over all of them).
const STEP_BELIEVED: f64 = 16.0;
/// Gain of chi-square from which tilting is possible (two parts, p = 0.01).
const POSSIBLE: f64 = 9.21;
/// Prior probability of a tilting base: where the forces indicate it, and where they do not.
const TILTING: [f64; 2] = [0.02, 0.0003];
/// Standard deviation of the rate of a base that tilts, 1/s: 3 °/h.
const FASTEST: f64 = 3.0 * DEGREE_PER_HOUR;

/// Change of the tilt's magnitude, in σ, that counts as none.
const ALIKE: f64 = 3.0;

/// Result of the test for tilting of the base.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tilting {
    /// Rate of the force's phasor, g/s; zero unless it is accepted.
    pub rate: Complex,
    /// Variance of either part of the true rate about `rate`, (g/s)².
    pub variance: f64,
    /// Most likely rate where none is accepted, g/s, and the probability that there is one.
    possible: Complex,
    probability: f64,
    /// Time from the first turn to the last, s.
    seconds: f64,
    /// Middle of the turns, s, to which the mean force refers.
    since: f64,
    /// Response of the gyro's phasor to a change of tilt, rad/s per g.
    per_tilt: Complex,
    /// Size of a step of the force's phasor, g, where one is accepted.
    pub step: Option<f64>,
}

impl Tilting {
    /// Tests the forces of all turns, for gravity in m/s² and the response of the gyro's phasor to
    /// tilt, rad/s per g.
    #[inline(never)]
    pub(crate) fn of(stretches: &[Stretch], gravity: f64, per_tilt: Complex) -> Self {
        let mut marks = marks(stretches, gravity);
        // The forces are resolved along their mean direction, and across it, where a delay shows.
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
        let prior = TILTING[usize::from(found.gain < POSSIBLE)];
        let odds = prior * libm::exp(0.5 * found.gain);
        let possible = 1.0 / (1.0 + found.change_variance / (FASTEST * FASTEST));
        let probability = odds / (1.0 + odds) * possible;
        Self { possible: rate, variance: found.change_variance, probability, ..standing }
    }

    /// Rate of a creeping encoder that would explain the drift of the tilt's direction, rad/s, for
    /// a tilt in g; `None` where no tilting is accepted, or where the tilt's magnitude changes as
    /// well.
    pub(crate) fn creep(&self, tilt: Complex) -> Option<f64> {
        let turned = self.rate * tilt.conjugate();
        let is_turning = turned.re.abs() < ALIKE * libm::sqrt(self.variance) * tilt.size();
        let is_believed = self.rate != Complex::default();
        (is_believed && is_turning).then(|| turned.im / tilt.power())
    }

    /// Total change of the tilt, g.
    pub(crate) fn change(&self) -> f64 {
        self.rate.size() * self.seconds
    }

    /// Angle of an encoder slip that would explain the step, rad, for a tilt in g: the azimuth may
    /// be off by a part of it. Zero without a step.
    pub(crate) fn slip(&self, tilt: f64) -> f64 {
        self.step.map_or(0.0, |change| change / tilt.max(f64::MIN_POSITIVE))
    }

    /// Change of the gyro's phasor from the middle of all turns to a time in s, rad/s: vertical
    /// Earth rate and g-sensitivity through the changed tilt.
    pub(crate) fn vertical_part(&self, time: f64) -> Complex {
        self.per_tilt * self.rate.scaled(time - self.since)
    }

    /// Change of the tilt from the middle of all turns to a time in s, g.
    pub(crate) fn tilt_at(&self, time: f64) -> Complex {
        self.rate.scaled(time - self.since)
    }

    /// Azimuth error of the rotation of a tilting base for a scale factor with this 1σ, rad.
    pub(crate) fn scale(&self, sigma: f64, lean: &Lean, azimuth: f64, horizontal: f64) -> f64 {
        sigma * (self.turning(lean) * Complex::unit(-azimuth)).im.abs() / horizontal
    }

    /// Phasor of the rotation of the tilting base itself, rad/s.
    pub(crate) fn turning(&self, lean: &Lean) -> Complex {
        lean.turning(self.rate)
    }

    /// Variance of an azimuth, rad², for the tilting that the forces leave open, for a horizontal
    /// Earth rate in rad/s.
    pub(crate) fn inflation(&self, lean: &Lean, azimuth: f64, horizontal: f64) -> f64 {
        if self.probability == 0.0 {
            return self.variance / (horizontal * horizontal);
        }
        let across = (lean.turning(self.possible) * Complex::unit(-azimuth)).im;
        self.probability * (across * across + self.variance) / (horizontal * horizontal)
    }
}

/// Unit phasor of the mean of all forces.
fn direction(marks: &[Mark]) -> Complex {
    let of = |mark: &Mark| {
        let [re, im] = mark.value.map(f64::from);
        Complex::new(re, im).scaled(f64::from(mark.turns))
    };
    Complex::unit(marks.iter().map(of).sum::<Complex>().angle())
}

/// Force phasors of all turns over gravity, g.
fn marks(stretches: &[Stretch], gravity: f64) -> Marks {
    let of = |turn: &Turn| Complex::of_signal(turn.force).scaled(1.0 / gravity);
    let mark = |stretch, turn| Mark::of(stretch, turn, of(turn));
    let all = stretches.iter();
    all.flat_map(|stretch| stretch.turns.iter().map(move |turn| mark(stretch, turn))).collect()
}
