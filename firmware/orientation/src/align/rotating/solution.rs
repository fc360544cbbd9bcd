//! From the phasors of both senses to an azimuth with its standard deviation (equations.md §4).

use super::Setting;
use super::average::Average;
use super::coupling::{self, Coupling};
use super::level::Lean;
use super::molecular::{self, Freed, Halves};
use super::tilting::Tilting;
use crate::align::budget::Budget;
use crate::math::Complex;
use crate::units::{ARCSECOND, TURN, wrapped};

/// How far a flat sensor may lag behind the encoder, where no uneven turn has told, 1σ, s.
const UNKNOWN_LAG: f64 = 0.01;

/// Least 1σ of a lag, s: an encoder and a gyro are read no nearer to each other.
pub const EXACT_LAG: f64 = 1e-6;

/// What the law by which a lag follows from the uneven turn, that of one pole, may be wrong by, relative.
pub const LAG_LAW: f64 = 0.15;

/// What an uneven turn leaves untold of a sensor's phase at the turn, 1σ, rad: it is modulated over a band,
/// and an integrated g-sensitivity answers to the modulation.
const UNTOLD: f64 = 2.5e-3;

/// How far the frequency of a modulation may be from the speed that it stands for, relative.
const SAME_SPEED: f64 = 0.3;

/// What an encoder's harmonic may turn the angle by where nothing is stated, 1σ, rad: 2″.
const ENCODER_HARMONIC: f64 = 2.0 * ARCSECOND;

/// Part of an azimuth's error for which a platform's unevenness twice a turn counts, 1σ, where it may be the encoder's
/// error as well: it is all of it or nothing.
const ELLIPTIC: f64 = 0.6;

/// 1σ of what rounding to a step leaves in the phasor of a signal that turns with the platform, over the step: 2/π of
/// Bessel's function J₁, of any phase, in the mean of both senses.
const ROUNDED: f64 = 0.32;
/// Greatest value of that function.
const BESSEL: f64 = 0.58;

/// Most speeds.
pub const SPEEDS: usize = 2;

/// Both senses at one speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Clockwise.
    pub clockwise: Average,
    /// Counter-clockwise.
    pub counter: Average,
}

impl Pair {
    /// Mean speed of both senses, rad/s.
    #[must_use]
    pub fn speed(&self) -> f64 {
        0.5 * (self.clockwise.speed + self.counter.speed)
    }

    /// Both.
    #[must_use]
    pub fn senses(&self) -> [&Average; 2] {
        [&self.clockwise, &self.counter]
    }

    fn phasors(&self) -> [Complex; 2] {
        self.senses().map(|average| average.phasor)
    }

    /// Half the difference of the platform's rates: an unevenness that belongs to the angle.
    fn uneven(&self) -> Complex {
        (self.clockwise.turning - self.counter.turning).scaled(0.5)
    }

    /// The same with the phasors turned back by what a lag of so many seconds makes of them.
    fn without_lag(mut self, lag: f64) -> Self {
        let back = Complex::unit(libm::atan(self.speed() * lag));
        self.clockwise.phasor = self.clockwise.phasor * back;
        self.counter.phasor = self.counter.phasor * back.conjugate();
        self
    }

    /// Half the sum of both senses: what does not change its sign.
    #[must_use]
    pub fn even(&self) -> Complex {
        (self.clockwise.phasor + self.counter.phasor).scaled(0.5)
    }

    /// Half their difference: what does.
    #[must_use]
    pub fn odd(&self) -> Complex {
        (self.clockwise.phasor - self.counter.phasor).scaled(0.5)
    }

    /// Gain of the sensor by the horizontal Earth rate that both senses show, without the tilt's part.
    #[must_use]
    pub fn gain(&self, horizontal: f64) -> f64 {
        let [clockwise, counter] = self.phasors();
        libm::sqrt((clockwise * counter).size()) / horizontal
    }

