//! A base that sways from power-on and never rests: what its gyros' biases, which no rest shows, make of a kept azimuth.
//! To gyros and accelerometers a base that stands with a bias and one that circles look alike.

use hal_mock::noise::Generator;
use orientation::attitude::Setting;
use orientation::units::{DEGREE, RadiansPerSecond};

use super::world::{Body, Known, coarse, keep_acting};

/// When the azimuth is handed over, and how long it is kept, s.
const ALIGNED: f64 = 240.0;
const KEPT: f64 = 300.0;
/// 1σ of the gyros' switch-on biases, °/s.
const BIAS: f64 = 3.0;
/// Bases, each with biases of its own.
const BASES: u64 = 12;

/// Attitude of a base that sways about both level axes by so many hundredths of a degree, and turns by a right angle a
/// minute after it has its azimuth.
fn swaying<const HUNDREDTHS: i32>(time: f64) -> [f64; 3] {
    let size = 0.01 * f64::from(HUNDREDTHS) * DEGREE;
    let turned = ((time - ALIGNED - 60.0) / 20.0).clamp(0.0, 1.0);
    let course = 1.0 + 90.0 * DEGREE * turned;
    [course, 0.03 + size * (3.1 * time).sin(), -0.02 + size * (2.7 * time).sin()]
}

/// The same one, which was carried to its place until ten seconds before the alignment began.
fn carried<const HUNDREDTHS: i32>(time: f64) -> [f64; 3] {
    let [course, pitch, roll] = swaying::<HUNDREDTHS>(time);
    let left = 1.0 - (time / 20.0).min(1.0);
    [course + 9.0 * left, pitch + 0.8 * left * time.sin(), roll - 0.5 * left]
}

/// The same one, which was turned slowly until two minutes and a half before its azimuth, at 1.5 °/s.
fn circled<const HUNDREDTHS: i32>(time: f64) -> [f64; 3] {
    let [course, pitch, roll] = swaying::<HUNDREDTHS>(time);
    [course - 1.5 * DEGREE * (ALIGNED - 150.0 - time).max(0.0), pitch, roll]
}

/// A coarse IMU on a base.
fn base(attitude: fn(f64) -> [f64; 3], seed: u64) -> Body {
    let mut draw = Generator::new(1000 + seed);
    let Setting { latitude, sample_seconds, .. } = coarse(1.0).setting;
    let mut setting = Setting::coarse(latitude, sample_seconds);
    for gyro in &mut setting.gyros {
        gyro.bias_sigma = RadiansPerSecond(BIAS * DEGREE);
    }
    let biases = [0; 3].map(|_| BIAS * DEGREE * draw.gaussian());
    let force_biases = [0; 3].map(|_| setting.force_bias_sigma.0 * draw.gaussian());
    let body = coarse(ALIGNED + KEPT);
    Body { setting, biases, force_biases, attitude, handed: Some(ALIGNED), seed, ..body }
}

/// What is known of a base from the moment on at which it has its azimuth: from an alignment, which shows that it stood,
/// or from outside.
fn kept(attitude: fn(f64) -> [f64; 3], seed: u64, is_aligned: bool) -> Vec<Known> {
    let mut is_shown = !is_aligned;
    let base = base(attitude, seed);
    let known = keep_acting(
        &base,
        |_, _| true,
        |time, keeper| {
            if !is_shown && time >= ALIGNED {
                is_shown = true;
                keeper.learn_from_sway();
            }
        },
    );
    known.into_iter().filter(|known| known.time > ALIGNED).collect()
}

/// Error of the azimuth and its 1σ, °.
fn azimuth(known: &Known) -> [f64; 2] {
    let sigma = known.report.azimuth.expect("it is held").sigma.0;
    [known.azimuth.expect("it is held"), sigma].map(|angle| angle / DEGREE)
}

/// Greatest error of the azimuth over its σ.
fn worst(known: &[Known]) -> f64 {
    let held = known.iter().filter(|known| known.azimuth.is_some());
    let of = held.map(azimuth).map(|[error, sigma]| error.abs() / sigma);
    of.fold(0.0, f64::max)
}

#[test]
fn an_alignment_shows_the_biases_of_a_base_that_sways_from_power_on() {
    for attitude in [swaying::<15>, swaying::<50>, carried::<15>, circled::<15>] {
        let mut square = 0.0;
        for seed in 1..=BASES {
            let known = kept(attitude, seed, true);
            assert!(known.iter().all(|known| !known.report.is_at_rest));
            assert!(worst(&known) < 4.0, "{seed}: {} σ", worst(&known));
            let level = known.iter().map(Known::in_sigmas).fold(0.0, f64::max);
            assert!(level < 4.5, "{seed}: the level by {level} σ");
            let [error, sigma] = known.last().map(azimuth).expect("it was kept");
            assert!(sigma < 4.0, "{seed}: ± {sigma}° after five minutes");
            square += error * error / (sigma * sigma) / BASES as f64;
        }
        assert!(square < 2.0, "RMS of error over σ {}", square.sqrt());
    }
}

#[test]
fn an_azimuth_from_outside_is_worth_nothing_soon_on_a_base_that_sways_from_power_on() {
    for seed in 1..=BASES {
        let known = kept(swaying::<15>, seed, false);
        assert!(worst(&known) < 4.0, "{seed}: {} σ", worst(&known));
        assert!(known.iter().any(|known| known.azimuth.is_some()));
        let lost = known.iter().find(|known| known.azimuth.is_none()).map(|known| known.time);
        assert!(lost.is_some_and(|lost| lost < ALIGNED + 30.0), "{seed}: lost at {lost:?} s");
    }
}

#[test]
fn a_base_that_rested_before_it_sways_keeps_what_the_rest_has_shown() {
    let rested = |time: f64| {
        if time < 30.0 { [1.0, 0.03, -0.02] } else { swaying::<15>(time) }
    };
    for seed in 1..=BASES {
        let [aligned, outside] = [true, false].map(|is_aligned| kept(rested, seed, is_aligned));
        assert!(worst(&aligned) < 4.0, "{seed}: {} σ", worst(&aligned));
        let last = |known: &[Known]| known.last().map(azimuth);
        assert_eq!(last(&aligned), last(&outside), "{seed}");
    }
}
