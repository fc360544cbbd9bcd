//! Tilt of the stage from the accelerometer on its platform.
//!
//! Over the stage angle θ the readings are `f_x/g = Re(F e^{jθ}) + b_x` and
//! `f_y/g = −Im(F e^{jθ}) + b_y`. The tilt phasor F and both biases are fitted
//! together: over a full circle F comes out free of bias; over a short arc, or from an accelerometer
//! on the base, the bias's stated uncertainty goes into F's.
//!
//! Three more phasors are fitted to detect faults. One that grows with time, t·F′, is a base that
//! tilts: it turns the gyro by F′ just as the Earth does, and 1 °/h of it costs 6° of azimuth at
//! 50° of latitude. One that rotates the other way, `G e^{−jθ}`, is an encoder that counts against
//! the stage. One that is present only after some dwell is an encoder that slipped, or a platform
//! that was moved. Biases that grow with time are an accelerometer that warms up: they do not
//! rotate with the stage.

use super::direction::{inverted, quadratic};
use super::mount::Mount;
use super::setting::Setting;
use super::tilt::{Tilt, TiltRate};
use crate::math::{COLUMNS, Column, Regression};
use crate::signal::Dwell;
use crate::units::DEGREE_PER_HOUR;

/// Least uncertainty of a bias that is configured as exact, g.
const EXACT_BIAS: f64 = 1e-9;
/// Uncertainty of a bias without prior knowledge, g.
const ANY_BIAS: f64 = 1.0;
/// Twice the log-likelihood ratio from which one explanation is clearly better than another.
const CLEARLY: f64 = 10.0;
/// Scatter with which the first fit is weighted, and least scatter of the second, g.
const SCATTER: [f64; 2] = [1e-4, 5e-6];

/// Squared significance at which a tilt rate or a counter-rotating phasor is accepted: for two
/// parts, one of ten thousand sound sessions exceeds it.
const BELIEVED: f64 = 18.4;
/// Squared significance at which a step is accepted, which may be at any of sixty places.
const STEP_BELIEVED: f64 = 22.0;
/// Ratio of the counter-rotating phasor to the one that rotates with the stage, beyond which the
/// encoder counts the wrong way: an accelerometer whose axes differ by 20 % shows a tenth.
const COUNTER: f64 = 0.3;
/// Increase of that threshold over the degrees of freedom, because the scatter is itself estimated
/// (F instead of chi-square).
const FEW: f64 = 11.0;
/// Increase of the threshold of a step over the degrees of freedom.
const STEP_FEW: f64 = 25.0;
/// Standard deviation of the rate at which a moving base tilts, 1/s: 3 °/h.
const FASTEST: f64 = 3.0 * DEGREE_PER_HOUR;
/// Squared significance at which a tilt rate is possible: one of forty sound sessions exceeds it.
const SHOWN: f64 = 7.4;

impl TiltRate {
    /// Magnitude of the phasor.
    fn size(&self) -> f64 {
        libm::hypot(self.value[0], self.value[1])
    }

    /// Rate shrunk by the prior of a base that tilts no faster than [`FASTEST`].
    fn possible(&self) -> Self {
        let [[a, _], [_, b]] = self.covariance;
        let part = 1.0 / (1.0 + 0.5 * (a + b) / (FASTEST * FASTEST));
        Self {
            value: self.value.map(|value| value * libm::sqrt(part)),
            covariance: self.covariance.map(|row| row.map(|value| value * part)),
        }
    }
}

