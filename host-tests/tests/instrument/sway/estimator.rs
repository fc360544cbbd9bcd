//! The estimate of the sway against closed forms: sinusoids, biases, noise, levers.

use std::f64::consts::{SQRT_2, TAU};

use hal_mock::noise::Generator;
use orientation::signal::sway::{CoarseSensors, Decision, Size, Sway, SwayNoise};
use orientation::units::{AngularRate, Seconds, SpecificForce};
use proptest::prelude::*;

/// Readings a second.
const HERTZ: f64 = 200.0;
/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;

/// A base that rolls and pitches a little, under sensors with errors.
#[derive(Clone, Copy, Debug)]
struct World {
    /// Amplitude of roll and pitch, rad.
    amplitude: f64,
    /// Frequency, Hz; pitch is a quarter of a period late.
    hertz: f64,
    /// Bias of the gyros, rad/s.
    bias: [f64; 3],
    /// Offset of the accelerometers, g.
    offset: [f64; 3],
    /// Height of the sensors above the point that the base sways about, m.
    height: f64,
    /// White noise of one reading of a gyro, rad/s, and of an accelerometer, g.
    noise: [f64; 2],
}

const STILL: World = World {
    amplitude: 0.0,
    hertz: 0.5,
    bias: [0.0; 3],
    offset: [0.0; 3],
    height: 0.0,
    noise: [0.0; 2],
};

impl World {
    fn phase(&self, seconds: f64) -> f64 {
        TAU * self.hertz * seconds + 0.4
    }

    /// Roll and pitch, rad.
    fn angles(&self, seconds: f64) -> [f64; 2] {
        let (sine, cosine) = self.phase(seconds).sin_cos();
        [self.amplitude * sine, -self.amplitude * cosine]
    }

    /// Their rates, to first order in the angles.
    fn rates(&self, seconds: f64) -> [f64; 2] {
        let (sine, cosine) = self.phase(seconds).sin_cos();
        [cosine, sine].map(|part| self.amplitude * TAU * self.hertz * part)
    }

    /// What the sensors show: rates, and forces in g, to first order in the angles.
    fn show(&self, seconds: f64, chance: &mut Generator) -> ([AngularRate; 3], [SpecificForce; 3]) {
        let ([roll, pitch], [p, q]) = (self.angles(seconds), self.rates(seconds));
        let angular = (TAU * self.hertz).powi(2) * self.height / GRAVITY;
        // At a height h (z = −h) a roll of −ω²φ accelerates right by hφ̈ … = −hω²φ, a pitch forward
        // by −hθ̈ = hω²θ; gravity shows as pitch forward and −roll right.
        let force = [pitch * (1.0 + angular), -roll * (1.0 + angular), -1.0];
        let mut noisy =
            |value: f64, error: f64, sigma: f64| value + error + sigma * chance.gaussian();
        let rate = [0, 1, 2].map(|i| noisy([p, q, 0.0][i], self.bias[i], self.noise[0]));
        let force = [0, 1, 2].map(|i| noisy(force[i], self.offset[i], self.noise[1]));
        (
            rate.map(AngularRate::from_rad_per_s),
            force.map(|force| SpecificForce::from_m_per_s2(force * GRAVITY)),
        )
    }
}

/// Feeds an estimate from one time to another, s; the integral of what is subtracted along an axis.
fn feed(
    sway: &mut Sway,
    world: &World,
    chance: &mut Generator,
    [from, until]: [f64; 2],
    axis: [f32; 2],
) -> f64 {
    let steps = ((until - from) * HERTZ).round() as u32;
    (1..=steps)
        .map(|step| {
            let (rate, force) = world.show(from + f64::from(step) / HERTZ, chance);
            sway.push(1.0 / HERTZ as f32, rate, force);
            f64::from(sway.along(axis)) / HERTZ
        })
        .sum()
}

/// The data sheet's densities at this rate of readings, one-sided: 4 m°/s/√Hz and 90 µg/√Hz.
fn noise() -> [f64; 2] {
    [4e-3_f64.to_radians(), 90e-6].map(|density| density * (HERTZ / 2.0).sqrt())
}

