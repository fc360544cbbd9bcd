//! Both senses of a sensor with unknown dynamics, against complex numbers written out here.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use hal_mock::noise::Generator;
use orientation::alignment::rotating::molecular::{Freed, Halves, freed};
use orientation::math::Complex;

/// Real and imaginary part.
type Pair = [f64; 2];

fn times(a: Pair, b: Pair) -> Pair {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn polar(size: f64, angle: f64) -> Pair {
    [size * angle.cos(), size * angle.sin()]
}

fn conjugate([re, im]: Pair) -> Pair {
    [re, -im]
}

/// Q₊ = H E′ (1 − jγ) and Q₋ = H* E′ (1 + jγ), with γ = x + jy.
fn phasors(earth: Pair, response: Pair, [x, y]: Pair) -> [Pair; 2] {
    let clockwise = times(times(response, earth), [1.0 + y, -x]);
    let counter = times(times(conjugate(response), earth), [1.0 - y, x]);
    [clockwise, counter]
}

fn halves(speed: f64, phasors: [Pair; 2], variance: f64) -> Halves {
    let phasors = phasors.map(|[re, im]| Complex::new(re, im));
    Halves::of(speed, phasors, [variance; 2], 0.0)
}

fn away(angle: f64, from: f64) -> f64 {
    let off = angle - from;
    off.sin().atan2(off.cos())
}

const SPEEDS: [f64; 2] = [0.4, 1.0];

/// A sensor: arg E′, γ at the slower speed, gains and phases at both.
#[derive(Clone, Copy)]
struct Sensor {
    angle: f64,
    gamma: Pair,
    responses: [Pair; 2],
}

impl Sensor {
    fn draw(generator: &mut Generator, greatest: f64) -> Self {
        let mut between = |low: f64, high: f64| low + (high - low) * generator.uniform();
        let responses = [0.0; 2].map(|_: f64| polar(between(0.3, 3.0), between(-0.8, 0.8)));
        let gamma = polar(between(0.0, greatest), between(0.0, TAU));
        Self { angle: between(0.0, TAU), gamma, responses }
    }

    /// What it shows at a speed with this noise.
    fn at(&self, index: usize, noise: impl FnMut() -> f64, variance: f64) -> Halves {
        let scale = SPEEDS[0] / SPEEDS[index];
        let gamma = self.gamma.map(|part| part * scale);
        let exact = phasors(polar(1.0, self.angle), self.responses[index], gamma);
        let mut noise = noise;
        let shown = exact.map(|phasor| phasor.map(|part| part + noise()));
        halves(SPEEDS[index], shown, variance)
    }

    fn both(&self) -> [Halves; 2] {
        [0, 1].map(|index| self.at(index, || 0.0, 1e-12))
    }
}

fn solved(halves: &[Halves], sigma: f64) -> Freed {
    freed(halves, sigma).expect("there are halves")
}

#[test]
fn two_speeds_find_the_direction_within_three_thousandths_of_a_degree() {
    let mut generator = Generator::new(3);
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        let sensor = Sensor::draw(&mut generator, 0.3);
        let found = solved(&sensor.both(), f64::INFINITY);
        worst = worst.max(away(found.angle, sensor.angle).abs().to_degrees());
        assert!((found.ratio.im - sensor.gamma[1]).abs() < 0.01, "{:?}", found.ratio);
    }
    assert!(worst <= 0.003, "{worst}°");
}

#[test]
fn one_speed_is_off_by_half_the_angle_of_one_plus_the_square_of_gamma() {
    let mut generator = Generator::new(4);
    for _ in 0..2000 {
        let sensor = Sensor::draw(&mut generator, 0.3);
        let [slow, _] = sensor.both();
        let [re, im] = times(sensor.gamma, sensor.gamma);
        let predicted = 0.5 * im.atan2(1.0 + re);
        assert!((away(slow.angle, sensor.angle) - predicted).abs() < 1e-9);
        // Both speeds tell what one would be off by.
        let reported = solved(&sensor.both(), f64::INFINITY).one_speed;
        assert!((reported - predicted).abs() < 1e-4, "{reported} {predicted}");
    }
}

