//! A gyro's record at rest, read once from its beginning to its end, in memory that does not grow with it.
//!
//! One thread reads and parses, another looks at the numbers and sums the Allan variances.

use std::panic::resume_unwind;
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;

use orientation::noise::allan::Point;
use orientation::noise::fit::FitError;
use orientation::units::{AngularRate, DEGREE, DEGREE_PER_SQRT_HOUR};
use thiserror::Error;

use super::Overlapping;
use super::spike::{Spike, Spikes};
use crate::interrupt;
use crate::output::significant;
use crate::recording::{
    Gap, Kind, Opened, ReadError, RestRows, Short, Spacer, Spacing, StaticRow, Unsteady, Warning,
    are_milliseconds,
};

/// Rows from which the usual step between samples is learnt.
pub const LEARNT: usize = 1 << 20;
/// Samples that go from thread to thread at once.
const BATCH: usize = 4096;
/// Batches that wait for the other thread.
const WAITING: usize = 8;
/// Mean rate of a gyro at rest, rad/s, and angle random walk, °/√h, beyond which no gyro is made: 20 °/s and 30 °/√h.
const MOST_BIAS: f64 = 20.0 * DEGREE;
const MOST_WALK: f64 = 30.0;

/// The rate in a row, where it has that column.
type RateOf = fn(&StaticRow) -> Option<f64>;

/// The column of a single gyro, or one that is named.
const SINGLE: (&str, RateOf) = ("g_rad_s", |row| row.rate_rad_s);
/// The column that is taken of an inertial measurement unit.
const AHEAD: (&str, RateOf) = ("gx_rad_s", |row| row.imu.map(|imu| imu.rates_rad_s[0]));

/// What the rates of one column at rest came to.
#[derive(Clone, Debug)]
pub struct Rest {
    /// The column's name.
    pub column: String,
    /// When the samples came.
    pub spacing: Spacing,
    /// How many samples there are in all segments.
    pub samples: u64,
    /// Their overlapping Allan variances, (rad/s)², rising in averaging time.
    pub points: Vec<Point>,
    survey: Survey,
}

/// Why a recording has no rates at rest.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RestError {
    /// The recording cannot be read.
    #[error("{0}")]
    Read(ReadError),
    /// The recording is of another kind.
    #[error("kind `{0}` is no record at rest; record the gyro at rest as kind `static`")]
    Kind(Kind),
    /// There is but one row.
    #[error("record too short: one row has no time between samples")]
    OneRow,
    /// The samples have no period in common.
    #[error("{0}")]
    Unsteady(Unsteady),
}

impl Rest {
    /// Reads a column of a recording to its end: the one that was named, else the gyro's, else that of body x. `warnings`
    /// takes what is passed over.
    ///
    /// # Errors
    /// Why there are no rates.
    pub fn read(opened: Opened<'_>, warnings: &mut Vec<Warning>) -> Result<Self, RestError> {
        let mut rows = match opened {
            Opened::AtRest(rows) => rows,
            Opened::Other(kind, passed_over) => {
                warnings.extend(passed_over);
                return Err(RestError::Kind(kind));
            }
        };
        let rest = Self::of(&mut rows);
        warnings.append(&mut rows.warnings);
        rest
    }

    fn of(rows: &mut RestRows<'_>) -> Result<Self, RestError> {
        let mut first = None;
        rows.read(1, |row| first = Some(row)).map_err(RestError::Read)?;
        let (usual, rate) = chosen(first.as_ref());
        let column = rows.column().unwrap_or(usual).to_owned();
        let gathered = gathered(rows, first, rate).map_err(RestError::Read)?;
        gathered.finish(column, rows.header.rate_hz)
    }

    /// That reading was interrupted, and after how many rows, where it was.
    #[must_use]
    pub fn interruption(&self) -> Option<String> {
        let rows = self.samples;
        let why = || format!("interrupted at {rows} rows: they are all that is analysed");
        interrupt::ended().map(|_| why())
    }

    /// The sample that stands far from its neighbours, where one does.
    #[must_use]
    pub fn spike(&self) -> Option<Spike> {
        self.survey.spikes.found(self.step())
    }

    /// That the rates are in another unit, as it seems, and what to do about it.
    fn unit_note(&self) -> Option<String> {
        let (column, why) = (&self.column, self.other_unit()?);
        Some(format!(
            "{column} was read in rad/s, as every rate is, but {why}: multiply it by 0.0174532925 where it is in °/s, by \
             4.84813681e-6 where it is in °/h, or name a column in rad/s by --column"
        ))
    }

