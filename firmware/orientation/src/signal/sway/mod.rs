//! The sway of the base, from coarse gyros and accelerometers that stand on it.
//!
//! ```text
//!  rates ─▶ − bias ─▶ + ─▶ rate of the estimated attitude ─▶ along the sensitive axis
//!             ▲       ▲ └─▶ up ─┐
//!             └── k₂ ─┴── k₁ ◀──┴── forces
//! ```
//!
//! A mean rate over a dwell contains the change of the base's angle over its time T. What is
//! subtracted is the rate of an *estimated attitude*, so the mean loses exactly that estimate's
//! change, and gets the change of its error: bounded, and divided by T.
//!
//! The estimate is a vector that points up, turned by the gyros and drawn to the accelerometers. The
//! draw is weak, 1/τ with τ of many seconds: a vehicle that sways about a point r below feels an
//! acceleration of rω² times its angle, which at a hertz is larger than what gravity shows; of it
//! rω/(gτ) enters. With a constant gyro bias b the estimate stands off by bτ, which no mean feels as
//! it does not change; the bias is taken off all the same (k₂), so that the estimate is upright soon
//! and couples nothing. Both gains begin as those of a line fit over the time so far, 4/t and 6/t²,
//! and fall to 1/τ and 1/(τt). The third gyro, about the vertical, has no such reference: its bias is
//! its mean so far, which leaves a high-pass; it only turns the two others' axes.
//!
//! The error of the angle is a Gauss–Markov process of variance (N²τ + a²/τ)/2 and correlation time
//! τ, for an angle random walk N of the gyros and a noise a of the tilt. Beside it stands what grows
//! with the sway: mismatch of scale and axes, uncertain time, and that acceleration.
//!
//! Nothing is subtracted before the sway was watched for some seconds; then, for the whole session,
//! where it is large against this error, else never.

mod noise;

pub use noise::SwayNoise;

use crate::units::{AngularRate, DEGREE, SpecificForce};

/// Gravity, m/s²: the unit of the estimated vector. Its error only changes τ.
const GRAVITY: f32 = 9.806_65;
/// Micrometres in a metre, as forces come.
const MICRO: f32 = 1e-6;
/// Nanoradians in a radian, as rates come.
const NANO: f32 = 1e-9;

/// Factor on the variance of the angle error that σ is told. While the axis turns, the errors of
/// successive dwells share less than the whitening believes: 1.16 on a circle of 24, computed. The
/// rest is measured: without the factor the RMS of error over σ was 1.18 in 180 simulated runs.
const RAISED: f64 = 1.4;

/// Shortest time that the gains are those of, s.
const YOUNGEST: f32 = 1.0;
/// Longest time that the bias is a mean of, s: a temperature that drifts may be followed.
const OLDEST: f32 = 300.0;
/// When the sway begins to be watched, s: the bias is then known to some hundredths of °/s.
const WATCH_FROM: f32 = 10.0;
/// When it is decided, s: one period of a slow sway later.
const WATCH_UNTIL: f32 = 22.0;
/// Longest time between two readings that can be bridged, s.
const LONGEST_STEP: f32 = 0.05;
/// How large a sway must be to be subtracted, in standard deviations of what the subtraction leaves:
/// it then takes away at least nine tenths of the variance that it would have left.
const LARGE: f32 = 3.0;

/// What is stated of the coarse sensors and where they stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoarseSensors {
    /// Angle random walk N of the gyros, rad/√s.
    pub rate_noise: f32,
    /// Noise a of the tilt by the accelerometers, rad·√s.
    pub force_noise: f32,
    /// 1σ of scale and alignment against the precise gyro, relative.
    pub mismatch: f32,
    /// By how much a rate that is held lags behind on average, s.
    pub delay: f32,
    /// 1σ of that time, s.
    pub delay_sigma: f32,
    /// From the point that the base sways about to the sensors, 1σ, m.
    pub lever: f32,
    /// Time constant τ of the draw to the accelerometers, s, > 0.
    pub memory: f32,
}

