//! Tilt of the stage from the accelerometer that rides on it.
//!
//! Over the stage angle θ the readings are `f_x/g = Re(F e^{jθ}) + b_x` and
//! `f_y/g = −Im(F e^{jθ}) + b_y`. The tilt phasor F and both biases are fitted
//! together: over a full circle F comes out free of bias; over a short arc, or from an accelerometer
//! on the base, the bias's stated uncertainty goes into F's.
//!
//! Three more phasors tell what is wrong. One that grows with time, t·F′, is a base that tilts: it turns the
//! gyro by F′ as the Earth does, 1 °/h of it by 6° at 50° of latitude. One that turns the other way,
//! `G e^{−jθ}`, is an encoder that counts against the stage. One that is there from some dwell on is an encoder
//! that slipped, or a platform that was moved. Biases that grow with time are an accelerometer that warms up: they
//! stay where they are while the stage turns.

use super::direction::{inverted, quadratic};
use super::regression::{COLUMNS, Column, Regression};
use super::setting::Mount;
use crate::signal::dwell::Dwell;
use crate::units::DEGREE_PER_HOUR;

/// The tilt phasor in g: real part along body x, imaginary part to its quadrature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tilt {
    /// Real part of F, sin(pitch), at [`Self::time`].
    pub real: f64,
    /// Imaginary part of F, sin(roll)·cos(pitch), at [`Self::time`].
    pub imaginary: f64,
    /// When F is so, s: the end of the last dwell.
    pub time: f64,
    /// How fast F changes: zero of a base that stands as far as its forces tell.
    pub rate: TiltRate,
    /// How fast it may change nevertheless: what the forces show but do not prove.
    pub unproven: TiltRate,
    /// Covariance of the two parts of F, g².
    pub covariance: [[f64; 2]; 2],
    /// Accelerometer biases along its x and y, g, at [`Self::time`].
    pub bias: [f64; 2],
    /// How fast they change, 1/s: zero as far as the forces tell.
    pub bias_rate: [f64; 2],
    /// RMS of the dwells' forces about any tilt and any bias, g.
    pub scatter: f64,
    /// Size of the phasor that turns against the stage, g; zero where it may be chance, or two axes that differ.
    pub counter: f64,
    /// After which time, s, F became another one, and by how much, g.
    pub step: Option<(f64, f64)>,
    /// RMS that this tilt and rate leave of the forces, g.
    pub left: f64,
    /// Whether it was measured; else the platform is taken as level.
    pub measured: bool,
}

/// How fast a tilt phasor changes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TiltRate {
    /// F′, 1/s.
    pub value: [f64; 2],
    /// Its covariance, 1/s².
    pub covariance: [[f64; 2]; 2],
}

impl Tilt {
    /// The tilt at another time, s.
    #[must_use]
    pub fn at(&self, time: f64) -> Self {
        let elapsed = time - self.time;
        let [real, imaginary] = self.rate.value.map(|rate| rate * elapsed);
        Self { real: self.real + real, imaginary: self.imaginary + imaginary, time, ..*self }
    }

    /// What a base that tilts turns about its axes forward and right, rad/s, for a rate of F in 1/s.
    #[must_use]
    pub fn turning(&self, [real, imaginary]: [f64; 2]) -> [f64; 2] {
        let upward = self.upward();
        [imaginary / upward, real / upward]
    }

