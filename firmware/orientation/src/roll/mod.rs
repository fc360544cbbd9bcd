//! Roll of a body that spins rapidly about its longitudinal axis (Nekrasova 2017).
//!
//! ```text
//!  x-gyro ─▶ angle ─────────────────┬─────────────────────────────▶ roll ± σ ─▶ attitude: course, pitch
//!  y, z forces ─▶ extrema ─γ := γₑ──▲   or   ─▶ sums of a turn ─▶ phase, scale ─▲
//! ```
//!
//! The lift q supports the body, so the accelerometers measure it as `a_y = q cos γ − ρ_y ω²` and
//! `a_z = −q sin γ − ρ_z ω²` (the paper's equation 3; ρ is their distance from the axis). The gyro
//! alone loses the angle by its scale error: at 100 turns a second and 0.1 %, 36° in a second.
//!
//! Axes are the paper's: x forward, y up and z right at roll zero, roll clockwise seen from behind.
//! On the axes of the rest of this crate the force to the right is `a_z`, the force down `−a_y`.

pub mod attitude;
mod circle;
mod extrema;
mod fit;
mod flight;
mod harmonics;
mod lock;
mod phase_accumulator;
mod plausibility;
pub mod progress;

pub use self::extrema::Signal;
pub use self::flight::Flight;
pub use self::phase_accumulator::Roll;
pub use self::progress::Progress;

use self::extrema::Extrema;
use self::lock::Lock;
use self::phase_accumulator::PhaseAccumulator;
use self::plausibility::Plausibility;
use crate::signal::SpinSample;
use crate::units::{AngleIncrement, Instant};
use crate::words::Rounded;

/// Complex numbers in single precision, for the sums of a spinning body.
type Complex = crate::math::Complex<f32>;

/// Method by which the roll is corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Method {
    /// Extrema without interpolation (Nekrasova 2017): at every extremum of a force the roll is set
    /// to that of the extremum, accurate to half a sample at best.
    Extrema,
    /// Extrema located between the samples by a parabola.
    Interpolated,
    /// Phase lock: phase of all samples of a turn, with the gyro's scale error estimated from turn
    /// to turn.
    #[default]
    PhaseLocked,
}

/// Configuration of the roll estimation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Setting {
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Angle random walk N of the x-gyro, rad/√s.
    pub angle_random_walk: f64,
    /// Standard deviation of the x-gyro's scale factor, 1σ, relative.
    pub scale_sigma: f64,
    /// Standard deviation of the x-gyro's bias, 1σ, rad/s.
    pub bias_sigma: f64,
    /// Method by which the roll is corrected.
    pub method: Method,
}

impl Setting {
    /// Configuration of a phase-locked gyro of 0.06 °/√s, with its scale known to 1 % and its bias
    /// to 0.06 °/s.
    #[must_use]
    pub fn new(sample_seconds: f64) -> Self {
        Self {
            sample_seconds,
            angle_random_walk: 1e-3,
            scale_sigma: 0.01,
            bias_sigma: 1e-3,
            method: Method::PhaseLocked,
        }
    }
}

/// Accelerometers of the spinning body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accelerometer {
    /// Accelerometer along y.
    Y,
    /// Accelerometer along z.
    Z,
    /// Accelerometers along y and z.
    Both,
}

crate::words! { Accelerometer:
    Self::Y => "the accelerometer along y shows";
    Self::Z => "the accelerometer along z shows";
    Self::Both => "both accelerometers show";
}

/// Source of the present roll, or fault that prevents it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Condition {
    /// No lift has been detected yet.
    #[default]
    Searching,
    /// Lift and gyro agree.
    Locked,
    /// The lift is below the noise, and the gyro holds the roll.
    Holding,
    /// The body spins too slowly to evaluate its turns.
    NotSpinning,
    /// There are no usable forces.
    ForceLost,
    /// Rotation was lost, and with it the roll, until the next turns show it again.
    RotationLost,
    /// An accelerometer repeats one identical value.
    AccelerometerStuck(Accelerometer),
    /// The gyro about the longitudinal axis repeats one identical rate.
    GyroStuck,
    /// The forces rotate against the gyro: axes or signs are exchanged.
    Mirrored,
    /// The forces describe an ellipse instead of a circle: a scale or axis is wrong.
    Elliptic,
    /// The phase of the forces contradicts the gyro's angle.
    Contradicted,
}

/// Source of the present roll, or fault that prevents it, and how long it has been so.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Source or fault.
    pub condition: Condition,
    /// Duration of a condition other than [`Condition::Searching`] and [`Condition::Locked`], s.
    pub seconds: f64,
}

crate::words! { State:
    Self { condition: Condition::Searching, .. } => "searching: no lift was felt yet";
    Self { condition: Condition::Locked, .. } => "locked";
    Self { condition: Condition::Holding, seconds } => "holding on the gyro for {} s: no lift", Rounded::<2>(seconds);
    Self { condition: Condition::NotSpinning, seconds } => "not spinning for {} s", Rounded::<2>(seconds);
    Self { condition: Condition::ForceLost, seconds } => "without forces for {} s", Rounded::<2>(seconds);
    Self { condition: Condition::RotationLost, seconds } => "rotation lost for {} s", Rounded::<2>(seconds);
    Self { condition: Condition::AccelerometerStuck(which), seconds } => "{} one value for {} s: stuck or dead, check supply and wires", which, Rounded::<2>(seconds);
    Self { condition: Condition::GyroStuck, seconds } => "the gyro about x shows one rate for {} s: stuck or dead, check supply and wires", Rounded::<2>(seconds);
    Self { condition: Condition::Mirrored, seconds } => "the forces go round against the gyro for {} s: swapped or turned round, check axes and signs", Rounded::<2>(seconds);
    Self { condition: Condition::Elliptic, seconds } => "the forces draw an ellipse for {} s: check scales and axes of the accelerometers", Rounded::<2>(seconds);
    Self { condition: Condition::Contradicted, seconds } => "the forces contradict the gyro for {} s: check its scale", Rounded::<2>(seconds);
}