/// Fits the tilt to the dwells' mean forces; a 1σ of zero takes the accelerometers as free of bias.
///
/// The mount determines whether the accelerometer rides on the stage. The scatter of the dwells about a
/// first fit weights the second. Without forces the platform is taken as level and the tilt as not measured.
pub fn tilt<'a>(setting: &Setting, dwells: impl Iterator<Item = &'a Dwell> + Clone) -> Tilt {
    let mut forces = Forces::new(setting, dwells);
    let time = forces.time;
    // On an arc, drifting biases and a tilting base look like an encoder that counts the other way.
    let alone = forces.countering([0.0; 2]);
    let mut tilting = forces.weighted(Beside::Rate);
    // Drifting biases matter only where they look like a tilting base.
    let is_shown = tilting.as_ref().is_some_and(|tilting| tilting.significance() > SHOWN);
    let drifting = is_shown.then(|| forces.weighted(Beside::Drift)).flatten();
    let drifting = drifting.filter(|drifting| drifting.significance() > BELIEVED);
    let explains = |one: &Option<Found>, other: &Option<Found>| match (one, other) {
        (Some(one), Some(other)) => other.is_beaten_by(one.scatter),
        (one, None) => one.is_some(),
        (None, Some(_)) => false,
    };
    let is_drifting = explains(&drifting, &tilting);
    let is_ambiguous = !is_drifting && drifting.is_some() && !explains(&tilting, &drifting);
    if let Some(drifting) = drifting.filter(|_| is_drifting) {
        forces.drift = drifting.beside.value;
        tilting = forces.weighted(Beside::Rate);
    }
    let any = forces.fit(ANY_BIAS, SCATTER[0], Beside::Nothing).map_or(0.0, |fit| fit.scatter);
    let Some(standing) = forces.weighted(Beside::Nothing) else { return Tilt::default() };
    let mut tilt = Tilt { bias_rate: forces.drift, ..standing.tilt(time, any) };
    let after = forces.likeliest_step(&standing);
    if let Some(tilting) = tilting {
        tilt = tilting.believed(tilt, is_ambiguous);
    }
    let step = forces.weighted(Beside::Step(after));
    // A step is searched for at many places, and is one more hypothesis to accept.
    let is_shown =
        |fit: &Found| fit.significance() * fit.few(FEW) > STEP_BELIEVED * fit.few(STEP_FEW);
    let step = step.filter(|fit| is_shown(fit) && fit.scatter < tilt.left);
    tilt.step = step.map(|fit| (after, fit.beside.size()));
    let alone = alone.filter(|fit| !fit.is_beaten_by(tilt.left));
    let counter = alone.or_else(|| forces.countering(tilt.rate.value));
    tilt.counter = counter.map_or(0.0, |fit| fit.beside.size());
    tilt
}

/// Rate of tilt that the forces show, significant or not; `None` where they cannot determine it.
pub(super) fn tilting<'a>(
    setting: &Setting,
    dwells: impl Iterator<Item = &'a Dwell> + Clone,
) -> Option<TiltRate> {
    Forces::new(setting, dwells).weighted(Beside::Rate).map(|found| found.beside)
}

/// Mean specific force over gravity, positive where it points up through the platform, as at rest;
/// `None` where no dwell has a force.
pub(super) fn gravity_ratio<'a>(
    dwells: impl Iterator<Item = &'a Dwell>,
    gravity: f64,
) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for [x, y, z] in dwells.filter_map(|dwell| dwell.force) {
        let size = libm::sqrt(x.0 * x.0 + y.0 * y.0 + z.0 * z.0);
        sum += if z.0 < 0.0 { size } else { -size };
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count / gravity)
}

/// Phasor that is fitted in addition to the tilt's.
#[derive(Clone, Copy)]
enum Beside {
    /// No additional phasor.
    Nothing,
    /// Phasor that grows with time: a tilting base, F′ in 1/s.
    Rate,
    /// No phasor, but biases that change with time, in 1/s.
    Drift,
    /// Phasor that rotates against the stage, for a base that tilts at this rate, 1/s.
    Counter([f64; 2]),
    /// Phasor that is present after a time, s.
    Step(f64),
}

