//! Sway of the base, estimated by coarse gyros and accelerometers that are fixed to it (Burov: the
//! analytic gyrovertical on the base).
//!
//! ```text
//!  rates ─▶ − bias ─▶ + ─▶ rate of the estimated attitude ─▶ along the sensitive axis
//!             ▲       ▲ └─▶ up ─┐
//!             └── k₂ ─┴── k₁ ◀──┴── forces
//! ```
//!
//! A mean rate over a dwell contains the change of the base's angle over its time T. The rate that
//! is subtracted is that of an *estimated attitude*, so the mean loses exactly that estimate's
//! change, and gains the change of its error: bounded, and divided by T.
//!
//! The estimate is a vector that points up, turned by the gyros and drawn to the accelerometers.
//! The correction is weak, 1/τ with τ of many seconds: a vehicle that sways about a point r below
//! feels an acceleration of rω² times its angle, which at a hertz is larger than the tilt's share
//! of gravity; of it rω/(gτ) enters. With a constant gyro bias b the estimate is off by bτ, which
//! cancels in every mean as it does not change; the bias is estimated all the same (k₂), so that
//! the vector is upright soon and axes do not mix. Both gains begin as those of a line fit over the
//! elapsed time, 4/t and 6/t², and fall to 1/τ and 1/(τt). The third gyro, about the vertical, has
//! no such reference: its bias is its mean so far, which leaves a high-pass; it only rotates the
//! axes of the other two.
//!
//! The error of the angle is a Gauss–Markov process of variance (N²τ + a²/τ)/2 and correlation time
//! τ, for an angle random walk N of the gyros and a noise a of the tilt. In addition there are
//! errors that grow with the sway: mismatch of scale and axes, uncertain time, and that
//! acceleration.
//!
//! The sway is observed for some seconds before anything is subtracted. Compensation is then
//! switched on for the whole alignment if the sway is large against this error, else not at all.

mod noise;

pub use noise::SwayNoise;

use crate::math::rotation::cross;
use crate::units::{AngularRate, DEGREE, Seconds, SpecificForce};

/// Gravity, m/s²: the unit of the estimated vector. Its error only changes τ slightly.
const GRAVITY: f32 = 9.806_65;
/// Metres per second squared in one step of a force.
const MICRO: f32 = 1e-6;
/// Radians per second in one step of a rate.
const NANO: f32 = 1e-9;

/// Factor on the variance of the angle error that enters σ. While the axis turns, the errors of
/// successive dwells share less than the whitening filter assumes: 1.16 on a circle of 24,
/// computed. The rest is measured: without the factor the RMS of error over σ was 1.18 in 180
/// simulated runs.
const RAISED: f64 = 1.4;

/// Least age at which the gains are computed, s.
const YOUNGEST: f32 = 1.0;
/// Longest averaging time of the bias, s, so that a drift with temperature is followed.
const OLDEST: f32 = 300.0;
/// Age at which observation of the sway begins, s: the bias is then known to some hundredths of
/// °/s.
const WATCH_FROM: f32 = 10.0;
/// Age at which compensation is decided, s: one period of a slow sway later.
pub const WATCH_UNTIL: f32 = 22.0;
/// Longest time between two readings that is bridged, s: the slowest outputs come 12.5 times a second.
const LONGEST_STEP: f32 = 0.1;
/// Least sway that is compensated, in standard deviations of the error that the compensation
/// leaves: it then removes at least nine tenths of the variance.
const LARGE: f32 = 3.0;

/// Standard deviation of a uniform distribution over its width, 1/√12.
const UNIFORM: f64 = 0.288_675_134_594_812_9;

/// Stated properties of the coarse sensors and of their place on the base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CoarseSensors {
    /// Angle random walk N of the gyros, rad/√s.
    pub rate_noise: f32,
    /// Noise a of the tilt by the accelerometers, rad·√s.
    pub force_noise: f32,
    /// 1σ of scale and alignment against the precise gyro, relative.
    pub mismatch: f32,
    /// Mean delay of a rate that is held until the next reading, s.
    pub delay: f32,
    /// Standard deviation of that delay, 1σ, s.
    pub delay_sigma: f32,
    /// Distance from the point about which the base sways to the sensors, 1σ, m.
    pub lever: f32,
    /// Time constant τ of the correction by the accelerometers, s, > 0.
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
            memory: 20.0,
            ..Self::default()
        }
    }

    /// The same sensors with an output once in a period, read once in the period `read` and held between,
    /// while the precise gyro has a sample once in the period `sample`; all s.
    ///
    /// An output is a mean over its period, waits for half a reading on average, and is held for half a period
    /// less half a sample.
    #[must_use]
    pub fn read_in_periods(self, output: f64, read: f64, sample: f64) -> Self {
        let delay = 0.5 * (output + read) + 0.5 * (output - sample);
        Self { delay: delay as f32, delay_sigma: (UNIFORM * read) as f32, ..self }
    }

    /// Variance of the angle error that is independent of the sway, rad²: (N²τ + a²/τ)/2.
    #[must_use]
    pub fn angle_variance(&self) -> f32 {
        let Self { rate_noise, force_noise, memory, .. } = *self;
        0.5 * (rate_noise * rate_noise * memory + force_noise * force_noise / memory)
    }

    /// Variance of the angle error that grows with the sway, rad², for a sway of these variances of
    /// angle, rad², and rate, (rad/s)².
    fn residual_variance(&self, angle: f32, rate: f32) -> f32 {
        let felt = self.lever / (GRAVITY * self.memory);
        self.mismatch * self.mismatch * angle
            + (self.delay_sigma * self.delay_sigma + felt * felt) * rate
    }
}