impl CoarseSensors {
    /// Sensors with noise densities as data sheets give them, one-sided, in m°/s/√Hz and µg/√Hz, and
    /// without any other error; τ is 20 s.
    ///
    /// A one-sided density d is an angle random walk of d/√2.
    #[must_use]
    pub fn of_densities(rate: f64, force: f64) -> Self {
        let half = core::f64::consts::FRAC_1_SQRT_2;
        Self {
            rate_noise: (rate * 1e-3 * DEGREE * half) as f32,
            force_noise: (force * 1e-6 * half) as f32,
            mismatch: 0.0,
            delay: 0.0,
            delay_sigma: 0.0,
            lever: 0.0,
            memory: 20.0,
        }
    }

    /// Variance of the angle error that does not grow with the sway, rad²: (N²τ + a²/τ)/2.
    #[must_use]
    pub fn angle_variance(&self) -> f32 {
        let Self { rate_noise, force_noise, memory, .. } = *self;
        0.5 * (rate_noise * rate_noise * memory + force_noise * force_noise / memory)
    }

    /// Variance of the angle error that grows with a sway of these variances of angle, rad², and
    /// rate, (rad/s)².
    fn residual_variance(&self, angle: f32, rate: f32) -> f32 {
        let felt = self.lever / (GRAVITY * self.memory);
        self.mismatch * self.mismatch * angle
            + (self.delay_sigma * self.delay_sigma + felt * felt) * rate
    }
}

/// How a base sways.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    /// RMS of its angle along an axis in the horizontal plane, mean over all directions, rad.
    pub angle: f32,
    /// RMS of its rate, likewise, rad/s.
    pub rate: f32,
}

/// What was decided about a session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Decision {
    /// Nothing yet.
    #[default]
    Watching,
    /// The base hardly moves: nothing is subtracted.
    Still(Size),
    /// It sways and this is subtracted, which leaves that noise.
    Swaying(Size, SwayNoise),
}

/// Sums over the time that the sway is watched.
#[derive(Clone, Copy, Debug, Default)]
struct Watch {
    count: f32,
    /// The estimated vector when it began.
    origin: [f32; 2],
    sums: [f32; 2],
    squares: f32,
    /// Squared rates, less what the gyros' noise adds.
    rates: f32,
}

impl Watch {
    fn push(&mut self, up: [f32; 3], rate: [f32; 3], noise: f32) {
        let [x, y, _] = up;
        if self.count == 0.0 {
            self.origin = [x, y];
        }
        self.count += 1.0;
        for (sum, (value, origin)) in self.sums.iter_mut().zip([x, y].iter().zip(self.origin)) {
            *sum += value - origin;
            self.squares += (value - origin) * (value - origin);
        }
        self.rates += rate[0] * rate[0] + rate[1] * rate[1] - 2.0 * noise;
    }

    /// Variances of angle and rate along an axis, mean over all directions.
    fn variances(&self) -> [f32; 2] {
        let [x, y] = self.sums.map(|sum| sum / self.count);
        let angle = self.squares / self.count - x * x - y * y;
        [0.5 * angle, 0.5 * self.rates / self.count].map(|variance| variance.max(0.0))
    }
}

/// The estimator.
#[derive(Clone, Copy, Debug)]
pub struct Sway {
    sensors: CoarseSensors,
    /// Points up, on the base's axes forward, right, down; nothing before the first reading.
    up: Option<[f32; 3]>,
    /// The first rates: what differs from them is small enough for the last bits to count.
    origin: [AngularRate; 3],
    /// What is the gyros' own of that difference, rad/s.
    bias: [f32; 3],
    /// Rate of the estimated attitude, rad/s, as it will be a delay later.
    rate: [f32; 2],
    /// The same without the delay.
    latest: [f32; 2],
    /// Time since the estimate began, and since it was last set upright, s.
    age: f32,
    upright: f32,
    watch: Watch,
    decision: Decision,
}

impl Sway {
    /// Knows nothing yet.
    #[must_use]
    pub fn new(sensors: CoarseSensors) -> Self {
        Self {
            sensors,
            up: None,
            origin: [AngularRate(0); 3],
            bias: [0.0; 3],
            rate: [0.0; 2],
            latest: [0.0; 2],
            age: 0.0,
            upright: 0.0,
            watch: Watch::default(),
            decision: Decision::Watching,
        }
    }

