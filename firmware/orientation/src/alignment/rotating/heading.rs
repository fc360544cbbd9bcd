//! Test whether the direction of the Earth rate is constant over all turns. A base that turns or
//! was turned, and an encoder that creeps or slipped, change it.
//!
//! If chi-square shows a change the azimuth is refused, because the turns do not show which of the
//! causes it was. Otherwise σ is inflated by the effect of a change on the azimuth, times its
//! probability.

use super::change::{Found, Mark, Marks, Record, Shape};
use super::solution::{Fit, Pair, Problem, believed_lag, of_one_turn};
use super::turn::Sense;
use super::{Refusal, misalignment, solution};
use crate::alignment::{self, Passed, SlowMotion, refuse_if};
use crate::math::{Column, Complex};
use crate::units::{MilliG, Radians, RadiansPerSecond, Seconds};

/// Gain of chi-square from which a drift of the direction is accepted (p = 0.0001).
const BELIEVED: f64 = 15.1;
/// Gain of chi-square from which a step is accepted, for each place at which it may be (p = 0.001
/// over all of them).
const STEP_BELIEVED: f64 = 10.8;
/// Gain of chi-square from which a drift is possible (p = 0.2).
const POSSIBLE: f64 = 1.64;
/// Gain of chi-square from which a step is possible, beyond that of the choice among its places.
const STEP_POSSIBLE: f64 = 3.8;
/// Prior probability of a changing direction: where the turns indicate one, and where they do not.
const CHANGING: [f64; 2] = [0.03, 0.0003];
/// Greatest inflation of the azimuth's variance for a change other than with the sense, in units of
/// the variance: σ is then five times as great.
const INFLATION: f64 = 24.0;
/// Distance in σ within which a drift of the direction agrees with that of the tilt.
const ALIKE: f64 = 3.0;

/// Phasors of the turns as directions.
pub(crate) struct Directions<'a> {
    /// Problem from which the fit was solved.
    pub problem: &'a Problem<'a>,
    /// Fit of the azimuth.
    pub fit: &'a Fit,
}

