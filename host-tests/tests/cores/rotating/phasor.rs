//! Sums of integer products give the coefficients of a plain least-squares fit in f64.

use hal_mock::noise::Generator;
use orientation::alignment::rotating::turn_accumulator::{Mode, TurnAccumulator};
use orientation::math::regression::Column;
use orientation::signal::Sample;
use orientation::signal::phasor::{
    Block, Blocks, COLUMNS, Products, QUICKENING, RATE, Sums, TURNING,
};
use orientation::units::{Angle, AngularRate, Instant};

/// A made-up platform: angle w t + (δ/ν)(1 − cos νt), and a gyro of known coefficients.
#[derive(Clone, Copy)]
struct Made {
    rate_hz: f64,
    /// Mean rate of the platform, rad/s.
    speed: f64,
    /// Its modulation δ, rad/s, and the frequency ν, rad/s.
    modulation: f64,
    frequency: f64,
    /// Constant, cosine, sine, slope, part of the rate, part of its derivative.
    coefficients: [f64; COLUMNS],
    /// White noise of a sample, rad/s.
    noise: f64,
    /// Of how many samples one is missing; zero for none.
    missing: u64,
}

impl Made {
    fn at(&self, time: f64) -> (f64, [f64; COLUMNS]) {
        let (sine, cosine) = (self.frequency * time).sin_cos();
        let angle = self.speed * time + self.modulation / self.frequency * (1.0 - cosine);
        let turning = self.modulation * sine;
        let quickening = self.modulation * self.frequency * cosine;
        (angle, [1.0, angle.cos(), angle.sin(), time, turning, quickening])
    }

    /// Columns and gyro's rate, sample by sample, over some turns.
    fn rows(&self, turns: f64) -> Vec<(f64, [f64; COLUMNS], f64)> {
        let mut generator = Generator::new(5);
        let count = (turns * std::f64::consts::TAU / self.speed.abs() * self.rate_hz) as u64;
        let kept = |number: &u64| self.missing == 0 || number % self.missing != self.missing / 2;
        let row = |number: u64| {
            let time = number as f64 / self.rate_hz;
            let (_, columns) = self.at(time);
            let shown: f64 = columns.iter().zip(self.coefficients).map(|(x, c)| x * c).sum();
            (time, columns, shown + self.noise * generator.gaussian())
        };
        (0..=count).filter(kept).map(row).collect()
    }

    /// Products of these samples through blocks of so many periods.
    fn sums(&self, rows: &[(f64, [f64; COLUMNS], f64)], periods: u32) -> (Sums, Block) {
        let mut blocks = Blocks::of(periods);
        let samples = rows.iter().map(|(time, _, rate)| Sample {
            time: Instant::from_seconds(*time),
            stage: Angle::from_rad(self.at(*time).0),
            rate: AngularRate::from_rad_per_s(*rate),
            ..Sample::default()
        });
        let blocks: Vec<Block> = samples.filter_map(|sample| blocks.push(&sample, None)).collect();
        let reference = blocks[1];
        let mut sums = Sums::default();
        for some in blocks.windows(3).collect::<Vec<_>>().chunks(500) {
            let mut products = Products::default();
            for three in some {
                let [before, block, next] = [&three[0], &three[1], &three[2]];
                let seconds = block.seconds + 0.5 * (before.seconds + next.seconds);
                products.push(block, (next.turning - before.turning) / seconds, &reference);
            }
            assert!(!products.is_clamped);
            sums.absorb(&products);
        }
        (sums, reference)
    }
}