/// Greatest delay of a sample, in sample periods.
const LATE: f32 = 0.5;

/// Estimator of the roll.
#[derive(Clone, Debug)]
pub struct Spin {
    /// Angle from the gyro, corrected.
    phase_accumulator: PhaseAccumulator,
    /// Method in use.
    corrector: Corrector,
    /// Sample period, µs.
    period: f32,
    /// Time of the latest sample.
    latest: Option<Instant>,
    /// Plausibility check of the gyro.
    plausibility: Plausibility,
}

#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap, and the large one is the usual one"
)]
#[derive(Clone, Debug)]
enum Corrector {
    /// Correction by extrema.
    Extrema(Extrema),
    /// Correction by phase lock.
    Lock(Lock),
}

impl Spin {
    /// Begins with an unknown roll.
    #[must_use]
    pub fn new(setting: &Setting) -> Self {
        let corrector = match setting.method {
            Method::Extrema => Corrector::Extrema(Extrema::new(false)),
            Method::Interpolated => Corrector::Extrema(Extrema::new(true)),
            Method::PhaseLocked => Corrector::Lock(Lock::new(setting)),
        };
        Self {
            phase_accumulator: PhaseAccumulator::new(),
            corrector,
            period: (setting.sample_seconds * 1e6) as f32,
            latest: None,
            plausibility: Plausibility::new(setting),
        }
    }

    /// Takes a sample; returns the extremum at which the roll was corrected, if there was one.
    #[inline]
    pub fn push(&mut self, sample: &SpinSample) -> Option<Signal> {
        let missing = self.missing(sample.time);
        let [turned, ..] = sample.turned;
        let before = self.plausibility.before;
        let turned = self.plausibility.take(turned);
        if missing > 0.0 || self.plausibility.is_lost() {
            self.bridge(missing, [before, turned]);
        }
        self.phase_accumulator.turn(turned);
        match &mut self.corrector {
            Corrector::Extrema(extrema) => extrema.push(sample.force, &mut self.phase_accumulator),
            Corrector::Lock(lock) => {
                lock.push(sample, &mut self.phase_accumulator);
                None
            }
        }
    }

    /// Number of samples missing before one of this time.
    #[inline]
    fn missing(&mut self, now: Instant) -> f32 {
        let Some(before) = self.latest.replace(now) else { return 0.0 };
        let elapsed = now.0.saturating_sub(before.0) as u32 as f32;
        let missing = elapsed - self.period;
        if missing > LATE * self.period { missing / self.period } else { 0.0 }
    }

    /// Propagates the roll at the last rate while samples are missing or their gyro reading is
    /// implausible.
    #[inline(never)]
    fn bridge(&mut self, missing: f32, turned: [AngleIncrement; 2]) {
        let [before, now] = turned.map(|turned| turned.0 as f32);
        let mean = 0.5 * (before + now);
        self.phase_accumulator.pass(mean, missing);
        match &mut self.corrector {
            Corrector::Extrema(extrema) => extrema.disturb(),
            Corrector::Lock(lock) => {
                let off = self.plausibility.off();
                // A jump may be genuine at once; a saturated or stuck gyro was right before.
                let unknown =
                    |samples| if off > 0.0 { samples } else { lock.unknown_length(samples) };
                let [known, lost] = self.plausibility.lost().map(unknown);
                let change = (now - before).abs() + off;
                lock.lose(missing, [known, lost + missing], mean, change);
            }
        }
    }

    /// Roll at the latest sample. Before the first correction it counts from zero at the first
    /// sample.
    #[must_use]
    pub fn roll(&self) -> Roll {
        self.phase_accumulator.roll()
    }

    /// Standard deviation of the roll, 1σ, rad; `None` where it is unknown, and for extrema, which
    /// give none.
    #[must_use]
    pub fn sigma(&self) -> Option<f64> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => lock.sigma(&self.phase_accumulator),
        }
    }

    /// Scale error of the gyro, shown over true less one, and its 1σ; `None` for extrema.
    #[must_use]
    pub fn scale(&self) -> Option<[f64; 2]> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => Some(lock.scale()),
        }
    }

    /// Lift of the latest turns, m/s², negative where it points down; `None` where it is unknown.
    #[must_use]
    pub fn lift(&self) -> Option<f64> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => lock.lift(),
        }
    }

    /// Source of the present roll, or fault that prevents it, with its duration.
    #[must_use]
    pub fn state(&self) -> State {
        match (&self.corrector, self.plausibility.stuck()) {
            (Corrector::Extrema(extrema), _) => {
                let found = Condition::Locked;
                let condition = if extrema.has_corrected { found } else { Condition::Searching };
                State { condition, seconds: 0.0 }
            }
            (Corrector::Lock(_), Some(samples)) => {
                let seconds = f64::from(samples) * f64::from(self.period) * 1e-6;
                State { condition: Condition::GyroStuck, seconds }
            }
            (Corrector::Lock(lock), None) => lock.state(self.latest.unwrap_or_default()),
        }
    }

    /// Rotation of the latest sample, corrected for the scale error, in 2⁻³² of a turn.
    pub(super) fn step(&self) -> i32 {
        self.phase_accumulator.step()
    }
}