    /// |F|, the sine of the tilt angle.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        libm::hypot(self.real, self.imaginary)
    }

    /// Pitch of the body, rad; positive nose up.
    #[must_use]
    pub fn pitch(&self) -> f64 {
        libm::asin(self.real.clamp(-1.0, 1.0))
    }

    /// Roll of the body, rad; positive right side down.
    #[must_use]
    pub fn roll(&self) -> f64 {
        let cosine = libm::sqrt((1.0 - self.real * self.real).max(1e-12));
        libm::asin((self.imaginary / cosine).clamp(-1.0, 1.0))
    }

    /// The sensitive axis at stage angle `theta` (rad), in the levelled frame: forward, right, down.
    #[must_use]
    pub fn sensitive_axis(&self, theta: f64) -> [f64; 3] {
        let (sine, cosine) = libm::sincos(theta);
        let (sine_pitch, sine_roll) = (self.real, libm::sin(self.roll()));
        let cosine_pitch = libm::sqrt((1.0 - sine_pitch * sine_pitch).max(0.0));
        let cosine_roll = libm::sqrt((1.0 - sine_roll * sine_roll).max(0.0));
        [
            cosine_pitch * cosine + sine_pitch * sine_roll * sine,
            cosine_roll * sine,
            -sine_pitch * cosine + cosine_pitch * sine_roll * sine,
        ]
    }

    /// The base's downward axis, in the levelled frame.
    #[must_use]
    pub fn down(&self) -> [f64; 3] {
        let (sine_roll, cosine_roll) = libm::sincos(self.roll());
        let cosine_pitch = libm::sqrt((1.0 - self.real * self.real).max(0.0));
        [self.real * cosine_roll, -sine_roll, cosine_pitch * cosine_roll]
    }

    /// Specific force away from the base plane, up through it, in g.
    #[must_use]
    pub fn upward(&self) -> f64 {
        let magnitude = self.magnitude();
        libm::sqrt((1.0 - magnitude * magnitude).max(0.0))
    }

    /// Accelerometer biases along its x and y, g, at another time, s.
    #[must_use]
    pub fn bias_at(&self, time: f64) -> [f64; 2] {
        let [x, y] = self.bias_rate.map(|rate| rate * (time - self.time));
        [self.bias[0] + x, self.bias[1] + y]
    }

    /// Specific force along the sensitive axis and 90° clockwise of it, in g, free of bias.
    #[must_use]
    pub fn force(&self, theta: f64) -> [f64; 2] {
        let (sine, cosine) = libm::sincos(theta);
        [self.real * cosine - self.imaginary * sine, -(self.real * sine + self.imaginary * cosine)]
    }
}

/// Least uncertainty of a bias that is said to be exact, g.
const EXACT_BIAS: f64 = 1e-9;
/// Uncertainty of a bias of which nothing is known, g.
const ANY_BIAS: f64 = 1.0;
/// Twice the logarithm of likelihoods by which one explanation is clearly better than another.
const CLEARLY: f64 = 10.0;
/// Scatter with which the first fit is weighted, and the least that the second believes, g.
const SCATTER: [f64; 2] = [1e-4, 5e-6];

/// Squared significance from which a tilt rate or a counter-turning phasor is believed: two parts of which
/// one of ten thousand healthy sessions has so much.
const BELIEVED: f64 = 18.4;
/// The same of a step, which may be at any of sixty places.
const STEP_BELIEVED: f64 = 22.0;
/// Size of the phasor of the forces that turns against the stage, over that which turns with it, beyond which
/// the encoder counts the wrong way: an accelerometer whose axes differ by 20 % makes a tenth.
const COUNTER: f64 = 0.3;
/// What a scatter that is itself estimated adds to that bound, over its degrees of freedom (F instead of
/// chi-square), and what it adds to the rarer step's.
const FEW: f64 = 11.0;
const STEP_FEW: f64 = 25.0;
/// 1σ of how fast a base tilts that does, 1/s: 3 °/h.
const FASTEST: f64 = 3.0 * DEGREE_PER_HOUR;
/// Squared significance from which a tilt rate is more than chance: one of forty healthy sessions has so much.
const SHOWN: f64 = 7.4;

impl TiltRate {
    /// The same, for a base that tilts no faster than [`FASTEST`].
    fn possible(&self) -> Self {
        let [[a, _], [_, b]] = self.covariance;
        let part = 1.0 / (1.0 + 0.5 * (a + b) / (FASTEST * FASTEST));
        Self {
            value: self.value.map(|value| value * libm::sqrt(part)),
            covariance: self.covariance.map(|row| row.map(|value| value * part)),
        }
    }
}

/// Fits the tilt to the dwells' mean forces, for gravity in m/s² and the 1σ of each accelerometer
/// bias in m/s² (zero: taken as free of bias).
///
/// The accelerometer rides on a stage. The scatter of the dwells about a first fit is the noise of the
/// second. Dwells without force make the platform level and not measured.
#[must_use]
pub fn tilt<'a>(
    dwells: impl Iterator<Item = &'a Dwell> + Clone,
    gravity: f64,
    bias_sigma: f64,
) -> Tilt {
    tilt_in(&Mount::STAGE, dwells, gravity, bias_sigma)
}

