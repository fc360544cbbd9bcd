//! What happens to a base that is not left alone: a bump, a nudge, or a push.
//!
//! All act on the sensors during [start, start + seconds) only, and leave attitude and azimuth as
//! they were. A bump shakes gyro and accelerometer, a nudge only the gyro, a push only the
//! accelerometer.

use crate::gyro::DEGREE_PER_HOUR;

/// One event: a kick that oscillates and dies away linearly, amplitude·sin(2πft)·(1 − t/T), or, where it
/// has no frequency, the steady rate of a base that sinks or is leant upon, or a steady force.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Disturbance {
    /// Beginning, s from the first sample.
    pub start_s: f64,
    /// Duration T, s.
    pub seconds: f64,
    /// Frequency f of a kick, Hz; zero for one that is steady.
    pub frequency_hz: f64,
    /// Amplitude of the rate along the sensitive axis, °/h.
    pub rate_deg_h: f64,
    /// Amplitude of the specific force on platform x, y, z, m/s².
    pub force_m_s2: [f64; 3],
}

/// What disturbances add at one moment.
#[must_use]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effect {
    /// Rate along the sensitive axis, rad/s.
    pub rate_rad_s: f64,
    /// Specific force on the platform axes, m/s².
    pub force_m_s2: [f64; 3],
}

impl Disturbance {
    /// A door that falls shut nearby, `start_s` after the first sample: 0.4 s of a structure's 14 Hz,
    /// of 150 °/h and some hundredths of m/s², far above the noise of a good gyro.
    pub const fn door_slam(start_s: f64) -> Self {
        Self {
            start_s,
            seconds: 0.4,
            frequency_hz: 14.0,
            rate_deg_h: 150.0,
            force_m_s2: [0.05, 0.03, 0.08],
        }
    }

    /// A rate of 1000 °/s, beyond the full scale of any precise gyro.
    pub fn overload(start_s: f64, seconds: f64) -> Self {
        Self { start_s, seconds, rate_deg_h: 1000.0 * 3600.0, ..Self::default() }
    }

    /// Three times gravity along the sensitive axis, beyond the ±2 g of a tilt sensor.
    pub fn force_overload(start_s: f64, seconds: f64) -> Self {
        Self { start_s, seconds, force_m_s2: [30.0, 0.0, 0.0], ..Self::default() }
    }

    /// Effect of the disturbance at a time in s from the first sample; nothing outside its interval.
    pub fn at(&self, time_s: f64) -> Effect {
        let shape = self.shape(time_s - self.start_s);
        Effect {
            rate_rad_s: self.rate_deg_h * DEGREE_PER_HOUR * shape,
            force_m_s2: self.force_m_s2.map(|force| force * shape),
        }
    }

    /// What there is of the amplitude, within ±1, so many seconds after the start.
    fn shape(&self, elapsed_s: f64) -> f64 {
        if !(0.0..self.seconds).contains(&elapsed_s) {
            return 0.0;
        }
        if self.frequency_hz == 0.0 {
            return 1.0;
        }
        let phase_rad = core::f64::consts::TAU * self.frequency_hz * elapsed_s;
        libm::sin(phase_rad) * (1.0 - elapsed_s / self.seconds)
    }
}

/// Sum of several disturbances at a time in s.
#[inline]
pub fn total(disturbances: &[Disturbance], time_s: f64) -> Effect {
    let mut sum = Effect::default();
    for disturbance in disturbances {
        let effect = disturbance.at(time_s);
        sum.rate_rad_s += effect.rate_rad_s;
        for (axis, force) in sum.force_m_s2.iter_mut().zip(effect.force_m_s2) {
            *axis += force;
        }
    }
    sum
}
