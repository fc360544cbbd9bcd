//! Corrections by extrema (Nekrasova 2017): at four extrema a turn the roll is known.
//!
//! An extremum of a force is detected one sample after it occurred; the rotation since then is
//! added. The paper takes the extremum at its sample, which is off by up to half a sample; a
//! parabola through it and its neighbours locates it between samples.

use super::phase_accumulator::PhaseAccumulator;
use crate::units::{Angle, SpinForce};

/// Correction signal, with the numbering of Nekrasova 2017.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Signal {
    /// Signal “1”: maximum of y, γ = 0.
    YMaximum,
    /// Signal “2”: minimum of y, γ = π.
    YMinimum,
    /// Signal “−1”: maximum of z, γ = 3π/2.
    ZMaximum,
    /// Signal “−2”: minimum of z, γ = π/2.
    ZMinimum,
}

impl Signal {
    /// Roll at which the signal occurs.
    pub(crate) fn roll(self) -> Angle {
        match self {
            Self::YMaximum => Angle(0),
            Self::ZMinimum => Angle(1 << 30),
            Self::YMinimum => Angle(1 << 31),
            Self::ZMaximum => Angle(3 << 30),
        }
    }
}

/// Detector of extrema.
#[derive(Clone, Debug)]
pub(super) struct Extrema {
    /// Whether the extremum is located between samples.
    is_interpolated: bool,
    /// Whether a correction has been made.
    pub(super) has_corrected: bool,
    /// The two previous pairs of forces, older first.
    before: Option<[[SpinForce; 2]; 2]>,
    /// Latest pair of forces.
    latest: Option<[SpinForce; 2]>,
}

impl Extrema {
    /// Detector before the first sample.
    pub(super) fn new(is_interpolated: bool) -> Self {
        Self { is_interpolated, has_corrected: false, before: None, latest: None }
    }

    /// Discards the previous forces, which do not join on to those after a gap.
    pub(super) fn disturb(&mut self) {
        self.before = None;
        self.latest = None;
    }

    /// Takes a pair of forces; the phase accumulator must already include this sample's rotation.
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
        let (signal, [first, second, third]) = extremum([old, middle, now])?;
        let place = if self.is_interpolated { vertex(first, second, third) } else { 0.0 };
        // Rotation from the extremum to this sample.
        let since = (1.0 - place) * phase_accumulator.step() as f32;
        phase_accumulator.set(Angle(signal.roll().0.wrapping_add((since as i32).cast_unsigned())));
        self.has_corrected = true;
        Some(signal)
    }
}

/// Extremum at the middle one of three pairs of forces, with the three forces of that axis.
fn extremum(forces: [[SpinForce; 2]; 3]) -> Option<(Signal, [i32; 3])> {
    let [y, z] = [0, 1].map(|axis: usize| forces.map(|force| force[axis].0));
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

/// Whether the middle value is a maximum.
fn is_greatest([first, second, third]: [i32; 3]) -> bool {
    second > first && second >= third
}

/// Whether the middle value is a minimum.
fn is_least([first, second, third]: [i32; 3]) -> bool {
    second < first && second <= third
}

/// Vertex of a parabola through three values, in samples from the middle one, limited to half a
/// sample.
fn vertex(first: i32, second: i32, third: i32) -> f32 {
    let rise = first.wrapping_sub(third) as f32;
    let bend = first.wrapping_sub(second).wrapping_add(third.wrapping_sub(second)) as f32;
    let place = 0.5 * rise / bend;
    if place.abs() <= 0.5 { place } else { 0.0 }
}