/// Amplitude of the sway of a base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Size {
    /// RMS angle along an axis in the horizontal plane, mean over all directions, rad.
    pub angle: f32,
    /// RMS rate along an axis in the horizontal plane, mean over all directions, rad/s.
    pub rate: f32,
}

/// State of the decision on compensation for an alignment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Decision {
    /// The sway is still being observed.
    #[default]
    Watching,
    /// The base hardly moves, with this sway: no compensation is applied.
    Still(Size),
    /// The base sways by this size: it is compensated, which leaves this noise.
    Swaying(Size, SwayNoise),
}

/// Sums over the time in which the sway is observed.
#[derive(Clone, Copy, Debug, Default)]
struct Watch {
    /// Number of readings.
    count: f32,
    /// Horizontal components of the estimated vector when the observation began.
    origin: [f32; 2],
    /// Sums of the components' deviations from the origin.
    sums: [f32; 2],
    /// Sum of the squares of these deviations.
    squares: f32,
    /// Sum of the squared rates less the part that the gyros' noise adds, (rad/s)².
    rates: f32,
}

impl Watch {
    /// Adds one estimate; `noise` is the variance of a rate, (rad/s)².
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

    /// Variances of angle, rad², and rate, (rad/s)², along an axis, mean over all directions.
    fn variances(&self) -> [f32; 2] {
        let [x, y] = self.sums.map(|sum| sum / self.count);
        let angle = self.squares / self.count - x * x - y * y;
        [0.5 * angle, 0.5 * self.rates / self.count].map(|variance| variance.max(0.0))
    }
}

/// Estimator of the sway.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sway {
    /// Stated properties of the sensors.
    sensors: CoarseSensors,
    /// Estimated up vector on the base's axes forward, right, down; none before the first reading.
    up: Option<[f32; 3]>,
    /// First rates, subtracted so that single precision suffices for the rest.
    origin: [AngularRate; 3],
    /// Estimated gyro bias after subtraction of the first rates, rad/s.
    bias: [f32; 3],
    /// Rate of the estimated attitude, rad/s, extrapolated by the delay.
    rate: [f32; 2],
    /// Rate of the estimated attitude, rad/s, without extrapolation.
    latest: [f32; 2],
    /// Age of the estimate, and time since the vector was last set by the accelerometers alone, s.
    age: f32,
    upright: f32,
    /// Sums of the observation.
    watch: Watch,
    /// Decision on compensation.
    pub decision: Decision,
}

impl Sway {
    /// Begins without an estimate.
    #[must_use]
    pub fn new(sensors: CoarseSensors) -> Self {
        Self { sensors, ..Self::default() }
    }

    /// Begins without an estimate again, for another alignment: a base that was driven meanwhile has shown rates that were
    /// taken for biases, and it sways otherwise.
    pub fn begin_anew(&mut self) {
        *self = Self::new(self.sensors);
    }

    /// Takes a reading `seconds` after the previous one: rates about, and specific forces on, the
    /// base's axes forward, right, down. After a gap longer than 0.1 s the vector is set anew by
    /// the accelerometers, and the estimated bias is kept.
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

    /// Propagates the estimate by one reading.
    fn turn(&mut self, seconds: f32, rate: [f32; 3], force: [f32; 3], up: [f32; 3]) {
        self.age += seconds;
        self.upright += seconds;
        let off = cross(&force, &up);
        let draw = (4.0 / self.upright.max(YOUNGEST)).max(1.0 / self.sensors.memory);
        let turning = [0, 1, 2].map(|i| rate[i] - self.bias[i] + draw * off[i]);
        self.learn(seconds, rate, off);
        let moved = cross(&turning, &up);
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

    /// Updates the biases: of the level axes by the accelerometer correction, of the vertical axis
    /// by its mean.
    fn learn(&mut self, seconds: f32, rate: [f32; 3], off: [f32; 3]) {
        let age = if self.age > OLDEST { OLDEST } else { self.age.max(YOUNGEST) };
        let gain = (6.0 / (age * age)).max(1.0 / (self.sensors.memory * age)) * seconds;
        self.bias[0] -= gain * off[0];
        self.bias[1] -= gain * off[1];
        self.bias[2] += (rate[2] - self.bias[2]) * (seconds / age);
    }

    /// Decides once, when the sway was observed for long enough.
    fn decide(&mut self) {
        if self.age < WATCH_UNTIL {
            return;
        }
        let [angle, rate] = self.watch.variances();
        let size = Size { angle: libm::sqrtf(angle), rate: libm::sqrtf(rate) };
        let own = self.sensors.angle_variance();
        let left = self.sensors.residual_variance(angle, rate);
        let is_large = angle > LARGE * LARGE * (own + left);
        self.decision =
            if is_large { self.swaying(size, own, left) } else { Decision::Still(size) };
    }

    /// Decision for compensation, with the noise that it leaves.
    fn swaying(&self, size: Size, own: f32, left: f32) -> Decision {
        let noise = SwayNoise {
            angle_variance: RAISED * f64::from(own),
            correlation: Seconds(f64::from(self.sensors.memory)),
            residual_variance: f64::from(left),
        };
        Decision::Swaying(size, noise)
    }

    /// Rate to be subtracted along the level axis with this cosine and sine of its angle from
    /// forward, clockwise from above, rad/s; zero without compensation.
    #[must_use]
    pub fn along(&self, [cosine, sine]: [f32; 2]) -> f32 {
        match self.decision {
            Decision::Swaying(..) => cosine * self.rate[0] + sine * self.rate[1],
            Decision::Watching | Decision::Still(_) => 0.0,
        }
    }
}

/// Renormalises a vector whose length is nearly one, by one Newton step for 1/√x.
fn normalised(v: [f32; 3]) -> [f32; 3] {
    let factor = 1.5 - 0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    v.map(|part| part * factor)
}
