//! The rotation stage: a list of stops, rotations of minimum jerk between them, its gear's unevenness,
//! and the encoder.
//!
//! Sample k is taken at k/`rate_hz`. A dwell begins with the sample at which the stage arrives, so a
//! dwell of T seconds after an instantaneous rotation has exactly T·`rate_hz` samples. The sample at
//! which a slow rotation begins still stands at the old angle: that dwell seems one sample longer.

/// One position of the stage.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stop {
    /// Stage angle, rad, clockwise from above, not wrapped.
    pub angle_rad: f64,
    /// Time spent at rest, s, ≥ 0.
    pub dwell_s: f64,
    /// Time the rotation into this position takes, s, ≥ 0; zero is instantaneous. The stage already
    /// stands at the first stop, whose rotation is ignored.
    pub rotation_s: f64,
}

impl Stop {
    /// A stop entered in no time: `angle_rad`, `dwell_s`.
    pub const fn new(angle_rad: f64, dwell_s: f64) -> Self {
        Self { angle_rad, dwell_s, rotation_s: 0.0 }
    }

    /// This stop, entered by a rotation of `rotation_s` seconds, ≥ 0.
    pub const fn after(self, rotation_s: f64) -> Self {
        Self { rotation_s, ..self }
    }
}

/// Where the stage is and how fast it turns.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageState {
    /// True angle, rad.
    pub angle_rad: f64,
    /// True rate, rad/s, clockwise positive.
    pub rate_rad_s: f64,
}

/// State of a rotation of minimum jerk from one angle to another, rad, that takes `seconds`, at
/// `elapsed_s` after its start: s(u) = 10u³ − 15u⁴ + 6u⁵ (Flash and Hogan 1985). At rest outside.
pub fn minimum_jerk(from: f64, to: f64, seconds: f64, elapsed_s: f64) -> StageState {
    let u = elapsed_s / seconds;
    if u <= 0.0 {
        return StageState { angle_rad: from, rate_rad_s: 0.0 };
    }
    // Also where the rotation takes no time and u is infinite or not a number.
    if u.is_nan() || u >= 1.0 {
        return StageState { angle_rad: to, rate_rad_s: 0.0 };
    }
    let part = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
    let speed = 30.0 * u * u * (1.0 - u) * (1.0 - u);
    StageState { angle_rad: from + (to - from) * part, rate_rad_s: (to - from) * speed / seconds }
}

/// A stage that follows a list of stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage<'a> {
    /// Positions in order.
    stops: &'a [Stop],
    /// Samples per second, Hz.
    pub(crate) rate_hz: f64,
    /// Index of the stop stood at or rotated into.
    current: usize,
    /// Angle from which it turns to that stop, rad.
    from_rad: f64,
    /// When the stage left that angle, s from the first sample.
    departure_s: f64,
    /// First sample at the current stop.
    arrival: u64,
    /// First sample after the dwell at the current stop.
    departure: u64,
}

impl<'a> Stage<'a> {
    /// A stage standing at the first stop, looked at `rate_hz` times a second (> 0).
    #[must_use]
    pub fn new(stops: &'a [Stop], rate_hz: f64) -> Self {
        let dwell_s = stops.first().map_or(0.0, |stop| stop.dwell_s);
        Self {
            stops,
            rate_hz,
            current: 0,
            from_rad: 0.0,
            departure_s: 0.0,
            arrival: 0,
            departure: first_sample(dwell_s, rate_hz),
        }
    }

    /// Whole time of the list, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        let first = self.stops.first().map_or(0.0, |stop| stop.rotation_s);
        self.stops.iter().map(|stop| stop.rotation_s + stop.dwell_s).sum::<f64>() - first
    }

    /// State at sample number `sample`; ask in rising order. None after the last dwell.
    #[inline]
    pub fn state(&mut self, sample: u64) -> Option<StageState> {
        while sample >= self.departure {
            self.depart()?;
        }
        let stop = self.stops.get(self.current)?;
        if sample >= self.arrival {
            return Some(StageState { angle_rad: stop.angle_rad, rate_rad_s: 0.0 });
        }
        let elapsed_s = sample as f64 / self.rate_hz - self.departure_s;
        Some(minimum_jerk(self.from_rad, stop.angle_rad, stop.rotation_s, elapsed_s))
    }

    /// Leaves for the next stop, if there is one.
    #[cold]
    fn depart(&mut self) -> Option<()> {
        let left = self.stops.get(self.current)?;
        let next = self.stops.get(self.current + 1)?;
        let rotated_s = if self.current == 0 { 0.0 } else { left.rotation_s };
        self.departure_s += rotated_s + left.dwell_s;
        let arrival_s = self.departure_s + next.rotation_s;
        self.from_rad = left.angle_rad;
        self.current += 1;
        self.arrival = first_sample(arrival_s, self.rate_hz);
        self.departure = first_sample(arrival_s + next.dwell_s, self.rate_hz);
        Some(())
    }
}

