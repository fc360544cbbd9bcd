//! Cost of the work done once per session: from the dwells to an azimuth with its standard
//! deviation.

use hal_mock::noise::Generator;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::setting::Setting;
use orientation::earth::Latitude;
use orientation::filter::{Coefficients, DesignError};
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::signal::Sample;
use orientation::signal::dwell::{Dwell, DwellAverage};
use orientation::units::{Angle, AngularRate, Instant, Seconds, SpecificForce, TURN, Temperature};

use crate::report::Report;
use firmware::budget::CONCLUSION_INSTRUCTIONS;
use measure::counter::Counter;
use measure::stack::stack_of;

/// Latitude, °.
const LATITUDE_DEG: f64 = 47.0 + 35.0 / 60.0;
/// Azimuth of the body, rad.
const AZIMUTH: f64 = 0.5;
/// Sample period, s.
const SAMPLE_SECONDS: f64 = 0.01;
/// Number of samples of a dwell.
const SAMPLES: u32 = 200;
/// Time from one dwell to the next, samples.
const PERIOD: u32 = 300;
/// Angle random walk N of the default gyro, °/√h (OIUS-1000 class).
const WHITE: f64 = 0.001;
/// Bias instability B, °/h, and rate random walk K, °/h/√h, where drift is set.
const DRIFT: [f64; 2] = [0.007, 0.01];
/// Greatest number of dwells that is measured.
const MOST: usize = 60;

/// Measures conclusions of 24 and 60 dwells, with white noise alone and with drift.
pub fn report(counter: &Counter, report: &mut Report) -> Result<(), DesignError> {
    for count in [24, MOST] {
        let mut dwells = [Dwell::default(); MOST];
        let dwells = fill(&mut dwells[..count])?;
        for (name, drift) in [("white noise", [0.0; 2]), ("with B and K", DRIFT)] {
            let Some(setting) = setting(drift) else { continue };
            let mut conclusion = Conclusion::default();
            let (cost, ()) = counter.measure(|| conclude(&mut conclusion, &setting, dwells));
            report.require("the session found its azimuth", is_right(&conclusion));
            let title = format_args!("conclusion of {count} dwells, {name}");
            report.budget(title, cost.instructions(), CONCLUSION_INSTRUCTIONS);
        }
    }
    Ok(())
}

/// Bytes of stack of a conclusion with drift, drawn in place as a session does.
pub fn stack() -> Result<usize, DesignError> {
    let mut dwells = [Dwell::default(); MOST];
    let dwells = fill(&mut dwells)?;
    let mut conclusion = Conclusion::default();
    Ok(setting(DRIFT)
        .map_or(0, |setting| stack_of(|| conclude(&mut conclusion, &setting, dwells)).0))
}

/// Call that is measured, not inlined.
#[inline(never)]
fn conclude(conclusion: &mut Conclusion, setting: &Setting, dwells: &[Dwell]) {
    conclusion.draw(setting, dwells, Criterion::MaximumLikelihood);
}

/// Whether the azimuth is that of the simulated dwells within 5σ.
fn is_right(conclusion: &Conclusion) -> bool {
    conclusion.verdict.is_ok_and(|it| (it.angle.0 - AZIMUTH).abs() < 5.0 * it.sigma.0)
}

/// Configuration with this bias instability and rate random walk.
fn setting([flicker, walk]: [f64; 2]) -> Option<Setting> {
    let noise = GyroNoise::from_field_units(WHITE, flicker, walk, 0.0);
    let latitude = Latitude::from_degrees(LATITUDE_DEG)?;
    let site = Site { noise: StatedNoise::Whole(noise), ..Site::at(latitude) };
    Some(Setting::new(site))
}

/// Fills dwells over the full circle, through the session's own average.
fn fill(dwells: &mut [Dwell]) -> Result<&[Dwell], DesignError> {
    let coefficients = Coefficients::<3>::low_pass(10.0, 1.0 / SAMPLE_SECONDS)?;
    let mut noise = Generator::new(4);
    let step = TURN / dwells.len() as f64;
    for (index, dwell) in (0..).zip(dwells.iter_mut()) {
        let angle = f64::from(index) * step;
        let mut average =
            DwellAverage::begin(&coefficients, &sample(index * PERIOD, angle, &mut noise));
        for moment in 1..SAMPLES {
            average.push(&coefficients, &sample(index * PERIOD + moment, angle, &mut noise));
        }
        *dwell = average.finish(&coefficients, Seconds(SAMPLE_SECONDS)).unwrap_or_default();
    }
    Ok(dwells)
}

/// A sample of a level platform at stage angle `angle`, rad.
fn sample(moment: u32, angle: f64, noise: &mut Generator) -> Sample {
    let horizontal =
        Latitude::from_degrees(LATITUDE_DEG).map_or(0.0, |latitude| latitude.horizontal_rate().0);
    let white = GyroNoise::from_field_units(WHITE, 0.0, 0.0, 0.0).white_variance(SAMPLE_SECONDS);
    let rate = horizontal * libm::cos(AZIMUTH + angle) + libm::sqrt(white) * noise.gaussian();
    Sample {
        time: Instant(u64::from(moment) * 10_000),
        stage: Angle::from_rad(angle),
        rate: AngularRate::from_rad_per_s(rate),
        force: Some([0.0, 0.0, -9.8085].map(SpecificForce::from_m_per_s2)),
        temperature: Some(Temperature(25_000)),
        elevation: None,
    }
}