/// Plain least squares by the normal equations, columns scaled to their sizes.
fn fit(rows: &[(f64, [f64; COLUMNS], f64)]) -> [f64; COLUMNS] {
    let size = |i: usize| rows.iter().map(|row| row.1[i] * row.1[i]).sum::<f64>().sqrt();
    let sizes: [f64; COLUMNS] = std::array::from_fn(size);
    let (mut matrix, mut right) = ([[0.0; COLUMNS]; COLUMNS], [0.0; COLUMNS]);
    for (_, columns, value) in rows {
        for i in 0..COLUMNS {
            for j in 0..COLUMNS {
                matrix[i][j] += columns[i] / sizes[i] * columns[j] / sizes[j];
            }
            right[i] += columns[i] / sizes[i] * value;
        }
    }
    for i in 0..COLUMNS {
        for below in i + 1..COLUMNS {
            let factor = matrix[below][i] / matrix[i][i];
            (i..COLUMNS).for_each(|j| matrix[below][j] -= factor * matrix[i][j]);
            right[below] -= factor * right[i];
        }
    }
    for i in (0..COLUMNS).rev() {
        let known: f64 = (i + 1..COLUMNS).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    std::array::from_fn(|i| right[i] / sizes[i])
}

const COEFFICIENTS: [f64; COLUMNS] = [3e-5, 4e-5, -2.5e-5, 1e-9, 0.012, -3e-4];

fn made(rate_hz: f64, speed: f64) -> Made {
    let (modulation, frequency) = (0.2 * speed, 0.83 * speed.abs());
    let coefficients = COEFFICIENTS;
    Made { rate_hz, speed, modulation, frequency, coefficients, noise: 0.0, missing: 0 }
}

fn found(made: &Made, turns: f64, periods: u32) -> ([f64; COLUMNS], [f64; COLUMNS]) {
    let rows = made.rows(turns);
    let (sums, _) = made.sums(&rows, periods);
    let model = [Column::Free; COLUMNS];
    let found = sums.regression(RATE).solve(&model).expect("its rate is modulated").coefficients;
    (found, fit(&rows))
}

#[test]
fn the_coefficients_are_those_that_were_made_at_any_rate_speed_and_sense() {
    for (rate_hz, block_s) in [(50.0, 0.02), (50.0, 0.1), (400.0, 0.02), (2400.0, 0.02)] {
        for speed in [0.02, 0.2, 1.0, 4.0] {
            if rate_hz > 1000.0 && speed < 0.1 {
                continue;
            }
            for speed in [speed, -speed] {
                let made = made(rate_hz, speed);
                let (found, plain) = found(&made, 7.0, (block_s * rate_hz) as u32);
                // What the platform turns in a block costs (w T)²/12 of the signal.
                let turned = speed * block_s;
                let block = turned * turned / 12.0;
                for index in [1, 2, TURNING] {
                    let (found, plain) = (found[index], plain[index]);
                    let exact = COEFFICIENTS[index];
                    let allowed = 2e-4 * exact.abs() + block * exact.abs().max(4.8e-5);
                    assert!((plain - exact).abs() < 1e-6 * exact.abs(), "{plain} {exact}");
                    let off = (found - exact).abs();
                    assert!(off <= allowed, "{index}: {found} for {exact} at {rate_hz} {speed}");
                }
                let off = (found[QUICKENING] - COEFFICIENTS[QUICKENING]).abs();
                assert!(
                    off * speed.abs() < 1e-3 * 0.012 + block * 0.012,
                    "{off} at {rate_hz} {speed}"
                );
            }
        }
    }
}

#[test]
fn noise_moves_the_coefficients_as_it_moves_a_plain_fit() {
    for speed in [0.3, -1.0] {
        for periods in [1, 8] {
            let made = Made { noise: 1e-6, ..made(400.0, speed) };
            let (found, plain) = found(&made, 7.0, periods);
            let samples = 7.0 * std::f64::consts::TAU / speed.abs() * 400.0;
            let sigma = 1e-6 * (2.0 / samples).sqrt();
            for index in [1, 2] {
                let apart = found[index] - plain[index];
                assert!(apart.abs() < 0.15 * sigma, "{apart} at σ {sigma}, {speed}, {periods}");
            }
        }
    }
}

#[test]
fn missing_samples_cost_next_to_nothing() {
    for missing in [11, 50, 3] {
        for speed in [0.5, -2.0] {
            let made = Made { missing, modulation: 0.002 * speed, ..made(400.0, speed) };
            let (found, _) = found(&made, 6.0, 8);
            for index in [1, 2] {
                let off = (found[index] - COEFFICIENTS[index]).abs();
                assert!(off < 1e-3 * 5e-5, "{off}: {missing} {speed}");
            }
        }
    }
}

#[test]
fn the_products_hold_four_thousand_blocks_of_the_greatest_values() {
    let mut blocks = Blocks::of(1);
    let mut all = Vec::new();
    for number in 0..4100_u64 {
        // 3000 s later, from one limit of the range to the other.
        let rate = AngularRate(if number % 2 == 0 { i32::MAX } else { i32::MIN });
        let sample = Sample {
            time: Instant(number * 20_000 + if number > 3 { 3_000_000_000 } else { 0 }),
            stage: Angle((number as u32).wrapping_mul(54_687_000)),
            rate: if number % 7 < 3 { rate } else { AngularRate(0) },
            ..Sample::default()
        };
        all.extend(blocks.push(&sample, Some(if number % 2 == 0 { 4.0 } else { -4.0 })));
    }
    let mut reference = all[0];
    reference.turning = 4.0;
    let mut products = Products::default();
    // Overflow panics in this profile.
    all.iter().take(4096).for_each(|block| products.push(block, 10.0, &reference));
    assert!(products.is_clamped);
    let mut sums = Sums::default();
    sums.absorb(&products);
    assert_eq!(sums.rows, 4096);
    assert!((sums.product(QUICKENING, QUICKENING) - 409_600.0).abs() < 1e-6);
}

#[test]
fn angles_taken_for_rates_are_no_overflow() {
    let mut turn_accumulator = TurnAccumulator::new(1, Mode::Recorded);
    for number in 0..20_000_u64 {
        let angle = 0.02 * number as f64;
        let sample = Sample {
            time: Instant(number * 20_000),
            stage: Angle::from_rad(0.86 + 1e-4 * angle.sin()),
            rate: AngularRate::from_rad_per_s(0.01),
            ..Sample::default()
        };
        // Overflow panics in this profile.
        turn_accumulator.push(&sample, Some(angle as f32));
    }
    assert!(turn_accumulator.stretches.is_empty());
}
