//! A healthy platform, faults in it, and what the session may make of them: a refusal of the right name,
//! or an azimuth within 4 σ.

use std::f64::consts::TAU;

use hal_mock::accelerometer::AccelerometerConfiguration;
use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::noise::Generator;
use hal_mock::stage::{EncoderConfiguration, Ripple, Unevenness};
use hal_mock::turntable::{TurningSample, TurntableConfiguration};
use orientation::alignment::refusal::Refusal;
use orientation::units::MetresPerSecondSquared;

use super::rig::{Case, both_senses, flat, over};

pub const LATITUDE_DEG: f64 = 55.75;
/// Platform speed, rad/s, and turns in either sense.
pub const SPEED: f64 = 0.8;
pub const TURNS: f64 = 12.0;
/// Modulated turns of [`both_senses`], and its ramps, s.
const MODULATED: f64 = 8.0;
const RAMP_S: f64 = 2.0;

/// Seconds of so many turns.
pub fn turns_s(turns: f64) -> f64 {
    turns * TAU / SPEED
}

/// When so many turns of the clockwise stretch are over, s.
pub fn clockwise_s(turn: f64) -> f64 {
    turns_s(MODULATED + turn) + RAMP_S
}

/// When so many turns of the counter-clockwise stretch are over, s.
pub fn counter_s(turn: f64) -> f64 {
    clockwise_s(TURNS + 0.1) + RAMP_S + turns_s(turn)
}

/// In the ramp from one sense to the other, s.
pub fn between_s() -> f64 {
    clockwise_s(TURNS + 0.1) + 0.5 * RAMP_S
}

/// A healthy platform of N °/√h.
pub fn healthy(seed: u64, n: f64) -> Case {
    let mut generator = Generator::new(seed + 77);
    let mut between = |low: f64, high: f64| low + (high - low) * generator.uniform();
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: n,
        bias_sigma_deg_h: 3.0,
        axis_elevation_rad: between(-1.0, 1.0).to_radians(),
        ..GyroConfiguration::default()
    };
    let instruments = InstrumentsConfiguration {
        latitude_deg: LATITUDE_DEG,
        azimuth_deg: between(0.0, 360.0),
        rate_hz: 50.0,
        gyro,
        accelerometer: AccelerometerConfiguration {
            noise_m_s2_sqrt_hz: 2.5e-4,
            bias_sigma_m_s2: 0.05,
            ..AccelerometerConfiguration::default()
        },
        encoder: EncoderConfiguration { step_rad: TAU / 2_097_152.0, ..Default::default() },
        ..InstrumentsConfiguration::default()
    };
    let instruments = instruments.leaning(between(0.05, 0.5), between(0.0, 360.0));
    let first = Ripple { relative: 0.002, phase_rad: between(0.0, TAU) };
    let mut setting = flat(LATITUDE_DEG, n);
    setting.site.accelerometer_bias_sigma = MetresPerSecondSquared(0.05);
    Case {
        instruments,
        unevenness: Unevenness { first, ..Unevenness::default() },
        start_rad: between(0.0, TAU),
        segments: both_senses(SPEED, TURNS + 0.1),
        setting,
        is_by_encoder: seed.is_multiple_of(2),
    }
}

/// The azimuth's error and σ, rad, or why there is none.
pub type Run = Result<(f64, f64), Refusal>;

const NOISES: [f64; 3] = [0.0002, 0.002, 0.02];
const RUNS: u64 = 12;

/// Some platforms of three noises, both with the encoder's rates and with recorded ones.
fn runs(run: impl Fn(u64, Case) -> Run + Sync + Send) -> Vec<Run> {
    over(0..RUNS, |number| run(number, healthy(number, NOISES[(number % 3) as usize])))
}

/// The refusal's name.
fn name(reason: &Refusal) -> String {
    let text = format!("{reason:?}");
    let own = text.strip_prefix("Rotating(").unwrap_or(&text);
    own.split([' ', '{', '(', ')']).next().unwrap_or_default().to_owned()
}

#[track_caller]
fn assert_sound(run: &Run, names: &[&str]) {
    match run {
        Ok((error, sigma)) => assert!(error.abs() <= 4.0 * sigma, "{error} at σ {sigma}"),
        Err(reason) => assert!(names.contains(&name(reason).as_str()), "{reason:?}"),
    }
}

/// Every run is refused, by one of these names.
#[track_caller]
pub fn assert_refused(names: &[&str], run: impl Fn(u64, Case) -> Run + Sync + Send) {
    for run in runs(run) {
        assert!(run.is_err(), "{run:?} has an azimuth");
        assert_sound(&run, names);
    }
}

/// No run is wrong: it may be refused by one of these names.
#[track_caller]
pub fn assert_never_wrong(names: &[&str], run: impl Fn(u64, Case) -> Run + Sync + Send) {
    for run in runs(run) {
        assert_sound(&run, names);
    }
}

/// Every run has an azimuth within 4 σ.
#[track_caller]
pub fn assert_right(run: impl Fn(u64, Case) -> Run + Sync + Send) {
    assert_never_wrong(&[], run);
}

/// What a platform with a changed configuration comes to.
pub fn with<'a>(
    seed: u64,
    case: &'a Case,
    change: impl Fn(TurntableConfiguration<'a>) -> TurntableConfiguration<'a>,
) -> Run {
    case.error(&case.conclude_as(&change(case.configuration()), seed))
}

/// What a platform comes to.
pub fn plain(seed: u64, case: &Case) -> Run {
    case.error(&case.conclude(seed))
}

/// What changed samples come to.
pub fn edited(seed: u64, case: &Case, edit: impl Fn(&mut [TurningSample])) -> Run {
    let mut samples = case.samples(seed);
    edit(&mut samples);
    case.error(&case.replay(&samples))
}

/// What one platform comes to that is another from a time on.
pub fn changed_at(time_s: f64, case: &Case, after: &Case, seed: u64) -> Run {
    let changed = after.samples(seed);
    edited(seed, case, |samples| {
        for (sample, other) in samples.iter_mut().zip(&changed) {
            if sample.time_s >= time_s {
                *sample = *other;
            }
        }
    })
}
