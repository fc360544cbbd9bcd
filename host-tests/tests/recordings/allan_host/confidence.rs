//! The limits hold the true deviation as often as they say, and the analysis refuses what it must.

use hal_mock::noise::Generator;
use host::allan::analysis::{Analysis, factors};
use host::allan::rest::{Rest, RestError};
use host::recording::{Kind, RestRows};
use orientation::noise::fit::FitError;

/// What a text comes to.
fn read(text: &str) -> Result<Rest, RestError> {
    let opened = RestRows::open("rest.csv", text.as_bytes(), None).map_err(RestError::Read)?;
    Rest::read(opened, &mut Vec::new())
}

/// The recording of a gyro at rest that has these rates at 10 Hz.
fn text(rates: &[f64]) -> String {
    let row = |(index, rate): (usize, &f64)| format!("{:.1},{rate:e}\n", index as f64 * 0.1);
    let rows: String = rates.iter().enumerate().map(row).collect();
    format!("# kind: static\nt_s,g_rad_s\n{rows}")
}

fn rest(rates: &[f64]) -> Rest {
    read(&text(rates)).expect("it is a record at rest")
}

/// White noise of 1 mrad/s a sample.
fn white(seed: u64, samples: usize) -> Vec<f64> {
    let mut generator = Generator::new(seed);
    (0..samples).map(|_| 1e-3 * generator.gaussian()).collect()
}

#[test]
fn limits_are_those_of_the_chi_square_distribution() {
    // scipy.stats.chi2.ppf at the normal distribution's ±1σ.
    let expected = [
        (1.0, [0.709_416_729, 4.995_661_613]),
        (2.5, [0.749_595_819, 2.086_490_627]),
        (10.0, [0.835_497_220, 1.326_790_088]),
        (300.0, [0.961_556_575, 1.043_456_315]),
        (20000.5, [0.995_037_334, 1.005_037_667]),
    ];
    for (degrees, limits) in expected {
        for (found, limit) in factors(degrees).into_iter().zip(limits) {
            assert!((found / limit - 1.0).abs() < 1e-6, "{degrees}: {found} for {limit}");
        }
    }
    for degrees in [0.0, -1.0, f64::NAN] {
        assert_eq!(factors(degrees), [0.0, f64::INFINITY], "nothing is known");
    }
}

#[test]
fn limits_hold_the_true_deviation_of_white_noise_in_two_of_three_records() {
    const RECORDS: u64 = 400;
    let mut held = [0_u32; 4];
    let spans = [1.0, 4.0, 16.0, 64.0_f64];
    for seed in 0..RECORDS {
        let analysis = Analysis::of(&rest(&white(seed, 512))).expect("it is long enough");
        for (held, span) in held.iter_mut().zip(spans) {
            let is_here = |seconds: f64| (seconds / 0.1 / span - 1.0).abs() < 1e-9;
            let point = analysis.points.iter().find(|point| is_here(point.seconds));
            let [low, high] = point.expect("every record reaches it").limits;
            *held += u32::from((low..high).contains(&(1e-3 / span.sqrt())));
        }
    }
    for (held, span) in held.into_iter().zip(spans) {
        let part = f64::from(held) / RECORDS as f64;
        // Three deviations of 400 draws are 7 %.
        assert!((part - 0.683).abs() < 0.07, "{part} at {span} samples");
    }
}

#[test]
fn longer_averages_are_less_sure() {
    let analysis = Analysis::of(&rest(&white(1, 4096))).expect("it is long enough");
    let width = |limits: [f64; 2]| limits[1] / limits[0];
    let widths: Vec<f64> = analysis.points.iter().map(|point| width(point.limits)).collect();
    assert!(widths.windows(2).all(|pair| pair[0] < pair[1]), "{widths:?}");
}

#[test]
fn what_says_nothing_is_refused_by_name() {
    let refused = |rates: &[f64]| Analysis::of(&rest(rates)).expect_err("it says nothing");
    assert_eq!(refused(&[1e-5; 1000]), FitError::Constant);
    assert!(matches!(refused(&white(3, 40)), FitError::TooShort { samples: 40, .. }));
    let mut saturated = white(4, 1000);
    saturated[500] = 2.147_483_647;
    assert_eq!(refused(&saturated), FitError::Saturated);
    // A step that is rarely taken.
    let stepping: Vec<f64> = (0..1000).map(|index| f64::from(index / 300) * 1e-5).collect();
    assert_eq!(refused(&stepping), FitError::Unresolved);
}

#[test]
fn a_recording_of_another_kind_or_of_one_row_is_no_record_at_rest() {
    let refused = |text: &str| read(text).expect_err("it is none");
    let moving = "# kind: dwells\nstage_rad,rate_rad_s,sigma_rad_s,seconds\n0,1e-5,1e-8,60\n";
    assert_eq!(refused(moving), RestError::Kind(Kind::Dwells));
    assert_eq!(refused(&text(&[1e-5])), RestError::OneRow);
}