    /// Variances of either part of Q₊ and Q₋ for a spectral density of the sensor's input.
    fn variances(&self, density: f64, gain: f64) -> [f64; 2] {
        self.senses().map(|average| average.share * of_turn(average.speed, density) * gain * gain)
    }

    /// One over the variance of either part of their mean.
    fn information(&self, density: f64, gain: f64) -> f64 {
        let [clockwise, counter] = self.variances(density, gain);
        4.0 / (clockwise + counter)
    }
}

/// Variance of either part of one turn's phasor at a speed in rad/s, for a spectral density, (rad/s)².
#[must_use]
pub fn of_turn(speed: f64, density: f64) -> f64 {
    2.0 * density * speed / TURN
}

/// The azimuth after each stage of compensation, rad, [0, 2π).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stages {
    /// The raw phasor of the clockwise turns at the first speed.
    pub raw: f64,
    /// The same without the platform's own rate.
    pub coupling: f64,
    /// Both senses together.
    pub senses: f64,
    /// Everything: tilt, g-sensitivity, second speed.
    pub full: f64,
}

/// What the phasors say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fit {
    /// Azimuth of body x from true north, clockwise from above, rad, [0, 2π).
    pub azimuth: f64,
    /// Where its standard deviation comes from.
    pub budget: Budget,
    /// Standard deviation that no estimator can beat which must find the same unknowns, rad; zero where
    /// the gyro's noise is not known.
    pub limit: f64,
    /// The same with gain, lag and integrated g-sensitivity known, rad.
    pub plain_limit: f64,
    /// The azimuth after each stage.
    pub stages: Stages,
    /// Tilt of the platform as the accelerometer shows it, g: size and angle of its phasor.
    pub tilt: Complex,
    /// 1σ of either part of it, g.
    pub tilt_sigma: f64,
    /// The same as pitch and roll of the body.
    pub lean: Lean,
    /// Horizontal Earth rate found over expected, and its 1σ; one and infinite where the sensor's gain is
    /// unknown.
    pub ratio: f64,
    /// 1σ of that.
    pub ratio_sigma: f64,
    /// Least part of it that a flat sensor passes which lags as the uneven turn shows.
    pub passed: f64,
    /// The integrated g-sensitivity at the slower speed over the Earth rate that turns with it, γ.
    pub molecular: Complex,
    /// What the slower speed alone would be off by for it, rad.
    pub one_speed: f64,
    /// How far both speeds disagree about it, in σ.
    pub disagreement: f64,
    /// How far two speeds of a sensor of unknown lag stray from what the uneven turn shows of it, in σ.
    pub astray: f64,
    /// Phase of the sensor at each speed, rad; zero for a flat one.
    pub phases: [f64; SPEEDS],
    /// How much both senses differ, squared and over the variance of either part; flat sensors alone.
    pub difference: f64,
    /// 1σ of half the difference that both senses of a flat sensor may show beside its noise, of the Earth
    /// rate: its lag, as far as it is not known, and the encoder's harmonics through the coupling.
    pub senses_sigma: f64,
}

impl Fit {
    /// Standard deviation of the azimuth, rad.
    #[must_use]
    pub fn sigma(&self) -> f64 {
        self.budget.sigma()
    }
}

/// What the phasors are solved with.
pub struct Problem<'a> {
    /// What is known beforehand.
    pub setting: &'a Setting,
    /// The speeds, one or two.
    pub pairs: &'a [Pair],
    /// How the gyro feels the platform's rate, at one speed or at each.
    pub couplings: &'a [Coupling],
    /// Spectral density of the gyro's noise at a speed in rad/s, (rad/s)²/Hz.
    pub density: &'a dyn Fn(f64) -> f64,
    /// Spectral density of its white noise; zero where it is not known.
    pub white: f64,
    /// Its N, rad/√s: known, or as the turns show it.
    pub angle_random_walk: f64,
    /// How the base tilts.
    pub tilting: &'a Tilting,
    /// The encoder's error twice a turn that would make the platform turn evenly, ε e^{jψ}, rad.
    pub ellipse: Complex,
}

