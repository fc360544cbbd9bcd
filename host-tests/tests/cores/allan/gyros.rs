//! Simulated gyros at rest, from the noise generators of the simulated chips.

use hal_mock::flicker::Flicker;
use hal_mock::gyro::{DEGREE_PER_HOUR, Gyro, GyroConfiguration};
use hal_mock::noise::Generator;
use orientation::noise::allan::Allan;
use orientation::units::AngularRate;

/// Sample rate, Hz.
pub const RATE_HZ: f64 = 10.0;
/// Steps of the flicker that are averaged in one sample, so that its spectrum does not fold back.
const FINER: u32 = 4;
/// Stream of the flicker.
const STREAM: u64 = 77;

/// Q in arcsec, N in °/√h, B in °/h, K in °/h/√h and R in °/h².
pub type Mix = [f64; 5];

/// The Allan variance of a record. The bias keeps the quantiser busy, as the Earth rate does.
pub fn record([q, n, b, k, r]: Mix, samples: u32, seed: u64) -> Allan {
    let configuration = GyroConfiguration {
        q_arcsec: q,
        n_deg_sqrt_h: n,
        k_deg_h_sqrt_h: k,
        r_deg_h2: r,
        bias_deg_h: 10.37,
        ..GyroConfiguration::default()
    };
    let mut gyro = Gyro::new(&configuration, RATE_HZ, seed);
    let finer = RATE_HZ * f64::from(FINER);
    let noise = Generator::stream(seed, STREAM);
    let mut flicker = Flicker::new(b * DEGREE_PER_HOUR, 1e-6, finer / 2.0, finer, noise);
    let mut allan = Allan::new();
    for index in 0..samples {
        let slow = (0..FINER).map(|_| flicker.sample()).sum::<f64>() / f64::from(FINER);
        let rate = gyro.sample(slow, f64::from(index) / RATE_HZ, 25.0);
        allan.push(AngularRate::from_rad_per_s(rate));
    }
    allan
}
