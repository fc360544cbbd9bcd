//! Azimuth and its standard deviation from the phasors of both senses (MET 2018).
//!
//! The steps are: remove the response to the platform's rate (axis misalignment) and the known lag,
//! take the mean of both senses (flat sensor) or half of arg Q₊Q₋ (unknown response), subtract the
//! tilt's part (`Ω_v` + κ)F, and solve for the azimuth on the horizon.

use super::Setting;
use super::average::Average;
use super::level::Lean;
use super::misalignment::{self, AxisMisalignment};
use super::molecular::{self, Freed, Halves};
use super::tilting::Tilting;
use super::turn::SPEEDS;
use crate::alignment::budget::Budget;
use crate::math::Complex;
use crate::noise::GyroNoise;
use crate::units::{ARCSECOND, Radians, TURN, wrapped};

/// Standard deviation of a flat sensor's lag without a rate-modulated turn, 1σ, s.
const UNKNOWN_LAG: f64 = 0.01;

/// Least 1σ of a lag, s: encoder and gyro are not synchronised better.
pub(crate) const EXACT_LAG: f64 = 1e-6;

/// Relative error of the one-pole law by which the lag follows from the rate-modulated turn.
pub(crate) const LAG_LAW: f64 = 0.15;

/// Part of a sensor's phase at the turn rate that a rate-modulated turn does not determine, 1σ,
/// rad: the modulation covers a band, and an integrated g-sensitivity responds to it.
const UNDETERMINED_PHASE: f64 = 2.5e-3;

/// Greatest relative distance of a modulation's frequency from the speed that it represents.
const SAME_SPEED: f64 = 0.3;

/// Encoder harmonic where none is configured, 1σ, rad: 2″.
const ENCODER_HARMONIC: f64 = 2.0 * ARCSECOND;

/// Weight of a platform's unevenness twice per turn in the azimuth's error, 1σ, where it may as
/// well be an encoder error: the truth is all of it or none.
const ELLIPTIC: f64 = 0.6;

/// Standard deviation, 1σ, that quantisation leaves in the phasor of a signal that rotates with the
/// platform, over the step: 2/π of Bessel's function J₁, for any phase, in the mean of both senses.
const ROUNDED: f64 = 0.32;
/// Greatest value of J₁.
const BESSEL: f64 = 0.58;

/// Averages of both senses at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Average of the clockwise stretch.
    pub clockwise: Average,
    /// Average of the counter-clockwise stretch.
    pub counter: Average,
}

impl Pair {
    /// Mean speed of both senses, rad/s.
    #[must_use]
    pub fn speed(&self) -> f64 {
        0.5 * (self.clockwise.speed + self.counter.speed)
    }

    /// Averages of both senses, clockwise first.
    #[must_use]
    pub fn senses(&self) -> [&Average; 2] {
        [&self.clockwise, &self.counter]
    }

    /// Phasors Q₊ and Q₋, rad/s.
    fn phasors(&self) -> [Complex; 2] {
        self.senses().map(|average| average.phasor)
    }

    /// Half the difference of the platform's rate phasors: an unevenness that is fixed to the
    /// angle.
    fn unevenness(&self) -> Complex {
        (self.clockwise.turning - self.counter.turning).scaled(0.5)
    }

    /// Pair with its phasors rotated back by the effect of a lag, s.
    fn without_lag(mut self, lag: f64) -> Self {
        let back = Complex::unit(libm::atan(self.speed() * lag));
        self.clockwise.phasor = self.clockwise.phasor * back;
        self.counter.phasor = self.counter.phasor * back.conjugate();
        self
    }

    /// Half the sum of both senses' phasors: the part that does not change its sign with the sense.
    pub(super) fn even(&self) -> Complex {
        (self.clockwise.phasor + self.counter.phasor).scaled(0.5)
    }

    /// Half the difference of both senses' phasors: the part that changes its sign with the sense.
    pub(super) fn odd(&self) -> Complex {
        (self.clockwise.phasor - self.counter.phasor).scaled(0.5)
    }

    /// Gain of the sensor from the horizontal Earth rate that both senses show, neglecting the
    /// tilt's part.
    #[must_use]
    pub fn gain(&self, horizontal: f64) -> f64 {
        let [clockwise, counter] = self.phasors();
        libm::sqrt((clockwise * counter).size()) / horizontal
    }