fn sensors() -> CoarseSensors {
    CoarseSensors::of_densities(4.0, 90.0)
}

const FORWARD: [f32; 2] = [1.0, 0.0];
const RIGHT: [f32; 2] = [0.0, 1.0];

fn settled(world: &World, sensors: CoarseSensors, until: f64) -> (Sway, Generator) {
    let (mut sway, mut chance) = (Sway::new(sensors), Generator::new(7));
    feed(&mut sway, world, &mut chance, [0.0, until], FORWARD);
    (sway, chance)
}

#[test]
fn densities_are_those_of_data_sheets() {
    let sensors = sensors();
    // 4 m°/s/√Hz one-sided are 4/√2·60 m°/√h = 0.1697 °/√h, and that in rad/√s.
    let expected = (4e-3_f64 / SQRT_2).to_radians();
    assert!((f64::from(sensors.rate_noise) / expected - 1.0).abs() < 1e-6);
    assert!((f64::from(sensors.force_noise) / (90e-6 / SQRT_2) - 1.0).abs() < 1e-6);
    // (N²τ + a²/τ)/2 with τ = 20 s.
    let variance = 0.5 * (expected.powi(2) * 20.0 + (90e-6 / SQRT_2).powi(2) / 20.0);
    assert!((f64::from(sensors.angle_variance()) / variance - 1.0).abs() < 1e-5);
}

#[test]
fn the_mean_over_a_dwell_is_the_change_of_the_angle() {
    for hertz in [0.3, 0.5, 1.0, 2.0] {
        let amplitude = 0.3_f64.to_radians();
        let world = World { amplitude, hertz, bias: [0.05, -0.03, 0.02], ..STILL };
        for (axis, index) in [(FORWARD, 0), (RIGHT, 1)] {
            let (mut sway, mut chance) = settled(&world, sensors(), 100.0);
            for begin in [100.0, 111.3, 122.6, 133.9] {
                let found = feed(&mut sway, &world, &mut chance, [begin, begin + 10.0], axis);
                let change = world.angles(begin + 10.0)[index] - world.angles(begin)[index];
                // The draw of 1/τ: 1/(ωτ) of a sway's accelerations, none here, and the sum's own
                // half step, ω/(2·200) of it; the bias is known to a thousandth of the sway by now.
                let bound = amplitude * (0.002 + TAU * hertz / (2.0 * HERTZ) * 1.1);
                assert!((found - change).abs() < bound, "{hertz} Hz: {found} for {change}");
                feed(&mut sway, &world, &mut chance, [begin + 10.0, begin + 11.3], axis);
            }
        }
    }
}

#[test]
fn a_delay_is_made_up_for() {
    let (hertz, amplitude) = (1.0, 0.3_f64.to_radians());
    let world = World { amplitude, hertz, ..STILL };
    // Half a step beyond the sum's own half step is 5 ms ahead of the mid-point.
    let late = CoarseSensors { delay: 0.1, ..sensors() };
    let (mut sway, mut chance) = settled(&world, late, 100.0);
    let found = feed(&mut sway, &world, &mut chance, [100.0, 100.5], FORWARD);
    let shift = 0.1 - 0.5 / HERTZ + 1.0 / HERTZ;
    let change = world.angles(100.5 + shift)[0] - world.angles(100.0 + shift)[0];
    // A straight line ahead errs by half the square of ω·0.1 s.
    let bound = amplitude * 2.0 * (TAU * 0.1_f64).powi(2);
    assert!((found - change).abs() < bound, "{found} for {change}");
    let (mut sway, mut chance) = settled(&world, sensors(), 100.0);
    let without = feed(&mut sway, &world, &mut chance, [100.0, 100.5], FORWARD);
    assert!((found - change).abs() < 0.5 * (without - change).abs(), "{without}");
}

