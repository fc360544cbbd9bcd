//! Runs the filter along a path, again and again until the start frame stands still.

use super::Setting;
use super::block::Block;
use super::filter::{
    BIAS, Filter, LATITUDE, Measurement, NOW, PLACE, START, STATES, VELOCITY, force_row, rest_row,
    velocity_row,
};
use super::path::Path;
use super::place::{Place, up};
use super::stop::Stop;
use crate::earth::EARTH_RATE;
use crate::math::chi_square_tail;
use crate::math::rotation::{
    Matrix, Vector, by, cross, difference, dot, length, product, scaled, small, sum, transposed,
    turned,
};
use crate::signal::strapdown::{Carried, Rough};

/// 1σ of the level that the first stop gives the start frame, rad; far above what it is.
const LEVEL_SIGMA: f64 = 0.1;
/// 1σ of its azimuth, rad: unknown.
const AZIMUTH_SIGMA: f64 = 3.0;
/// Repetitions, and the correction below which no further one is needed, rad: half of its square is not
/// seen, 1e-5°.
const REPETITIONS: u32 = 16;
const SETTLED: f64 = 5e-4;
/// Scatter over the believed one that is too much, and the most that is taken for a sway.
const ROUGH: f64 = 1.5;
const ROUGHEST: f64 = 6.0;
/// Correlation of neighbouring blocks from which on they are believed less, in its 1σ of white blocks.
const COLOURED: f64 = 3.0;
/// Probability of biases as great as those found below which what was known of them is not believed.
const FALSE_BIAS: f64 = 0.05;
/// How much greater than believed, in power, biases still are once they are believed as great as they are.
const BELIEVED: f64 = 1.1;
/// 1σ of biases, rad/s, beyond which and beyond so many times what was known they are none: a fifth of the Earth
/// rate is what a wrong latitude or axis makes.
const GREATEST_BIAS: f64 = 0.2 * EARTH_RATE;
const GREATEST_WIDENING: f64 = 3.0;
/// Least part of the biases' variance that must be observed before they are judged.
const LEAST_SEEN: f64 = 0.1;
/// Longest time in which a vehicle at rest is turned by hand, s: a rate that is there all the time is a bias.
const TURNED_BY_HAND: f64 = 5.0;
/// Fewest degrees of freedom of which a correlation means something.
const LEAST_DEGREES: f64 = 20.0;
/// Chi-square beyond which a block, or the rest of a stop, is left out: one healthy block in three million.
const OUTLIER: f64 = 30.0;
/// Least variance of what a vehicle sways, rad²: 20 milliarcseconds.
const LEAST_SWAY: f64 = 1e-14;
/// How much slower than a second a sway may be: the power of its angle over that of its change in a second.
const SLOW_SWAY: f64 = 4.0;
/// Least angle random walk that is believed, rad/√s: 1e-5 °/√h.
const LEAST_WALK: f64 = 2.9e-9;
/// 1σ of what driving adds to an accelerometer's bias, m/s²: its scale and its axes under vibration, 0.1 mg.
const DRIVING: f64 = 1e-3;
/// How far a vehicle is from the straight way in the mean, of what it could have driven.
const DETOUR: f64 = 0.1;
/// Time after a stop that may still be one, s: what the criteria hold back.
const REMAINDER: f64 = 4.0;
/// Part of a drive that its blocks may miss.
const COVERED: f64 = 0.002;
/// Step by which the latitude's effect is found, rad.
const LATITUDE_STEP: f64 = 1e-3;

/// A matrix of nothing.
const NOTHING: Matrix = [[0.0; 3]; 3];

/// What is believed of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Belief {
    /// What it shows.
    Shown,
    /// That nothing sways, all is quiet, nothing is left out: the limit of any estimator, and where to begin.
    Ideal,
}

/// The filter at the end of the path.
#[derive(Clone, Debug)]
pub struct Solution {
    /// States; of φ what is left when [`Self::frame`] is taken for the start frame.
    pub filter: Filter,
    /// From north, east, down at the start, frozen, to the start frame.
    pub frame: Matrix,
    /// Sum of squares of what blocks showed beyond the expected, over their variances, of so many degrees
    /// of freedom.
    pub chi_square: f64,
    /// Those degrees.
    pub degrees: f64,
    /// Blocks left out.
    pub left_out: u32,
    /// Stops at which the vehicle turned, whose rest rates are left out.
    pub turning: u32,
    /// Greatest rate at which it turned there beside the Earth, rad/s.
    pub turning_rate: f64,
    /// Drives that did not come to rest at their end, whose velocity is left out.
    pub unsteady: u32,
    /// Sums of what blocks showed beyond the expected, times the same of the block before, and squared.
    pub neighbours: [f64; 2],
    /// How much more than their neighbours say the blocks scatter: power over power, one or more.
    pub roughness: f64,
    /// The same of blocks that go together with their neighbours; one until that is known.
    pub colour: f64,
    /// How much greater than is known the biases are taken to be; one or more.
    pub widening: f64,
    /// Greatest rate beside the Earth's that was there all through a stop whose rest was left out, rad/s.
    pub steady: f64,
}