    /// Variances of either part of Q₊ and Q₋, (rad/s)², for a spectral density at the sensor's
    /// input.
    fn variances(&self, density: f64, gain: f64) -> [f64; 2] {
        self.senses().map(|average| average.share * of_turn(average.speed, density) * gain * gain)
    }

    /// Inverse variance of either part of the mean of both senses.
    fn information(&self, density: f64, gain: f64) -> f64 {
        let [clockwise, counter] = self.variances(density, gain);
        4.0 / (clockwise + counter)
    }
}

/// Variance of either part of one turn's phasor, (rad/s)², at a speed in rad/s, for a two-sided
/// spectral density, (rad/s)²/Hz.
pub(super) fn of_turn(speed: f64, density: f64) -> f64 {
    2.0 * density * speed / TURN
}

/// Variance of either part of one turn's phasor at a speed in rad/s about those of other turns,
/// (rad/s)², for a sensor of gain one.
pub(super) fn of_one_turn(noise: &GyroNoise, speed: f64) -> f64 {
    of_turn(speed, noise.density_of_period(speed / TURN))
}

/// Azimuth after each stage of compensation, rad, [0, 2π).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stages {
    /// Angle of the raw phasor of the clockwise turns at the first speed.
    pub raw: Radians,
    /// Angle after the axis misalignment is compensated.
    pub misalignment: Radians,
    /// Angle from both senses together.
    pub senses: Radians,
    /// Azimuth after all compensations: tilt, g-sensitivity, second speed.
    pub full: Radians,
}

/// Result of the fit of the phasors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// Azimuth of body x from true north, clockwise from above, [0, 2π).
    pub azimuth: Radians,
    /// Error budget of the azimuth.
    pub budget: Budget,
    /// Cramér–Rao bound of the azimuth for the same unknowns, 1σ; zero where the gyro's noise
    /// is not known.
    pub limit: Radians,
    /// Cramér–Rao bound with gain, lag and integrated g-sensitivity known, 1σ.
    pub plain_limit: Radians,
    /// Azimuth after each stage of compensation.
    pub stages: Stages,
    /// Tilt phasor F of the platform from the accelerometer, g.
    pub tilt: Complex,
    /// Standard deviation of either part of the tilt phasor, 1σ, g.
    pub tilt_sigma: f64,
    /// Inclination of the body as pitch and roll.
    pub lean: Lean,
    /// Horizontal Earth rate found over the expected one; one where the sensor's gain is unknown.
    pub ratio: f64,
    /// Standard deviation of the ratio, 1σ; infinite where the sensor's gain is unknown.
    pub ratio_sigma: f64,
    /// Least ratio of a flat sensor with the lag that the rate-modulated turn shows.
    pub passed: f64,
    /// Integrated g-sensitivity at the slower speed over the Earth rate, γ.
    pub molecular: Complex,
    /// Error of the slower speed alone due to the integrated g-sensitivity.
    pub one_speed: Radians,
    /// Disagreement of both speeds on the integrated g-sensitivity, in σ.
    pub disagreement: f64,
    /// Disagreement of two speeds with the lag from the rate-modulated turn, in σ; sensors of
    /// unknown lag only.
    pub lag_disagreement: f64,
    /// Phase of the sensor at each speed; zero for a flat one.
    pub phases: [Radians; SPEEDS],
    /// Squared difference of both senses over the variance of either part; flat sensors only.
    pub difference: f64,
    /// Standard deviation, 1σ, of half the difference between the senses of a flat sensor beyond
    /// its noise, relative to the Earth rate: its unknown lag, and the encoder's harmonics through
    /// the axis misalignment.
    pub senses_sigma: f64,
}

impl Fit {
    /// Standard deviation of the azimuth.
    pub fn sigma(&self) -> Radians {
        self.budget.sigma()
    }
}

/// Inputs of the solution.
pub(crate) struct Problem<'a> {
    /// Configuration of the alignment.
    pub setting: &'a Setting,
    /// Pairs of averages, one for each of one or two speeds.
    pub pairs: &'a [Pair],
    /// Axis misalignments, at one speed or at each.
    pub misalignments: &'a [AxisMisalignment],
    /// Noise model of the gyro; its N is known, or estimated from the turns.
    pub noise: GyroNoise,
    /// Motion of a tilting base.
    pub tilting: &'a Tilting,
    /// Encoder error twice per turn that would make the platform's rotation uniform, ε e^{jψ}, rad.
    pub ellipse: Complex,
}