    /// What says that the rates are not in rad/s: the column's name, or a mean and a noise at rest that no gyro has.
    fn other_unit(&self) -> Option<String> {
        let name = self.column.to_lowercase();
        if ["deg", "dps", "°"].iter().any(|unit| name.contains(unit)) {
            return Some("its name says degrees".to_owned());
        }
        let (mean, white) = (self.mean(), self.points.first()?);
        let walk = (white.variance * white.seconds.0).sqrt() / DEGREE_PER_SQRT_HOUR;
        let is_likely = mean.abs() <= MOST_BIAS && walk <= MOST_WALK;
        let [mean, walk] = [mean / DEGREE, walk].map(|number| significant(number, 3));
        let words = || {
            format!(
                "its mean of {mean} °/s and its N of about {walk} °/√h are those of no gyro at rest"
            )
        };
        (!is_likely).then(words)
    }

    /// What a reader must know of the record: an interruption, units that cannot be, a header's rate that is wrong, gaps, and
    /// a sample far from all others.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let units = [self.spacing.unit_note(), self.unit_note()];
        let rest = [self.rate_note(), self.gap_note(), self.spike_note()];
        self.interruption().into_iter().chain(units.into_iter().chain(rest).flatten()).collect()
    }

    /// What says that times or rates may be in another unit, so that every number is wrong.
    #[must_use]
    pub fn unit_notes(&self) -> Vec<String> {
        let times = self.rate_note().filter(|_| self.are_milliseconds());
        [self.spacing.unit_note(), self.unit_note(), times].into_iter().flatten().collect()
    }

    /// Whether the header's rate says that the times are in milliseconds.
    fn are_milliseconds(&self) -> bool {
        let stated = self.spacing.contradicted_rate_hz;
        stated.is_some_and(|stated| are_milliseconds(stated, 1.0 / self.spacing.period_s))
    }

    /// That the header's rate is not that of the times.
    fn rate_note(&self) -> Option<String> {
        let (stated, found) = (self.spacing.contradicted_rate_hz?, 1.0 / self.spacing.period_s);
        let unit = if self.are_milliseconds() {
            "; t_s was read in s, and is in ms, as it seems: divide it by 1000"
        } else {
            ""
        };
        let stated = Short(stated);
        Some(format!(
            "the header's {stated} Hz contradicts the times, which have {found:.6} Hz: the times are believed{unit}"
        ))
    }

    /// Where samples are missing.
    fn gap_note(&self) -> Option<String> {
        let Spacing { gaps, gap_count, missing_s, .. } = &self.spacing;
        let Gap { line, from_s, .. } = gaps.first()?;
        let gaps = if *gap_count == 1 { "gap" } else { "gaps" };
        Some(format!(
            "{gap_count} {gaps}, {missing_s:.3} s in all, the first before line {line} after {from_s} s: no window crosses one"
        ))
    }

    /// That a sample stands far from its neighbours.
    fn spike_note(&self) -> Option<String> {
        let Spike { line, off, sigmas } = self.spike()?;
        let off = significant((off / DEGREE).abs(), 3);
        Some(format!(
            "line {line}: one sample is {sigmas:.0} σ off its neighbours, {off} °/s: the coefficients hold it, too; leave the \
             row out if it is no motion of the gyro"
        ))
    }

    /// The mean rate, rad/s.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.survey.sum / self.samples as f64
    }

    /// Why nothing can be said whatever the variances are.
    pub(super) fn check(&self) -> Result<(), FitError> {
        let Survey { is_saturated, is_constant, .. } = self.survey;
        match (is_saturated, is_constant) {
            (true, _) => Err(FitError::Saturated),
            (false, true) if self.samples > 1 => Err(FitError::Constant),
            _ => Ok(()),
        }
    }

    /// The smallest change between neighbouring samples, rad/s: in a record of noise, the step of the
    /// numbers it came in.
    pub(super) fn step(&self) -> f64 {
        self.survey.step
    }
}

/// The column whose rate is taken, by what a row has.
fn chosen(first: Option<&StaticRow>) -> (&'static str, RateOf) {
    let is_single = first.is_none_or(|row| row.rate_rad_s.is_some());
    if is_single { SINGLE } else { AHEAD }
}

/// One rate of a row.
#[derive(Clone, Copy, Debug)]
struct Sample {
    line: u64,
    time_s: f64,
    /// rad/s.
    rate: f64,
}

