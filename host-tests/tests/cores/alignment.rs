//! Regression, whitening, direction, level and the dwell tests, against dense algebra written here
//! and closed forms.

use hal_mock::noise::Generator;
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::direction::Components;
use orientation::alignment::stepwise::level::tilt;
use orientation::alignment::stepwise::quality::{Disturbance, ExpectedScatter};
use orientation::alignment::stepwise::setting::{Amplitude, Half, Setting};
use orientation::alignment::stepwise::tilt::Tilt;
use orientation::earth::Latitude;
use orientation::math::regression::{Column, Regression};
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::noise::whitener::Whitener;
use orientation::signal::blocks::Blocks;
use orientation::signal::dwell::Dwell;
use orientation::units::{
    Angle, MetresPerSecondSquared, RadiansPerRootSecond, RadiansPerSecond, RateRandomWalk, Seconds,
};

/// Solves A x = b by Gauss–Jordan with pivoting: the independent way.
fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).expect("rows");
        a.swap(k, pivot);
        b.swap(k, pivot);
        let scale = 1.0 / a[k][k];
        a[k].iter_mut().chain(b[k].iter_mut()).for_each(|x| *x *= scale);
        for i in (0..n).filter(|&i| i != k) {
            let factor = a[i][k];
            let (row, right) = (a[k].clone(), b[k].clone());
            a[i].iter_mut().zip(&row).for_each(|(x, y)| *x -= factor * y);
            b[i].iter_mut().zip(&right).for_each(|(x, y)| *x -= factor * y);
        }
    }
    b
}