/// What has been carried until a moment.
#[derive(Clone, Copy, Debug, Default)]
struct Moment {
    at: f64,
    bias: Rough,
    scale: Rough,
}

impl Moment {
    fn of(at: f64, carried: &Carried) -> Self {
        Self { at, bias: carried.bias, scale: carried.scale }
    }
}

/// A run along the path with one start frame.
struct Run<'a> {
    setting: &'a Setting,
    path: &'a Path<'a>,
    /// Power of the forces' noise, (m/s²)²·s.
    density: f64,
    /// The place, a little farther north, where the latitude is not exact.
    north: Option<Place>,
    belief: Belief,
    last: Moment,
    /// What the block before showed beyond the expected, m/s².
    before: [f64; 2],
}

impl Solution {
    /// Of nothing, with a start frame that is nearly right.
    #[must_use]
    pub const fn new(frame: Matrix) -> Self {
        Self {
            filter: Filter::EMPTY,
            frame,
            chi_square: 0.0,
            degrees: 0.0,
            left_out: 0,
            turning: 0,
            turning_rate: 0.0,
            unsteady: 0,
            neighbours: [0.0; 2],
            roughness: 1.0,
            colour: 1.0,
            widening: 1.0,
            steady: 0.0,
        }
    }

    /// Runs along the path until the start frame stands still; the first run must have been made.
    pub fn settle(&mut self, setting: &Setting, path: &Path) {
        for _ in 0..REPETITIONS {
            self.frame = product(&by(&self.filter.three(START)), &self.frame);
            self.run(setting, path, Belief::Shown);
            let is_settled = length(&self.filter.three(START)) < SETTLED;
            if is_settled && !self.widen(setting) && !self.roughen() {
                break;
            }
        }
    }

    /// Correlation of what neighbouring blocks showed beyond the expected.
    #[must_use]
    pub fn correlation(&self) -> f64 {
        let [products, squares] = self.neighbours;
        if self.degrees < LEAST_DEGREES { 0.0 } else { products / squares }
    }

    /// Whether the biases are greater than was known of them by more than chance, which is then not believed:
    /// their 1σ is what they show where they do. What they are along east no rest shows.
    fn widen(&mut self, setting: &Setting) -> bool {
        let sigma = self.widening * setting.bias_sigma();
        let before = sigma * sigma;
        let left =
            |axis: usize| (self.filter.covariance[BIAS + axis][BIAS + axis] / before).min(1.0);
        let seen = 3.0 - left(0) - left(1) - left(2);
        let found = self.filter.three(BIAS);
        let power = dot(&found, &found) / before;
        let ratio = if seen < LEAST_SEEN { 0.0 } else { power / seen };
        let ratio = ratio.max(self.steady * self.steady / (3.0 * before));
        let degrees = libm::round(seen).max(1.0);
        let is_chance = if self.widening > 1.0 {
            ratio < BELIEVED
        } else {
            chi_square_tail(ratio * degrees, degrees) > FALSE_BIAS
        };
        let wider = libm::sqrt(ratio);
        let greatest = GREATEST_BIAS.max(GREATEST_WIDENING * setting.bias_sigma());
        if is_chance || wider * sigma > greatest {
            return false;
        }
        self.widening *= wider;
        (self.roughness, self.colour) = (1.0, 1.0);
        true
    }

    /// Whether the blocks scatter more than was believed, by which they are then believed less: a sway that
    /// is slower than two of them does not show in neighbours, and what goes together means less.
    fn roughen(&mut self) -> bool {
        let correlation = self.correlation();
        let is_coloured = correlation * libm::sqrt(self.degrees) > COLOURED;
        if is_coloured && self.colour <= 1.0 {
            // The mean of values that go together from one to the next scatters by so much more.
            self.colour = (1.0 + correlation) / (1.0 - correlation);
            return true;
        }
        let ratio = self.chi_square / self.degrees.max(1.0);
        let is_rough = ratio > ROUGH && self.roughness * ratio < ROUGHEST;
        if is_rough {
            self.roughness *= ratio;
        }
        is_rough
    }

