//! The paper's corrections: four extrema a turn, at each of which the roll is known.
//!
//! A force is greatest or least one sample before that is seen; what the body has turned since is added. The
//! paper leaves the extremum at its sample, which is half a sample off at most; a parabola through it and
//! its neighbours finds it between.

use super::phase_accumulator::PhaseAccumulator;
use crate::units::{Angle, SpinForce};

/// A signal of correction, by the paper's names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// “1”: y is greatest, γ = 0.
    YMaximum,
    /// “2”: y is least, γ = π.
    YMinimum,
    /// “−1”: z is greatest, γ = 3π/2.
    ZMaximum,
    /// “−2”: z is least, γ = π/2.
    ZMinimum,
}

impl Signal {
    /// The roll that it stands for.
    #[must_use]
    pub fn roll(self) -> Angle {
        match self {
            Self::YMaximum => Angle(0),
            Self::ZMinimum => Angle(1 << 30),
            Self::YMinimum => Angle(1 << 31),
            Self::ZMaximum => Angle(3 << 30),
        }
    }
}

/// Looks for extrema.
#[derive(Clone, Debug)]
pub(super) struct Extrema {
    is_interpolated: bool,
    has_corrected: bool,
    /// The two forces before, older first.
    before: Option<[[SpinForce; 2]; 2]>,
    latest: Option<[SpinForce; 2]>,
}

impl Extrema {
    pub(super) fn new(is_interpolated: bool) -> Self {
        Self { is_interpolated, has_corrected: false, before: None, latest: None }
    }

    pub(super) fn has_corrected(&self) -> bool {
        self.has_corrected
    }

    /// Forces before a gap do not go together with those after it.
    pub(super) fn disturb(&mut self) {
        self.before = None;
        self.latest = None;
    }

    /// Takes forces; the phase accumulator has turned already.
    #[inline]
    pub(super) fn push(
        &mut self,
        force: Option<[SpinForce; 2]>,
        phase_accumulator: &mut PhaseAccumulator,
    ) -> Option<Signal> {
        let latest = core::mem::replace(&mut self.latest, force);
        let before = self.before.take();
        let (Some(now), Some(middle)) = (force, latest) else { return None };
        self.before = Some([middle, now]);
        let [old, _] = before?;
        let (signal, [first, second, third]) = extremum(old, middle, now)?;
        let place = if self.is_interpolated { vertex(first, second, third) } else { 0.0 };
        // From the extremum to this sample.
        let since = (1.0 - place) * phase_accumulator.step() as f32;
        phase_accumulator.set(Angle(signal.roll().0.wrapping_add((since as i32).cast_unsigned())));
        self.has_corrected = true;
        Some(signal)
    }
}

/// The extremum that the middle one of three pairs of forces is, with that axis' three forces.
fn extremum(
    old: [SpinForce; 2],
    middle: [SpinForce; 2],
    now: [SpinForce; 2],
) -> Option<(Signal, [i32; 3])> {
    let [y, z] = [0, 1].map(|axis: usize| [old[axis].0, middle[axis].0, now[axis].0]);
    if is_greatest(y) {
        Some((Signal::YMaximum, y))
    } else if is_least(y) {
        Some((Signal::YMinimum, y))
    } else if is_greatest(z) {
        Some((Signal::ZMaximum, z))
    } else if is_least(z) {
        Some((Signal::ZMinimum, z))
    } else {
        None
    }
}

fn is_greatest([first, second, third]: [i32; 3]) -> bool {
    second > first && second >= third
}

fn is_least([first, second, third]: [i32; 3]) -> bool {
    second < first && second <= third
}

/// Where a parabola through three values has its vertex, in samples from the middle one, within half of one.
fn vertex(first: i32, second: i32, third: i32) -> f32 {
    let rise = first.wrapping_sub(third) as f32;
    let bend = first.wrapping_sub(second).wrapping_add(third.wrapping_sub(second)) as f32;
    let place = 0.5 * rise / bend;
    if place.abs() <= 0.5 { place } else { 0.0 }
}