#[test]
fn biases_and_offsets_leave_nothing_in_a_mean() {
    let sway_of = World { amplitude: 0.1_f64.to_radians(), ..STILL };
    let errors = World { bias: [0.05, 0.05, -0.05], offset: [0.04, -0.04, 0.04], ..sway_of };
    let mut means = [sway_of, errors].map(|world| {
        let (mut sway, mut chance) = settled(&world, sensors(), 150.0);
        feed(&mut sway, &world, &mut chance, [150.0, 160.0], FORWARD) / 10.0
    });
    means[1] -= means[0];
    // 0.1 °/h; a gyro with that bias alone would leave 10 000 °/h.
    assert!(means[1].abs() < 0.1 * 4.85e-6, "{} rad/s", means[1]);
}

/// The variance that is stated must be the one that is found, and neighbours as they are said to be.
#[test]
fn the_noise_of_a_mean_is_that_of_the_change_of_a_gauss_markov_angle() {
    let amplitude = 0.3_f64.to_radians();
    let world = World { amplitude, hertz: 1.0, noise: noise(), ..STILL };
    let (mut sum, mut shared, mut count) = (0.0, 0.0, 0.0);
    let mut stated = SwayNoise::NONE;
    for seed in 0..12 {
        let (mut sway, mut chance) = (Sway::new(sensors()), Generator::new(seed));
        feed(&mut sway, &world, &mut chance, [0.0, 100.0], FORWARD);
        let Decision::Swaying(_, noise) = sway.decision else { panic!("it sways") };
        stated = noise;
        let mut before = None;
        for dwell in 0..20 {
            let begin = 100.0 + 10.0 * f64::from(dwell);
            // Whole periods: the sway itself changes nothing.
            let error = feed(&mut sway, &world, &mut chance, [begin, begin + 10.0], FORWARD) / 10.0;
            sum += error * error;
            shared += error * before.replace(error).unwrap_or(0.0);
            count += 1.0;
        }
    }
    let variance = stated.mean_variance(10.0);
    let ratio = sum / count / variance;
    // 240 dwells: the variance is known to √(2/240) = 9 %.
    assert!((0.72..1.28).contains(&ratio), "{ratio} of the stated variance");
    // Neighbours, of e₂ − e₁ and e₃ − e₂: −(1 − e^{−T/τ})²/2(1 − e^{−T/τ}).
    let expected = -0.5 * (1.0 - (-0.5_f64).exp());
    let correlation = shared / sum;
    assert!((correlation - expected).abs() < 0.2, "{correlation} instead of {expected}");
}

#[test]
fn what_the_lever_accelerates_enters_no_more_than_stated() {
    for (hertz, height) in [(0.5, 1.0), (1.0, 0.5), (2.0, 0.5)] {
        let amplitude = 0.2_f64.to_radians();
        let world = World { amplitude, hertz, height, ..STILL };
        let stated = CoarseSensors { lever: height as f32, ..sensors() };
        let (mut sway, mut chance) = settled(&world, stated, 150.0);
        let Decision::Swaying(_, noise) = sway.decision else { panic!("it sways") };
        let (mut sum, mut count) = (0.0, 0.0);
        for dwell in 0..20 {
            let begin = 150.0 + 11.37 * f64::from(dwell);
            let found = feed(&mut sway, &world, &mut chance, [begin, begin + 10.0], FORWARD);
            // The sum stands half a step later than its mid-points.
            let half = 0.5 / HERTZ;
            let change = world.angles(begin + 10.0 + half)[0] - world.angles(begin + half)[0];
            sum += (found - change).powi(2);
            count += 1.0;
            feed(&mut sway, &world, &mut chance, [begin + 10.0, begin + 11.37], FORWARD);
        }
        let found: f64 = sum / count;
        let residual = noise.residual_mean_variance(1.0);
        assert!(found < 1.5 * residual, "{hertz} Hz, {height} m: {found} of {residual}");
        // Without the weak draw it would be ω²r/g of the sway.
        let plain = (amplitude * (TAU * hertz).powi(2) * height / GRAVITY).powi(2);
        assert!(found < 0.02 * plain, "{found} of {plain}");
    }
}