/// Number of the first sample at or after a time. A millionth of a period is forgiven, so that sums
/// of decimal fractions fall on the sample they mean.
pub(crate) fn first_sample(time_s: f64, rate_hz: f64) -> u64 {
    libm::ceil(time_s * rate_hz - 1e-6) as u64
}

/// One harmonic of a gear's unevenness.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ripple {
    /// Relative amplitude ε of the rate, 1, within ±1.
    pub relative: f64,
    /// Rotor angle φ at which the stage is quickest, rad.
    pub phase_rad: f64,
}

impl Ripple {
    /// What the `k`-th harmonic adds to an even angle, rad, and to 1 in the ratio of the rates:
    /// (ε/k)·sin k(y − φ) and ε·cos k(y − φ), the one the slope of the other.
    fn at(&self, k: f64, even_rad: f64) -> (f64, f64) {
        if self.relative == 0.0 {
            return (0.0, 0.0);
        }
        let (sine, cosine) = libm::sincos(k * (even_rad - self.phase_rad));
        (self.relative / k * sine, self.relative * cosine)
    }
}

/// Unevenness of the gear: an even rotor turns the stage quicker here and slower there. The default
/// is even.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Unevenness {
    /// The harmonic once per turn, which eccentricity makes.
    pub first: Ripple,
    /// The harmonic twice per turn, which ellipticity makes.
    pub second: Ripple,
}

impl Unevenness {
    /// The stage behind a gear whose even angle and rate are these: angle y + Σ (`ε_k`/k)·sin k(y − `φ_k`)
    /// and rate ẏ·(1 + Σ `ε_k` cos k(y − `φ_k`)). An even gear changes no bit.
    #[inline]
    pub fn stage(&self, even: StageState) -> StageState {
        if self.first.relative == 0.0 && self.second.relative == 0.0 {
            return even;
        }
        let (first_rad, first) = self.first.at(1.0, even.angle_rad);
        let (second_rad, second) = self.second.at(2.0, even.angle_rad);
        StageState {
            angle_rad: even.angle_rad + (first_rad + second_rad),
            rate_rad_s: even.rate_rad_s * (1.0 + first + second),
        }
    }
}

/// One harmonic of the encoder's error over a turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Harmonic {
    /// Amplitude of the error, rad; zero for none.
    pub amplitude_rad: f64,
    /// Phase at stage angle zero, rad.
    pub phase_rad: f64,
}

impl Harmonic {
    /// The error of the `k`-th harmonic at a stage angle, rad: amplitude·sin(kθ + phase).
    fn at(&self, k: f64, angle_rad: f64) -> f64 {
        if self.amplitude_rad == 0.0 {
            return 0.0;
        }
        self.amplitude_rad * libm::sin(k * angle_rad + self.phase_rad)
    }
}

/// Errors of the encoder; the default is perfect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderConfiguration {
    /// Resolution, rad (2π/2²¹ for 21 bit); zero for none.
    pub step_rad: f64,
    /// Error once per turn: eccentricity.
    pub first: Harmonic,
    /// Error twice per turn: ellipticity, or unequal sine and cosine.
    pub second: Harmonic,
}

impl EncoderConfiguration {
    /// What the encoder shows, rad, at a true stage angle in rad, to the nearest step.
    #[must_use]
    pub fn read(&self, angle_rad: f64) -> f64 {
        let shown = angle_rad + self.first.at(1.0, angle_rad) + self.second.at(2.0, angle_rad);
        if self.step_rad > 0.0 { libm::rint(shown / self.step_rad) * self.step_rad } else { shown }
    }
}
