//! Whether the body stands, by the gyros' noise and what is known of their biases.
//!
//! Half a second is quiet if the mean rates are the biases' within their uncertainty, and rates and forces are
//! those of the half second before within their noise. Three in a row are a rest, if what the body turned in all of
//! them is the biases' as well, and if the force is gravity as the attitude has it: a vehicle that speeds up steadily on a
//! straight road is quiet too. A turn that is as even as a bias and smaller than what is still possible for one can be told
//! from it by nobody; once biases are known that is no turn at all.

/// Standard deviations that a mean may be off.
const BOUND: f32 = 4.0;
/// Length of a window, s.
pub const WINDOW: f32 = 0.5;
/// Quiet windows that make a rest.
const ENOUGH: u32 = 3;
/// Quiet windows that make one although the force is not where the attitude has it: a minute, in which a vehicle that
/// speeds up enough to be seen becomes too fast to be one. The attitude is wrong then.
const PATIENCE: u32 = 120;
/// How far wind and engine turn a body that stands within a window, rad: 20″.
const SHAKING: f32 = 1e-4;
/// How much a mean force may change at rest, m/s²: 3 mg.
const FORCE_CHANGE: f32 = 0.03;

/// What a window shows.
#[derive(Clone, Copy, Debug, Default)]
pub struct Means {
    /// Mean rates less what the Earth turns, rad/s.
    pub rate: [f32; 3],
    /// Mean forces, m/s²; none where there was none.
    pub force: Option<[f32; 3]>,
    /// Whether that is gravity by the attitude.
    pub is_gravity: bool,
}

/// What is known of the gyros.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known {
    /// Biases, rad/s, and their variances.
    pub biases: [f32; 3],
    pub variances: [f32; 3],
    /// Angle random walk, squared, rad²/s.
    pub walk: [f32; 3],
}

/// Watches for rests.
#[derive(Clone, Copy, Debug, Default)]
pub struct RestWatch {
    before: Option<Means>,
    quiet: u32,
    /// What the body has turned beside the biases since it is quiet or the biases were learnt, rad, and for how long, s.
    turned: [f32; 3],
    seconds: f32,
    is_at_rest: bool,
}

impl RestWatch {
    /// Takes a window; whether it belongs to a rest.
    pub fn push(&mut self, means: Means, known: &Known) -> bool {
        let before = self.before.replace(means);
        if before.is_some_and(|before| self.is_quiet(&means, &before, known)) {
            self.quiet = self.quiet.saturating_add(1);
            let enough = if self.is_at_rest || means.is_gravity { ENOUGH } else { PATIENCE };
            self.is_at_rest = self.quiet >= enough;
        } else {
            *self = Self { before: self.before, ..Self::default() };
        }
        self.is_at_rest
    }

    fn is_quiet(&mut self, means: &Means, before: &Means, known: &Known) -> bool {
        self.seconds += WINDOW;
        let noise_and_bias = |axis: usize, seconds: f32| {
            let noise = known.walk[axis] * seconds + known.variances[axis] * seconds * seconds;
            BOUND * libm::sqrtf(noise) + SHAKING
        };
        let mut is_quiet = is_steady(means, before);
        for axis in 0..3 {
            let away = WINDOW * (means.rate[axis] - known.biases[axis]);
            let change = WINDOW * (means.rate[axis] - before.rate[axis]);
            self.turned[axis] += away;
            is_quiet &= away.abs() <= noise_and_bias(axis, WINDOW)
                && self.turned[axis].abs() <= noise_and_bias(axis, self.seconds)
                && change.abs() <= BOUND * libm::sqrtf(2.0 * known.walk[axis] * WINDOW) + SHAKING;
        }
        is_quiet
    }

    /// The biases were learnt: what the body has turned beside them counts anew.
    pub fn learnt(&mut self) {
        (self.turned, self.seconds) = ([0.0; 3], 0.0);
    }

    /// Whether the body stands.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.is_at_rest
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