/// Covariance of generalised least squares: (XᵀC⁻¹X)⁻¹, dense.
fn dense_covariance(x: &[Vec<f64>], c: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let weighted = solve(c.to_vec(), x.to_vec());
    let p = x[0].len();
    let normal = (0..p)
        .map(|i| (0..p).map(|j| x.iter().zip(&weighted).map(|(r, w)| r[i] * w[j]).sum()).collect())
        .collect();
    let identity = (0..p).map(|i| (0..p).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    solve(normal, identity)
}

/// cos, sin, 1 over a circle of `count` dwells of `length` s with pauses of 1 s.
fn circle(count: usize, length: f64) -> (Vec<Vec<f64>>, Vec<(f64, f64)>) {
    let step = std::f64::consts::TAU / count as f64;
    let rows =
        (0..count).map(|i| vec![(i as f64 * step).cos(), (i as f64 * step).sin(), 1.0]).collect();
    let times = (0..count).map(|i| (i as f64 * (length + 1.0), length)).collect();
    (rows, times)
}

fn whitened_covariance(
    noise: &GyroNoise,
    white: f64,
    rows: &[Vec<f64>],
    times: &[(f64, f64)],
) -> [[f64; 3]; 3] {
    let mut whitener = Whitener::<4>::new(noise, times[0].1);
    let mut regression = Regression::<3>::default();
    for (row, (start, length)) in rows.iter().zip(times) {
        let mut row = [row[0], row[1], row[2], 0.0];
        whitener.whiten(*start, start + length, white, &mut row);
        regression.push(&[row[0], row[1], row[2]], row[3]);
    }
    regression.solve(&[Column::Free; 3]).expect("it is determined").covariance
}

/// N²/T on the diagonal and K²(a + T/3), else K² times the earlier mid-time.
#[test]
fn a_random_walk_is_whitened_exactly() {
    let (rows, times) = circle(12, 10.0);
    let (white, k) = (0.3, 0.05);
    let noise = GyroNoise { rate_random_walk: RateRandomWalk(k), ..GyroNoise::default() };
    let middle = |i: usize| times[i].0 + 0.5 * times[i].1;
    let c: Vec<Vec<f64>> = (0..12)
        .map(|i| {
            let shared = |j: usize| k * k * middle(i).min(middle(j));
            let own = white + k * k * (times[i].0 + times[i].1 / 3.0);
            (0..12).map(|j| if i == j { own } else { shared(j) }).collect()
        })
        .collect();
    let expected = dense_covariance(&rows, &c);
    let found = whitened_covariance(&noise, white, &rows, &times);
    for i in 0..2 {
        for j in 0..2 {
            let difference = (found[i][j] - expected[i][j]).abs();
            assert!(difference < 1e-9 * expected[0][0], "{found:?} {expected:?}");
        }
    }
}

/// Mean of ln|s − t| over two windows of length `l` whose starts are `lag` apart.
fn mean_log(lag: f64, l: f64) -> f64 {
    let g = |x: f64| if x == 0.0 { 0.0 } else { x * x * (0.5 * x.abs().ln() - 0.75) };
    (g(lag + l) - 2.0 * g(lag) + g(lag - l)) / (l * l)
}

/// Flicker with S(f) = B²/(π f): C = (B²/π)(c − mean ln|lag|), c absorbed by the constant.
#[test]
fn flicker_is_whitened_to_within_two_per_cent() {
    for (count, length, white) in [(12, 10.0, 0.05), (8, 30.0, 0.01), (60, 1.0, 0.3)] {
        let (rows, times) = circle(count, length);
        let b: f64 = 0.7;
        let noise = GyroNoise { bias_instability: RadiansPerSecond(b), ..GyroNoise::default() };
        let density = b * b / std::f64::consts::PI;
        let c: Vec<Vec<f64>> = (0..count)
            .map(|i| {
                let entry = |j: usize| {
                    let own = if i == j { white } else { 0.0 };
                    own + density * (20.0 - mean_log((times[i].0 - times[j].0).abs(), length))
                };
                (0..count).map(entry).collect()
            })
            .collect();
        let expected = dense_covariance(&rows, &c);
        let found = whitened_covariance(&noise, white, &rows, &times);
        for i in 0..2 {
            let ratio = (found[i][i] / expected[i][i]).sqrt();
            assert!((ratio - 1.0).abs() < 0.02, "{count} × {length} s: {ratio}");
        }
    }
}

#[test]
fn a_prior_adds_its_information() {
    let mut regression = Regression::<2>::default();
    for i in 0..10 {
        let x = f64::from(i) - 4.5;
        regression.push(&[1.0, x], 2.0 + 0.5 * x);
    }
    let free = regression.solve(&[Column::Free; 2]).expect("it is determined");
    assert!((free.coefficients[1] - 0.5).abs() < 1e-12 && free.chi_square < 1e-9);
    assert_eq!(free.degrees, 8);
    // Σx² = 82.5: with a prior of σ the slope shrinks by 82.5/(82.5 + 1/σ²).
    let held = regression.solve(&[Column::Free, Column::Prior(0.1)]).expect("it is determined");
    assert!((held.coefficients[1] - 0.5 * 82.5 / 182.5).abs() < 1e-12);
    assert!((held.covariance[1][1] - 1.0 / 182.5).abs() < 1e-12);
    let without = regression.solve(&[Column::Free, Column::Absent]).expect("it is determined");
    assert_eq!(without.coefficients[1], 0.0);
    assert!((without.chi_square - 0.25 * 82.5).abs() < 1e-9);
}

/// Chi-square of an azimuth and an amplitude.
fn chi_square(components: &Components, amplitude: Amplitude, azimuth: f64, rho: f64) -> f64 {
    let [[a, b], [_, d]] = components.covariance;
    let x = components.value[0] - rho * azimuth.cos();
    let y = components.value[1] - rho * azimuth.sin();
    let own = (d * x * x - 2.0 * b * x * y + a * y * y) / (a * d - b * b);
    match amplitude {
        Amplitude::Known(sigma) if sigma > 0.0 => own + ((rho - 1.0) / sigma).powi(2),
        _ => own,
    }
}

/// Least chi-square over a grid of azimuths and amplitudes.
fn least_of_grid(components: &Components, amplitude: Amplitude) -> f64 {
    let rhos: Vec<f64> = match amplitude {
        Amplitude::Known(0.0) => vec![1.0],
        _ => (0..=200).map(|i| f64::from(i) * 0.01).collect(),
    };
    let azimuths = (0..36_000).map(|k| f64::from(k) * std::f64::consts::TAU / 36_000.0);
    azimuths
        .flat_map(|azimuth| rhos.iter().map(move |&rho| (azimuth, rho)))
        .map(|(azimuth, rho)| chi_square(components, amplitude, azimuth, rho))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn the_direction_is_the_best_of_the_whole_circle() {
    let mut generator = Generator::new(3);
    for case in 0..24 {
        let azimuth = generator.uniform() * std::f64::consts::TAU;
        let (long, short) = (0.1 + 0.3 * generator.uniform(), 0.02);
        let (s, c) = (generator.uniform() * 3.0).sin_cos();
        let covariance = [
            [long * long * c * c + short * short * s * s, (long * long - short * short) * s * c],
            [(long * long - short * short) * s * c, long * long * s * s + short * short * c * c],
        ];
        let value = [
            azimuth.cos() + long * c * generator.gaussian(),
            azimuth.sin() + long * s * generator.gaussian(),
        ];
        let components = Components { value, covariance, vertical: [0.0; 2], half: None };
        for amplitude in [Amplitude::Known(0.0), Amplitude::Known(0.05)] {
            let found = components.direction(amplitude).expect("it is determined");
            let least = least_of_grid(&components, amplitude);
            let value = chi_square(&components, amplitude, found.azimuth, found.amplitude);
            assert!(value <= least + 1e-9, "{case} {amplitude:?}: {value} {least}");
        }
        let free = components.direction(Amplitude::Free).expect("it is determined");
        assert!((free.azimuth - value[1].atan2(value[0])).abs() < 1e-9);
    }
}

#[test]
fn a_known_amplitude_sees_only_the_error_across() {
    let covariance = [[0.04, 0.0], [0.0, 0.01]];
    let components = Components { value: [1.0, 0.0], covariance, vertical: [0.0; 2], half: None };
    for amplitude in [Amplitude::Free, Amplitude::Known(0.0), Amplitude::Known(0.02)] {
        let direction = components.direction(amplitude).expect("it is determined");
        assert!((direction.variance - 0.01).abs() < 1e-9, "{direction:?}");
        assert!((direction.gain[1] - 1.0).abs() < 1e-6 && direction.gain[0].abs() < 1e-6);
    }
}

#[test]
fn two_azimuths_that_fit_alike_have_no_margin() {
    // Only cos A is known: +A and −A.
    let components = Components {
        value: [0.5, 0.0],
        covariance: [[1e-4, 0.0], [0.0, 100.0]],
        vertical: [0.0; 2],
        half: None,
    };
    let direction = components.direction(Amplitude::Known(0.0)).expect("it is determined");
    assert!(direction.margin < 1e-3, "{direction:?}");
    // Where the half is known, there is but one of them.
    for (half, azimuth) in [(Half::East, 60.0_f64), (Half::West, -60.0)] {
        let known = Components { half: Some(half), ..components };
        let direction = known.direction(Amplitude::Known(0.0)).expect("it is determined");
        assert!((direction.azimuth - azimuth.to_radians()).abs() < 1e-6, "{direction:?}");
        assert!(direction.margin > 1e3, "{direction:?}");
    }
}

/// The tilt of dwells on the stage at the equator, with accelerometers of this bias, 1σ, m/s².
fn levelled(dwells: &[Dwell], accelerometer_bias_sigma: f64) -> Tilt {
    let site = Site {
        accelerometer_bias_sigma: MetresPerSecondSquared(accelerometer_bias_sigma),
        ..Site::at(Latitude::EQUATOR)
    };
    tilt(&Setting::new(site), dwells.iter())
}

/// A dwell with the forces of a tilt and biases, in g of the equator.
fn leaning(theta_deg: f64, tilt: [f64; 2], bias: [f64; 2]) -> Dwell {
    let (s, c) = theta_deg.to_radians().sin_cos();
    let x = tilt[0] * c - tilt[1] * s + bias[0];
    let y = -(tilt[0] * s + tilt[1] * c) + bias[1];
    let gravity = Latitude::EQUATOR.gravity();
    Dwell {
        stage: Angle::from_rad(theta_deg.to_radians()),
        force: Some([
            MetresPerSecondSquared(gravity.0 * x),
            MetresPerSecondSquared(gravity.0 * y),
            MetresPerSecondSquared(-gravity.0),
        ]),
        ..Dwell::default()
    }
}

#[test]
fn a_full_circle_frees_the_tilt_of_the_bias_and_an_arc_does_not() {
    let truth = [0.02, -0.01];
    let at = |angles: &[f64]| -> Vec<Dwell> {
        angles.iter().map(|&angle| leaning(angle, truth, [0.025, -0.015])).collect()
    };
    let circle = at(&[0.0, 60.0, 120.0, 180.0, 240.0, 300.0]);
    let found = levelled(&circle, 0.3);
    assert!((found.real - truth[0]).abs() < 1e-6 && (found.imaginary - truth[1]).abs() < 1e-6);
    assert!((found.bias[0] - 0.025).abs() < 1e-5, "{found:?}");
    // On an arc with some mg of scatter the tilt is known no better than the bias: 0.3/9.8 g.
    let mut arc = at(&[0.0, 2.0, 4.0, 6.0]);
    for (dwell, push) in arc.iter_mut().zip([0.05, -0.05, -0.05, 0.05]) {
        dwell.force = dwell.force.map(|[x, y, z]| {
            [MetresPerSecondSquared(x.0 + push), MetresPerSecondSquared(y.0 - push), z]
        });
    }
    let found = levelled(&arc, 0.3);
    let sigma = found.covariance[0][0].sqrt();
    assert!((0.5..1.1).contains(&(sigma / (0.3 / 9.8))), "{found:?}");
    assert!((found.real - truth[0]).abs() < 3.5 * sigma, "{found:?}");
}

#[test]
fn pitch_and_roll_come_from_the_phasor() {
    let (pitch, roll) = (3.0_f64.to_radians(), (-2.0_f64).to_radians());
    let phasor = [pitch.sin(), roll.sin() * pitch.cos()];
    let dwells: Vec<Dwell> =
        (0..12).map(|i| leaning(f64::from(i) * 30.0, phasor, [0.0, 0.0])).collect();
    let found = levelled(&dwells, 0.05);
    assert!((found.pitch().0 - pitch).abs() < 1e-8 && (found.roll().0 - roll).abs() < 1e-8);
    assert!(!levelled(&[Dwell::default()], 0.0).measured);
}

/// Blocks of white noise of one unit (in µrad/s) a sample, plus what `add` says for each sample.
fn blocks(generator: &mut Generator, samples: u32, add: impl Fn(u32) -> f64) -> Dwell {
    let mut blocks = Blocks::default();
    for index in 0..samples {
        blocks.push((1000.0 * (generator.gaussian() + add(index))).round() as i32);
    }
    Dwell { statistics: blocks.statistics(0.01), samples, ..Dwell::default() }
}

/// N for one µrad/s a sample at 100 Hz.
fn gyro() -> Setting {
    let noise =
        GyroNoise { angle_random_walk: RadiansPerRootSecond(1e-6 * 0.1), ..GyroNoise::default() };
    let latitude = Latitude::from_degrees(50.0).expect("it is one");
    Setting::new(Site { noise: StatedNoise::Whole(noise), ..Site::at(latitude) })
}

#[test]
fn quiet_dwells_pass_and_kicks_nudges_and_slopes_do_not() {
    let mut generator = Generator::new(5);
    let healthy: Vec<Dwell> = (0..40).map(|_| blocks(&mut generator, 1000, |_| 0.0)).collect();
    let norm = ExpectedScatter::of(&gyro(), &healthy);
    assert!(healthy.iter().all(|dwell| norm.disturbance(dwell).is_none()));
    let kick = blocks(&mut generator, 1000, |i| if i / 50 == 8 { 8.0 } else { 0.0 });
    assert!(norm.disturbance(&kick).is_some());
    // A nudge of 0.5 σ of a sample over a third of the dwell moves its mean by 5 of its σ.
    let nudge = blocks(&mut generator, 1000, |i| if (400..740).contains(&i) { 0.5 } else { 0.0 });
    assert!(norm.disturbance(&nudge).is_some());
    let slope = blocks(&mut generator, 1000, |i| 0.001 * f64::from(i));
    let found = norm.disturbance(&slope);
    assert!(matches!(found, Some(Disturbance::Drift(_))), "{found:?}");
}

#[test]
fn the_stop_criteria_name_dwells_in_which_a_vehicle_turned_or_drove() {
    let mut generator = Generator::new(9);
    let dph = 1f64.to_radians() / 3600.0;
    // A gyro of 40 °/h bias on a stage at 50°, an accelerometer 0.2 m/s² beside gravity: biases are no motion.
    let mut dwell = |index: u32, rate: f64, force: f64| Dwell {
        seconds: Seconds(10.0),
        rate: RadiansPerSecond(
            (40.0 + 9.67 * f64::from(index * 15).to_radians().cos() + rate) * dph,
        ),
        force: Some([
            MetresPerSecondSquared(0.1),
            MetresPerSecondSquared(-0.05),
            MetresPerSecondSquared(-9.81 - 0.2 - force),
        ]),
        ..blocks(&mut generator, 1000, |_| 0.0)
    };
    let healthy: Vec<Dwell> = (0..24).map(|index| dwell(index, 0.0, 0.0)).collect();
    let norm = ExpectedScatter::of(&gyro(), &healthy);
    for dwell in &healthy {
        assert_eq!(norm.disturbance(dwell), None);
    }
    // Twice the Earth rate, and 2 °/h that wind leaves to a mean of 10 s: 45 °/h is more, 20 °/h may be less.
    assert_eq!(norm.disturbance(&dwell(0, 20.0, 0.0)), None);
    let turning = norm.disturbance(&dwell(0, 45.0, 0.0));
    assert!(matches!(turning, Some(Disturbance::Driving(rate, _)) if rate.0 > 10.0), "{turning:?}");
    let driving = norm.disturbance(&dwell(0, 0.0, 0.05));
    assert!(
        matches!(driving, Some(Disturbance::Driving(_, force)) if force.0 > 0.04),
        "{driving:?}"
    );
}

#[test]
fn a_slope_that_all_dwells_share_is_no_disturbance() {
    let mut generator = Generator::new(6);
    let warming: Vec<Dwell> =
        (0..24).map(|_| blocks(&mut generator, 1000, |i| 0.001 * f64::from(i))).collect();
    let norm = ExpectedScatter::of(&gyro(), &warming);
    let disturbed = warming.iter().filter(|dwell| norm.disturbance(dwell).is_some()).count();
    assert_eq!(disturbed, 0);
}

#[test]
fn a_healthy_dwell_is_rejected_less_than_once_in_two_thousand() {
    let mut generator = Generator::new(7);
    let norm = ExpectedScatter::of(&gyro(), &[]);
    let rejected = (0..20_000)
        .filter(|_| {
            let dwell = blocks(&mut generator, 250, |_| 0.0);
            norm.disturbance(&dwell).is_some()
        })
        .count();
    assert!(rejected < 10, "{rejected} of 20 000");
}

#[test]
fn an_unknown_noise_is_taken_from_the_dwells() {
    let mut generator = Generator::new(8);
    let dwells: Vec<Dwell> = (0..20).map(|_| blocks(&mut generator, 1000, |_| 0.0)).collect();
    let mut setting = gyro();
    setting.site.noise = StatedNoise::ExceptWhite(*setting.site.noise.model());
    let found = ExpectedScatter::of(&setting, &dwells).white.sqrt();
    assert!((found / 1e-7 - 1.0).abs() < 0.15, "{found}");
}