impl Problem<'_> {
    /// Spectral density of the gyro's noise at a speed in rad/s, (rad/s)²/Hz.
    fn density(&self, speed: f64) -> f64 {
        self.noise.density_at(speed / TURN)
    }

    /// Spectral density of the gyro's white noise, (rad/s)²/Hz; zero where it is not known.
    fn white(&self) -> f64 {
        let walk = self.noise.angle_random_walk;
        if self.setting.site.noise.is_white_known() { walk.0 * walk.0 } else { 0.0 }
    }

    /// Solves for the azimuth; `None` without a pair, or without a solution on the horizon.
    pub(crate) fn solve(&self) -> Option<Fit> {
        let first = self.pairs.first()?;
        let (tilt, tilt_sigma) = self.tilt();
        let lean = Lean::of(tilt);
        let mut fit = Fit { tilt, tilt_sigma, lean, ratio: 1.0, passed: 1.0, ..Fit::default() };
        fit.ratio_sigma = f64::INFINITY;
        let is_flat = self.setting.sensor.is_flat;
        let turned = if is_flat { self.flat(&mut fit) } else { self.lagging(&mut fit)? };
        fit.azimuth = Radians(wrapped(turned.angle));
        fit.budget = self.budget(&fit, &turned);
        fit.plain_limit = Radians(self.plain_limit());
        fit.limit = if self.white() > 0.0 { fit.budget.noise } else { Radians(0.0) };
        let senses = if is_flat { first.even().angle() } else { self.halves(first).angle };
        let stages = [first.clockwise.raw.angle(), first.clockwise.phasor.angle(), senses];
        let [raw, misalignment, senses] = stages.map(|angle| Radians(wrapped(angle)));
        fit.stages = Stages { raw, misalignment, senses, full: fit.azimuth };
        Some(fit)
    }

    /// Horizontal and vertical Earth rate that the misaligned axis can measure, rad/s.
    pub(crate) fn earth(&self) -> [f64; 2] {
        let latitude = self.setting.site.latitude;
        let along = self.misalignments.first().map_or(1.0, |found| libm::cos(found.angle().0));
        [latitude.horizontal_rate().0 * along, latitude.vertical_rate().0]
    }

    /// Tilt phasor and the 1σ of its parts, g.
    fn tilt(&self) -> (Complex, f64) {
        let gravity = self.setting.site.latitude.gravity();
        let (mut sum, mut seconds) = (Complex::default(), 0.0);
        for average in self.pairs.iter().flat_map(Pair::senses) {
            sum += average.force.scaled(average.seconds);
            seconds += average.seconds;
        }
        let variance = force_density(self.pairs).0 / seconds;
        (sum.scaled(1.0 / seconds / gravity.0), libm::sqrt(variance) / gravity.0)
    }

    /// Factor of the tilt, rad/s per g: vertical Earth rate and ordinary g-sensitivity.
    fn per_tilt(&self, ratio: f64) -> Complex {
        let [along, across] = self.setting.site.g_sensitivity;
        Complex::new(ratio * self.earth()[1] + along.0, across.0)
    }

    /// Solution of a flat sensor: terms that change sign with the sense cancel.
    fn flat(&self, fit: &mut Fit) -> Turned {
        let [horizontal, _] = self.earth();
        let (mut sum, mut information) = (Complex::default(), 0.0);
        for pair in self.pairs {
            let found = misalignment::nearest(self.misalignments, pair.speed());
            let sigma = found.map_or(UNKNOWN_LAG, AxisMisalignment::lag_sigma).min(UNKNOWN_LAG);
            let harmonic = ENCODER_HARMONIC + self.setting.site.encoder_sigma.0;
            let shown = match found {
                Some(found) => harmonic * found.sine.abs() * pair.speed() / horizontal,
                // Without a misalignment the response to the platform's unevenness cancels between
                // the senses.
                None => self.setting.misalignment_limit.0 * pair.unevenness().size() / horizontal,
            };
            let known = libm::hypot(shown, self.rounded(1.0, self.beside()));
            fit.senses_sigma = fit.senses_sigma.max(libm::hypot(sigma * pair.speed(), known));
            let lag = found.map_or(0.0, believed_lag);
            let tangent = libm::fabs(lag * pair.speed()) * (1.0 + LAG_LAW);
            fit.passed = fit.passed.min(1.0 / libm::hypot(1.0, tangent));
            let pair = pair.without_lag(lag);
            let weight = pair.information(self.density(pair.speed()), 1.0);
            sum += pair.even().scaled(weight);
            information += weight;
            let odd = pair.odd().size();
            fit.difference = fit.difference.max(odd * odd * weight);
        }
        let mean = sum.scaled(1.0 / information);
        let (mut angle, mut size) = (0.0, mean.size());
        // The tilt's part is small, so a few rounds settle the ratio.
        for _ in 0..4 {
            fit.ratio = size / horizontal;
            let others = self.per_tilt(fit.ratio) * fit.tilt + self.tilting.turning(&fit.lean);
            (angle, size) = fit.lean.azimuth(mean - others);
        }
        let rounded = self.rounded(1.0, self.beside());
        fit.ratio_sigma = libm::hypot(libm::sqrt(1.0 / information) / horizontal, rounded);
        // The difference Q₊ − Q₋ is −2jγE′.
        let odd = self.slowest().map_or(Complex::default(), Pair::odd);
        fit.molecular = odd / mean * Complex::new(0.0, 1.0);
        let noise = 1.0 / information / (size * size);
        Turned { angle, noise, rounded: of_turned(rounded, self.beside()), left: 0.0 }
    }

    /// Standard deviation, 1σ, that quantisation adds along the rotating signal, relative to the
    /// Earth rate, for a sensor's gain and for the further rotating signal `beside`, also relative
    /// to it.
    fn rounded(&self, gain: f64, beside: f64) -> f64 {
        let step = self.setting.rate_step.0 / self.earth()[0] / gain;
        // Bessel's function J₁ of 2π times the signal over the step falls as √(2/(πx)).
        let falling = libm::sqrt(step / libm::hypot(1.0, beside)) / core::f64::consts::PI;
        ROUNDED * step * falling.min(BESSEL)
    }

    /// Rotating signal due to the platform's unevenness, relative to the Earth rate, at the speed
    /// where it is greatest.
    fn beside(&self) -> f64 {
        self.pairs.iter().map(|pair| self.beside_at(pair)).fold(0.0, f64::max)
    }

    /// Rotating signal due to the platform's unevenness at one speed, relative to the Earth rate.
    fn beside_at(&self, pair: &Pair) -> f64 {
        let found = misalignment::nearest(self.misalignments, pair.speed());
        found.map_or(0.0, |found| found.sine.abs() * pair.unevenness().size()) / self.earth()[0]
    }

    /// Slowest speed, at which an integrated g-sensitivity is greatest.
    fn slowest(&self) -> Option<&Pair> {
        self.pairs.iter().reduce(|a, b| if b.speed() < a.speed() { b } else { a })
    }

    /// Half-angle quantities of a pair.
    fn halves(&self, pair: &Pair) -> Halves {
        let (gain, density) = (pair.gain(self.earth()[0]), self.density(pair.speed()));
        let beside = self.beside_at(pair);
        let rounded = of_turned(self.rounded(gain, beside), beside);
        Halves::of(pair.speed(), pair.phasors(), pair.variances(density, gain), rounded)
    }

    /// Solution of a sensor of unknown gain and lag: half of arg Q₊Q₋, then the tilt's part is
    /// subtracted from the angle.
    fn lagging(&self, fit: &mut Fit) -> Option<Turned> {
        let halves: heapless::Vec<Halves, SPEEDS> =
            self.pairs.iter().map(|pair| self.halves(pair)).collect();
        let freed: Freed = molecular::freed(&halves, self.setting.sensor.molecular_sigma.0)?;
        fit.molecular = freed.ratio;
        fit.one_speed = Radians(freed.one_speed);
        fit.disagreement = freed.disagreement;
        fit.lag_disagreement = self.lag_disagreement(&halves, &freed, self.misalignment_sigma(fit));
        let slowest = self.slowest()?.speed();
        for ((phase, half), pair) in fit.phases.iter_mut().zip(&halves).zip(self.pairs) {
            *phase = Radians(half.phase + freed.ratio.re * slowest / pair.speed());
        }
        let [horizontal, _] = self.earth();
        let others = self.per_tilt(1.0) * fit.tilt + self.tilting.turning(&fit.lean);
        let others = others.scaled(1.0 / horizontal);
        let (angle, slope) = fit.lean.azimuth_towards(freed.angle, others)?;
        let [noise, left] = [freed.noise, freed.left].map(|variance| variance * slope * slope);
        Some(Turned { angle, noise, rounded: freed.rounded * slope.abs(), left })
    }

    /// Disagreement of two speeds with the lag from the rate-modulated turn, in σ: of their own
    /// lags, and of the azimuth change by the g-sensitivity that follows from these. A base that
    /// rotates between the stretches causes both.
    fn lag_disagreement(&self, halves: &[Halves], freed: &Freed, misalignment_sigma: f64) -> f64 {
        let [slow, quick] = halves else { return 0.0 };
        let (slow, quick) = if quick.speed < slow.speed { (quick, slow) } else { (slow, quick) };
        // The difference of a phase from the law's is −x, which falls as the speed grows.
        let residual = misalignment_sigma * misalignment_sigma;
        let [(at_slow, slow_variance), (at_quick, quick_variance)] = [slow, quick].map(|half| {
            let (law, sigma) = self.law(half.speed, freed.ratio.size());
            (half.phase - law, half.variance + residual + sigma * sigma)
        });
        let falls = slow.speed / quick.speed;
        let lags = (at_quick - falls * at_slow)
            / libm::sqrt(quick_variance + falls * falls * slow_variance);
        let (y, span) = (freed.ratio.im, 1.0 - falls * falls);
        let variance = (slow.variance + quick.variance + 2.0 * residual) / (span * span);
        let speeds = (freed.one_speed + at_slow * y) / libm::sqrt(variance + y * y * slow_variance);
        lags.abs().max(speeds.abs())
    }

    /// Phase of the sensor at a speed in rad/s from the lag of the rate-modulated turn, and its 1σ,
    /// rad. An integrated g-sensitivity of this size relative to the Earth rate responds to the
    /// modulation too.
    fn law(&self, speed: f64, molecular: f64) -> (f64, f64) {
        let found = misalignment::nearest(self.misalignments, speed);
        let Some(found) = found else { return (0.0, TURN) };
        let at = |speed: f64| found.response(speed).scaled(found.sine.signum()).angle();
        let phase = at(speed);
        // A pole and a high-pass together curve as either may; the test is whether one pole holds
        // from speed to speed.
        let is_near = (speed / found.frequency.0 - 1.0).abs() < SAME_SPEED;
        let bent = if is_near { phase - at(found.frequency.0) } else { 0.0 };
        let lag = speed * found.lag_sigma();
        let beside = molecular * self.earth()[0] / (speed * found.sine).abs();
        let sigma = libm::hypot(libm::hypot(lag, beside), bent).min(TURN);
        (phase, libm::hypot(UNDETERMINED_PHASE, sigma))
    }

    /// Cramér–Rao bound of a flat sensor of known g-sensitivity in the same time, 1σ, rad.
    fn plain_limit(&self) -> f64 {
        let white = self.white();
        if white <= 0.0 {
            return 0.0;
        }
        let information: f64 = self.pairs.iter().map(|pair| pair.information(white, 1.0)).sum();
        1.0 / libm::sqrt(information) / self.earth()[0]
    }

    /// White part of the noise power, 0 to 1; one where it is not known.
    fn white_part(&self, pair: &Pair) -> f64 {
        let white = self.white();
        if white > 0.0 { (white / self.density(pair.speed())).min(1.0) } else { 1.0 }
    }

    /// Error budget of the azimuth.
    fn budget(&self, fit: &Fit, turned: &Turned) -> Budget {
        let site = &self.setting.site;
        let [horizontal, _] = self.earth();
        let size = fit.tilt.size();
        let white = self.pairs.first().map_or(1.0, |pair| self.white_part(pair));
        let across = (fit.tilt * Complex::unit(-turned.angle)).im;
        let cosine = libm::cos(site.latitude.rad());
        let encoder = self.encoder_sigma(turned.angle);
        Budget {
            noise: Radians(libm::sqrt(turned.noise * white)),
            drift: Radians(libm::sqrt(
                turned.noise * (1.0 - white)
                    + self.tilting.inflation(&fit.lean, turned.angle, horizontal),
            )),
            g_sensitivity: Radians(libm::hypot(
                site.kappa_sigma(self.noise.angle_random_walk).0 * size / horizontal,
                libm::sqrt(turned.left),
            )),
            accelerometer: Radians(self.per_tilt(1.0).size() * fit.tilt_sigma / horizontal),
            encoder: Radians(libm::hypot(encoder, self.misalignment_sigma(fit))),
            latitude: Radians(across.abs() * site.latitude_sigma.0 / (cosine * cosine)),
            // A flat sensor's scale is estimated with the azimuth, but it still scales the rotation
            // of a tilting base.
            scale: Radians(libm::hypot(
                self.tilting.scale(site.scale_sigma, &fit.lean, turned.angle, horizontal),
                turned.rounded,
            )),
            ..Budget::default()
        }
    }

    /// Contribution of the encoder to the azimuth, 1σ, rad: of its zero, and, where the harmonics
    /// are unknown, of an error twice per turn, (ε/2) e^{j(ψ − 2A)} relative to the Earth rate.
    fn encoder_sigma(&self, azimuth: f64) -> f64 {
        let Setting { site, encoder_zero_sigma: zero, .. } = self.setting;
        let known = libm::hypot(site.encoder_sigma.0, zero.0);
        if self.setting.harmonics_known {
            return known;
        }
        let turned = 0.5 * (self.ellipse * Complex::unit(-2.0 * azimuth)).im;
        libm::hypot(known, ELLIPTIC * turned)
    }

    /// Contribution of the misalignment's uncertainty to the azimuth, 1σ, rad. For an unevenness
    /// that is fixed to the angle, and so changes its sign with the sense, the in-phase part
    /// cancels except for what an integrated g-sensitivity mixes in; the quadrature part, a lag,
    /// does not cancel.
    pub(super) fn misalignment_sigma(&self, fit: &Fit) -> f64 {
        let [horizontal, _] = self.earth();
        let worst = self.pairs.iter().map(|pair| {
            let [clockwise, counter] = pair.senses().map(|average| average.turning);
            let (even, odd) = ((clockwise + counter).scaled(0.5), pair.unevenness());
            let found = misalignment::nearest(self.misalignments, pair.speed());
            let limit = self.setting.misalignment_limit.0;
            let unknown = [limit, limit * UNKNOWN_LAG * pair.speed()];
            let [in_phase, lagging] = found.map_or(unknown, |found| found.sigmas(pair.speed()));
            let mixed = libm::hypot(even.size(), odd.size() * fit.molecular.size());
            // A flat sensor has no dynamics that the rate-modulated turn could show in part only.
            let response = found.filter(|_| !self.setting.sensor.is_flat);
            let left = response.map_or(0.0, |found| UNDETERMINED_PHASE * found.sine.abs());
            libm::hypot(in_phase * mixed, libm::hypot(lagging, left) * odd.size())
        });
        worst.fold(0.0, f64::max) / horizontal
    }
}

