//! The small recording that ships with the program, and how it was made.
//!
//! A fibre-optic gyro of the OIUS-1000 class (N 0.001 °/√h) beside an accelerometer with
//! a bias of some mg, on a stage that turns a full circle in twelve steps, on a base that is not
//! quite level. Somebody leans on the base in the seventh dwell.

use std::fmt::{self, Write};

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::disturbance::Disturbance;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::stage::Stop;
use hal_mock::world::{World, WorldConfiguration};

/// The recording as it ships, gzip-compressed.
pub const RECORDING: &[u8] = include_bytes!("../data/demonstration.csv.gz");
/// Its name in messages.
pub const NAME: &str = "demonstration.csv (built in)";

/// Samples per second, Hz.
const RATE_HZ: f64 = 50.0;
/// Positions on the circle.
const POSITIONS: u32 = 12;

fn instruments() -> InstrumentsConfiguration {
    InstrumentsConfiguration {
        latitude_deg: 47.58,
        azimuth_deg: 213.7,
        pitch_deg: 0.6,
        roll_deg: -0.4,
        rate_hz: RATE_HZ,
        gyro: GyroConfiguration {
            n_deg_sqrt_h: 0.001,
            bias_deg_h: 0.4,
            g_sensitivity_deg_h_g: [0.05, -0.03],
            ..GyroConfiguration::default()
        },
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 2.5e-4,
            bias_m_s2: [0.03, -0.05, 0.02],
            ..AccelerometerConfiguration::default()
        },
        ..InstrumentsConfiguration::default()
    }
}

/// The recording as text; the same at every call.
///
/// # Errors
/// Those of writing to a string: none.
pub fn text() -> Result<String, fmt::Error> {
    let stops: Vec<Stop> = (0..POSITIONS)
        .map(|i| {
            Stop::new(f64::from(i) * std::f64::consts::TAU / f64::from(POSITIONS), 5.0).after(1.0)
        })
        .collect();
    let disturbances = [Disturbance::Nudge { start_s: 38.0, seconds: 2.0, rate_deg_h: 4.0 }];
    let configuration = WorldConfiguration {
        instruments: instruments(),
        stops: &stops,
        disturbances: &disturbances,
    };
    let mut text = header()?;
    for sample in World::new(configuration, 1) {
        let [x, y, z] = sample.force_m_s2;
        writeln!(
            text,
            "{:.2},{:.7},{:.5e},{x:.4},{y:.4},{z:.4}",
            sample.time_s, sample.stage_rad, sample.rate_rad_s
        )?;
    }
    Ok(text)
}

fn header() -> Result<String, fmt::Error> {
    let mut text = String::new();
    writeln!(text, "# kind: stage")?;
    writeln!(text, "# latitude_deg: 47.58")?;
    writeln!(text, "# rate_hz: {RATE_HZ}")?;
    writeln!(text, "# gyro_N_deg_sqrt_h: 0.001")?;
    writeln!(text, "# gyro_scale_sigma: 0.001")?;
    writeln!(text, "# g_sensitivity_deg_h_g: 0.05,-0.03")?;
    writeln!(text, "# g_sensitivity_sigma_deg_h_g: 0.02")?;
    writeln!(text, "# accelerometer_bias_m_s2: 0.05")?;
    writeln!(text, "# truth_azimuth_deg: 213.7")?;
    writeln!(text, "# truth_disturbed_s: 38-40")?;
    writeln!(text, "t_s,stage_rad,g_rad_s,fx_m_s2,fy_m_s2,fz_m_s2")?;
    Ok(text)
}
