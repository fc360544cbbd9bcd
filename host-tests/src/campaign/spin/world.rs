//! A simulated spinning body's samples for the core, and the truth beside them.

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::spin::profile::Profile;
use hal_mock::spin::{SpinConfiguration, SpinSample as Shown, SpinWorld};
use orientation::roll::Setting;
use orientation::signal::SpinSample;
use orientation::units::{DEGREE_PER_SQRT_HOUR, RadiansPerRootSecond, Seconds};

use crate::campaign::chance::Chance;
use crate::methods::spin::METHODS;
use crate::methods::spin::errors::Errors;
use crate::methods::spin::limit::{self, Noise};
use crate::methods::spin::samples::Converter;
use crate::methods::spin::track::Track;

/// Samples a second: the paper's.
pub const RATE_HZ: f64 = 10_000.0;
/// Scale error of the gyro: the paper's.
pub const SCALE_ERROR: f64 = 1e-3;
/// 1σ of the scale error that the core is given.
const SCALE_SIGMA: f64 = 0.01;

/// What a flight is like.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight<'a> {
    /// Length, s.
    pub seconds: f64,
    /// Roll at the start, rad.
    pub roll_rad: f64,
    /// Rate of the roll over the time, rad/s.
    pub spin_rad_s: &'a [(f64, f64)],
    /// The lift over the time, m/s².
    pub lift_m_s2: &'a [(f64, f64)],
    /// Noise of an accelerometer in a sample, m/s².
    pub noise_m_s2: f64,
    /// N of the gyros, °/√h.
    pub gyro_n_deg_sqrt_h: f64,
}

/// A second of a lift that holds a heavy body and grows a little, that of the recordings, without noise; nothing turns.
pub(super) const STEADY: Flight<'static> = Flight {
    seconds: 1.0,
    roll_rad: 0.0,
    spin_rad_s: &[],
    lift_m_s2: &[(0.0, 30.0), (1.0, 35.0)],
    noise_m_s2: 0.0,
    gyro_n_deg_sqrt_h: 0.0,
};

/// A flight as it was recorded.
#[derive(Clone, Debug)]
pub(super) struct Recorded {
    /// The samples.
    pub samples: Vec<SpinSample>,
    /// The true roll at each, rad.
    pub rolls_rad: Vec<f64>,
    /// The true lift at each, m/s².
    pub lifts_m_s2: Vec<f64>,
    /// The noise in it.
    pub noise: Noise,
}

impl Flight<'_> {
    /// Flies; the seed fixes everything random in it.
    pub(super) fn fly(&self, seed: u64) -> Recorded {
        let mut world = SpinWorld::new(&self.configuration(), seed);
        let noise = Noise {
            force: self.noise_m_s2,
            angle_random_walk: self.gyro_n_deg_sqrt_h * DEGREE_PER_SQRT_HOUR,
        };
        let mut recorded =
            Recorded { samples: Vec::new(), rolls_rad: Vec::new(), lifts_m_s2: Vec::new(), noise };
        let mut converter = Converter::new(1.0 / RATE_HZ);
        while let Some(Shown { time_s, rate_rad_s, force_m_s2 }) = world.next() {
            let truth = world.truth();
            recorded.samples.push(converter.sample(time_s, rate_rad_s, force_m_s2));
            recorded.rolls_rad.push(truth.roll_rad);
            recorded.lifts_m_s2.push(truth.lift_m_s2);
        }
        recorded
    }

    fn configuration(&self) -> SpinConfiguration<'_> {
        let mut configuration = SpinConfiguration {
            rate_hz: RATE_HZ,
            seconds: self.seconds,
            roll_rad: self.roll_rad,
            spin_rad_s: Profile(self.spin_rad_s),
            accelerometer: AccelerometerConfiguration {
                noise_m_s2_sqrt_hz: self.noise_m_s2 / (0.5 * RATE_HZ).sqrt(),
                ..AccelerometerConfiguration::default()
            },
            ..SpinConfiguration::default()
        };
        configuration.forces.lift_m_s2 = Profile(self.lift_m_s2);
        for gyro in &mut configuration.gyros {
            gyro.n_deg_sqrt_h = self.gyro_n_deg_sqrt_h;
            gyro.scale_error = SCALE_ERROR;
        }
        configuration
    }
}

impl Recorded {
    /// The Cramér–Rao bound of the roll at each sample, rad.
    pub(super) fn bounds(&self) -> Vec<f64> {
        limit::bounds(&self.samples, self.noise, SCALE_SIGMA, |index| self.lifts_m_s2[index])
    }

    /// What each of the [`METHODS`] makes of it, and the errors of that.
    pub(super) fn tracked(&self) -> [(Track, Errors); 3] {
        METHODS.map(|method| {
            let setting = Setting {
                angle_random_walk: RadiansPerRootSecond(self.noise.angle_random_walk),
                scale_sigma: SCALE_SIGMA,
                method,
                ..Setting::new(Seconds(1.0 / RATE_HZ))
            };
            let track = Track::of(&setting, &self.samples);
            let errors = Errors::between(&track, &self.rolls_rad);
            (track, errors)
        })
    }
}

/// A roll at the start and a spin of 60 to 100 turns a second that changes by up to 5 % a second.
pub(super) fn drawn(seed: u64, seconds: f64) -> (f64, [(f64, f64); 2]) {
    // Streams of a world begin at one.
    let mut chance = Chance::new(seed, 0);
    let (roll, spin) = (chance.between(-0.5 * TAU, 0.5 * TAU), TAU * chance.between(60.0, 100.0));
    (roll, [(0.0, spin), (seconds, spin * (1.0 + chance.between(-0.05, 0.05) * seconds))])
}
