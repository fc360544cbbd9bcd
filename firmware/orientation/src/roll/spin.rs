//! Estimator of the roll: the gyro's angle, corrected by extrema or by phase lock.

use super::extrema::{Extrema, Signal};
use super::lock::Lock;
use super::phase_accumulator::{PhaseAccumulator, Roll};
use super::plausibility::Plausibility;
use super::setting::{Method, Setting};
use super::state::{Condition, State, lasted};
use crate::signal::SpinSample;
use crate::units::{AngleIncrement, Instant, MetresPerSecondSquared, Radians, Seconds};

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
    /// Number of gaps in which samples were missing, modulo 2³².
    pub(super) gaps: u32,
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
            period: (setting.sample_seconds.0 * 1e6) as f32,
            latest: None,
            gaps: 0,
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
        self.gaps = self.gaps.wrapping_add((missing > 0.0).into());
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

    /// Phase lock, where that is the method.
    fn lock(&self) -> Option<&Lock> {
        match &self.corrector {
            Corrector::Extrema(_) => None,
            Corrector::Lock(lock) => Some(lock),
        }
    }

    /// Roll at the latest sample. Before the first correction it counts from zero at the first
    /// sample.
    #[must_use]
    pub fn roll(&self) -> Roll {
        self.phase_accumulator.roll()
    }

    /// Standard deviation of the roll, 1σ; `None` where it is unknown, and for extrema, which
    /// give none.
    #[must_use]
    pub fn sigma(&self) -> Option<Radians> {
        self.lock()?.sigma(&self.phase_accumulator).map(Radians)
    }

    /// Scale error of the gyro, shown over true less one, and its 1σ; `None` for extrema.
    #[must_use]
    pub fn scale(&self) -> Option<[f64; 2]> {
        self.lock().map(Lock::scale)
    }

    /// Lift of the latest turns, negative where it points down; `None` where it is unknown.
    #[must_use]
    pub fn lift(&self) -> Option<MetresPerSecondSquared> {
        self.lock()?.lift().map(MetresPerSecondSquared)
    }

    /// Source of the present roll, or fault that prevents it.
    #[inline]
    #[must_use]
    pub fn condition(&self) -> Condition {
        match &self.corrector {
            Corrector::Extrema(extrema) if extrema.has_corrected => Condition::Locked,
            Corrector::Extrema(_) => Condition::Searching,
            Corrector::Lock(_) if self.plausibility.stuck().is_some() => Condition::GyroStuck,
            Corrector::Lock(lock) => lock.condition(),
        }
    }

    /// Time since which the turns are not used; [`None`] while they are.
    pub(super) fn troubled(&self) -> Option<Instant> {
        self.lock().and_then(Lock::troubled)
    }

    /// Source of the present roll, or fault that prevents it, with its duration.
    #[must_use]
    pub fn state(&self) -> State {
        let of_turns = || lasted(self.troubled(), self.latest.unwrap_or_default());
        let of_samples = |samples| Seconds(f64::from(samples) * f64::from(self.period) * 1e-6);
        let stuck = self.plausibility.stuck().filter(|_| self.lock().is_some());
        State { condition: self.condition(), seconds: stuck.map_or_else(of_turns, of_samples) }
    }

    /// Rotation of the latest sample, corrected for the scale error, in 2⁻³² of a turn.
    pub(super) fn step(&self) -> i32 {
        self.phase_accumulator.step()
    }
}
