//! The rotation stage: a list of stops, rotations of minimum jerk between them, and the encoder.
//!
//! Sample k is taken at k/`rate_hz`. A dwell begins with the sample at which the stage arrives, so a
//! dwell of T seconds after an instantaneous rotation has exactly T·`rate_hz` samples. The sample at
//! which a slow rotation begins still stands at the old angle: that dwell seems one sample longer.

/// One position of the stage.
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
    #[must_use]
    pub const fn new(angle_rad: f64, dwell_s: f64) -> Self {
        Self { angle_rad, dwell_s, rotation_s: 0.0 }
    }

    /// The same stop, entered by a rotation of `rotation_s` seconds.
    #[must_use]
    pub const fn after(self, rotation_s: f64) -> Self {
        Self { rotation_s, ..self }
    }
}

/// Where the stage is and how fast it turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageState {
    /// True angle, rad.
    pub angle_rad: f64,
    /// True rate, rad/s, clockwise positive.
    pub rate_rad_s: f64,
}

/// State of a rotation of minimum jerk from one angle to another, rad, that takes `seconds`, at
/// `elapsed_s` after its start: s(u) = 10u³ − 15u⁴ + 6u⁵ (Flash and Hogan 1985). At rest outside.
#[must_use]
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
    stops: &'a [Stop],
    rate_hz: f64,
    /// Index of the stop stood at or rotated into.
    current: usize,
    from_rad: f64,
    departure_s: f64,
    /// First sample at the current stop, and the first after it.
    arrival: u64,
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
fn first_sample(time_s: f64, rate_hz: f64) -> u64 {
    libm::ceil(time_s * rate_hz - 1e-6) as u64
}

/// One harmonic of the encoder's error over a turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Harmonic {
    /// Amplitude, rad.
    pub amplitude_rad: f64,
    /// Phase at stage angle zero, rad.
    pub phase_rad: f64,
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
        let first = self.first.amplitude_rad * libm::sin(angle_rad + self.first.phase_rad);
        let second = self.second.amplitude_rad * libm::sin(2.0 * angle_rad + self.second.phase_rad);
        let shown = angle_rad + first + second;
        if self.step_rad > 0.0 { libm::rint(shown / self.step_rad) * self.step_rad } else { shown }
    }
}
