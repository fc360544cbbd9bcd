//! Molecular-electronic sensors drawn at random, at two speeds: σ is true and no bias is left.

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::earth::earth_rate_rad_s;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::molecular::MolecularConfiguration;
use hal_mock::noise::Generator;
use hal_mock::stage::{Ripple, Unevenness};
use hal_mock::turntable::Segment;

use super::rig::{Case, molecular, over, rms, uneven};

/// ρ, the greatest at the slower speed, and what the sensor does to a rate.
#[derive(Clone, Copy, Debug)]
struct Draw {
    rho: f64,
    high_pass_hz: f64,
    n: f64,
    /// Non-orthogonality at most, °.
    alpha_deg: f64,
}

const SPEEDS: [f64; 2] = [0.6, 1.2];

/// Uneven turns, then both senses, at each speed, with the time to settle in a ramp.
fn segments(turns: f64) -> Vec<Segment> {
    SPEEDS
        .iter()
        .flat_map(|&speed| {
            // Twice as many turns at the quicker speed take as long.
            let seconds = turns * TAU / SPEEDS[0];
            let even = |rate: f64| Segment::steady(rate, seconds).after(30.0);
            [uneven(speed, 12.0).after(30.0), even(speed), even(-speed)]
        })
        .collect()
}

fn case(seed: u64, draw: Draw) -> Case {
    let mut generator = Generator::new(seed + 500);
    let mut between = |low: f64, high: f64| low + (high - low) * generator.uniform();
    let latitude_deg = between(-65.0, 65.0);
    let [horizontal, ..] = earth_rate_rad_s(f64::to_radians(latitude_deg));
    let tilt_deg = between(0.05, 0.5);
    // G = κ_M F makes ρ = |G|/(w Ω_h).
    let size = between(0.0, draw.rho) * SPEEDS[0] * horizontal / f64::to_radians(tilt_deg).sin();
    let direction = between(0.0, TAU);
    let sensor = MolecularConfiguration {
        force_rad_s2_g: [size * direction.cos(), size * direction.sin()],
        high_pass_hz: draw.high_pass_hz,
        lag_s: between(0.05, 0.3),
    };
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: draw.n,
        bias_sigma_deg_h: 3.0,
        axis_elevation_rad: between(-draw.alpha_deg, draw.alpha_deg).to_radians(),
        molecular: Some(sensor),
        ..GyroConfiguration::default()
    };
    let instruments = InstrumentsConfiguration {
        latitude_deg,
        azimuth_deg: between(0.0, 360.0),
        rate_hz: 50.0,
        gyro,
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 2.5e-5,
            ..AccelerometerConfiguration::default()
        },
        ..InstrumentsConfiguration::default()
    };
    let first = Ripple { relative: 0.002, phase_rad: between(0.0, TAU) };
    Case {
        instruments: instruments.leaning(tilt_deg, between(0.0, 360.0)),
        unevenness: Unevenness { first, ..Unevenness::default() },
        start_rad: 0.0,
        segments: segments(8.1),
        setting: molecular(latitude_deg, draw.n),
        is_by_encoder: false,
    }
}

#[test]
fn explore() {
    let draws = [
        Draw { rho: 0.3, high_pass_hz: 0.0, n: 0.002, alpha_deg: 0.0 },
        Draw { rho: 0.3, high_pass_hz: 0.0, n: 0.002, alpha_deg: 0.5 },
        Draw { rho: 0.3, high_pass_hz: 0.03, n: 0.002, alpha_deg: 0.0 },
        Draw { rho: 0.3, high_pass_hz: 0.03, n: 0.002, alpha_deg: 0.5 },
        Draw { rho: 0.3, high_pass_hz: 0.0, n: 1e-5, alpha_deg: 0.0 },
        Draw { rho: 0.3, high_pass_hz: 0.0, n: 1e-5, alpha_deg: 0.5 },
        Draw { rho: 0.3, high_pass_hz: 0.03, n: 1e-5, alpha_deg: 0.0 },
        Draw { rho: 0.3, high_pass_hz: 0.03, n: 1e-5, alpha_deg: 0.5 },
        Draw { rho: 0.01, high_pass_hz: 0.03, n: 0.002, alpha_deg: 0.5 },
    ];
    for draw in draws {
        let runs = over(0..60, |seed| {
            let case = case(seed, draw);
            case.error(&case.conclude(seed))
        });
        let refused: Vec<_> = runs.iter().filter_map(|run| run.err()).map(|r| format!("{r:?}").chars().take(60).collect::<String>()).collect();
        let good: Vec<(f64, f64)> = runs.into_iter().flatten().collect();
        let ratios: Vec<f64> = good.iter().map(|(e, s)| e / s).collect();
        let errors: Vec<f64> = good.iter().map(|(e, _)| e.to_degrees()).collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{draw:?}: {:.3} of σ, rms {:.4}°, mean {mean:.4}°, median σ {:.4}°, {} given, {:?}", rms(&ratios), rms(&errors), good.get(good.len()/2).map_or(0.0, |g| g.1.to_degrees()), good.len(), &refused[..refused.len().min(3)]);
    }
}
