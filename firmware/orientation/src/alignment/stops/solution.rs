//! Iteration of the filter along a path until the start frame is consistent.

use super::Setting;
use super::block::Block;
use super::drift::Drift;
use super::filter::{
    BIAS, Filter, LATITUDE, Measurement, PLACE, START, STATES, VELOCITY, force_row, placed,
    rest_row, velocity_row,
};
use super::path::{Path, gained};
use super::place::{Place, up};
use super::stop::Stop;
use crate::earth::EARTH_RATE;
use crate::math::chi_square_tail;
use crate::math::rotation::{
    Matrix, Vector, about_down, by, cross, difference, dot, length, product, scaled, small, sum,
    transposed, turned,
};
use crate::signal::strapdown::{Carried, Rough};
use crate::units::RadiansPerSecond;

/// Prior 1σ of the start frame's level from the first stop, rad; far above the actual one.
const LEVEL_SIGMA: f64 = 0.1;
/// Prior 1σ of the start frame's azimuth, rad: unknown.
const AZIMUTH_SIGMA: f64 = 3.0;
/// Greatest number of iterations.
const REPETITIONS: u32 = 16;
/// Correction below which the iteration ends, rad: half of its square is below 1e-5°.
const SETTLED: f64 = 5e-4;
/// Greatest number of iterations from a far start, on either side of the circle.
const APPROACHES: u32 = 8;
/// One of so many blocks at rest is used there.
const APART: usize = 8;
/// Correction below which outliers are looked for, rad: half of its square is worth 0.1° of azimuth.
const NEAR: f64 = 0.05;
/// Probability of the misfit of sound data below which the other side of the circle is looked at.
const MISFIT: f64 = 1e-3;
/// Ratio of the scatter to the assumed one from which it is too large.
const ROUGH: f64 = 1.5;
/// Greatest ratio that is attributed to a sway.
const ROUGHEST: f64 = 6.0;
/// Correlation of neighbouring blocks from which their weight is reduced, in its 1σ for white
/// blocks.
const COLOURED: f64 = 3.0;
/// Probability of the estimated biases below which their prior is inflated.
const FALSE_BIAS: f64 = 0.05;
/// Ratio, in power, of the biases to their inflated prior from which the prior is inflated further.
const BELIEVED: f64 = 1.1;
/// Greatest 1σ of biases, rad/s, to which a prior is inflated: larger ones, a fifth of the Earth
/// rate, are rather the effect of a wrong latitude or axis.
const GREATEST_BIAS: f64 = 0.2 * EARTH_RATE;
/// Greatest factor by which a prior is inflated in any case.
const GREATEST_WIDENING: f64 = 3.0;
/// Least observed part of the biases' variance from which they are judged.
const LEAST_SEEN: f64 = 0.1;
/// Longest time in which a vehicle at rest is turned by hand, s: a rate present all the time is a
/// bias.
const TURNED_BY_HAND: f64 = 5.0;
/// Fewest degrees of freedom for a meaningful correlation.
const LEAST_DEGREES: f64 = 20.0;
/// Normalised innovation squared beyond which a block, or the rest of a stop, is excluded: one
/// sound block in three million.
const OUTLIER: f64 = 30.0;
/// Least variance of a vehicle's sway, rad²: 20 milliarcseconds.
const LEAST_SWAY: f64 = 1e-14;
/// Ratio of the power of a slow sway's angle to that of its change within a second.
const SLOW_SWAY: f64 = 4.0;
/// Least angle random walk that is assumed, rad/√s: 1e-5 °/√h.
const LEAST_WALK: f64 = 2.9e-9;
/// Additional 1σ of an accelerometer's bias while driving, m/s²: scale and axes under vibration,
/// 0.1 mg.
const DRIVING: f64 = 1e-3;
/// Mean distance of a vehicle from the straight way, relative to the distance that it could have
/// driven.
const DETOUR: f64 = 0.1;
/// Part of a drive that its blocks may miss.
const COVERED: f64 = 0.002;
/// Step of the latitude in a numerical derivative, rad.
const LATITUDE_STEP: f64 = 1e-3;

/// The zero matrix.
const NOTHING: Matrix = [[0.0; 3]; 3];

/// Assumptions of a run on disturbances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Belief {
    /// Disturbances as the data show them.
    Shown,
    /// The same, but of a few blocks and without outliers: enough to come near.
    Untested,
    /// No sway, no outliers, least noise: the Cramér–Rao bound, and the starting point of the
    /// iteration.
    Ideal,
}