/// The same from the accelerometer of any mount.
#[must_use]
pub fn tilt_in<'a>(
    mount: &Mount,
    dwells: impl Iterator<Item = &'a Dwell> + Clone,
    gravity: f64,
    bias_sigma: f64,
) -> Tilt {
    let bias = (bias_sigma / gravity).max(EXACT_BIAS);
    let mut forces = Forces::new(mount, dwells, gravity);
    let time = forces.time;
    // On an arc biases that drift, and a base that tilts, look like an encoder that counts the other way.
    let alone = forces.countering(bias, [0.0; 2]);
    let mut tilting = forces.weighted(bias, Beside::Rate);
    // Biases that drift matter where they look like a base that tilts.
    let is_shown = tilting.as_ref().is_some_and(|tilting| tilting.significance() > SHOWN);
    let drifting = is_shown.then(|| forces.weighted(bias, Beside::Drift)).flatten();
    let drifting = drifting.filter(|drifting| drifting.significance() > BELIEVED);
    let explains = |one: &Option<Found>, other: &Option<Found>| match (one, other) {
        (Some(one), Some(other)) => one.explains_more_than(other),
        (one, None) => one.is_some(),
        (None, Some(_)) => false,
    };
    let is_drifting = explains(&drifting, &tilting);
    let is_doubtful = !is_drifting && drifting.is_some() && !explains(&tilting, &drifting);
    if let Some(drifting) = drifting.filter(|_| is_drifting) {
        forces.drift = drifting.beside;
        tilting = forces.weighted(bias, Beside::Rate);
    }
    let any = forces.fit(ANY_BIAS, SCATTER[0], Beside::Nothing).map_or(0.0, |fit| fit.scatter);
    let Some(standing) = forces.weighted(bias, Beside::Nothing) else { return Tilt::default() };
    let mut tilt = Tilt { bias_rate: forces.drift, ..standing.tilt(time, any) };
    let after = forces.likeliest_step(&standing);
    if let Some(tilting) = tilting {
        tilt = tilting.believed(tilt, is_doubtful);
    }
    let step = forces.weighted(bias, Beside::Step(after));
    // A step is searched for at many places, and there is one more thing to believe in.
    let is_shown =
        |fit: &Found| fit.significance() * fit.few(FEW) > STEP_BELIEVED * fit.few(STEP_FEW);
    let step = step.filter(|fit| is_shown(fit) && fit.scatter < tilt.left);
    tilt.step = step.map(|fit| (after, libm::hypot(fit.beside[0], fit.beside[1])));
    let alone = alone.filter(|fit| !fit.is_beaten_by(tilt.left));
    let counter = alone.or_else(|| forces.countering(bias, tilt.rate.value));
    tilt.counter = counter.map_or(0.0, |fit| libm::hypot(fit.beside[0], fit.beside[1]));
    tilt
}

/// How fast the forces show the base to tilt, proven or not; `None` where they show nothing of it.
#[must_use]
pub fn tilting<'a>(
    mount: &Mount,
    dwells: impl Iterator<Item = &'a Dwell> + Clone,
    gravity: f64,
    bias_sigma: f64,
) -> Option<TiltRate> {
    let bias = (bias_sigma / gravity).max(EXACT_BIAS);
    let found = Forces::new(mount, dwells, gravity).weighted(bias, Beside::Rate)?;
    Some(TiltRate { value: found.beside, covariance: found.beside_covariance })
}

/// Mean specific force over gravity, positive where it points up through the platform, as at rest;
/// `None` where no dwell has a force.
#[must_use]
pub fn gravity_ratio<'a>(dwells: impl Iterator<Item = &'a Dwell>, gravity: f64) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for [x, y, z] in dwells.filter_map(|dwell| dwell.force) {
        let size = libm::sqrt(x * x + y * y + z * z);
        sum += if z < 0.0 { size } else { -size };
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count / gravity)
}

/// A phasor that is fitted beside the tilt's.
#[derive(Clone, Copy)]
enum Beside {
    Nothing,
    /// One that grows with the time: F′, 1/s.
    Rate,
    /// None, but biases that change with the time, 1/s.
    Drift,
    /// One that turns against the stage, of a base that tilts by so much, 1/s.
    Counter([f64; 2]),
    /// One that is there after a time, s.
    Step(f64),
}