impl Directions<'_> {
    /// Inflation of the azimuth's variance for a change that is possible but not accepted, rad²,
    /// from the turns' phasors, rad/s, each marked with the sign of its sense.
    ///
    /// # Errors
    /// [`Refusal::DirectionDrifts`], [`alignment::Refusal::HeadingStepped`],
    /// [`Refusal::SensesDisagree`], and [`Refusal::TiltChanged`] where the tilt's direction drifts as
    /// an encoder that creeps lets it.
    #[inline(never)]
    pub(crate) fn inflation(&self, marks: Marks) -> Result<f64, alignment::Refusal> {
        let Some(record) = self.record(marks) else { return Ok(0.0) };
        let Some(steady) = record.steady() else { return Ok(0.0) };
        let drift = record.changing(Shape::Rate, &steady);
        let step = record.likeliest_step().and_then(|shape| record.changing(shape, &steady));
        // The change with the sense has a single possible place, the reversal.
        let turn = record.change_of_sense().and_then(|shape| record.changing(shape, &steady));
        self.judge(&record, [drift, turn, step])?;
        // A sensor that is not flat settles for long, and its directions drift slightly meanwhile.
        if !self.is_flat() {
            return Ok(0.0);
        }
        let lacks = |change: Option<Found>, places: f64| {
            change.map_or(0.0, |change| lacking(&change, &steady, places))
        };
        let most = INFLATION * steady.variance;
        let [drift, step] = [lacks(drift, 0.0), lacks(step, record.places())];
        Ok(drift.min(most) + lacks(turn, 0.0) + step.min(most))
    }

    /// Observability of a slow rotation of the base about the vertical; `None` without turns.
    pub(crate) fn slow_turn(&self, marks: Marks) -> Option<SlowMotion> {
        let record = self.record(marks)?;
        let steady = record.steady()?;
        let drift = record.changing(Shape::Rate, &steady);
        let variance = drift.map_or(f64::INFINITY, |drift| drift.change_variance);
        let sigma = RadiansPerSecond(libm::sqrt(variance));
        Some(SlowMotion { sigma, lever: Seconds(record.to_end()) })
    }

    /// Directions of the turns, rad, relative to that of the Earth rate.
    fn record(&self, mut marks: Marks) -> Option<Record> {
        let first = self.problem.pairs.first()?;
        let variance = self.angle_variance(first);
        for mark in &mut marks {
            let pair = self.problem.pairs.get(usize::from(mark.is_second)).unwrap_or(first);
            mark.turns *= (variance / self.angle_variance(pair)) as f32;
            mark.value = [self.angle(mark, pair) as f32, 0.0];
            if self.is_flat() {
                mark.odd *= pair.speed() as f32;
            }
        }
        let odd = if self.is_flat() { Column::Prior(self.lag_sigma()) } else { Column::Free };
        let is_known = self.problem.setting.site.noise.is_white_known();
        Some(Record::of_angles(marks, odd, (variance, is_known), self.lever()))
    }

    /// Refuses a significant drift, change with the sense or step, and a drift that agrees with the
    /// tilt's.
    fn judge(&self, record: &Record, [drift, turn, step]: [Option<Found>; 3]) -> Passed {
        let gain = |found: &Option<Found>| found.map_or(0.0, |found| found.gain);
        let believed = [gain(&drift) - BELIEVED, gain(&step) - STEP_BELIEVED - record.places()];
        if believed[1] > 0.0 && believed[1] >= believed[0] {
            return Err(stepped(record, step));
        }
        let [drifts, turns] = [gain(&drift), gain(&turn)];
        let sigmas = libm::sqrt(turns);
        refuse_if(turns > BELIEVED, Refusal::SensesDisagree { sigmas })?;
        let sigmas = libm::sqrt(drifts);
        refuse_if(believed[0] > 0.0, Refusal::DirectionDrifts { sigmas })?;
        let tilting = self.problem.tilting;
        let is_creep = drift.zip(tilting.creep(self.fit.tilt)).is_some_and(|(drift, creep)| {
            (drift.change[0] - creep).abs() < ALIKE * libm::sqrt(drift.change_variance)
        });
        refuse_if(is_creep, Refusal::TiltChanged { change: MilliG(tilting.change() * 1e3) })
    }

    /// Whether the sensor has a flat response.
    fn is_flat(&self) -> bool {
        self.problem.setting.sensor.is_flat
    }

    /// Time, s, that a rotating base must have turned for its angle to equal the effect of its rate
    /// on the vertical Earth rate, which the gyro measures through the tilt.
    fn lever(&self) -> f64 {
        let across = (self.fit.tilt * Complex::unit(-self.fit.azimuth.0)).im;
        across / self.problem.earth()[0]
    }

    /// Variance of a turn's direction, rad².
    fn angle_variance(&self, pair: &Pair) -> f64 {
        let size = self.reference(pair, Sense::Clockwise).size();
        let gain = if self.is_flat() { 1.0 } else { pair.gain(self.problem.earth()[0]) };
        of_one_turn(&self.problem.noise, pair.speed()) * gain * gain / (size * size)
    }

    /// Reference phasor of a turn: the Earth rate, or the mean phasor of its sense for a sensor
    /// that is not flat.
    fn reference(&self, pair: &Pair, sense: Sense) -> Complex {
        if self.is_flat() {
            let size = self.fit.ratio * self.problem.earth()[0];
            return Complex::unit(self.fit.azimuth.0).scaled(size);
        }
        if sense == Sense::Clockwise { pair.clockwise.phasor } else { pair.counter.phasor }
    }

    /// Direction of a turn's phasor relative to the reference, rad, for small angles.
    fn angle(&self, mark: &Mark, pair: &Pair) -> f64 {
        let sense = Sense::of(f64::from(mark.odd));
        let lag = if self.is_flat() { self.lag(pair) } else { 0.0 };
        let back = Complex::unit(libm::atan(sense.signed(pair.speed() * lag)));
        let [re, im] = mark.value.map(f64::from);
        let reference = self.reference(pair, sense);
        (Complex::new(re, im) * back * reference.conjugate()).im / reference.power()
    }

    /// Lag that was compensated, s.
    fn lag(&self, pair: &Pair) -> f64 {
        misalignment::nearest(self.problem.misalignments, pair.speed()).map_or(0.0, believed_lag)
    }

    /// Standard deviation of the lag that was not compensated, 1σ, s.
    fn lag_sigma(&self) -> f64 {
        let of = |pair: &Pair| {
            let law = solution::LAG_LAW * self.lag(pair).abs();
            libm::hypot(law, self.fit.senses_sigma / pair.speed()).max(solution::EXACT_LAG)
        };
        self.problem.pairs.iter().map(of).fold(0.0, f64::max)
    }
}

/// Refusal of a step.
fn stepped(record: &Record, step: Option<Found>) -> alignment::Refusal {
    let Some((Shape::Step(after), step)) = step.map(|step| (step.shape, step)) else {
        return Refusal::DirectionDrifts { sigmas: 0.0 }.into();
    };
    if record.is_between_senses(after) {
        return Refusal::SensesDisagree { sigmas: libm::sqrt(step.gain) }.into();
    }
    let (angle, after) = (Radians(step.change[0]).into(), Seconds(after));
    alignment::Refusal::HeadingStepped { angle, after }
}

/// Variance that the azimuth lacks where a possible change is neglected, rad²: at the end, or of a
/// step on either side of it. `places` is the gain in chi-square that chance achieves by choosing
/// among them.
fn lacking(change: &Found, steady: &Found, places: f64) -> f64 {
    let possible = if places > 0.0 { STEP_POSSIBLE + places } else { POSSIBLE };
    let prior = CHANGING[usize::from(change.gain < possible)];
    let odds = prior * libm::exp(0.5 * (change.gain.min(50.0) - places));
    let late = change.at_end[0] - steady.at_end[0];
    let is_step = matches!(change.shape, Shape::Step(_));
    let early = if is_step { late - change.change[0] } else { 0.0 };
    let shift = late.abs().max(early.abs());
    let lacks = shift * shift + (change.variance - steady.variance).max(0.0);
    odds / (1.0 + odds) * lacks
}