/// State of the filter at the end of the path, with statistics of the run.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Filter states; φ is the remaining error of [`Self::frame`].
    pub filter: Filter,
    /// Rotation from the frozen north, east, down of the start to the start frame.
    pub frame: Matrix,
    /// Drift by the biases about which the filter is linear, up to the end of the path.
    pub(super) drift: Drift,
    /// Statistics of the latest run.
    pub tally: Tally,
    /// Sum of all normalised innovations squared of that run, chi-square of the estimates with their prior, and its degrees
    /// of freedom.
    misfit: [f64; 2],
    /// Greatest rate relative to the Earth that was present all through a stop whose rest was
    /// excluded, rad/s.
    steady: f64,
    /// Factor by which the blocks scatter more than their neighbours indicate, in power; at least
    /// one.
    pub roughness: f64,
    /// Factor for the correlation of neighbouring blocks, in power; one until it is known.
    pub colour: f64,
    /// Factor on the prior 1σ of the biases; at least one.
    pub widening: f64,
}

/// Statistics of a run along the path.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Sum of the blocks' normalised innovations squared.
    pub chi_square: f64,
    /// Degrees of freedom of that sum.
    pub degrees: f64,
    /// Number of excluded blocks.
    pub left_out: u32,
    /// Number of stops at which the vehicle turned, whose rest rates are excluded.
    pub turning: u32,
    /// Greatest rate at which it turned there relative to the Earth.
    pub turning_rate: RadiansPerSecond,
    /// Number of drives that did not end at rest, whose velocity is excluded.
    pub unsteady: u32,
    /// Sum of products of successive blocks' innovations, and sum of their squares.
    neighbours: [f64; 2],
}

impl Tally {
    /// Correlation of neighbouring blocks' innovations; zero with too few degrees of freedom.
    pub(crate) fn correlation(&self) -> f64 {
        let [products, squares] = self.neighbours;
        if self.degrees < LEAST_DEGREES { 0.0 } else { products / squares }
    }
}

/// Sensitivities carried up to a moment.
#[derive(Clone, Copy, Debug, Default)]
struct Moment {
    /// Time, s.
    at: f64,
    /// Sensitivity of the frame to gyro biases, s.
    bias: Rough,
    /// Sensitivity of the frame to scale errors, rad.
    scale: Rough,
    /// Variance of the frame's rotation by missing samples, rad².
    lost: f32,
}

impl Moment {
    /// Sensitivities of a carried attitude at a time, s.
    fn of(at: f64, carried: &Carried) -> Self {
        Self { at, bias: carried.bias, scale: carried.scale, lost: carried.lost }
    }

    /// Sensitivities in the middle of a block; that to scale errors is not kept of each.
    fn within(block: &Block, scale: Rough) -> Self {
        Self { at: block.middle, bias: block.bias, scale, lost: block.lost }
    }
}

/// One run along the path with one start frame.
struct Run<'a> {
    /// Solution that the run updates.
    solution: &'a mut Solution,
    /// Configuration of the alignment.
    setting: &'a Setting,
    /// Path of the vehicle.
    path: &'a Path<'a>,
    /// Power of the force noise, (m/s²)²·s.
    density: f64,
    /// Powers of the random walks of the angle, rad²/s, and of the biases, (rad/s)²/s.
    walks: [f64; 2],
    /// Place slightly farther north, for the derivative with respect to latitude; none where the
    /// latitude is exact.
    north: Option<Place>,
    /// Assumptions on disturbances.
    belief: Belief,
    /// Sensitivities at the latest step.
    last: Moment,
    /// Innovation of the previous block, m/s².
    before: [f64; 2],
}

impl Solution {
    /// Solution before any run, with an approximate start frame.
    pub(crate) fn new(frame: Matrix) -> Self {
        let (filter, tally) = (Filter::EMPTY, Tally::default());
        let drift = Drift::by([0.0; 3]);
        Self {
            filter,
            frame,
            drift,
            tally,
            misfit: [0.0; 2],
            steady: 0.0,
            roughness: 1.0,
            colour: 1.0,
            widening: 1.0,
        }
    }

    /// Iterates along the path until the start frame is consistent; the first run must have been
    /// made.
    pub(crate) fn settle(&mut self, setting: &Setting, path: &Path) {
        if self.correction(path) > NEAR {
            self.search(setting, path);
        }
        for _ in 0..REPETITIONS {
            self.relinearise();
            self.run(setting, path, Belief::Shown);
            let is_settled = self.correction(path) < SETTLED;
            if is_settled && !self.widen(setting) && !self.roughen() {
                break;
            }
        }
    }

