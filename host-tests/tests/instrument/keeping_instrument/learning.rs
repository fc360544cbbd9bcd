//! An azimuth that is kept while its gyro's bias is being learnt: what is learnt corrects nothing twice, and nothing that
//! was measured otherwise.

use orientation::attitude::{Gyro, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::navigation::progress::VerticalGyro;
use orientation::navigation::{Input, Motion, Navigator, Policy};
use orientation::units::{DEGREE, RadiansPerSecond, Seconds};

use super::handing::{azimuth, policy};
use super::recalling::{Body, RATE, at};

/// 1σ of the coarse gyros' biases, rad/s.
const BIAS: f64 = 0.5 * DEGREE;

/// Coarse gyros.
fn coarse() -> Gyro {
    Gyro { bias_sigma: RadiansPerSecond(BIAS), ..Gyro::coarse() }
}

/// An input that comes before a sample, by the true azimuth then, °.
type Given = (u64, Box<dyn Fn(f64) -> Input>);

/// An azimuth from outside, s.
fn outside(second: u64, sigma: f64) -> Given {
    (second * RATE, Box::new(move |truth| Input::Aided(None, Some(azimuth(truth, sigma)))))
}

/// The error, in its σ, of the azimuth at the end of so many seconds of a body, which turns by these degrees with a sample of
/// this number, by coarse gyros with biases of so many σ.
fn in_sigmas(seconds: u64, biases: f64, turns: fn(u64) -> f64, given: &[Given]) -> f64 {
    let latitude = Latitude::from_degrees(45.0).expect("a latitude");
    let period = Seconds(1.0 / RATE as f64);
    let setting = Setting { gyros: [coarse(); 3], ..Setting::coarse(latitude, period) };
    let mut keeper = Keeper::new(&setting);
    let policy = Policy { beside: coarse(), precise: coarse(), ..policy() };
    let mut navigator = Navigator::new(&mut keeper, &policy);
    let mut body = Body { azimuth: 100.0, bias: biases * BIAS, ..Body::default() };
    for index in 0..seconds * RATE {
        for (_, input) in given.iter().filter(|(at, _)| *at == index) {
            navigator.take(&input(body.azimuth), &mut |_| ());
        }
        navigator.take(&body.moved(index, turns(index)), &mut |_| ());
    }
    navigator.take(&Input::Settled, &mut |_| ());
    let kept = keeper.report().azimuth.expect("it is kept");
    let off = (kept.angle.degrees() - body.azimuth + 180.0).rem_euclid(360.0) - 180.0;
    off.abs() / kept.sigma.degrees()
}

/// It weaves for a minute, and stands. What it was when it stood already was found later.
#[test]
fn what_a_stop_shows_of_a_bias_does_not_turn_an_azimuth_that_was_found_at_it() {
    let weaves = |index| if index < 60 * RATE { 0.05 * (0.02 * index as f64).sin() } else { 0.0 };
    for (marked, found) in [(60, 90), (61, 90), (62, 64), (63, 100), (75, 77)] {
        for biases in [-2.0, 0.8, 2.0] {
            let moment = at(marked * RATE - 1);
            let given: [Given; 3] = [
                outside(5, 0.05),
                (marked * RATE, Box::new(move |_| Input::Concluding(moment))),
                (found * RATE, Box::new(move |truth| Input::Found(moment, azimuth(truth, 0.02)))),
            ];
            let sigmas = in_sigmas(120, biases, weaves, &given);
            assert!(sigmas < 3.0, "{marked} s, {found} s, {biases} σ of bias: {sigmas} σ");
        }
    }
}

#[test]
fn the_first_rest_undoes_a_bias_once() {
    for biases in [-2.0, -0.5, 1.0, 2.5] {
        // Before anything is known of the gyros, and where one of them is replaced.
        let exchanged: Given =
            (60 * RATE, Box::new(|_| Input::Motion(Motion::Exchanged(VerticalGyro::Coarse))));
        for given in [vec![outside(1, 0.05)], vec![outside(20, 0.05), exchanged]] {
            let sigmas = in_sigmas(90, biases, |_| 0.0, &given);
            assert!(sigmas < 3.0, "{} inputs, {biases} σ of bias: {sigmas} σ", given.len());
        }
    }
}