/// The mean forces of dwells.
struct Forces<'m, D> {
    mount: &'m Mount,
    dwells: D,
    gravity: f64,
    /// Since when the time of a rate counts, s.
    time: f64,
    /// How fast the accelerometer's biases are known to change, 1/s.
    drift: [f64; 2],
}

/// What a fit of the forces found, in g.
struct Found {
    phasor: [f64; 2],
    covariance: [[f64; 2]; 2],
    bias: [f64; 2],
    beside: [f64; 2],
    beside_covariance: [[f64; 2]; 2],
    scatter: f64,
    freedom: f64,
}

impl<'a, 'm, D: Iterator<Item = &'a Dwell> + Clone> Forces<'m, D> {
    /// Rates count from the end of the last dwell.
    fn new(mount: &'m Mount, dwells: D, gravity: f64) -> Self {
        let time = dwells.clone().last().map_or(0.0, Dwell::end);
        Self { mount, dwells, gravity, time, drift: [0.0; 2] }
    }

    /// Fits with the scatter that a first fit shows.
    #[inline(never)]
    fn weighted(&self, bias_sigma: f64, beside: Beside) -> Option<Found> {
        let first = self.fit(bias_sigma, SCATTER[0], beside)?;
        let scatter = first.scatter.max(SCATTER[1]) * libm::sqrt(first.few(FEW));
        Some(self.fit(bias_sigma, scatter, beside).unwrap_or(first))
    }

    /// A phasor that turns against the stage, of a base that tilts by so much, 1/s, where it is believed.
    fn countering(&self, bias_sigma: f64, rate: [f64; 2]) -> Option<Found> {
        let found = self.weighted(bias_sigma, Beside::Counter(rate))?;
        let [counter, with] = [found.beside, found.phasor].map(|[a, b]| libm::hypot(a, b));
        (found.significance() > BELIEVED && counter > COUNTER * with).then_some(found)
    }

    /// After which time, s, the forces show another tilt most: the greatest sum of what is left of them, turned
    /// back by the stage, on either side.
    fn likeliest_step(&self, standing: &Found) -> f64 {
        let count = self.dwells.clone().filter(|dwell| dwell.force.is_some()).count() as f64;
        let (mut sum, mut behind, mut before) = ([0.0; 2], 0.0, None);
        let mut best = (0.0, 0.0);
        for dwell in self.dwells.clone() {
            let Some([x, y, _]) = dwell.force else { continue };
            if let Some(last) = before {
                let gain = (sum[0] * sum[0] + sum[1] * sum[1]) / (behind * (1.0 - behind / count));
                if gain > best.0 {
                    best = (gain, 0.5 * (last + dwell.middle));
                }
            }
            let (sine, cosine) = libm::sincos(self.mount.accelerometer_turn(dwell));
            let [real, imaginary] = standing.phasor;
            let [x, y] = self.steady([x, y], dwell);
            let left_x = x - standing.bias[0] - (real * cosine - imaginary * sine);
            let left_y = y - standing.bias[1] + real * sine + imaginary * cosine;
            sum[0] += left_x * cosine - left_y * sine;
            sum[1] -= left_x * sine + left_y * cosine;
            behind += 1.0;
            before = Some(dwell.middle);
        }
        best.1
    }

    /// A force, m/s², in g without what the biases are known to have changed.
    fn steady(&self, [x, y]: [f64; 2], dwell: &Dwell) -> [f64; 2] {
        let elapsed = dwell.middle - self.time;
        [x / self.gravity - self.drift[0] * elapsed, y / self.gravity - self.drift[1] * elapsed]
    }