/// Mean forces of the dwells, as the fits use them.
struct Forces<'m, D> {
    /// Mount of the accelerometer.
    mount: &'m Mount,
    /// Standard deviation of each accelerometer bias, 1σ, g.
    bias: f64,
    /// Iterator over the dwells.
    dwells: D,
    /// Local gravity, m/s².
    gravity: f64,
    /// Reference time of rates, s.
    time: f64,
    /// Known rate of change of the accelerometer's biases, 1/s.
    drift: [f64; 2],
}

/// Result of a fit of the forces, in g.
struct Found {
    /// Tilt phasor F.
    phasor: [f64; 2],
    /// Covariance of F, g².
    covariance: [[f64; 2]; 2],
    /// Biases along x and y.
    bias: [f64; 2],
    /// Additional phasor, in g or 1/s, and its covariance.
    beside: TiltRate,
    /// RMS of the residuals.
    scatter: f64,
    /// Degrees of freedom.
    freedom: f64,
}

impl<'a, 'm, D: Iterator<Item = &'a Dwell> + Clone> Forces<'m, D> {
    /// Forces of these dwells, with rates counted from the end of the last dwell.
    fn new(setting: &'m Setting, dwells: D) -> Self {
        let (mount, gravity) = (&setting.mount, setting.site.latitude.gravity().0);
        let bias = (setting.site.accelerometer_bias_sigma.0 / gravity).max(EXACT_BIAS);
        let time = dwells.clone().last().map_or(0.0, |dwell| dwell.end().0);
        Self { mount, bias, dwells, gravity, time, drift: [0.0; 2] }
    }

    /// Fits a second time, weighted by the scatter of the first fit.
    #[inline(never)]
    fn weighted(&self, beside: Beside) -> Option<Found> {
        let first = self.fit(self.bias, SCATTER[0], beside)?;
        let scatter = first.scatter.max(SCATTER[1]) * libm::sqrt(first.few(FEW));
        Some(self.fit(self.bias, scatter, beside).unwrap_or(first))
    }

    /// Counter-rotating phasor for a base that tilts at this rate, 1/s, where it is significant and
    /// large.
    fn countering(&self, rate: [f64; 2]) -> Option<Found> {
        let found = self.weighted(Beside::Counter(rate))?;
        let counter = found.beside.size();
        let with = libm::hypot(found.phasor[0], found.phasor[1]);
        (found.significance() > BELIEVED && counter > COUNTER * with).then_some(found)
    }

    /// Time, s, after which the forces most likely show another tilt: the greatest sum of
    /// residuals, rotated back by the stage angle, on either side.
    fn likeliest_step(&self, standing: &Found) -> f64 {
        let count = self.dwells.clone().filter(|dwell| dwell.force.is_some()).count() as f64;
        let (mut sum, mut behind, mut before) = ([0.0; 2], 0.0, None);
        let mut best = (0.0, 0.0);
        for dwell in self.dwells.clone() {
            let Some([x, y, _]) = dwell.force else { continue };
            if let Some(last) = before {
                let gain = (sum[0] * sum[0] + sum[1] * sum[1]) / (behind * (1.0 - behind / count));
                if gain > best.0 {
                    best = (gain, 0.5 * (last + dwell.middle.0));
                }
            }
            let (sine, cosine) = libm::sincos(self.mount.accelerometer_turn(dwell));
            let [real, imaginary] = standing.phasor;
            let [x, y] = self.steady([x.0, y.0], dwell);
            let left_x = x - standing.bias[0] - (real * cosine - imaginary * sine);
            let left_y = y - standing.bias[1] + real * sine + imaginary * cosine;
            sum[0] += left_x * cosine - left_y * sine;
            sum[1] -= left_x * sine + left_y * cosine;
            behind += 1.0;
            before = Some(dwell.middle.0);
        }
        best.1
    }

    /// Force in g without the known drift of the biases, from m/s².
    fn steady(&self, [x, y]: [f64; 2], dwell: &Dwell) -> [f64; 2] {
        let elapsed = dwell.middle.0 - self.time;
        [x / self.gravity - self.drift[0] * elapsed, y / self.gravity - self.drift[1] * elapsed]
    }