    /// One run along the path.
    #[inline(never)]
    pub fn run(&mut self, setting: &Setting, path: &Path, belief: Belief) {
        let common = &setting.common;
        (self.chi_square, self.degrees) = (0.0, 0.0);
        (self.left_out, self.turning, self.unsteady) = (0, 0, 0);
        (self.turning_rate, self.steady) = (0.0, 0.0);
        self.neighbours = [0.0; 2];
        self.filter.begin(
            &start_covariance(&self.frame),
            self.widening * setting.bias_sigma(),
            common.scale_sigma,
            common.accelerometer_bias_sigma,
            common.latitude_sigma,
        );
        let is_exact = common.latitude_sigma <= 0.0;
        let is_ideal = belief == Belief::Ideal;
        let mut run = Run {
            setting,
            path,
            density: if is_ideal {
                path.least_density()
            } else {
                self.roughness * self.colour * path.density()
            },
            north: (!is_exact).then(|| Place::moved(common.latitude, LATITUDE_STEP)),
            belief,
            last: Moment { at: path.start, ..Moment::default() },
            before: [0.0; 2],
        };
        for index in 0..path.stops.len() {
            run.stop(self, index);
        }
        // Where a vehicle has driven since its last stop is not known.
        let driven = path.stops.last().map_or(0.0, |stop| path.now - stop.to - REMAINDER);
        self.filter.add_process_noise(setting.speed_sigma * driven.max(0.0));
        run.carry(self, Moment::of(path.now, &path.carried));
    }
}