#[test]
fn a_base_at_rest_is_left_alone_and_nothing_is_subtracted_before_it_is_decided() {
    for seed in 0..30 {
        let world = World { noise: noise(), bias: [0.05, -0.05, 0.03], ..STILL };
        let (mut sway, mut chance) = (Sway::new(sensors()), Generator::new(seed));
        let subtracted = feed(&mut sway, &world, &mut chance, [0.0, 21.9], FORWARD);
        assert_eq!((subtracted, sway.decision), (0.0, Decision::Watching));
        let subtracted = feed(&mut sway, &world, &mut chance, [21.9, 40.0], FORWARD);
        assert_eq!(subtracted, 0.0);
        assert!(matches!(sway.decision, Decision::Still(_)), "{:?}", sway.decision);
    }
}

#[test]
fn the_size_of_a_sway_is_found() {
    for (degrees, hertz) in [(0.05_f64, 2.0), (0.1, 1.0), (0.5, 0.3)] {
        let world = World { amplitude: degrees.to_radians(), hertz, noise: noise(), ..STILL };
        let (sway, _) = settled(&world, sensors(), 30.0);
        let Decision::Swaying(Size { angle, rate }, _) = sway.decision else {
            panic!("{degrees}° at {hertz} Hz: {:?}", sway.decision)
        };
        let angle = f64::from(angle).to_degrees() * SQRT_2;
        assert!((angle / degrees - 1.0).abs() < 0.15, "{angle}° of {degrees}°");
        let rate = f64::from(rate).to_degrees() * SQRT_2;
        assert!((rate / (TAU * hertz * degrees) - 1.0).abs() < 0.1, "{rate} °/s");
    }
}

#[test]
fn an_estimate_goes_on_after_a_gap() {
    let world = World { amplitude: 0.2_f64.to_radians(), hertz: 0.7, ..STILL };
    let (mut sway, mut chance) = settled(&world, sensors(), 60.0);
    let (rate, force) = world.show(63.0, &mut chance);
    sway.push(3.0, rate, force);
    feed(&mut sway, &world, &mut chance, [63.0, 90.0], FORWARD);
    let found = feed(&mut sway, &world, &mut chance, [90.0, 100.0], FORWARD);
    let half = 0.5 / HERTZ;
    let change = world.angles(100.0 + half)[0] - world.angles(90.0 + half)[0];
    assert!((found - change).abs() < 0.01 * world.amplitude, "{found} for {change}");
}

/// With τ → ∞ only the gyros count, N²/T; with τ → 0 both ends stand alone, 2σ²/T².
#[test]
fn the_variance_of_a_mean_has_its_limits() {
    let of = |correlation: f64| SwayNoise {
        angle_variance: 0.5 * correlation,
        correlation: Seconds(correlation),
        residual_variance: 0.0,
    };
    assert!((of(1e7).mean_variance(10.0) * 10.0 - 1.0).abs() < 1e-5);
    let short =
        SwayNoise { angle_variance: 3.0, correlation: Seconds(1e-3), residual_variance: 2.0 };
    assert!((short.mean_variance(10.0) - 0.1).abs() < 1e-12);
    assert_eq!(SwayNoise::NONE.mean_variance(10.0), 0.0);
}

proptest! {
    /// Whatever comes, the estimate stays finite and what it subtracts is bounded by what came in.
    #[test]
    fn nothing_makes_the_estimate_run_away(
        readings in prop::collection::vec(
            (prop::array::uniform3(any::<i32>()), prop::array::uniform3(-40_000_000..40_000_000_i32)),
            1..400,
        ),
        seconds in 0.0..0.1_f32,
    ) {
        let mut sway = Sway::new(sensors());
        for (rate, force) in readings {
            sway.push(seconds, rate.map(AngularRate), force.map(SpecificForce));
            prop_assert!(sway.along([0.6, 0.8]).is_finite());
        }
    }
}