/// Lag of a flat sensor, s: that of the rate-modulated turn, shrunk towards zero by the prior that
/// a lag is small.
pub(super) fn believed_lag(misalignment: &AxisMisalignment) -> f64 {
    let (known, sigma) = (UNKNOWN_LAG * UNKNOWN_LAG, misalignment.lag_sigma());
    misalignment.lag().0 * known / (known + sigma * sigma)
}

/// Variance of either part of a force's phasor times the time over which it was measured,
/// (m/s²)²·s, and the degrees of freedom of this estimate.
pub(super) fn force_density(pairs: &[Pair]) -> (f64, u32) {
    let (mut sum, mut degrees) = (0.0, 0);
    for average in pairs.iter().flat_map(Pair::senses) {
        sum += average.force_scatter * average.seconds / (0.5 * f64::from(average.degrees) + 1.0);
        degrees += average.degrees;
    }
    (sum / f64::from(degrees.max(1)), degrees)
}

/// Rotation of a phasor's angle by quantisation, 1σ, rad: along a signal that alone is quantised
/// there is no error across.
fn of_turned(rounded: f64, beside: f64) -> f64 {
    rounded * beside / libm::hypot(1.0, beside)
}

/// Azimuth before the tests.
struct Turned {
    /// Azimuth, rad.
    angle: f64,
    /// Variance from the gyro's noise, rad².
    noise: f64,
    /// Standard deviation from quantisation, 1σ, rad.
    rounded: f64,
    /// Variance from an unresolved g-sensitivity, rad².
    left: f64,
}
