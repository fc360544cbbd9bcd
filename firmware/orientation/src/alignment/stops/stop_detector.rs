//! Detection of a vehicle's stops: carries the attitude, finds the intervals of rest, and keeps
//! averages of them.
//!
//! Samples are averaged to seconds, seconds to a window of ten, whose average is tested by the stop
//! criteria. A stop begins a delay T₀ after the first window that passes did, and ends two seconds
//! before the window that fails, in which the vehicle may have set off (Szymanowski 2003, criteria
//! Kryt1 and Kryt2).

use heapless::{Deque, Vec};

use super::Refusal;
use super::block::{AT_REST, Block, Blocks, DRIVEN, combined};
use super::lever::Lever;
use super::stop::{Course, STOPS, Second, Stop};
use crate::math::rotation::{length, scaled, sum};
use crate::signal::InertialSample;
use crate::signal::rest::{Criteria, Limits, Sensors};
use crate::signal::strapdown::{Carried, Rough, Strapdown, Sums};
use crate::units::{AngleIncrement, Instant, Metres, MetresPerSecondSquared, Seconds};

/// Length of the low-pass average for the criteria, s: at least ten (Szymanowski 2003).
pub(crate) const WINDOW: usize = 10;
/// Seconds at the end of a stop in which the vehicle may have set off.
const LATEST: usize = 2;
/// Delay T₀ after which a vehicle that stopped hardly rocks any more, s.
const DELAY: usize = 3;
/// Latest seconds of the window that show how quiet a vehicle is that no longer rocks.
const QUIET: usize = 3;
/// Ratio of the power of back-and-forth motion to theirs up to which a second is as quiet; noise alone stays below it.
const ROCKING: f32 = 4.0;
/// Length of a block at rest as long as there is room, s.
const REST_SPAN: f32 = 5.0;
/// Length of a block of a drive as long as there is room, s.
const DRIVE_SPAN: f32 = 15.0;
/// Nominal length of a second, µs.
const SECOND: u64 = 1_000_000;
/// Distance of two samples, in sample periods, from which samples are missing.
const GAP: f64 = 1.6;
/// Longest gap whose rotation its neighbours bound, s.
const LONGEST_GAP: f64 = 1.0;
/// Greatest standard deviation of the rotation in all gaps, 1σ, rad: two degrees, up to which the
/// equations of the filter are linear.
const GREATEST_LOSS: f64 = 0.035;
/// Part of the variance of an azimuth from which the gaps are its cause.
const CAUSE: f64 = 0.5;

/// Source of the stops.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Rests {
    /// The stop criteria find them.
    Found,
    /// They are configured as intervals of time.
    Stated(Vec<[Seconds; 2], STOPS>),
    /// The whole recording is one stop.
    Whole,
}

/// The second in progress.
#[derive(Clone, Copy, Debug, Default)]
struct Progress {
    /// Beginning of the second.
    since: Instant,
    /// Attitude and sensitivities at its beginning.
    begin: Carried,
}

/// State of the stop detection, apart from what is kept of stops and drives.
#[derive(Clone, Debug, Default)]
pub(super) struct State {
    /// Strapdown attitude.
    strapdown: Strapdown,
    /// Beginning of the first sample.
    begun: Option<Instant>,
    /// End of the latest sample.
    last: Instant,
    /// Second in progress.
    progress: Progress,
    /// Criteria of the window.
    criteria: Option<Criteria>,
    /// Whether the vehicle stands, and the last stop continues.
    pub(super) is_at_rest: bool,
    /// Seconds for which the criteria have held without interruption.
    held: usize,
    /// Length of the longest halt that was too short for a stop, s; zero without one.
    pub(super) fleeting: f64,
    /// What is carried on within the latest stop.
    course: Course,
    /// Lever arm from the axis of the sway to the sensors.
    lever: Lever,
    /// Loss of rotation that first made the carried attitude invalid.
    loss: Option<Refusal>,
    /// Gap with the greatest variance, rad², and length of all gaps, s.
    gap: Option<(f32, Refusal)>,
    missing: f64,
}

/// Detection of the stops.
#[derive(Clone, Debug)]
pub struct StopDetector {
    /// Source of the stops.
    pub(super) rests: Rests,
    /// Limits of the stop criteria.
    limits: Limits,
    /// Stated squared angle random walk of the gyros, rad²/s.
    walk: f32,
    /// Local gravity, m/s².
    gravity: f64,
    /// Least distance of two samples that counts as a gap, µs.
    gap: u64,
    /// Sample period, µs.
    period: u64,
    /// State at the latest sample.
    pub(super) state: State,
    /// Latest seconds, whose average is tested.
    window: Deque<Second, WINDOW>,
    /// Stops so far; the last one may still continue.
    pub(super) stops: Vec<Stop, STOPS>,
    /// Averages of the time at rest.
    pub(super) blocks: Blocks<AT_REST>,
    /// Averages of the drives, each with the number of the stop before it.
    pub(super) drives: Blocks<DRIVEN>,
}

