//! Whether the body stands, by the gyros' noise and what is known of their biases.
//!
//! Half a second is quiet if the mean rates are the biases' within their uncertainty, and rates and forces are
//! those of the half second before within their noise. Three in a row are a rest. A turn that is as even as a
//! bias and smaller than what is still possible for one can be told from it by nobody; once biases
//! are known that is no turn at all.

/// Standard deviations that a mean may be off.
const BOUND: f32 = 4.0;
/// Length of a window, s.
pub const WINDOW: f32 = 0.5;
/// Quiet windows that make a rest.
const ENOUGH: u32 = 3;
/// How far wind and engine turn a body that stands within a window, rad: 20″.
const SHAKING: f32 = 1e-4;
/// How much a mean force may change at rest, m/s²: 3 mg.
const FORCE_CHANGE: f32 = 0.03;

/// The means of a window.
#[derive(Clone, Copy, Debug, Default)]
pub struct Means {
    /// Rates less what the Earth turns, rad/s.
    pub rate: [f32; 3],
    /// Forces, m/s²; none where there was none.
    pub force: Option<[f32; 3]>,
}

/// Watches for rests.
#[derive(Clone, Copy, Debug, Default)]
pub struct RestWatch {
    before: Option<Means>,
    quiet: u32,
}

impl RestWatch {
    /// Takes a window with the biases, rad/s, their variances, and the gyros' walks, rad²/s; whether it belongs to a rest.
    pub fn push(
        &mut self,
        means: Means,
        biases: [f32; 3],
        variances: [f32; 3],
        walk: [f32; 3],
    ) -> bool {
        let is_quiet = self.before.replace(means).is_some_and(|before| {
            let of_axis = |axis: usize| {
                let noise = walk[axis] / WINDOW;
                let shaking = SHAKING / WINDOW;
                let away = (means.rate[axis] - biases[axis]).abs();
                let change = (means.rate[axis] - before.rate[axis]).abs();
                away <= BOUND * libm::sqrtf(noise + variances[axis]) + shaking
                    && change <= BOUND * libm::sqrtf(2.0 * noise) + shaking
            };
            (0..3).all(of_axis) && is_steady(&means, &before)
        });
        self.quiet = if is_quiet { self.quiet.saturating_add(1) } else { 0 };
        self.is_at_rest()
    }

    /// Whether the body stands.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.quiet >= ENOUGH
    }

    /// Begins anew.
    pub fn disturb(&mut self) {
        *self = Self::default();
    }
}

fn is_steady(now: &Means, before: &Means) -> bool {
    let (Some(now), Some(before)) = (now.force, before.force) else { return false };
    (0..3).all(|axis| (now[axis] - before[axis]).abs() <= FORCE_CHANGE)
}