    /// One fit with noise of `sigma` g.
    #[inline(never)]
    fn fit(&self, bias_sigma: f64, sigma: f64, beside: Beside) -> Option<Found> {
        let mut regression = Regression::<COLUMNS>::default();
        let mut rows: f64 = 0.0;
        for dwell in self.dwells.clone() {
            let Some([x, y, _]) = dwell.force else { continue };
            let (sine, cosine) = libm::sincos(self.mount.accelerometer_turn(dwell));
            let elapsed = dwell.middle.0 - self.time;
            let (mut across, mut along) = ([0.0; 2], [0.0; 2]);
            let [mut left_x, mut left_y] = self.steady([x.0, y.0], dwell);
            match beside {
                Beside::Rate => {
                    along = [cosine * elapsed, -sine * elapsed];
                    across = [-sine * elapsed, -cosine * elapsed];
                }
                Beside::Drift => (along, across) = ([elapsed, 0.0], [0.0, elapsed]),
                Beside::Step(after) if dwell.middle.0 > after => {
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
        let is_alone = matches!(beside, Beside::Nothing);
        let (extra, parameters) =
            if is_alone { (Column::Absent, 4.0) } else { (Column::Free, 6.0) };
        let model = [Column::Free, Column::Free, bias, bias, Column::Absent, extra, extra];
        let solution = regression.solve(&model)?;
        let [real, imaginary, bias_x, bias_y, _, beside_real, beside_imaginary] =
            solution.coefficients;
        let covariance = &solution.covariance;
        let freedom = (rows - parameters).max(1.0);
        // The squares of the biases in their own σ belong to the prior, not to the scatter of the
        // dwells.
        let biases = (bias_x * bias_x + bias_y * bias_y) / (bias_sigma * bias_sigma);
        Some(Found {
            phasor: [real, imaginary],
            covariance: square(covariance, 0),
            bias: [bias_x, bias_y],
            beside: TiltRate {
                value: [beside_real, beside_imaginary],
                covariance: square(covariance, 5),
            },
            scatter: sigma * libm::sqrt((solution.chi_square - biases).max(0.0) / freedom),
            freedom,
        })
    }
}

/// Covariance block of two neighbouring columns.
pub(super) fn square(covariance: &[[f64; COLUMNS]; COLUMNS], from: usize) -> [[f64; 2]; 2] {
    [0, 1].map(|i| [0, 1].map(|j| covariance[from + i][from + j]))
}

impl Found {
    /// Tilt of this fit at a time, with the RMS about any bias.
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

    /// Squared significance of the additional phasor, to be compared with [`BELIEVED`].
    fn significance(&self) -> f64 {
        let information = inverted(&self.beside.covariance);
        information.map_or(0.0, |information| quadratic(&information, self.beside.value))
    }

    /// Whether a fit with this scatter and as many parameters is clearly more likely.
    fn is_beaten_by(&self, scatter: f64) -> bool {
        2.0 * self.freedom * libm::log(self.scatter / scatter) > CLEARLY
    }

    /// Factor on a variance that rests on this scatter, for its few degrees of freedom.
    fn few(&self, few: f64) -> f64 {
        1.0 + few / self.freedom
    }

    /// Tilt with this rate of change: adopted where it is significant and there is no other
    /// explanation, otherwise kept as unproven.
    fn believed(&self, standing: Tilt, is_ambiguous: bool) -> Tilt {
        let significance = self.significance();
        let found = self.beside;
        if significance > BELIEVED && !is_ambiguous {
            let Tilt { time, scatter, bias_rate, .. } = standing;
            return Tilt { rate: found, bias_rate, ..self.tilt(time, scatter) };
        }
        let unproven = if significance > SHOWN { found.possible() } else { TiltRate::default() };
        Tilt { unproven, ..standing }
    }
}
