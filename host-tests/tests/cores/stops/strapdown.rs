//! The strapdown against arithmetic in double precision and closed forms.

use orientation::math::quaternion::Attitude;
use orientation::math::rotation::{
    Matrix, Vector, cross, length, product, small, transposed, turned,
};
use orientation::signal::InertialSample;
use orientation::signal::strapdown::Strapdown;
use orientation::units::{AngleIncrement, Instant, SpecificForce};
use std::f64::consts::TAU;

use super::assert_near;

/// Turns increments about three axes, rad, into samples that lose nothing.
struct Sampler {
    period_us: u64,
    count: u64,
    carried: [f64; 3],
}

impl Sampler {
    fn every(period_us: u64) -> Self {
        Self { period_us, count: 0, carried: [0.0; 3] }
    }

    fn sample(&mut self, turned: Vector) -> InertialSample {
        self.count += 1;
        InertialSample {
            time: Instant(self.count * self.period_us),
            turned: std::array::from_fn(|axis| {
                AngleIncrement::from_rad(turned[axis], &mut self.carried[axis])
            }),
            force: None,
        }
    }
}

/// Angle between two attitudes, rad.
fn between(a: &Matrix, b: &Matrix) -> f64 {
    length(&small(&product(a, &transposed(b))))
}

/// The attitude after the samples so far.
fn attitude(strapdown: &Strapdown, now: Instant) -> Matrix {
    let mut strapdown = strapdown.clone();
    strapdown.update(now);
    strapdown.carried.attitude.matrix()
}

/// The reference: a quaternion of our own turned by a rotation vector at every sample.
#[derive(Clone, Copy)]
struct Reference {
    quaternion: [f64; 4],
    before: Vector,
    /// Weight of the change of the axis from sample to sample.
    coning: f64,
}

impl Reference {
    fn with_coning(coning: f64) -> Self {
        Self { quaternion: [1.0, 0.0, 0.0, 0.0], before: [0.0; 3], coning }
    }

    fn push(&mut self, turned: Vector) {
        let order = cross(&self.before, &turned);
        self.before = turned;
        let [x, y, z]: Vector = std::array::from_fn(|i| turned[i] + self.coning * order[i]);
        let angle = (x * x + y * y + z * z).sqrt();
        let factor = if angle < 1e-12 { 0.5 } else { (0.5 * angle).sin() / angle };
        let [w, [x, y, z]] = [[(0.5 * angle).cos(); 3], [x * factor, y * factor, z * factor]];
        let [a, b, c, d] = self.quaternion;
        let w = w[0];
        let q = [
            a * w - b * x - c * y - d * z,
            a * x + b * w + c * z - d * y,
            a * y - b * z + c * w + d * x,
            a * z + b * y - c * x + d * w,
        ];
        let norm = q.iter().map(|part| part * part).sum::<f64>().sqrt();
        self.quaternion = q.map(|part| part / norm);
    }

    fn matrix(&self) -> Matrix {
        let [w, x, y, z] = self.quaternion;
        [
            [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
        ]
    }
}

/// Integral of a vehicle's rates, rad: it sways, shakes, and turns by a third of a turn a minute.
fn vehicle(seconds: f64) -> Vector {
    let wave = |amplitude: f64, hertz: f64, phase: f64| {
        amplitude * ((TAU * hertz * seconds + phase).sin() - phase.sin())
    };
    [
        wave(0.03, 0.9, 0.3) + wave(0.001, 17.0, 1.0) + 0.0002 * seconds,
        wave(0.02, 1.4, 2.0) + wave(0.0007, 23.0, 0.2) - 0.0001 * seconds,
        wave(0.5, 0.02, 0.0) + wave(0.0003, 31.0, 0.5) + TAU / 180.0 * seconds,
    ]
}

/// The scheme of the strapdown, in double precision throughout: increments and what their order adds summed
/// over 20 ms, or until an axis turned by 0.02 rad, then one rotation.
struct TwoRates {
    reference: Reference,
    sum: Vector,
    order: Vector,
    before: Vector,
    count: u32,
}

impl TwoRates {
    fn new() -> Self {
        let [sum, order, before] = [[0.0; 3]; 3];
        Self { reference: Reference::with_coning(0.0), sum, order, before, count: 0 }
    }

