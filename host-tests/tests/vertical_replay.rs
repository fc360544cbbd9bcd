//! Recordings of kind `imu` through the gyrovertical, against the cameras of BROAD and against VQF.
//!
//! VQF's figures were computed with its authors' Python package `vqf` 2.1 in its default setting (6 axes, offline
//! methods not used) on the very samples of `data/recordings/imu-broad-*`, axes turned from forward, right, down to
//! forward, left, up and its quaternions back; errors as `bench::vertical::errors` defines them.
#![allow(clippy::expect_used, clippy::panic, reason = "a test that cannot go on has failed")]

#[path = "vertical_replay/output.rs"]
mod output;
#[path = "vertical_replay/spoilt.rs"]
mod spoilt;

use std::path::{Path, PathBuf};

use bench::recording::{self, Body, Header, ImuRow};
use bench::vertical::errors::Errors;
use bench::vertical::{Moment, Options, Replay, replay};

/// The trials, and inclination and heading RMSE of VQF, °.
const TRIALS: [(&str, [f64; 2]); 2] =
    [("imu-broad-06", [0.445, 0.299]), ("imu-broad-24", [0.494, 0.476])];
/// How much worse the inclination may be.
const MARGIN: f64 = 1.02;

/// A recording, its truth apart.
struct Recorded {
    header: Header,
    rows: Vec<ImuRow>,
    truth: Vec<Option<[f64; 4]>>,
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("data/recordings")
        .join(name)
        .with_extension("csv.gz")
}

fn recorded(name: &str) -> Recorded {
    let (header, body, truth) = recording::read(&file(name)).expect("it reads").into_parts();
    let Body::Imu(rows) = body else { panic!("{name} is {}", body.kind()) };
    Recorded { header, rows, truth: truth.attitude }
}

impl Recorded {
    fn replayed(&self) -> Replay {
        let body = Body::Imu(self.rows.clone());
        replay(&self.header, &body, &Options::default()).expect("it replays")
    }

    fn errors(&self, replay: &Replay) -> Errors {
        Errors::of(&replay.moments, &self.truth).expect("it carries a truth")
    }
}

#[test]
fn inclination_is_as_good_as_that_of_vqf_and_heading_no_worse() {
    for (name, [inclination, heading]) in TRIALS {
        let recorded = recorded(name);
        let replay = recorded.replayed();
        let errors = recorded.errors(&replay);
        let Errors { inclination_rmse_deg, heading_rmse_deg, coverage_percent, .. } = errors;
        println!(
            "{name}: inclination {inclination_rmse_deg:.4}°, heading {heading_rmse_deg:.4}°, \
             {coverage_percent:.1?} %"
        );
        assert!(inclination_rmse_deg <= MARGIN * inclination, "{name}: {inclination_rmse_deg}°");
        assert!(heading_rmse_deg <= heading, "{name}: {heading_rmse_deg}°");
        // An honest σ: no less than a normal distribution's within three of it, and not a wide guess.
        assert!(coverage_percent[2] >= 98.0, "{name}: {coverage_percent:?}");
        let sigmas: Vec<f64> = errors.off.iter().map(|off| off.sigma_deg).collect();
        let sigma = bench::campaign::statistics::rms(&sigmas);
        assert!(sigma <= 3.0 * inclination_rmse_deg, "{name}: σ {sigma}°");
    }
}

/// A moment with this attitude.
fn moment(attitude: [f64; 4]) -> Moment {
    let level_sigma = 1.5_f64.to_radians();
    Moment { time_s: 0.0, attitude, level_sigma, biases: [0.0; 3], bias_sigmas: [0.0; 3] }
}

/// A rotation by an angle in degrees about an axis of length one.
fn rotation(angle_deg: f64, [x, y, z]: [f64; 3]) -> [f64; 4] {
    let (sine, cosine) = (0.5 * angle_deg).to_radians().sin_cos();
    [cosine, sine * x, sine * y, sine * z]
}

#[test]
fn a_turn_about_the_vertical_is_heading_and_its_constant_part_is_no_error() {
    let truth = rotation(70.0, [0.6, 0.0, 0.8]);
    // Angles about the vertical that follow the truth, at ±3° about a constant that crosses 180°.
    let kept = [176.0, 182.0].map(|angle| {
        let [a, _, _, d] = rotation(angle, [0.0, 0.0, 1.0]);
        let [w, x, y, z] = truth;
        moment([a * w - d * z, a * x - d * y, a * y + d * x, a * z + d * w])
    });
    let errors = Errors::of(&kept, &[Some(truth), Some(truth)]).expect("there is a truth");
    assert!(errors.inclination_rmse_deg < 1e-6, "{errors:?}");
    assert!((errors.heading_rmse_deg - 3.0).abs() < 1e-9, "{errors:?}");
}

#[test]
fn a_tilt_is_inclination_whatever_the_heading_and_the_length_of_a_rounded_quaternion() {
    let upright = Some([1.00001, 0.0, 0.0, 0.0]);
    for (axis, tilts) in [([1.0, 0.0, 0.0], [0.0, -2.0]), ([0.0, 1.0, 0.0], [2.0, 0.0])] {
        let errors = Errors::of(&[moment(rotation(2.0, axis))], &[upright]).expect("a truth");
        assert!((errors.inclination_rmse_deg - 2.0).abs() < 1e-9, "{errors:?}");
        let off = errors.off[0].tilts_deg;
        assert!((off[0] - tilts[0]).abs() < 1e-9 && (off[1] - tilts[1]).abs() < 1e-9, "{off:?}");
        // One of both tilts lies within 1.5°, both within 3°.
        assert_eq!(errors.coverage_percent, [50.0, 100.0, 100.0]);
    }
    assert_eq!(Errors::of(&[moment([1.0, 0.0, 0.0, 0.0])], &[None]), None);
    assert_eq!(Errors::of(&[moment([1.0, 0.0, 0.0, 0.0])], &[]), None);
}
