//! Roll of a body that spins rapidly about its longitudinal axis (Nekrasova and Uspenskiy 2017).
//!
//! ```text
//!  x-gyro ─▶ angle ─────────────────┬─────────────────────────────▶ roll ± σ ─▶ attitude: course, pitch
//!  y, z forces ─▶ extrema ─γ := γₑ──▲   or   ─▶ sums of a turn ─▶ phase, scale ─▲
//! ```
//!
//! The lift q holds the body up, so the accelerometers feel it turn by turn: `a_y = q cos γ − ρ_y ω²` and
//! `a_z = −q sin γ − ρ_z ω²` (the paper's equation 3; ρ how far they sit off the axis). The gyro alone loses the
//! angle by its scale error: at 100 turns a second and 0.1 %, 36° in a second.
//!
//! Axes are the paper's: x forward, y up and z right at roll zero, roll clockwise seen from behind. On the axes of
//! the rest of this crate the force to the right is `a_z`, that downwards `−a_y`.

pub mod attitude;
mod circle;
mod complex;
mod extrema;
mod fit;
mod harmonics;
mod lock;
mod pace;
mod phase_accumulator;

pub use self::extrema::Signal;
pub use self::phase_accumulator::Roll;

use self::extrema::Extrema;
use self::lock::Lock;
use self::pace::Timing;
use self::phase_accumulator::PhaseAccumulator;
use crate::signal::SpinSample;
use crate::units::{AngleIncrement, Instant};
use crate::words;
use crate::words::Rounded;

/// How the roll is corrected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The paper's: at every extremum of a force the roll is that of the extremum, half a sample at best.
    Extrema,
    /// The same, with the place of the extremum between the samples from a parabola.
    Interpolated,
    /// The phase of all samples of a turn, and the gyro's scale from turn to turn.
    #[default]
    PhaseLocked,
}

/// What is known beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Angle random walk N of the x-gyro, rad/√s.
    pub angle_random_walk: f64,
    /// 1σ of its scale factor.
    pub scale_sigma: f64,
    /// 1σ of its bias, rad/s.
    pub bias_sigma: f64,
    /// How the roll is corrected.
    pub method: Method,
}

impl Setting {
    /// A gyro of 0.06 °/√s, its scale known to 1 %, its bias to 0.06 °/s, its phase locked.
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

/// Which accelerometer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accelerometer {
    /// That along y.
    Y,
    /// That along z.
    Z,
    /// Both.
    Both,
}

words! { Accelerometer:
    Self::Y => "the accelerometer along y shows";
    Self::Z => "the accelerometer along z shows";
    Self::Both => "both accelerometers show";
}

/// What the roll rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum State {
    /// No lift was felt yet.
    #[default]
    Searching,
    /// Lift and gyro agree.
    Locked,
    /// The lift is below the noise: the gyro holds the roll, for so many seconds.
    Holding {
        /// For how long.
        seconds: f64,
    },
    /// The body turns too slowly for its forces to tell its turns.
    NotSpinning {
        /// For how long.
        seconds: f64,
    },
    /// There are no forces.
    ForceLost {
        /// For how long.
        seconds: f64,
    },
    /// A part of the rotation was lost, and with it the roll, until the next turns show it again.
    RotationLost {
        /// For how long.
        seconds: f64,
    },
    /// An accelerometer shows one value all the time.
    AccelerometerStuck {
        /// Which one.
        which: Accelerometer,
        /// For how long.
        seconds: f64,
    },
    /// The gyro about the long axis shows one rate all the time.
    GyroStuck {
        /// For how long.
        seconds: f64,
    },
    /// The forces go round against the gyro.
    Mirrored {
        /// For how long.
        seconds: f64,
    },
    /// The forces draw an ellipse, not a circle.
    Elliptic {
        /// For how long.
        seconds: f64,
    },
    /// The forces turn otherwise than the gyro says.
    Contradicted {
        /// For how long.
        seconds: f64,
    },
}