impl Problem<'_> {
    /// Solves; `None` without a pair.
    #[must_use]
    pub fn solve(&self) -> Option<Fit> {
        let first = self.pairs.first()?;
        let (tilt, tilt_sigma) = self.tilt();
        let lean = Lean::of(tilt);
        let mut fit = Fit { tilt, tilt_sigma, lean, ratio: 1.0, passed: 1.0, ..Fit::default() };
        fit.ratio_sigma = f64::INFINITY;
        let is_flat = self.setting.sensor.is_flat;
        let turned = if is_flat { self.flat(&mut fit) } else { self.lagging(&mut fit)? };
        fit.azimuth = wrapped(turned.angle);
        fit.budget = self.budget(&fit, &turned);
        fit.plain_limit = self.plain_limit();
        fit.limit = if self.white > 0.0 { fit.budget.noise } else { 0.0 };
        let senses = if is_flat { first.even().angle() } else { self.halves(first).angle };
        let stages = [first.clockwise.raw.angle(), first.clockwise.phasor.angle(), senses];
        let [raw, coupling, senses] = stages.map(wrapped);
        fit.stages = Stages { raw, coupling, senses, full: fit.azimuth };
        Some(fit)
    }

    /// Horizontal and vertical Earth rate as the axis can feel them, rad/s.
    #[must_use]
    pub fn earth(&self) -> [f64; 2] {
        let latitude = self.setting.common.latitude;
        let along = self.couplings.first().map_or(1.0, |coupling| libm::cos(coupling.angle()));
        [latitude.horizontal_rate() * along, latitude.vertical_rate()]
    }

    /// The tilt's phasor and the 1σ of its parts, g.
    fn tilt(&self) -> (Complex, f64) {
        let gravity = self.setting.common.latitude.gravity();
        let (mut sum, mut seconds) = (Complex::default(), 0.0);
        for average in self.pairs.iter().flat_map(Pair::senses) {
            sum = sum + average.force.scaled(average.seconds);
            seconds += average.seconds;
        }
        let variance = force_density(self.pairs).0 / seconds;
        (sum.scaled(1.0 / seconds / gravity), libm::sqrt(variance) / gravity)
    }

    /// What multiplies the tilt, rad/s per g: vertical Earth rate and ordinary g-sensitivity.
    fn per_tilt(&self, ratio: f64) -> Complex {
        let [along, across] = self.setting.common.g_sensitivity;
        Complex::new(ratio * self.earth()[1] + along, across)
    }

    /// A flat sensor: what changes its sign with the sense cancels.
    fn flat(&self, fit: &mut Fit) -> Turned {
        let [horizontal, _] = self.earth();
        let (mut sum, mut information) = (Complex::default(), 0.0);
        for pair in self.pairs {
            let coupling = coupling::nearest(self.couplings, pair.speed());
            let sigma = coupling.map_or(UNKNOWN_LAG, Coupling::lag_sigma).min(UNKNOWN_LAG);
            let harmonic = ENCODER_HARMONIC + self.setting.common.encoder_sigma;
            let shown = match coupling {
                Some(coupling) => harmonic * coupling.sine.abs() * pair.speed() / horizontal,
                // What the platform's unevenness makes of it cancels between the senses.
                None => self.setting.coupling_limit * pair.uneven().size() / horizontal,
            };
            let known = libm::hypot(shown, self.rounded(1.0, self.beside()));
            fit.senses_sigma = fit.senses_sigma.max(libm::hypot(sigma * pair.speed(), known));
            let lag = coupling.map_or(0.0, believed_lag);
            let tangent = libm::fabs(lag * pair.speed()) * (1.0 + LAG_LAW);
            fit.passed = fit.passed.min(1.0 / libm::hypot(1.0, tangent));
            let pair = pair.without_lag(lag);
            let weight = pair.information((self.density)(pair.speed()), 1.0);
            sum = sum + pair.even().scaled(weight);
            information += weight;
            let odd = pair.odd().size();
            fit.difference = fit.difference.max(odd * odd * weight);
        }
        let mean = sum.scaled(1.0 / information);
        let (mut angle, mut size) = (0.0, mean.size());
        // The tilt's part is small: a few rounds settle the ratio.
        for _ in 0..4 {
            fit.ratio = size / horizontal;
            let others = self.per_tilt(fit.ratio) * fit.tilt + self.tilting.turning(&fit.lean);
            (angle, size) = fit.lean.azimuth(mean - others);
        }
        let rounded = self.rounded(1.0, self.beside());
        fit.ratio_sigma = libm::hypot(libm::sqrt(1.0 / information) / horizontal, rounded);
        // Q₊ − Q₋ is −2jγE′.
        let odd = self.slowest().map_or(Complex::default(), Pair::odd);
        fit.molecular = odd / mean * Complex::new(0.0, 1.0);
        let noise = 1.0 / information / (size * size);
        Turned { angle, noise, rounded: of_turned(rounded, self.beside()), left: 0.0 }
    }

    /// 1σ of what rounding to steps adds along what turns with the platform, of the Earth rate, for a sensor's gain and
    /// what turns beside that rate, of it.
    fn rounded(&self, gain: f64, beside: f64) -> f64 {
        let step = self.setting.rate_step / self.earth()[0] / gain;
        // J₁ of 2π times the signal over the step falls as √(2/(πx)).
        let falling = libm::sqrt(step / libm::hypot(1.0, beside)) / core::f64::consts::PI;
        ROUNDED * step * falling.min(BESSEL)
    }

    /// What turns with the platform beside the Earth rate for its unevenness, of it, at the speed where it is most.
    fn beside(&self) -> f64 {
        self.pairs.iter().map(|pair| self.beside_at(pair)).fold(0.0, f64::max)
    }

    /// The same at one speed.
    fn beside_at(&self, pair: &Pair) -> f64 {
        let coupling = coupling::nearest(self.couplings, pair.speed());
        coupling.map_or(0.0, |found| found.sine.abs() * pair.uneven().size()) / self.earth()[0]
    }

    /// The speed that shows an integrated g-sensitivity most.
    fn slowest(&self) -> Option<&Pair> {
        self.pairs.iter().reduce(|a, b| if b.speed() < a.speed() { b } else { a })
    }

    fn halves(&self, pair: &Pair) -> Halves {
        let (gain, density) = (pair.gain(self.earth()[0]), (self.density)(pair.speed()));
        let beside = self.beside_at(pair);
        let rounded = of_turned(self.rounded(gain, beside), beside);
        Halves::of(pair.speed(), pair.phasors(), pair.variances(density, gain), rounded)
    }

    /// A sensor of unknown gain and lag: half of arg Q₊Q₋, then the tilt's part off the angle.
    fn lagging(&self, fit: &mut Fit) -> Option<Turned> {
        let mut halves: heapless::Vec<Halves, SPEEDS> = heapless::Vec::new();
        for (pair, phase) in self.pairs.iter().zip(&mut fit.phases) {
            let half = self.halves(pair);
            *phase = half.phase;
            // There are no more pairs than speeds.
            let _ = halves.push(half);
        }
        let freed: Freed = molecular::freed(&halves, self.setting.sensor.molecular_sigma)?;
        fit.molecular = freed.ratio;
        fit.one_speed = freed.one_speed;
        fit.disagreement = freed.disagreement;
        fit.astray = self.astray(&halves, &freed, self.coupling_sigma(fit));
        let slowest = self.slowest()?.speed();
        for (phase, pair) in fit.phases.iter_mut().zip(self.pairs) {
            *phase += freed.ratio.re * slowest / pair.speed();
        }
        let [horizontal, _] = self.earth();
        let others = self.per_tilt(1.0) * fit.tilt + self.tilting.turning(&fit.lean);
        let others = others.scaled(1.0 / horizontal);
        let (angle, slope) = fit.lean.azimuth_towards(freed.angle, others)?;
        let [noise, left] = [freed.noise, freed.left].map(|variance| variance * slope * slope);
        Some(Turned { angle, noise, rounded: freed.rounded * slope.abs(), left })
    }

    /// How far two speeds stray from the lag that the uneven turn shows, in σ: their own lags, and what the g-sensitivity
    /// that follows from these does to the azimuth. A base that turns between the stretches does that.
    fn astray(&self, halves: &[Halves], freed: &Freed, coupling_sigma: f64) -> f64 {
        let [slow, quick] = halves else { return 0.0 };
        let (slow, quick) = if quick.speed < slow.speed { (quick, slow) } else { (slow, quick) };
        // What a phase lacks of the law's is −x, which falls as the speed grows.
        let uneven = coupling_sigma * coupling_sigma;
        let [(at_slow, slow_variance), (at_quick, quick_variance)] = [slow, quick].map(|half| {
            let (law, sigma) = self.law(half.speed, freed.ratio.size());
            (half.phase - law, half.variance + uneven + sigma * sigma)
        });
        let falls = slow.speed / quick.speed;
        let lags = (at_quick - falls * at_slow)
            / libm::sqrt(quick_variance + falls * falls * slow_variance);
        let (y, span) = (freed.ratio.im, 1.0 - falls * falls);
        let variance = (slow.variance + quick.variance + 2.0 * uneven) / (span * span);
        let speeds = (freed.one_speed + at_slow * y) / libm::sqrt(variance + y * y * slow_variance);
        lags.abs().max(speeds.abs())
    }

    /// Phase of the sensor at a speed in rad/s as the uneven turn shows its lag, and the 1σ of that, rad: an integrated
    /// g-sensitivity of so much of the Earth rate answers to the modulation as well.
    fn law(&self, speed: f64, molecular: f64) -> (f64, f64) {
        let Some(found) = coupling::nearest(self.couplings, speed) else { return (0.0, TURN) };
        let at = |speed: f64| found.response(speed).scaled(found.sine.signum()).angle();
        let phase = at(speed);
        // A pole and a high-pass together bend as either may; that one pole holds from speed to speed is what is asked.
        let is_near = (speed / found.frequency - 1.0).abs() < SAME_SPEED;
        let bent = if is_near { phase - at(found.frequency) } else { 0.0 };
        let lag = speed * found.lag_sigma();
        let beside = molecular * self.earth()[0] / (speed * found.sine).abs();
        let sigma = libm::hypot(libm::hypot(lag, beside), bent).min(TURN);
        (phase, libm::hypot(UNTOLD, sigma))
    }

    /// The limit of a flat sensor of known g-sensitivity in the same time.
    fn plain_limit(&self) -> f64 {
        if self.white <= 0.0 {
            return 0.0;
        }
        let information: f64 =
            self.pairs.iter().map(|pair| pair.information(self.white, 1.0)).sum();
        1.0 / libm::sqrt(information) / self.earth()[0]
    }

    /// The part of the noise that is white, of one; all of it where that is not known.
    fn white_part(&self, pair: &Pair) -> f64 {
        if self.white > 0.0 { (self.white / (self.density)(pair.speed())).min(1.0) } else { 1.0 }
    }

    fn budget(&self, fit: &Fit, turned: &Turned) -> Budget {
        let common = &self.setting.common;
        let [horizontal, _] = self.earth();
        let size = fit.tilt.size();
        let white = self.pairs.first().map_or(1.0, |pair| self.white_part(pair));
        let across = (fit.tilt * Complex::unit(-turned.angle)).im;
        let cosine = libm::cos(common.latitude.rad());
        Budget {
            noise: libm::sqrt(turned.noise * white),
            drift: libm::sqrt(
                turned.noise * (1.0 - white)
                    + self.tilting.doubt(&fit.lean, turned.angle, horizontal),
            ),
            g_sensitivity: libm::hypot(
                common.kappa_sigma(self.angle_random_walk) * size / horizontal,
                libm::sqrt(turned.left),
            ),
            accelerometer: self.per_tilt(1.0).size() * fit.tilt_sigma / horizontal,
            encoder: libm::hypot(self.encoder_sigma(turned.angle), self.coupling_sigma(fit)),
            latitude: across.abs() * common.latitude_sigma / (cosine * cosine),
            // A flat sensor's scale is found with the azimuth, but not for what a base that tilts turns it by.
            scale: libm::hypot(
                self.tilting.scale(common.scale_sigma, &fit.lean, turned.angle, horizontal),
                turned.rounded,
            ),
            temperature: 0.0,
            displacement: 0.0,
        }
    }

    /// What the encoder's errors turn the azimuth by, rad: of its zero, and where nothing is known of it twice a turn,
    /// (ε/2) e^{j(ψ − 2A)} of the Earth rate.
    fn encoder_sigma(&self, azimuth: f64) -> f64 {
        let known = libm::hypot(self.setting.common.encoder_sigma, self.setting.encoder_zero_sigma);
        if self.setting.harmonics_known {
            return known;
        }
        let turned = 0.5 * (self.ellipse * Complex::unit(-2.0 * azimuth)).im;
        libm::hypot(known, ELLIPTIC * turned)
    }

    /// What the coupling's uncertainty turns the azimuth by, rad. Of an unevenness that belongs to the
    /// angle, hence changes its sign with the sense, the part in phase cancels but for what an integrated
    /// g-sensitivity mixes in; the part in quadrature, a lag, does not.
    fn coupling_sigma(&self, fit: &Fit) -> f64 {
        let [horizontal, _] = self.earth();
        let worst = self.pairs.iter().map(|pair| {
            let [clockwise, counter] = pair.senses().map(|average| average.turning);
            let (even, odd) = ((clockwise + counter).scaled(0.5), pair.uneven());
            let coupling = coupling::nearest(self.couplings, pair.speed());
            let limit = self.setting.coupling_limit;
            let unknown = [limit, limit * UNKNOWN_LAG * pair.speed()];
            let [in_phase, lagging] = coupling.map_or(unknown, |found| found.sigmas(pair.speed()));
            let mixed = libm::hypot(even.size(), odd.size() * fit.molecular.size());
            // A flat sensor has no dynamics of which the uneven turn could show but a part.
            let response = coupling.filter(|_| !self.setting.sensor.is_flat);
            let left = response.map_or(0.0, |found| UNTOLD * found.sine.abs());
            libm::hypot(in_phase * mixed, libm::hypot(lagging, left) * odd.size())
        });
        worst.fold(0.0, f64::max) / horizontal
    }
}

