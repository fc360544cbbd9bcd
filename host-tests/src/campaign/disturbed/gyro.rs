//! What may be wrong with a gyro: drift that no key states, and a column that lags or is cut.

use std::collections::VecDeque;

use hal_mock::noise::Generator;

/// A drift of the gyro's bias that no key states.
#[derive(Clone, Debug)]
pub(super) enum Drift {
    /// A step, rad/s, at a time, s.
    Step { at_s: f64, rate: f64 },
    /// A random walk of this K, rad/s/√s.
    Walk { density: f64 },
    /// A warm-up: amplitude, rad/s, and time constant, s.
    WarmUp { rate: f64, seconds: f64 },
    /// The torque of cables: rad/s per rad of stage angle.
    Cable { rate_per_rad: f64 },
}

/// What is wrong with the gyro's column.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GyroFault {
    /// Time constant of a lag, s.
    pub(super) lag_s: f64,
    /// By how much the column is late, s.
    pub(super) late_s: f64,
    /// Step of the column, rad/s.
    pub(super) step: f64,
    /// Greatest value that it shows, rad/s; none for no limit.
    pub(super) limit: Option<f64>,
}

/// Drifts at work.
pub(super) struct Drifting {
    rate_hz: f64,
    chance: Generator,
    walked: f64,
}

impl Drifting {
    /// Begins without a drift; the generator draws the random walk.
    pub(super) fn new(rate_hz: f64, chance: Generator) -> Self {
        Self { rate_hz, chance, walked: 0.0 }
    }

    /// The drift at a time, s, and an unwrapped stage angle, rad; ask once a sample.
    pub(super) fn rate(&mut self, drifts: &[Drift], time_s: f64, angle_rad: f64) -> f64 {
        let of = |drift: &Drift| match *drift {
            Drift::Step { at_s, rate } if time_s >= at_s => rate,
            Drift::Step { .. } => 0.0,
            Drift::Walk { density } => {
                self.walked += density * self.chance.gaussian() / self.rate_hz.sqrt();
                self.walked
            }
            Drift::WarmUp { rate, seconds } => rate * (-time_s / seconds).exp(),
            Drift::Cable { rate_per_rad } => rate_per_rad * angle_rad,
        };
        drifts.iter().map(of).sum()
    }
}

/// The gyro's column at work.
pub(super) struct Column {
    rate_hz: f64,
    fault: GyroFault,
    lagged: Option<f64>,
    late: VecDeque<f64>,
}

impl Column {
    pub(super) fn new(rate_hz: f64, fault: &GyroFault) -> Self {
        Self { rate_hz, fault: *fault, lagged: None, late: VecDeque::new() }
    }

    /// What the column shows of the next rate, rad/s.
    pub(super) fn show(&mut self, rate: f64) -> f64 {
        let GyroFault { lag_s, late_s, step, limit } = self.fault;
        let before = self.lagged.unwrap_or(rate);
        let follow = if lag_s > 0.0 { 1.0 - (-1.0 / (lag_s * self.rate_hz)).exp() } else { 1.0 };
        let lagged = before + follow * (rate - before);
        self.lagged = Some(lagged);
        self.late.push_back(lagged);
        if self.late.len() > (late_s * self.rate_hz) as usize + 1 {
            self.late.pop_front();
        }
        let shown = self.late[0];
        let shown = if step > 0.0 { (shown / step).round() * step } else { shown };
        limit.map_or(shown, |limit| shown.min(limit))
    }
}