    /// One fit whose noise is `sigma` g.
    #[inline(never)]
    fn fit(&self, bias_sigma: f64, sigma: f64, beside: Beside) -> Option<Found> {
        let mut regression = Regression::<COLUMNS>::default();
        let mut rows: f64 = 0.0;
        for dwell in self.dwells.clone() {
            let Some([x, y, _]) = dwell.force else { continue };
            let (sine, cosine) = libm::sincos(self.mount.accelerometer_turn(dwell));
            let elapsed = dwell.middle - self.time;
            let (mut across, mut along) = ([0.0; 2], [0.0; 2]);
            let [mut left_x, mut left_y] = self.steady([x, y], dwell);
            match beside {
                Beside::Rate => {
                    along = [cosine * elapsed, -sine * elapsed];
                    across = [-sine * elapsed, -cosine * elapsed];
                }
                Beside::Drift => (along, across) = ([elapsed, 0.0], [0.0, elapsed]),
                Beside::Step(after) if dwell.middle > after => {
                    along = [cosine, -sine];
                    across = [-sine, -cosine];
                }
                Beside::Counter([real, imaginary]) => {
                    left_x -= (real * cosine - imaginary * sine) * elapsed;
                    left_y += (real * sine + imaginary * cosine) * elapsed;
                    along = [cosine, sine];
                    across = [sine, -cosine];
                }
                Beside::Nothing | Beside::Step(_) => {}
            }
            let mut push = |row: [f64; COLUMNS], left: f64| {
                regression.push(&row.map(|value| value / sigma), left / sigma);
            };
            push([cosine, -sine, 1.0, 0.0, 0.0, along[0], along[1]], left_x);
            push([-sine, -cosine, 0.0, 1.0, 0.0, across[0], across[1]], left_y);
            rows += 2.0;
        }
        let bias = Column::Prior(bias_sigma);
        let (extra, parameters) = match beside {
            Beside::Nothing => (Column::Absent, 4.0),
            Beside::Rate | Beside::Drift | Beside::Counter(_) | Beside::Step(_) => {
                (Column::Free, 6.0)
            }
        };
        let model = [Column::Free, Column::Free, bias, bias, Column::Absent, extra, extra];
        let solution = regression.solve(&model)?;
        let [real, imaginary, bias_x, bias_y, _, beside_real, beside_imaginary] =
            solution.coefficients;
        let covariance = &solution.covariance;
        let freedom = (rows - parameters).max(1.0);
        // What the biases are, in their own σ, is no scatter of the dwells.
        let biases = (bias_x * bias_x + bias_y * bias_y) / (bias_sigma * bias_sigma);
        Some(Found {
            phasor: [real, imaginary],
            covariance: square(covariance, 0),
            bias: [bias_x, bias_y],
            beside: [beside_real, beside_imaginary],
            beside_covariance: square(covariance, 5),
            scatter: sigma * libm::sqrt((solution.chi_square - biases).max(0.0) / freedom),
            freedom,
        })
    }
}

/// Two neighbouring columns' part of a covariance.
fn square(covariance: &[[f64; COLUMNS]; COLUMNS], from: usize) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| covariance[from + i][from + j]))
}

impl Found {
    fn tilt(&self, time: f64, scatter: f64) -> Tilt {
        let [real, imaginary] = self.phasor;
        Tilt {
            real,
            imaginary,
            time,
            covariance: self.covariance,
            bias: self.bias,
            scatter,
            left: self.scatter,
            measured: true,
            ..Tilt::default()
        }
    }

    /// Squared significance of what was fitted beside, as [`BELIEVED`] counts it.
    fn significance(&self) -> f64 {
        inverted(&self.beside_covariance)
            .map_or(0.0, |information| quadratic(&information, self.beside))
    }

    /// Whether it explains clearly more than another with as many parameters, by both likelihoods.
    fn explains_more_than(&self, other: &Self) -> bool {
        other.is_beaten_by(self.scatter)
    }

    /// Whether what leaves this scatter explains clearly more, with as many parameters.
    fn is_beaten_by(&self, scatter: f64) -> bool {
        2.0 * self.freedom * libm::log(self.scatter / scatter) > CLEARLY
    }

    /// By how much a variance that rests on this scatter is greater for its few degrees of freedom.
    fn few(&self, few: f64) -> f64 {
        1.0 + few / self.freedom
    }

    /// The tilt where this one changes: believed where it is significant and nothing else may be what shows, else
    /// unproven.
    fn believed(&self, standing: Tilt, is_doubtful: bool) -> Tilt {
        let significance = self.significance();
        let found = TiltRate { value: self.beside, covariance: self.beside_covariance };
        if significance > BELIEVED && !is_doubtful {
            let Tilt { time, scatter, bias_rate, .. } = standing;
            return Tilt { rate: found, bias_rate, ..self.tilt(time, scatter) };
        }
        let unproven = if significance > SHOWN { found.possible() } else { TiltRate::default() };
        Tilt { unproven, ..standing }
    }
}