words! { State:
    Self::Searching => "searching: no lift was felt yet";
    Self::Locked => "locked";
    Self::Holding { seconds } => "holding on the gyro for {} s: no lift", Rounded::<2>(seconds);
    Self::NotSpinning { seconds } => "not spinning for {} s", Rounded::<2>(seconds);
    Self::ForceLost { seconds } => "without forces for {} s", Rounded::<2>(seconds);
    Self::RotationLost { seconds } => "rotation lost for {} s", Rounded::<2>(seconds);
    Self::AccelerometerStuck { which, seconds } => "{} one value for {} s: stuck or dead, check supply and wires", which, Rounded::<2>(seconds);
    Self::GyroStuck { seconds } => "the gyro about x shows one rate for {} s: stuck or dead, check supply and wires", Rounded::<2>(seconds);
    Self::Mirrored { seconds } => "the forces go round against the gyro for {} s: swapped or turned round, check axes and signs", Rounded::<2>(seconds);
    Self::Elliptic { seconds } => "the forces draw an ellipse for {} s: check scales and axes of the accelerometers", Rounded::<2>(seconds);
    Self::Contradicted { seconds } => "the forces contradict the gyro for {} s: check its scale", Rounded::<2>(seconds);
}

/// Part of its period by which a sample may come late.
const LATE: f32 = 0.5;

/// Follows the roll.
#[derive(Clone, Debug)]
pub struct Spin {
    phase_accumulator: PhaseAccumulator,
    corrector: Corrector,
    /// Sample period, µs.
    period: f32,
    latest: Option<Instant>,
    pace: Timing,
}

#[expect(
    clippy::large_enum_variant,
    reason = "there is no heap, and the large one is the usual one"
)]
#[derive(Clone, Debug)]
enum Corrector {
    Extrema(Extrema),
    Lock(Lock),
}

impl Spin {
    /// Begins at an unknown roll.
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
            pace: Timing::new(setting),
        }
    }

    /// Takes a sample; the signal by which the roll was overridden, where it was.
    #[inline]
    pub fn push(&mut self, sample: &SpinSample) -> Option<Signal> {
        let missing = self.missing(sample.time);
        let [turned, ..] = sample.turned;
        let before = self.pace.before();
        let turned = self.pace.take(turned);
        if missing > 0.0 || self.pace.is_lost() {
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

    /// Samples that are missing before one of this time.
    #[inline]
    fn missing(&mut self, now: Instant) -> f32 {
        let Some(before) = self.latest.replace(now) else { return 0.0 };
        let elapsed = now.0.saturating_sub(before.0) as u32 as f32;
        let missing = elapsed - self.period;
        if missing > LATE * self.period { missing / self.period } else { 0.0 }
    }

    /// The body goes on turning as it did while samples are missing, or their gyro is not believed.
    #[inline(never)]
    fn bridge(&mut self, missing: f32, turned: [AngleIncrement; 2]) {
        let [before, now] = turned.map(|turned| turned.0 as f32);
        let mean = 0.5 * (before + now);
        self.phase_accumulator.pass(mean, missing);
        match &mut self.corrector {
            Corrector::Extrema(extrema) => extrema.disturb(),
            Corrector::Lock(lock) => {
                let off = self.pace.off();
                // A jump may be right at once; what clips or sticks was right before.
                let strayed = |samples| if off > 0.0 { samples } else { lock.strayed(samples) };
                let [known, lost] = self.pace.lost().map(strayed);
                let change = (now - before).abs() + off;
                lock.lose(missing, [known, lost + missing], mean, change);
            }
        }
    }
}

/// What is asked of it.
impl Spin {
    /// The roll at the latest sample. Before the first correction it counts from zero at the first sample.
    #[must_use]
    pub fn roll(&self) -> Roll {
        self.phase_accumulator.roll()
    }

    /// Its 1σ, rad; none where it is unknown, and of extrema, which do not tell.
    #[must_use]
    pub fn sigma(&self) -> Option<f64> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => lock.sigma(&self.phase_accumulator),
        }
    }

    /// The gyro's scale error, shown over true less one, and its 1σ; none of extrema.
    #[must_use]
    pub fn scale(&self) -> Option<[f64; 2]> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => Some(lock.scale()),
        }
    }

    /// The lift of the latest turn, m/s², negative where it pushes down; none where it is not known.
    #[must_use]
    pub fn lift(&self) -> Option<f64> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => lock.lift(),
        }
    }

    /// What the roll rests on.
    #[must_use]
    pub fn state(&self) -> State {
        let now = self.latest.unwrap_or_default();
        match &self.corrector {
            Corrector::Extrema(extrema) if extrema.has_corrected() => State::Locked,
            Corrector::Extrema(_) => State::Searching,
            Corrector::Lock(lock) => match self.pace.stuck() {
                Some(samples) => {
                    State::GyroStuck { seconds: f64::from(samples) * f64::from(self.period) * 1e-6 }
                }
                None => lock.state(now),
            },
        }
    }

    /// By what the latest sample turned the body, corrected for scale, in 2⁻³² of a turn.
    pub(super) fn step(&self) -> i32 {
        self.phase_accumulator.step()
    }
}