    fn push(&mut self, turned: Vector) {
        let arm = std::array::from_fn(|axis| 0.5 * self.sum[axis] + self.before[axis] / 12.0);
        let order = cross(&arm, &turned);
        for axis in 0..3 {
            self.order[axis] += order[axis];
            self.sum[axis] += turned[axis];
        }
        self.before = turned;
        self.count += 1;
        if self.count == 40 || self.sum.iter().any(|sum| sum.abs() > 0.02) {
            self.reference.push(std::array::from_fn(|axis| self.sum[axis] + self.order[axis]));
            (self.sum, self.order, self.count) = ([0.0; 3], [0.0; 3], 0);
        }
    }
}

#[test]
fn an_hour_at_two_kilohertz_loses_less_than_a_ten_thousandth_degree_to_arithmetic() {
    let mut sampler = Sampler::every(500);
    let mut strapdown = Strapdown::since(Instant(0));
    let mut each = Reference::with_coning(1.0 / 12.0);
    let mut same = TwoRates::new();
    let mut before = vehicle(0.0);
    let (mut arithmetic, mut whole): (f64, f64) = (0.0, 0.0);
    for count in 1..=7_200_000_u32 {
        let now = vehicle(f64::from(count) * 5e-4);
        let sample = sampler.sample(std::array::from_fn(|axis| now[axis] - before[axis]));
        before = now;
        strapdown.push(&sample);
        let turned = sample.turned.map(AngleIncrement::rad);
        each.push(turned);
        same.push(turned);
        if count % 2_000 == 0 {
            strapdown.take();
            let shown = attitude(&strapdown, sample.time);
            arithmetic = arithmetic.max(between(&shown, &same.reference.matrix()).to_degrees());
            whole = whole.max(between(&shown, &each.matrix()).to_degrees());
        }
    }
    println!("one hour at 2 kHz: {arithmetic:.2e}° from arithmetic, {whole:.2e}° with two rates");
    assert!(arithmetic < 1e-4, "{arithmetic}°");
    // What two rates leave out of this motion, of third order.
    assert!(whole < 1.5e-3, "{whole}°");
}

/// The axis of a cone of this half angle, rad, so many times a second: rates in closed form (P. G. Savage
/// 1998, or any book), here integrated over samples. The attitude comes back with every turn.
fn cone(half: f64, hertz: f64, seconds: f64) -> Vector {
    let angle = TAU * hertz * seconds;
    [half.sin() * angle.cos(), half.sin() * angle.sin(), -(1.0 - half.cos()) * angle]
}

#[test]
fn coning_drifts_as_theory_says_without_the_correction_and_a_hundredth_of_that_with_it() {
    let (half, hertz, period, seconds) = (1f64.to_radians(), 20.0, 5e-4, 60.0);
    let mut sampler = Sampler::every(500);
    let mut strapdown = Strapdown::since(Instant(0));
    let mut without = Reference::with_coning(0.0);
    let mut before = cone(half, hertz, 0.0);
    let mut last = Instant(0);
    for count in 1..=120_000_u32 {
        let now = cone(half, hertz, f64::from(count) * period);
        let sample = sampler.sample(std::array::from_fn(|axis| now[axis] - before[axis]));
        before = now;
        last = sample.time;
        strapdown.push(&sample);
        without.push(sample.turned.map(AngleIncrement::rad));
        if count % 2_000 == 0 {
            strapdown.take();
        }
    }
    // Of the cone's own turn about z, a sample's rotation vector misses (1 − sin Ωh / Ωh).
    let step = TAU * hertz * period;
    let drift = 0.5 * half.sin().powi(2) * TAU * hertz * (1.0 - step.sin() / step);
    let identity = Attitude::default().matrix();
    let [with, without] = [attitude(&strapdown, last), without.matrix()]
        .map(|attitude| between(&attitude, &identity) / seconds);
    println!("coning: {drift:.3e} rad/s in theory, {without:.3e} without, {with:.3e} with");
    assert_near(without, drift, 0.01 * drift);
    assert!(with < 0.01 * drift, "{with} of {drift} rad/s");
}

#[test]
fn one_large_rotation_is_a_rotation_vector() {
    let mut strapdown = Strapdown::since(Instant(0));
    strapdown.push(&Sampler::every(10_000).sample([0.3, -1.1, 0.7]));
    // scipy 1.17.1: Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix().
    let expected = [
        [0.269_463_503_028_091_63, -0.650_890_186_163_428_1, -0.709_740_365_268_855],
        [0.367_270_134_397_863_6, 0.750_758_136_327_231_3, -0.549_067_271_942_006_7],
        [0.890_225_852_756_032_3, -0.112_712_848_844_310_26, 0.441_354_443_492_07],
    ];
    let error = between(&strapdown.carried.attitude.matrix(), &expected);
    assert!(error < 1.5e-7, "{error} rad");
}

#[test]
fn a_turn_about_a_fixed_axis_ends_where_its_sum_says() {
    let axis = [0.36, -0.48, 0.8];
    let mut sampler = Sampler::every(500);
    let mut strapdown = Strapdown::since(Instant(0));
    let rate = 0.5;
    for count in 0..2_000_000 {
        let sample = sampler.sample(axis.map(|part| part * rate * 5e-4));
        strapdown.push(&sample);
        if count % 2_000 == 0 {
            strapdown.take();
        }
    }
    let shown = attitude(&strapdown, Instant(1_000_000_000));
    let mut expected = Reference::with_coning(0.0);
    expected.push(axis.map(|part| part * rate * 1000.0));
    let error = between(&shown, &expected.matrix());
    println!("80 turns about a fixed axis: {error:.2e} rad");
    // Half of a step of 2⁻³⁵ rad in each of 50 000 updates, on three axes; of 500 rad that is 2e-9.
    assert!(error < 50_000.0 * 3f64.sqrt() / 2f64.powi(36), "{error} rad");
}

/// Two minutes of driving at 100 Hz with errors of the gyros.
fn driven(bias: Vector, scale: Vector) -> Strapdown {
    let mut sampler = Sampler::every(10_000);
    let mut strapdown = Strapdown::since(Instant(0));
    let mut before = vehicle(0.0);
    for count in 1..=12_000_u32 {
        let now = vehicle(f64::from(count) * 0.01);
        let turned = std::array::from_fn(|axis| {
            (now[axis] - before[axis]) * (1.0 + scale[axis]) + bias[axis] * 0.01
        });
        before = now;
        strapdown.push(&sampler.sample(turned));
        if count % 100 == 0 {
            strapdown.take();
        }
    }
    strapdown
}

/// How an error turns the start frame: finite difference.
fn shift(strapdown: &Strapdown, error: f64) -> Vector {
    let [plain, with] = [&driven([0.0; 3], [0.0; 3]), strapdown]
        .map(|strapdown| strapdown.carried.attitude.matrix());
    small(&product(&with, &transposed(&plain))).map(|angle| angle / error)
}

#[test]
fn sensitivities_are_those_of_finite_differences() {
    let plain = driven([0.0; 3], [0.0; 3]);
    let unit = |axis: usize, error: f64| {
        let mut errors = [0.0; 3];
        errors[axis] = error;
        errors
    };
    for axis in 0..3 {
        let by_bias = shift(&driven(unit(axis, 2e-5), [0.0; 3]), 2e-5);
        let by_scale = shift(&driven([0.0; 3], unit(axis, 1e-4)), 1e-4);
        for row in 0..3 {
            // 120 s of bias, four radians of scale.
            assert_near(f64::from(plain.carried.bias[row][axis]), by_bias[row], 0.12);
            assert_near(f64::from(plain.carried.scale[row][axis]), by_scale[row], 0.004);
        }
    }
}

#[test]
fn forces_are_summed_on_the_axes_of_the_start() {
    let force = [1.0, -2.0, -9.5];
    let mut sampler = Sampler::every(10_000);
    let mut strapdown = Strapdown::since(Instant(0));
    let mut reference = Reference::with_coning(0.0);
    let mut before = vehicle(0.0);
    for count in 1..=6_000_u32 {
        let now = vehicle(f64::from(count) * 0.01);
        let turned_by: Vector = std::array::from_fn(|axis| now[axis] - before[axis]);
        before = now;
        // The mean over a sample: that of its middle.
        reference.push(turned_by.map(|angle| 0.5 * angle));
        let felt = turned(&transposed(&reference.matrix()), &force);
        reference.push(turned_by.map(|angle| 0.5 * angle));
        let force = Some(felt.map(SpecificForce::from_m_per_s2));
        strapdown.push(&InertialSample { force, ..sampler.sample(turned_by) });
    }
    let sums = strapdown.take();
    assert_eq!(sums.count, 6_000);
    assert!(!sums.is_blown);
    for (sum, force) in sums.start_force.iter().zip(force) {
        assert_near(f64::from(*sum) / 6_000.0, force, 2e-3);
    }
    assert_eq!(strapdown.take().count, 0);
}

#[test]
fn a_blow_is_reported_with_the_forces_it_spoils() {
    let mut strapdown = Strapdown::since(Instant(0));
    let mut sampler = Sampler::every(10_000);
    strapdown.push(&sampler.sample([0.0, 0.15, 0.0]));
    assert!(strapdown.take().is_blown);
    assert!(!strapdown.take().is_blown);
}
