//! What a method makes of samples, from the first to the last.

use orientation::roll::{Method, Setting, Spin, State};
use orientation::signal::SpinSample;

use crate::output::degrees;
use crate::report::POINTS;

/// What is known at one sample.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// When, s from the first sample.
    pub time_s: f64,
    /// The roll, rad, whole turns counted.
    pub roll_rad: f64,
    /// 1σ of the roll, rad, where it is known.
    pub sigma_rad: Option<f64>,
    /// The gyro's scale error and its 1σ, where the method finds it.
    pub scale: Option<[f64; 2]>,
    /// The lift, m/s², where the method finds it.
    pub lift: Option<f64>,
    /// What the method is doing.
    pub state: State,
}

impl Point {
    /// What a method knows after a sample.
    fn of(spin: &Spin, sample: &SpinSample) -> Self {
        Self {
            time_s: sample.time.seconds(),
            roll_rad: spin.roll().rad(),
            sigma_rad: spin.sigma().map(|sigma| sigma.0),
            scale: spin.scale(),
            lift: spin.lift().map(|lift| lift.0),
            state: spin.state(),
        }
    }
}

/// How a method went through samples.
#[derive(Clone, Debug)]
pub struct Track {
    /// Method that made the track.
    pub method: Method,
    /// The roll at each sample, rad.
    pub rolls_rad: Vec<f64>,
    /// 1σ of the roll at each sample, rad; not a number where it is not known.
    pub sigmas_rad: Vec<f64>,
    /// When each sample was taken, s.
    pub times_s: Vec<f64>,
    /// Some samples, evenly spread.
    pub points: Vec<Point>,
    /// Where the state changed: its text without numbers, and when, s.
    pub states: Vec<(f64, State)>,
    /// The numbers of the samples that brought a correction.
    pub corrections: Vec<usize>,
    /// The last sample.
    pub end: Point,
}

impl Track {
    /// Tracks the roll through samples.
    pub(crate) fn of(setting: &Setting, samples: &[SpinSample]) -> Self {
        let every = (samples.len() / POINTS).max(1);
        let mut spin = Spin::new(setting);
        let mut track = Self {
            method: setting.method,
            rolls_rad: Vec::with_capacity(samples.len()),
            sigmas_rad: Vec::with_capacity(samples.len()),
            times_s: Vec::with_capacity(samples.len()),
            points: Vec::new(),
            states: Vec::new(),
            corrections: Vec::new(),
            end: Point::of(&spin, &SpinSample::default()),
        };
        for (index, sample) in samples.iter().enumerate() {
            if spin.push(sample).is_some() {
                track.corrections.push(index);
            }
            track.take(Point::of(&spin, sample), index % every == 0);
        }
        track
    }

    /// Time, s, and an angle, °, of each sample.
    pub(crate) fn over_time(&self, angles_rad: &[f64]) -> Vec<(f64, f64)> {
        self.times_s.iter().copied().zip(angles_rad.iter().copied().map(degrees)).collect()
    }

    fn take(&mut self, point: Point, is_kept: bool) {
        self.rolls_rad.push(point.roll_rad);
        self.sigmas_rad.push(point.sigma_rad.unwrap_or(f64::NAN));
        self.times_s.push(point.time_s);
        let condition = point.state.condition;
        if self.states.last().is_none_or(|(_, state)| state.condition != condition) {
            self.states.push((point.time_s, point.state));
        }
        if is_kept {
            self.points.push(point);
        }
        self.end = point;
    }
}