    /// What was decided.
    #[must_use]
    pub fn decision(&self) -> Decision {
        self.decision
    }

    /// Takes a reading so many seconds after the one before: rates about, and specific forces on, the
    /// base's axes forward, right, down. After a longer time than can be bridged it begins anew, with
    /// the bias that it knows.
    pub fn push(&mut self, seconds: f32, rate: [AngularRate; 3], force: [SpecificForce; 3]) {
        if self.up.is_none() {
            self.origin = rate;
        }
        let off = |i: usize| rate[i].0.saturating_sub(self.origin[i].0) as f32 * NANO;
        let rate = [0, 1, 2].map(off);
        let force = force.map(|force| force.0 as f32 * (MICRO / GRAVITY));
        match self.up {
            Some(up) if seconds > 0.0 && seconds <= LONGEST_STEP => {
                self.turn(seconds, rate, force, up);
            }
            _ => {
                self.up = Some(force);
                self.upright = 0.0;
            }
        }
    }

    /// Turns the estimate on.
    fn turn(&mut self, seconds: f32, rate: [f32; 3], force: [f32; 3], up: [f32; 3]) {
        self.age += seconds;
        self.upright += seconds;
        let off = cross(force, up);
        let draw = (4.0 / self.upright.max(YOUNGEST)).max(1.0 / self.sensors.memory);
        let turning = [0, 1, 2].map(|i| rate[i] - self.bias[i] + draw * off[i]);
        self.learn(seconds, rate, off);
        let moved = cross(turning, up);
        let up = normalised([0, 1, 2].map(|i| up[i] - seconds * moved[i]));
        self.up = Some(up);
        let lead = self.sensors.delay / seconds;
        let ahead = |i: usize| turning[i] + lead * (turning[i] - self.latest[i]);
        self.rate = [ahead(0), ahead(1)];
        self.latest = [turning[0], turning[1]];
        if self.decision == Decision::Watching && self.age >= WATCH_FROM {
            let noise = self.sensors.rate_noise * self.sensors.rate_noise / seconds;
            self.watch.push(up, turning, noise);
            self.decide();
        }
    }

    /// Follows the biases: of the level axes by the draw, of the vertical one by its mean.
    fn learn(&mut self, seconds: f32, rate: [f32; 3], off: [f32; 3]) {
        let age = if self.age > OLDEST { OLDEST } else { self.age.max(YOUNGEST) };
        let gain = (6.0 / (age * age)).max(1.0 / (self.sensors.memory * age)) * seconds;
        self.bias[0] -= gain * off[0];
        self.bias[1] -= gain * off[1];
        self.bias[2] += (rate[2] - self.bias[2]) * (seconds / age);
    }

    /// Decides once, when it was watched for long enough.
    fn decide(&mut self) {
        if self.age < WATCH_UNTIL {
            return;
        }
        let [angle, rate] = self.watch.variances();
        let size = Size { angle: root(angle), rate: root(rate) };
        let own = self.sensors.angle_variance();
        let left = self.sensors.residual_variance(angle, rate);
        let is_large = angle > LARGE * LARGE * (own + left);
        self.decision =
            if is_large { self.swaying(size, own, left) } else { Decision::Still(size) };
    }

    fn swaying(&self, size: Size, own: f32, left: f32) -> Decision {
        let noise = SwayNoise {
            angle_variance: RAISED * f64::from(own),
            correlation: f64::from(self.sensors.memory),
            residual_variance: f64::from(left),
        };
        Decision::Swaying(size, noise)
    }

    /// What is to be subtracted from a rate along the level axis with this cosine and sine of its
    /// angle from forward, clockwise from above, rad/s; zero where nothing is.
    #[must_use]
    pub fn along(&self, [cosine, sine]: [f32; 2]) -> f32 {
        match self.decision {
            Decision::Swaying(..) => cosine * self.rate[0] + sine * self.rate[1],
            Decision::Watching | Decision::Still(_) => 0.0,
        }
    }
}

fn root(value: f32) -> f32 {
    libm::sqrtf(value)
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// A vector of nearly one, brought to one: a step of Newton's for 1/√x.
fn normalised(v: [f32; 3]) -> [f32; 3] {
    let factor = 1.5 - 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    v.map(|part| part * factor)
}