/// The lag of a flat sensor, s: as the uneven turn shows it, as far as that knows better than that it is
/// small.
#[must_use]
pub fn believed_lag(coupling: &Coupling) -> f64 {
    let (known, sigma) = (UNKNOWN_LAG * UNKNOWN_LAG, coupling.lag_sigma());
    coupling.lag() * known / (known + sigma * sigma)
}

/// Variance of either part of a force's phasor times the time over which it was found, (m/s²)²·s, and the
/// degrees of freedom from which this is known.
#[must_use]
pub fn force_density(pairs: &[Pair]) -> (f64, u32) {
    let (mut sum, mut degrees) = (0.0, 0);
    for average in pairs.iter().flat_map(Pair::senses) {
        sum += average.force_scatter * average.seconds / (0.5 * f64::from(average.degrees) + 1.0);
        degrees += average.degrees;
    }
    (sum / f64::from(degrees.max(1)), degrees)
}

/// 1σ of what rounding turns the angle of a phasor by, rad: along a signal that is all of what is rounded it adds
/// nothing across.
fn of_turned(rounded: f64, beside: f64) -> f64 {
    rounded * beside / libm::hypot(1.0, beside)
}

/// An azimuth before it is judged.
struct Turned {
    /// rad.
    angle: f64,
    /// Variance from the gyro's noise, rad².
    noise: f64,
    /// 1σ from rounding to steps, rad.
    rounded: f64,
    /// Variance from a g-sensitivity that was not told apart, rad².
    left: f64,
}