impl StopDetector {
    /// Detector before the first sample; samples come every `sample_seconds`, gravity in m/s².
    #[inline]
    #[must_use]
    pub fn new(
        rests: Rests,
        sensors: &Sensors,
        gravity: MetresPerSecondSquared,
        sample_seconds: Seconds,
    ) -> Self {
        Self {
            rests,
            limits: sensors.limits(Seconds(WINDOW as f64)),
            walk: (sensors.angle_random_walk.0 * sensors.angle_random_walk.0) as f32,
            gravity: gravity.0,
            gap: libm::round(GAP * sample_seconds.0 * 1e6) as u64,
            period: libm::round(sample_seconds.0 * 1e6) as u64,
            state: State::default(),
            window: Deque::new(),
            stops: Vec::new(),
            blocks: Blocks::new(REST_SPAN),
            drives: Blocks::new(DRIVE_SPAN),
        }
    }

    /// Discards all stops, in place: the next sample is the first.
    pub(crate) fn clear(&mut self) {
        self.state = State::default();
        self.window.clear();
        self.stops.clear();
        self.blocks.clear(REST_SPAN);
        self.drives.clear(DRIVE_SPAN);
    }

    /// Takes a sample; returns whether a second ended with it.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) -> bool {
        if self.state.begun.is_none() {
            self.begin(sample.time);
        }
        self.watch(sample);
        // A rotation at its limit is large, so the strapdown has updated its attitude.
        if self.state.strapdown.push(sample)
            && sample.turned.iter().any(|turned| turned.is_saturated())
        {
            self.lose(Refusal::RotationClipped { at: Seconds(sample.time.seconds()) });
        }
        let is_over = sample.time.0.saturating_sub(self.state.progress.since.0) >= SECOND
            || self.is_edge(sample.time);
        if is_over {
            self.second(sample.time);
        }
        is_over
    }

    /// Freezes the start frame at the beginning of the first sample.
    #[cold]
    fn begin(&mut self, first: Instant) {
        let start = Instant(first.0.saturating_sub(self.period));
        self.state.begun = Some(start);
        self.state.last = start;
        self.state.strapdown = Strapdown::since(start);
        self.restart(start);
    }

    /// Detects a gap before a sample.
    #[inline]
    fn watch(&mut self, sample: &InertialSample) {
        let elapsed = sample.time.0.saturating_sub(self.state.last.0);
        if elapsed > self.gap {
            self.bridge(sample, elapsed as f64 * 1e-6);
        }
        self.state.last = sample.time;
    }

    /// Bridges a gap that ends with a sample this long after the one before it, s.
    #[cold]
    fn bridge(&mut self, sample: &InertialSample, elapsed: f64) {
        let at = Seconds(self.state.last.seconds());
        let gap = Refusal::RotationMissing { at, seconds: Seconds(elapsed) };
        let period = self.period as f64 * 1e-6;
        let missing = elapsed - period;
        self.state.missing += missing;
        if missing > LONGEST_GAP {
            return self.lose(gap);
        }
        let before = self.state.strapdown.carried.lost;
        let times = [missing as f32, period as f32];
        self.state.strapdown.bridge(sample, times, self.walk, self.state.is_at_rest);
        let variance = self.state.strapdown.carried.lost - before;
        if self.state.gap.is_none_or(|(greatest, _)| variance > greatest) {
            self.state.gap = Some((variance, gap));
        }
    }

    /// Stores the first loss.
    #[cold]
    fn lose(&mut self, loss: Refusal) {
        self.state.loss.get_or_insert(loss);
    }

    /// Loss of rotation by which no azimuth with this 1σ, rad, can be found any more.
    pub(super) fn loss(&self, required: f64) -> Option<Refusal> {
        let most = required.min(GREATEST_LOSS);
        let lost = f64::from(self.state.strapdown.carried.lost);
        let gap = self.state.gap.filter(|_| lost > most * most).map(|(_, gap)| gap);
        self.state.loss.or(gap)
    }

    /// The gap that contributes most to an azimuth's 1σ, rad, of which gaps are the cause.
    pub(super) fn cause(&self, sigma: f64) -> Option<Refusal> {
        self.loss(libm::sqrt(CAUSE) * sigma)
    }

    /// Whether a configured stop begins or ends with this sample.
    fn is_edge(&self, now: Instant) -> bool {
        let Rests::Stated(stops) = &self.rests else { return false };
        let (now, half) = (now.0, self.period / 2);
        let is_near = |edge: &Seconds| {
            let edge = Instant::from_seconds(edge.0).0;
            now + half >= edge && now + half < edge + self.period
        };
        stops.iter().flatten().any(is_near)
    }

    /// Begins a second.
    fn restart(&mut self, now: Instant) {
        let begin = self.state.strapdown.carried;
        self.state.progress = Progress { since: now, begin };
    }

    /// Ends the second, and tests the window.
    #[inline(never)]
    fn second(&mut self, now: Instant) {
        self.state.strapdown.update(now);
        let second = self.whole_second(now);
        if self.window.is_full() {
            self.leave();
        }
        // The oldest second was removed, so the push cannot fail.
        let _ = self.window.push_back(second);
        self.state.criteria = self.judge();
        match &self.rests {
            Rests::Whole => self.stay(Some(0)),
            Rests::Stated(stops) => {
                let half = 0.5e-6 * self.period as f64;
                let is_in = |[from, to]: &[Seconds; 2]| {
                    second.from >= from.0 - half && second.to <= to.0 + half
                };
                let stop = stops.iter().position(is_in);
                self.stay(stop);
            }
            Rests::Found => self.find(),
        }
        self.restart(now);
    }

    /// Removes the oldest second of the window; if it belongs to no stop it becomes part of a
    /// drive.
    fn leave(&mut self) {
        let Some(second) = self.window.pop_front() else { return };
        let begun = self.stops.iter().take_while(|stop| stop.from.0 <= second.from).count();
        let Some((index, stop)) = self.stops.iter().enumerate().take(begun).next_back() else {
            return;
        };
        if !second.is_rest && second.force.is_some() && second.from >= stop.to.0 {
            self.drives.push(block(&second, second.start_force, index as u8));
        }
    }

    /// Assigns the latest second to a stop, if it lies in one.
    fn stay(&mut self, stop: Option<usize>) {
        self.state.is_at_rest = stop.is_some();
        if let Some(stop) = stop {
            self.rest(self.window.len() - 1, stop);
        }
    }

    /// Averages of the second that ends now.
    fn whole_second(&mut self, now: Instant) -> Second {
        let Progress { since, begin } = self.state.progress;
        let sums = self.state.strapdown.take();
        let swung = sums.swung();
        let Sums { turned, force, start_force, count, is_blown, is_interrupted, .. } = sums;
        let inverse = 1.0 / count.max(1) as f32;
        let mean = |sum: i64| sum as f64 * 1e-6 / f64::from(count);
        Second {
            from: since.seconds(),
            to: now.seconds(),
            turned,
            swung,
            force: (count > 0 && !is_interrupted).then(|| force.map(mean)),
            start_force: start_force.map(|sum| sum * inverse),
            is_blown,
            is_rest: false,
            begin,
            end: self.state.strapdown.carried,
            rate: self.state.strapdown.rate(),
        }
    }

    /// Criteria of the window, once it is full and has forces.
    fn judge(&self) -> Option<Criteria> {
        let (mut turned, mut seconds, mut force, mut count) = ([0i64; 3], 0.0, [0.0; 3], 0.0);
        for second in &self.window {
            turned = sum(&turned, &second.turned);
            seconds += second.seconds();
            force = sum(&force, &second.force.unwrap_or_default());
            count += f64::from(u8::from(second.force.is_some()));
        }
        let rate = length(&turned.map(|sum| sum as f64 * AngleIncrement::STEP)) / seconds;
        let force = length(&scaled(&force, 1.0 / count));
        (self.window.is_full() && count > 0.0).then(|| Criteria::of(rate, force, self.gravity))
    }

    /// Detects the beginning or the end of a stop.
    fn find(&mut self) {
        let is_rest = self.state.criteria.is_some_and(|criteria| criteria.is_rest(&self.limits));
        self.state.held = if is_rest { self.state.held + 1 } else { 0 };
        match (self.state.is_at_rest, is_rest) {
            // A rocking vehicle may by chance be back at its attitude of ten seconds before.
            (false, true) if self.state.held <= DELAY => {}
            (false, true) => self.stand(),
            (true, true) => self.rest(WINDOW - 1 - LATEST, self.stops.len().saturating_sub(1)),
            (true, false) => self.set_off(),
            (false, false) => {}
        }
    }

    /// Begins a stop with the window, which is past the delay, or continues the previous one: a
    /// drive fails the criteria for at least their averaging time.
    fn stand(&mut self) {
        let now = self.window.back().map_or(0.0, |second| second.to);
        let last = self.stops.last().map_or(f64::NEG_INFINITY, |stop| stop.to.0);
        let goes_on = now - last < (WINDOW + DELAY + LATEST) as f64;
        let stop = self.stops.len() - usize::from(goes_on);
        // Further seconds are added to the last stop, so there must be one for this.
        self.state.is_at_rest = stop < STOPS;
        let first = if goes_on { 0 } else { self.rocking() };
        for index in first..WINDOW - LATEST {
            let is_new = self.window.iter().nth(index).is_some_and(|second| second.from >= last);
            if is_new {
                self.rest(index, stop);
            }
        }
    }

    /// Number of seconds at the beginning of the window in which a vehicle that stopped still rocks. Between both ends of a
    /// stop it would have turned by more than the Earth.
    fn rocking(&self) -> usize {
        let power = |second: &Second| second.swung.iter().map(|angle| angle * angle).sum::<f32>();
        let quiet = self.window.iter().rev().take(QUIET).map(power).sum::<f32>() / QUIET as f32;
        let rocks = |second: &&Second| power(second) > ROCKING * quiet;
        self.window.iter().take(WINDOW - LATEST - 1).take_while(rocks).count()
    }

    /// Ends a stop, and discards it if it was shorter than the criteria's average: a halt at a
    /// crossing.
    fn set_off(&mut self) {
        self.state.is_at_rest = false;
        let Some(last) = self.stops.last().map(Stop::seconds) else { return };
        if last.0 < WINDOW as f64 {
            self.stops.pop();
            self.blocks.discard(self.stops.len());
            self.state.fleeting = self.state.fleeting.max(last.0);
        }
    }

    /// Assigns a second of the window to a stop.
    fn rest(&mut self, index: usize, stop: usize) {
        let before = index.checked_sub(1).and_then(|before| self.window.iter().nth(before));
        let before = before.filter(|before| before.is_rest);
        let begun = before.map(|before| (before.to, before.swing()));
        let Some(second) = self.window.iter_mut().nth(index) else { return };
        second.is_rest = true;
        let mut second = *second;
        let is_relieved = self.state.lever.relieve(&mut second, begun);
        if stop >= self.stops.len() {
            let displacement = self.stops.is_empty().then_some([Metres(0.0); 2]);
            let (from, begin) = (second.from, second.begin);
            let begun = Stop { from: Seconds(from), begin, displacement, ..Stop::default() };
            if self.stops.push(begun).is_err() {
                return;
            }
        }
        let last = self.stops.len() - 1;
        self.stops[last].take(&second, &mut self.state.course);
        if let Some(force) = second.block_force().filter(|_| is_relieved) {
            self.blocks.push(block(&second, force, last as u8));
        }
    }

    /// Criteria of the last ten seconds, and their limits.
    pub(super) fn criteria(&self) -> Option<(Criteria, Limits)> {
        self.state.criteria.map(|criteria| (criteria, self.limits))
    }

    /// Sets the position of the last stop, north and east of the first.
    pub(super) fn displace(&mut self, displacement: [Metres; 2]) {
        if let Some(stop) = self.stops.last_mut() {
            stop.displacement = Some(displacement);
        }
    }

    /// Time from the beginning of the first sample to the end of the last one without gaps, s; zero
    /// without samples.
    pub(super) fn elapsed(&self) -> f64 {
        let begun = self.state.begun.unwrap_or(self.state.last);
        self.state.last.0.saturating_sub(begun.0) as f64 * 1e-6 - self.state.missing
    }

    /// Beginning of the first sample, s.
    pub(super) fn start(&self) -> f64 {
        self.state.begun.map_or(0.0, Instant::seconds)
    }

    /// Brings attitude and sensitivities to the end of the last sample.
    pub(super) fn update(&mut self) {
        self.state.strapdown.update(self.state.last);
    }

    /// Time of the latest update, s, with attitude and sensitivities then.
    pub(super) fn now(&self) -> (f64, Carried) {
        (self.state.last.seconds(), self.state.strapdown.carried)
    }
}

/// Converts a second to a block of a stop.
fn block(second: &Second, force: [f32; 3], stop: u8) -> Block {
    let Second { begin, end, .. } = second;
    Block {
        middle: 0.5 * (second.from + second.to),
        seconds: second.seconds() as f32,
        force,
        attitude: mean(&begin.attitude.rough_matrix(), &end.attitude.rough_matrix()),
        bias: mean(&begin.bias, &end.bias),
        lost: 0.5 * (begin.lost + end.lost),
        stop,
    }
}

/// Mean of two matrices.
fn mean(a: &Rough, b: &Rough) -> Rough {
    combined(a, b, |a, b| 0.5 * (a + b))
}