    /// Comes near to the estimates that fit best, from a far start. Where those that it comes to do not fit, another
    /// minimum may lie on the other side of the circle: biases explain some of what a wrong azimuth leaves.
    #[inline(never)]
    fn search(&mut self, setting: &Setting, path: &Path) {
        let [here, degrees] = self.approach(setting, path);
        if chi_square_tail(here, degrees) > MISFIT {
            return;
        }
        let (frame, drift) = (self.frame, self.drift);
        self.frame = product(&self.frame, &about_down(core::f64::consts::PI));
        self.drift = Drift::by([0.0; 3]);
        self.run(setting, path, Belief::Untested);
        if self.approach(setting, path)[0] > here {
            (self.frame, self.drift) = (frame, drift);
            self.run(setting, path, Belief::Untested);
        }
    }

    /// Iterates until the estimates are near to those about which the filter is linear, without tests: what contradicts
    /// an estimate that is far from the truth may be sound. Returns the misfit.
    fn approach(&mut self, setting: &Setting, path: &Path) -> [f64; 2] {
        for _ in 0..APPROACHES {
            if self.correction(path) < NEAR {
                break;
            }
            self.relinearise();
            self.run(setting, path, Belief::Untested);
        }
        self.misfit
    }

    /// Makes the estimates those about which the filter is linear.
    fn relinearise(&mut self) {
        self.frame = product(&by(&self.filter.three(START)), &self.frame);
        self.drift = Drift::by(self.filter.three(BIAS));
    }

    /// How far the estimates are from those about which the filter is linear, rad: the rotation at the start, or by the
    /// biases until now.
    pub(crate) fn correction(&self, path: &Path) -> f64 {
        let more = difference(&self.filter.three(BIAS), &self.drift.biases);
        length(&self.filter.three(START)).max(length(&more) * (path.now - path.start))
    }

    /// Inflates the prior 1σ of the biases where their estimates exceed it by more than chance. The
    /// component along east is not observable at rest. Returns whether the prior changed.
    fn widen(&mut self, setting: &Setting) -> bool {
        let sigma = self.widening * setting.bias_sigma().0;
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
        let greatest = GREATEST_BIAS.max(GREATEST_WIDENING * setting.bias_sigma().0);
        if is_chance || wider * sigma > greatest {
            return false;
        }
        self.widening *= wider;
        (self.roughness, self.colour) = (1.0, 1.0);
        true
    }

    /// Inflates the blocks' noise where they scatter more than assumed: a sway slower than two
    /// blocks does not show in neighbours, and correlated blocks carry less information. Returns
    /// whether the noise changed.
    fn roughen(&mut self) -> bool {
        let correlation = self.tally.correlation();
        let is_coloured = correlation * libm::sqrt(self.tally.degrees) > COLOURED;
        if is_coloured && self.colour <= 1.0 {
            // The mean of correlated values has a variance larger by this factor.
            self.colour = (1.0 + correlation) / (1.0 - correlation);
            return true;
        }
        let ratio = self.tally.chi_square / self.tally.degrees.max(1.0);
        let is_rough = ratio > ROUGH && self.roughness * ratio < ROUGHEST;
        if is_rough {
            self.roughness *= ratio;
        }
        is_rough
    }

    /// One run of the filter along the path.
    #[inline(never)]
    pub(crate) fn run(&mut self, setting: &Setting, path: &Path, belief: Belief) {
        let site = &setting.site;
        (self.tally, self.misfit, self.steady) = (Tally::default(), [0.0; 2], 0.0);
        self.drift = Drift::by(self.drift.biases);
        let bias_sigma = self.widening * setting.bias_sigma().0;
        self.filter.begin(&start_covariance(&self.frame), bias_sigma, site);
        let is_exact = site.latitude_sigma.0 <= 0.0;
        let is_ideal = belief == Belief::Ideal;
        let own_density = || self.roughness * self.colour * path.density();
        let mut run = Run {
            density: if is_ideal { path.least_density() } else { own_density() },
            walks: walks(setting, path),
            solution: self,
            setting,
            path,
            north: (!is_exact).then(|| Place::moved(site.latitude, LATITUDE_STEP)),
            belief,
            last: Moment { at: path.start, ..Moment::default() },
            before: [0.0; 2],
        };
        for index in 0..path.stops.len() {
            run.stop(index);
        }
        run.solution.filter.add_process_noise(path.left_sigma(setting));
        run.carry(Moment::of(path.now, &path.carried));
    }
}

