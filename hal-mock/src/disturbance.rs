//! What happens to a base that is not left alone: a bump, a nudge, or a push.
//!
//! All act on the sensors during [start, start + seconds) only, and leave attitude and azimuth as
//! they were. A bump shakes gyro and accelerometer, a nudge only the gyro, a push only the
//! accelerometer.

use crate::gyro::DEGREE_PER_HOUR;

/// One event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// An oscillating kick that dies away linearly: amplitude·sin(2πft)·(1 − t/T).
    Bump {
        /// Time of the kick, s from the first sample.
        start_s: f64,
        /// Duration T, s.
        seconds: f64,
        /// Frequency f, Hz.
        frequency_hz: f64,
        /// Amplitude of the rate along the sensitive axis, °/h.
        rate_deg_h: f64,
        /// Amplitude of the specific force on platform x, y, z, m/s².
        force_m_s2: [f64; 3],
    },
    /// A small steady rate, as of a base that sinks or is leant upon.
    Nudge {
        /// Beginning of the rate, s from the first sample.
        start_s: f64,
        /// Duration, s.
        seconds: f64,
        /// Rate along the sensitive axis, °/h.
        rate_deg_h: f64,
    },
    /// A steady force on the accelerometer.
    Push {
        /// Beginning of the force, s from the first sample.
        start_s: f64,
        /// Duration, s.
        seconds: f64,
        /// Specific force on platform x, y, z, m/s².
        force_m_s2: [f64; 3],
    },
}

/// What disturbances add at one moment.
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
    #[must_use]
    pub const fn door_slam(start_s: f64) -> Self {
        Self::Bump {
            start_s,
            seconds: 0.4,
            frequency_hz: 14.0,
            rate_deg_h: 150.0,
            force_m_s2: [0.05, 0.03, 0.08],
        }
    }

    /// A rate of 1000 °/s, beyond the full scale of any precise gyro.
    #[must_use]
    pub const fn overload(start_s: f64, seconds: f64) -> Self {
        Self::Nudge { start_s, seconds, rate_deg_h: 1000.0 * 3600.0 }
    }

    /// Three times gravity along the sensitive axis, beyond the ±2 g of a tilt sensor.
    #[must_use]
    pub const fn force_overload(start_s: f64, seconds: f64) -> Self {
        Self::Push { start_s, seconds, force_m_s2: [30.0, 0.0, 0.0] }
    }

    /// Its effect at a time in s from the first sample; nothing outside its interval.
    #[must_use]
    pub fn at(&self, time_s: f64) -> Effect {
        match *self {
            Self::Bump { start_s, seconds, frequency_hz, rate_deg_h, force_m_s2 } => {
                let shape = kick(time_s - start_s, seconds, frequency_hz);
                let rate_rad_s = rate_deg_h * DEGREE_PER_HOUR * shape;
                Effect { rate_rad_s, force_m_s2: force_m_s2.map(|force| force * shape) }
            }
            Self::Nudge { start_s, seconds, rate_deg_h } => {
                let active = (0.0..seconds).contains(&(time_s - start_s));
                let rate_deg_h = if active { rate_deg_h } else { 0.0 };
                Effect { rate_rad_s: rate_deg_h * DEGREE_PER_HOUR, ..Effect::default() }
            }
            Self::Push { start_s, seconds, force_m_s2 } => {
                let active = (0.0..seconds).contains(&(time_s - start_s));
                let force_m_s2 = if active { force_m_s2 } else { [0.0; 3] };
                Effect { force_m_s2, ..Effect::default() }
            }
        }
    }
}

/// Shape of the kick, within ±1, `elapsed_s` after its start.
fn kick(elapsed_s: f64, seconds: f64, frequency_hz: f64) -> f64 {
    if !(0.0..seconds).contains(&elapsed_s) {
        return 0.0;
    }
    libm::sin(core::f64::consts::TAU * frequency_hz * elapsed_s) * (1.0 - elapsed_s / seconds)
}

/// Sum of several disturbances at a time in s.
#[inline]
#[must_use]
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