#[test]
fn the_noise_of_two_speeds_is_what_many_runs_scatter_by() {
    let mut generator = Generator::new(5);
    for sigma in [f64::INFINITY, 0.0] {
        let greatest = if sigma == 0.0 { 0.0 } else { 0.2 };
        let mut sensor = Sensor::draw(&mut generator, greatest);
        sensor.responses = [polar(1.0, 0.2), polar(1.0, -0.4)];
        let noise = 1e-3;
        let middle = solved(&sensor.both(), sigma).angle;
        let (mut square, mut stated) = (0.0, 0.0);
        let count = 40_000;
        for _ in 0..count {
            let mut draw = || noise * generator.gaussian();
            let halves = [0, 1].map(|index| sensor.at(index, &mut draw, noise * noise));
            let found = solved(&halves, sigma);
            square += away(found.angle, middle).powi(2);
            stated += found.noise;
        }
        let ratio = (square / stated).sqrt();
        // 40 000 runs tell a standard deviation to 0.35 %.
        assert!((ratio - 1.0).abs() < 0.02, "{ratio} at {sigma}");
    }
}

#[test]
fn a_sensor_without_the_g_sensitivity_takes_the_weighted_mean() {
    let mut generator = Generator::new(6);
    let sensor = Sensor::draw(&mut generator, 0.0);
    let turned = |by: f64| Sensor { angle: sensor.angle + by, ..sensor };
    let first = turned(0.01).at(0, || 0.0, 1e-6);
    let second = turned(-0.02).at(1, || 0.0, 9e-6);
    let [a, b] = [first, second].map(|half| 1.0 / half.variance);
    let found = solved(&[first, second], 0.0);
    let mean = sensor.angle + (0.01 * a - 0.02 * b) / (a + b);
    assert!(away(found.angle, mean).abs() < 1e-9);
    assert!((found.noise * (a + b) - 1.0).abs() < 1e-9 && found.left == 0.0);
}

#[test]
fn a_prior_and_noise_together_are_what_sensors_drawn_from_it_scatter_by() {
    let mut generator = Generator::new(9);
    for (sigma, noise) in [(0.02, 1e-3), (0.05, 1e-3), (0.02, 1e-2)] {
        let (mut square, count) = (0.0, 20_000);
        for _ in 0..count {
            let mut sensor = Sensor::draw(&mut generator, 0.0);
            sensor.responses = [polar(1.0, 0.2), polar(1.0, -0.4)];
            sensor.gamma = [0.0; 2].map(|_: f64| sigma / SPEEDS[0] * generator.gaussian());
            let mut draw = || noise * generator.gaussian();
            let halves = [0, 1].map(|index| sensor.at(index, &mut draw, noise * noise));
            let found = solved(&halves, sigma);
            let error = away(found.angle, sensor.angle);
            square += error * error / (found.noise + found.left);
        }
        let ratio = (square / f64::from(count)).sqrt();
        assert!((ratio - 1.0).abs() < 0.05, "{ratio} at {sigma}, {noise}");
    }
}

#[test]
fn what_is_known_of_the_sensor_beforehand_lies_between_nothing_and_all() {
    let mut generator = Generator::new(7);
    let sensor = Sensor::draw(&mut generator, 0.2);
    let halves = [0, 1].map(|index| sensor.at(index, || 0.0, 1e-6));
    let variance = |sigma: f64| {
        let found = solved(&halves, sigma);
        found.noise + found.left
    };
    let (none, some, all) = (variance(f64::INFINITY), variance(0.01), variance(0.0));
    assert!(all < some && some < none, "{all} {some} {none}");
    // One speed: a prior of γ leaves xy, of which y is known and x is not.
    let one = solved(&halves[..1], 0.04);
    let left = (0.04 / SPEEDS[0] * sensor.gamma[1]).abs();
    assert!((one.left.sqrt() / left - 1.0).abs() < 0.1, "{} {left}", one.left.sqrt());
    assert!(freed(&[], 1.0).is_none());
}

#[test]
fn half_a_turn_is_resolved_up_to_a_phase_of_a_quarter() {
    let mut generator = Generator::new(8);
    for _ in 0..500 {
        let mut sensor = Sensor::draw(&mut generator, 0.0);
        let phase = (generator.uniform() - 0.5) * 0.99 * PI;
        sensor.responses = [polar(1.0, phase); 2];
        let half = sensor.at(0, || 0.0, 1e-6);
        assert!(away(half.angle, sensor.angle).abs() < 1e-9 && (half.phase - phase).abs() < 1e-9);
        sensor.responses = [polar(1.0, phase + 2.0 * FRAC_PI_2); 2];
        let other = sensor.at(0, || 0.0, 1e-6);
        assert!(away(other.angle, sensor.angle + PI).abs() < 1e-9);
    }
}