impl Run<'_> {
    /// Processes one stop, with the drive before it.
    fn stop(&mut self, index: usize) {
        let stop = &self.path.stops[index];
        if index > 0 {
            let driven = (stop.from.0 - self.last.at).max(0.0);
            self.drive(index, driven);
            let (known, unknown) = (self.setting.displacement_sigma, self.setting.speed_sigma);
            match stop.displacement {
                Some(_) => self.solution.filter.reset(PLACE..PLACE + 2, known.0),
                None => self.solution.filter.add_process_noise(unknown.0 * driven),
            }
        }
        self.carry(Moment::of(stop.from.0, &stop.begin));
        self.solution.filter.anchor();
        self.before = [0.0; 2];
        let begin = self.attitude(&stop.begin);
        let step = if self.belief == Belief::Untested { APART } else { 1 };
        for block in self.path.blocks.of(index).step_by(step) {
            self.carry(Moment::within(block, stop.begin.scale));
            self.block(block, self.path.displaced(index));
        }
        self.carry(Moment::of(stop.to.0, &stop.end));
        self.rest(stop, &begin);
    }

    /// Attitude of the body, at the moment to which the filter was propagated, on the frame without drift.
    fn attitude(&self, carried: &Carried) -> Matrix {
        product(&self.solution.drift.back, &carried.attitude.matrix())
    }

    /// Propagates the filter to a moment.
    fn carry(&mut self, to: Moment) {
        let seconds = (to.at - self.last.at).max(0.0);
        let has_scale = self.setting.site.scale_sigma > 0.0;
        let scale = if has_scale { gained(&to.scale, &self.last.scale) } else { NOTHING };
        let scale = product(&self.solution.drift.back, &scale);
        let lost = f64::from((to.lost - self.last.lost).max(0.0));
        let bias = self.solution.drift.carry(&to.bias);
        let [walk, bias_walk] = self.walks;
        self.solution.filter.carry(&bias, &scale, walk * seconds + lost);
        self.solution.filter.remove(&turned(&bias, &self.solution.drift.biases));
        self.solution.filter.walk(bias_walk * seconds);
        self.last = to;
    }

    /// Applies the condition that a drive to a stop, of this many seconds, ends at rest as it began
    /// (zero-velocity update): the integral of its forces beyond gravity is then due to φ.
    fn drive(&mut self, index: usize, driven: f64) {
        let path = self.path;
        self.solution.filter.reset(VELOCITY..VELOCITY + 3, 0.0);
        let (mut gained, mut seconds) = ([0.0; 3], 0.0);
        for block in path.drives.of(index - 1) {
            self.carry(Moment::within(block, self.last.scale));
            let displaced = path.underway(index - 1, block.middle);
            let above = up(&path.place.navigation(block.middle - path.start, displaced));
            let predicted = scaled(&turned(&self.solution.frame, &above), path.gravity);
            let length = f64::from(block.seconds);
            let rows: [_; 3] = core::array::from_fn(|axis| {
                velocity_row(&predicted, axis, &block.attitude, length)
            });
            self.solution.filter.add(VELOCITY, &rows);
            let beyond = difference(&self.solution.drift.force(block), &predicted);
            gained = sum(&gained, &scaled(&beyond, length));
            seconds += length;
        }
        self.carry(Moment::of(path.stops[index].from.0, &path.stops[index].begin));
        if (seconds - driven).abs() <= COVERED * driven {
            self.come_to_rest(index, &gained, driven);
        }
    }

    /// Updates the filter with the apparent velocity gained by a drive.
    fn come_to_rest(&mut self, index: usize, gained: &Vector, driven: f64) {
        let path = self.path;
        let middle = path.stops[index].from.0 - 0.5 * driven - path.start;
        let navigation =
            path.place.navigation(middle, path.underway(index - 1, middle + path.start));
        let along = transposed(&navigation);
        let [from, to] = [path.displaced(index - 1), path.displaced(index)];
        let way = sum(&scaled(&along[0], to[0] - from[0]), &scaled(&along[1], to[1] - from[1]));
        let turning = scaled(&cross(&path.place.axis(), &way), EARTH_RATE);
        let beyond = difference(gained, &turned(&self.solution.frame, &turning));
        let variance = self.velocity_variance(index, driven);
        let measurements: [Measurement; 2] = core::array::from_fn(|axis| {
            let direction = turned(&self.solution.frame, &along[axis]);
            let row = placed(VELOCITY, &direction);
            Measurement { row, value: dot(&beyond, &direction), variance }
        });
        if self.take(&measurements).is_none() {
            self.solution.tally.unsteady += 1;
        }
    }

    /// Variance of the apparent velocity gained by a drive, (m/s)²: the change of the
    /// accelerometers' biases while driving, their noise, the direction of gravity along an unknown
    /// way, and the Earth's rotation of it.
    fn velocity_variance(&self, index: usize, driven: f64) -> f64 {
        let way_sigma = self.way_sigma(index, driven);
        let direction = self.path.gravity * self.path.place.per_metre()[0] * way_sigma;
        let turning = EARTH_RATE * way_sigma;
        (DRIVING * DRIVING + direction * direction) * driven * driven
            + turning * turning
            + self.density * driven
    }

    /// Deviation of the way to a stop, driven in this many seconds, from the assumed one, 1σ, m.
    fn way_sigma(&self, index: usize, driven: f64) -> f64 {
        let stops = &self.path.stops;
        let is_known = |stop: usize| stop == 0 || stops[stop].displacement.is_some();
        let speed = self.setting.speed_sigma;
        if is_known(index - 1) && is_known(index) {
            return DETOUR * speed.0 * driven;
        }
        speed.0 * (stops[index].from.0 - stops[0].to.0)
    }

    /// Updates the filter with the force of a block.
    fn block(&mut self, block: &Block, displaced: [f64; 2]) {
        let elapsed = block.middle - self.path.start;
        let navigation = self.path.place.navigation(elapsed, displaced);
        let above = turned(&self.solution.frame, &up(&navigation));
        let predicted = scaled(&above, self.path.gravity);
        let force = self.solution.drift.force(block);
        let variance = self.density / f64::from(block.seconds);
        let along = transposed(&navigation);
        let farther = self.north.map(|place| {
            let moved = up(&place.navigation(elapsed, displaced));
            let change = difference(&moved, &up(&navigation));
            turned(&self.solution.frame, &scaled(&change, self.path.gravity / LATITUDE_STEP))
        });
        let measurements: [Measurement; 2] = core::array::from_fn(|axis| {
            let direction = turned(&self.solution.frame, &along[axis]);
            let mut row = force_row(&predicted, &direction, &block.attitude);
            row[PLACE + axis] = self.path.gravity * self.path.place.per_metre()[axis];
            row[LATITUDE] = farther.map_or(0.0, |change| dot(&change, &direction));
            let value = dot(&difference(&force, &predicted), &direction);
            Measurement { row, value, variance }
        });
        let beyond = measurements.map(|measurement| self.solution.filter.beyond(&measurement));
        let Some(chi_square) = self.take(&measurements) else {
            self.solution.tally.left_out += 1;
            return;
        };
        self.solution.tally.chi_square += chi_square;
        self.solution.tally.degrees += 2.0;
        let [north, east] = beyond;
        let before = core::mem::replace(&mut self.before, beyond);
        let [products, squares] = &mut self.solution.tally.neighbours;
        *products += north * before[0] + east * before[1];
        *squares += north * north + east * east;
    }

    /// Updates the filter with the condition that the body turned with the Earth alone during a
    /// stop (zero angular rate).
    fn rest(&mut self, stop: &Stop, begin: &Matrix) {
        let turn = EARTH_RATE * stop.seconds().0;
        let earth = by(&scaled(&turned(&self.solution.frame, &self.path.place.axis()), turn));
        let shown = product(&self.attitude(&stop.end), &transposed(begin));
        let beyond = small(&product(&shown, &transposed(&earth)));
        let rows: [_; 3] = core::array::from_fn(|axis| rest_row(&earth, axis));
        let sway = self.sway(stop);
        // Farther north the Earth's axis has another direction on the start frame.
        let farther = self.north.map(|place| {
            let change = difference(&place.axis(), &self.path.place.axis());
            turned(&self.solution.frame, &scaled(&change, turn / LATITUDE_STEP))
        });
        // The components are taken on the body's axes, which sway differently.
        let measurements: [Measurement; 3] = core::array::from_fn(|axis| {
            let direction: Vector = core::array::from_fn(|part| begin[part][axis]);
            let mut row = core::array::from_fn::<f64, STATES, _>(|state| {
                (0..3).map(|part| direction[part] * rows[part][state]).sum()
            });
            row[LATITUDE] = farther.map_or(0.0, |change| dot(&change, &direction));
            Measurement { row, value: dot(&direction, &beyond), variance: sway[axis] }
        });
        if self.take(&measurements).is_none() {
            self.solution.tally.turning += 1;
            let rate = length(&beyond) / stop.seconds().0;
            self.solution.tally.turning_rate =
                RadiansPerSecond(self.solution.tally.turning_rate.0.max(rate));
            // A rotation within a short time makes its seconds stand out of the others.
            let excess: f64 = self.excess(stop).iter().sum();
            if rate * rate * stop.seconds().0 > TURNED_BY_HAND * excess {
                self.solution.steady = self.solution.steady.max(rate);
            }
        }
    }

    /// Variance of the sway of the body's axes between both ends of a stop, rad²: from the rotation
    /// of its seconds beyond the gyros' noise, or from the swing within them if they return to
    /// their beginning: twice the variance of a swing is a quarter of its square. Where the body still rocked at one end,
    /// as after an arrival, that end's own swing counts.
    fn sway(&self, stop: &Stop) -> Vector {
        if self.belief == Belief::Ideal {
            return [LEAST_SWAY; 3];
        }
        let (excess, swinging, ends) =
            (self.excess(stop), stop.swinging(), stop.swinging_at_ends());
        let walk = self.setting.site.noise.model().angle_random_walk;
        core::array::from_fn(|axis| {
            let swung = (0.25 * swinging[axis]).max(0.125 * ends[axis]) - walk.0 * walk.0;
            (SLOW_SWAY * excess[axis]).max(swung).max(0.0) + LEAST_SWAY
        })
    }

    /// Variance of the rotation in the seconds of a stop beyond the gyros' noise, (rad/s)².
    fn excess(&self, stop: &Stop) -> Vector {
        let walk = self.setting.site.noise.model().angle_random_walk;
        stop.turned.variance().map(|variance| (variance - walk.0 * walk.0).max(0.0))
    }

    /// Updates the filter with measurements unless they are outliers; returns their normalised
    /// innovation squared.
    fn take(&mut self, measurements: &[Measurement]) -> Option<f64> {
        let filter = &mut self.solution.filter;
        let is_ideal = self.belief == Belief::Ideal;
        let normalised_innovation_squared =
            if is_ideal { 0.0 } else { filter.normalised_innovation_squared(measurements) };
        self.solution.misfit[0] += normalised_innovation_squared;
        self.solution.misfit[1] += measurements.len() as f64;
        let is_sound = normalised_innovation_squared <= OUTLIER;
        (is_sound || self.belief == Belief::Untested).then(|| {
            filter.measure(measurements);
            normalised_innovation_squared
        })
    }
}