/// Reads to the end on this thread while another one gathers.
fn gathered(
    rows: &mut RestRows<'_>,
    first: Option<StaticRow>,
    rate: RateOf,
) -> Result<Gatherer, ReadError> {
    thread::scope(|scope| {
        let (full, taken) = sync_channel(WAITING);
        let (emptied, empty) = channel();
        let gatherer = scope.spawn(move || Gatherer::of(&taken, &emptied));
        let read = send(rows, first, rate, full, &empty);
        let gatherer = gatherer.join().unwrap_or_else(|panic| resume_unwind(panic));
        read.map(|()| gatherer)
    })
}

/// Sends the samples of all rows in batches, in vectors that come back empty.
fn send(
    rows: &mut RestRows<'_>,
    first: Option<StaticRow>,
    rate: RateOf,
    full: SyncSender<Vec<Sample>>,
    empty: &Receiver<Vec<Sample>>,
) -> Result<(), ReadError> {
    let sample = |row: StaticRow| {
        let StaticRow { line, time_s, .. } = row;
        rate(&row).map(|rate| Sample { line, time_s, rate })
    };
    let mut batch: Vec<Sample> = first.and_then(sample).into_iter().collect();
    let mut is_more = true;
    while is_more {
        is_more = rows.read(BATCH, |row| batch.extend(sample(row)))?;
        // The other thread listens for as long as this one speaks.
        let _ = full.send(batch);
        batch = empty.try_recv().unwrap_or_else(|_| Vec::with_capacity(BATCH));
    }
    drop(full);
    Ok(())
}

/// What is kept of the samples.
#[derive(Default)]
struct Gatherer {
    /// The first samples, until the usual step between them is learnt.
    first: Vec<Sample>,
    spacer: Option<Spacer>,
    survey: Survey,
    sums: Overlapping,
    samples: u64,
}

impl Gatherer {
    /// Gathers batches until no more come.
    fn of(taken: &Receiver<Vec<Sample>>, emptied: &Sender<Vec<Sample>>) -> Self {
        let mut gatherer = Self::default();
        for mut batch in taken {
            for sample in batch.drain(..) {
                gatherer.take(sample);
            }
            // After the last batch the reader has gone, and a vector that comes back is of no use.
            let _ = emptied.send(batch);
        }
        gatherer
    }

    fn take(&mut self, sample: Sample) {
        if let Some(spacer) = &mut self.spacer {
            if spacer.is_apart(sample.line, sample.time_s) {
                self.sums.part();
                self.survey.spikes.part();
            }
            self.survey.take(sample.line, sample.rate);
            self.sums.push(sample.rate);
            self.samples += 1;
            return;
        }
        self.first.push(sample);
        if self.first.len() == LEARNT {
            self.learn();
        }
    }

    /// Learns the usual step from the first samples, and then takes them.
    fn learn(&mut self) {
        let first = std::mem::take(&mut self.first);
        self.spacer = Spacer::learnt(first.iter().map(|sample| sample.time_s));
        if self.spacer.is_some() {
            for sample in first {
                self.take(sample);
            }
        }
    }

    /// What all samples came to.
    fn finish(mut self, column: String, rate_hz: Option<f64>) -> Result<Rest, RestError> {
        if self.spacer.is_none() {
            self.learn();
        }
        let Self { spacer, survey, sums, samples, .. } = self;
        let spacing = spacer.ok_or(RestError::OneRow)?.finish(rate_hz);
        let spacing = spacing.map_err(RestError::Unsteady)?;
        let points = sums.points(spacing.period_s);
        Ok(Rest { column, spacing, samples, points, survey })
    }
}

/// What tells an unusable record.
#[derive(Clone, Copy, Debug)]
struct Survey {
    /// Whether a sample stood at a limit of its range.
    is_saturated: bool,
    /// Whether all samples were equal.
    is_constant: bool,
    /// The smallest change between neighbouring samples, rad/s.
    step: f64,
    /// The latest sample, rad/s.
    latest: Option<f64>,
    /// The sum of all, rad/s.
    sum: f64,
    /// Samples far from their neighbours.
    spikes: Spikes,
}

impl Default for Survey {
    fn default() -> Self {
        let (latest, sum, spikes) = Default::default();
        Self { is_saturated: false, is_constant: true, step: f64::INFINITY, latest, sum, spikes }
    }
}

impl Survey {
    fn take(&mut self, line: u64, rate: f64) {
        self.sum += rate;
        self.spikes.take(line, rate);
        self.is_saturated |= AngularRate::from_rad_per_s(rate).is_saturated();
        let change = self.latest.replace(rate).map_or(0.0, |before| (rate - before).abs());
        if change > 0.0 {
            self.is_constant = false;
            self.step = self.step.min(change);
        }
    }
}