impl Run<'_> {
    fn stop(&mut self, solution: &mut Solution, index: usize) {
        let stop = &self.path.stops[index];
        if index > 0 {
            let driven = (stop.from - self.last.at).max(0.0);
            self.drive(solution, index, driven);
            let (known, unknown) = (self.setting.displacement_sigma, self.setting.speed_sigma);
            match stop.displacement {
                Some(_) => solution.filter.reset(PLACE..PLACE + 2, known),
                None => solution.filter.add_process_noise(unknown * driven),
            }
        }
        self.carry(solution, Moment::of(stop.from, &stop.begin));
        solution.filter.anchor();
        self.before = [0.0; 2];
        for block in self.path.blocks.of(index) {
            let scale = stop.begin.scale;
            self.carry(solution, Moment { at: block.middle, bias: block.bias, scale });
            self.block(solution, block, self.path.displaced(index));
        }
        self.carry(solution, Moment::of(stop.to, &stop.end));
        self.rest(solution, stop);
    }

    /// Carries the filter on to a moment.
    fn carry(&mut self, solution: &mut Solution, to: Moment) {
        let seconds = (to.at - self.last.at).max(0.0);
        let noise = &self.setting.common.noise;
        let walk = noise.angle_random_walk.max(LEAST_WALK);
        let bias = gained(&to.bias, &self.last.bias);
        let has_scale = self.setting.common.scale_sigma > 0.0;
        let scale = if has_scale { gained(&to.scale, &self.last.scale) } else { NOTHING };
        solution.filter.carry(&bias, &scale, walk * walk * seconds);
        solution.filter.walk(self.bias_walk() * seconds);
        self.last = to;
    }

    /// Power of the biases' walk, (rad/s)²/s. A ramp is taken for the walk that has its Allan variance over
    /// the whole time, flicker for that which has it over a stop of mean length, whose rates are set against
    /// the drives.
    fn bias_walk(&self) -> f64 {
        let whole = (self.path.now - self.path.start).max(1.0);
        let stood: f64 = self.path.stops.iter().map(Stop::seconds).sum();
        let part = (stood / self.path.stops.len() as f64).max(1.0);
        let [_, _, b, k, r] = self.setting.common.noise.coefficients();
        k * k
            + 6.0 * core::f64::consts::LN_2 / core::f64::consts::PI * b * b / part
            + 1.5 * r * r * whole
    }

    /// Takes it that a drive to a stop, of so many seconds, ends at rest as it began: what its forces sum up
    /// to beyond gravity is the work of φ.
    fn drive(&mut self, solution: &mut Solution, index: usize, driven: f64) {
        let path = self.path;
        solution.filter.reset(VELOCITY..VELOCITY + 3, 0.0);
        let (mut gained, mut seconds) = ([0.0; 3], 0.0);
        for block in path.drives.of(index - 1) {
            self.carry(
                solution,
                Moment { at: block.middle, bias: block.bias, scale: self.last.scale },
            );
            let displaced = path.underway(index - 1, block.middle);
            let above = up(&path.place.navigation(block.middle - path.start, displaced));
            let predicted = scaled(&turned(&solution.frame, &above), path.gravity);
            let length = f64::from(block.seconds);
            let rows: [_; 3] = core::array::from_fn(|axis| {
                velocity_row(&predicted, axis, &block.attitude, length)
            });
            solution.filter.add(VELOCITY, &rows);
            let beyond = difference(&block.force.map(f64::from), &predicted);
            gained = sum(&gained, &scaled(&beyond, length));
            seconds += length;
        }
        self.carry(solution, Moment::of(path.stops[index].from, &path.stops[index].begin));
        if (seconds - driven).abs() <= COVERED * driven {
            self.come_to_rest(solution, index, &gained, driven);
        }
    }

    /// Takes the velocity that a drive seems to have gained.
    fn come_to_rest(&self, solution: &mut Solution, index: usize, gained: &Vector, driven: f64) {
        let path = self.path;
        let middle = path.stops[index].from - 0.5 * driven - path.start;
        let navigation =
            path.place.navigation(middle, path.underway(index - 1, middle + path.start));
        let along = transposed(&navigation);
        let [from, to] = [path.displaced(index - 1), path.displaced(index)];
        let way = sum(&scaled(&along[0], to[0] - from[0]), &scaled(&along[1], to[1] - from[1]));
        let turning = scaled(&cross(&path.place.axis(), &way), EARTH_RATE);
        let beyond = difference(gained, &turned(&solution.frame, &turning));
        let variance = self.velocity_variance(index, driven);
        let measurements: [Measurement; 2] = core::array::from_fn(|axis| {
            let direction = turned(&solution.frame, &along[axis]);
            let mut row = [0.0; STATES];
            row[VELOCITY..VELOCITY + 3].copy_from_slice(&direction);
            Measurement { row, value: dot(&beyond, &direction), variance }
        });
        if self.take(&mut solution.filter, &measurements).is_none() {
            solution.unsteady += 1;
        }
    }

    /// Variance of the velocity that a drive seems to gain, (m/s)²: what driving adds to the accelerometers'
    /// biases, their noise, gravity's direction along an unknown way and how the Earth turns that.
    fn velocity_variance(&self, index: usize, driven: f64) -> f64 {
        let astray = self.astray(index, driven);
        let direction = self.path.gravity * self.path.place.per_metre()[0] * astray;
        let turning = EARTH_RATE * astray;
        (DRIVING * DRIVING + direction * direction) * driven * driven
            + turning * turning
            + self.density * driven
    }

    /// How far the way to a stop, driven in so many seconds, may be from what is taken for it, 1σ, m.
    fn astray(&self, index: usize, driven: f64) -> f64 {
        let stops = &self.path.stops;
        let is_told = |stop: usize| stop == 0 || stops[stop].displacement.is_some();
        let speed = self.setting.speed_sigma;
        if is_told(index - 1) && is_told(index) {
            return DETOUR * speed * driven;
        }
        speed * (stops[index].from - stops[0].to)
    }

    /// Takes the force of a block.
    fn block(&mut self, solution: &mut Solution, block: &Block, displaced: [f64; 2]) {
        let elapsed = block.middle - self.path.start;
        let navigation = self.path.place.navigation(elapsed, displaced);
        let above = turned(&solution.frame, &up(&navigation));
        let predicted = scaled(&above, self.path.gravity);
        let force = block.force.map(f64::from);
        let variance = self.density / f64::from(block.seconds);
        let along = transposed(&navigation);
        let farther = self.north.map(|place| {
            let moved = up(&place.navigation(elapsed, displaced));
            let change = difference(&moved, &up(&navigation));
            turned(&solution.frame, &scaled(&change, self.path.gravity / LATITUDE_STEP))
        });
        let measurements: [Measurement; 2] = core::array::from_fn(|axis| {
            let direction = turned(&solution.frame, &along[axis]);
            let mut row = force_row(&predicted, &direction, &block.attitude);
            row[PLACE + axis] = self.path.gravity * self.path.place.per_metre()[axis];
            row[LATITUDE] = farther.map_or(0.0, |change| dot(&change, &direction));
            let value = dot(&difference(&force, &predicted), &direction);
            Measurement { row, value, variance }
        });
        let beyond = measurements.map(|measurement| solution.filter.beyond(&measurement));
        let Some(chi_square) = self.take(&mut solution.filter, &measurements) else {
            solution.left_out += 1;
            return;
        };
        solution.chi_square += chi_square;
        solution.degrees += 2.0;
        let [north, east] = beyond;
        let before = core::mem::replace(&mut self.before, beyond);
        let [products, squares] = &mut solution.neighbours;
        *products += north * before[0] + east * before[1];
        *squares += north * north + east * east;
    }

    /// Takes it that the body turned with the Earth alone during a stop.
    fn rest(&self, solution: &mut Solution, stop: &Stop) {
        let turn = EARTH_RATE * stop.seconds();
        let earth = by(&scaled(&turned(&solution.frame, &self.path.place.axis()), turn));
        let [begin, end] = [&stop.begin, &stop.end].map(|carried| carried.attitude.matrix());
        let shown = product(&end, &transposed(&begin));
        let beyond = small(&product(&shown, &transposed(&earth)));
        let rows: [_; 3] = core::array::from_fn(|axis| rest_row(&earth, axis));
        let sway = self.sway(stop);
        // Farther north the Earth's axis points elsewhere on the start frame.
        let farther = self.north.map(|place| {
            let change = difference(&place.axis(), &self.path.place.axis());
            turned(&solution.frame, &scaled(&change, turn / LATITUDE_STEP))
        });
        // On the body's axes, which sway differently.
        let measurements: [Measurement; 3] = core::array::from_fn(|axis| {
            let direction: Vector = core::array::from_fn(|part| begin[part][axis]);
            let mut row = core::array::from_fn::<f64, STATES, _>(|state| {
                (0..3).map(|part| direction[part] * rows[part][state]).sum()
            });
            row[LATITUDE] = farther.map_or(0.0, |change| dot(&change, &direction));
            Measurement { row, value: dot(&direction, &beyond), variance: sway[axis] }
        });
        if self.take(&mut solution.filter, &measurements).is_none() {
            solution.turning += 1;
            let rate = length(&beyond) / stop.seconds();
            solution.turning_rate = solution.turning_rate.max(rate);
            // A turn that takes little time makes these seconds stand out of the others.
            let excess: f64 = self.excess(stop).iter().sum();
            if rate * rate * stop.seconds() > TURNED_BY_HAND * excess {
                solution.steady = solution.steady.max(rate);
            }
        }
    }

    /// Variance of what a body's axes sway between both ends of a stop, rad²: what its seconds turn beyond the gyros'
    /// noise, or swing, if they come back to where they began: twice the variance of a swing is a quarter of its square.
    fn sway(&self, stop: &Stop) -> Vector {
        if self.belief == Belief::Ideal {
            return [LEAST_SWAY; 3];
        }
        let (excess, swinging) = (self.excess(stop), stop.swinging());
        let walk = self.setting.common.noise.angle_random_walk;
        core::array::from_fn(|axis| {
            let swung = 0.25 * swinging[axis] - walk * walk;
            (SLOW_SWAY * excess[axis]).max(swung).max(0.0) + LEAST_SWAY
        })
    }

    /// Variance of what the seconds of a stop turn beyond the gyros' noise, (rad/s)².
    fn excess(&self, stop: &Stop) -> Vector {
        let walk = self.setting.common.noise.angle_random_walk;
        stop.turned.variance().map(|variance| (variance - walk * walk).max(0.0))
    }

    /// Takes measurements, unless they are outliers; what they brought beyond the expected.
    fn take(&self, filter: &mut Filter, measurements: &[Measurement]) -> Option<f64> {
        let is_ideal = self.belief == Belief::Ideal;
        let normalised_innovation_squared =
            if is_ideal { 0.0 } else { filter.normalised_innovation_squared(measurements) };
        (normalised_innovation_squared <= OUTLIER).then(|| {
            filter.measure(measurements);
            normalised_innovation_squared
        })
    }
}

/// Covariance of φ at the start: the level is nearly known, the azimuth is not.
fn start_covariance(frame: &Matrix) -> Matrix {
    let down: Vector = frame.map(|row| row[2]);
    core::array::from_fn(|row| {
        core::array::from_fn(|column| {
            let level = if row == column { LEVEL_SIGMA * LEVEL_SIGMA } else { 0.0 };
            level + AZIMUTH_SIGMA * AZIMUTH_SIGMA * down[row] * down[column]
        })
    })
}

fn gained(now: &Rough, before: &Rough) -> Matrix {
    core::array::from_fn(|row| difference(&now[row].map(f64::from), &before[row].map(f64::from)))
}

/// How the state's rotation now turns something, as a row.
#[must_use]
pub fn now_row(gradient: &Vector) -> [f64; STATES] {
    let mut row = [0.0; STATES];
    row[NOW..NOW + 3].copy_from_slice(gradient);
    row
}