/// Powers of the random walks of the angle, rad²/s, and of the biases, (rad/s)²/s. A ramp is represented by the walk of
/// the biases with its Allan variance over the whole time. Flicker has the same Allan variance over any time; it is
/// represented by both walks, half and half at a time between the length of a stop and that of the way, whose rates are
/// compared. A walk of the biases alone would double as a drive gets twice as long, and vanish within a long stop.
fn walks(setting: &Setting, path: &Path) -> [f64; 2] {
    let whole = (path.now - path.start).max(1.0);
    let stood: f64 = path.stops.iter().map(|stop| stop.seconds().0).sum();
    let stop = (stood / path.stops.len() as f64).max(1.0);
    let middle = libm::sqrt(stop * libm::sqrt(stop * whole));
    let noise = setting.site.noise.model();
    let [_, _, b, k, r] = noise.coefficients();
    let half = core::f64::consts::LN_2 / core::f64::consts::PI * b * b;
    let walk = noise.angle_random_walk.0.max(LEAST_WALK);
    [walk * walk + half * middle, k * k + 3.0 * half / middle + 1.5 * r * r * whole]
}

/// Prior covariance of φ at the start: the level is nearly known, the azimuth is not.
fn start_covariance(frame: &Matrix) -> Matrix {
    let down: Vector = frame.map(|row| row[2]);
    core::array::from_fn(|row| {
        core::array::from_fn(|column| {
            let level = if row == column { LEVEL_SIGMA * LEVEL_SIGMA } else { 0.0 };
            level + AZIMUTH_SIGMA * AZIMUTH_SIGMA * down[row] * down[column]
        })
    })
}
