//! What an execution shows: observed while it goes on, and told as one object.

use std::collections::BTreeMap;

use serde::Serialize;

use crate::measure::{Origin, Origins, Snapshot};
use crate::probe::Line;
use crate::run::{Execution, Order};
use crate::time::Time;

/// What an execution showed.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The carrier.
    pub carrier: &'static str,
    /// Seed of the world.
    pub seed: u64,
    /// Cycles that an instruction takes.
    pub cycles_per_instruction: f64,
    /// The azimuth with its 1σ and limit, °; none where there is none.
    pub azimuth_deg: Option<[f64; 3]>,
    /// The true azimuth at its time, °.
    pub truth_deg: f64,
    /// The last line of the log that says how the alignment ended, or else the last line.
    pub outcome: String,
    /// Time from power-on to the result, s.
    pub seconds: f64,
    /// Time from power-on to the first line of the log, s.
    pub start_seconds: f64,
    /// Samples, of all converters together, between the first and the last step of the measurement.
    pub samples: u64,
    /// Instructions for each of these samples, all in.
    pub instructions_per_sample: f64,
    /// Where they go, for each sample.
    pub instructions_by_origin: BTreeMap<Origin, f64>,
    /// Part of the time between these steps that the core was asleep.
    pub idle: f64,
    /// How conversions were served until the last step of the measurement, from there to the result, and after it.
    pub service: [Service; 3],
    /// Notices of the log although nothing is wrong, by their words.
    pub false_notices: BTreeMap<String, u64>,
    /// Faults that the link counts at the end.
    pub faults: u64,
    /// Bytes that the stack took at its deepest.
    pub stack_bytes: u32,
    /// Bytes of flash.
    pub flash_bytes: usize,
    /// Bytes of static RAM.
    pub static_bytes: u32,
    /// The longest time with interrupts off: at the start, and after it, s.
    pub masked_seconds: [f64; 2],
    /// What was done to chips and buses that data sheets forbid.
    pub violations: Vec<String>,
    /// Rows of flash that were programmed, and pages that were erased.
    pub flash_use: [u64; 2],
}

/// How conversions were served for some time.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Service {
    /// Conversions that were read.
    pub read: u64,
    /// Conversions that a newer one replaced before they were read.
    pub lost: u64,
    /// The longest time for which one waited to be read, s.
    pub longest_wait_seconds: f64,
}

impl Service {
    /// Adds what came later.
    fn add(&mut self, later: Self) {
        self.read += later.read;
        self.lost += later.lost;
        self.longest_wait_seconds = self.longest_wait_seconds.max(later.longest_wait_seconds);
    }
}

/// Words of lines that notice something wrong, of which nothing is.
const NOTICES: [&str; 12] = [
    "missing",
    "beside its time",
    "starting it again",
    "beside its target",
    "given up",
    "drove on",
    "overflow",
    "without forces",
    "coasting",
    "bus error",
    "no motion is measured",
    "cannot be",
];

/// Words with which the steps of a measurement begin or contain.
const STEPS: [&str; 4] = ["dwell ", "turn ", "levelled for", "found after"];

/// A moment of an execution.
#[derive(Clone, Debug, Default)]
struct Moment {
    /// What was executed until then.
    executed: Snapshot,
    /// Conversions that were read.
    read: u64,
    /// Time since the supply came up.
    time: Time,
    /// Time asleep.
    asleep: Time,
}

/// What is observed while an image is executed.
#[derive(Default)]
pub struct Observation {
    /// The steps of the measurement.
    steps: Vec<Moment>,
    /// Conversions that were read, and that were lost, until now.
    conversions: (u64, u64),
    /// As [`Report::service`]; the second is what came since the latest step, which may be the last.
    service: [Service; 3],
    /// As [`Report::false_notices`].
    notices: BTreeMap<String, u64>,
    /// As [`Report::azimuth_deg`].
    azimuth_deg: Option<[f64; 3]>,
    /// As [`Report::outcome`].
    outcome: String,
    /// When the alignment ended.
    ended: Option<Time>,
    /// When the first line of the log came, and the longest time with interrupts off until then.
    first: Option<(Time, Time)>,
    /// What the link has sent.
    link: Vec<u8>,
}

impl Observation {
    /// When the execution is to end.
    pub fn end(&self, order: &Order) -> Time {
        let afterwards = Time::seconds(order.afterwards);
        self.ended.map_or(Time::seconds(order.longest), |ended| ended + afterwards)
    }

    /// Looks how conversions were served since the last look.
    pub fn look(&mut self, execution: &Execution) {
        let served = execution.processor.with_controller(|controller| controller.wiring.served());
        let lost = execution.world.carrier.borrow().lost();
        let before = std::mem::replace(&mut self.conversions.1, lost);
        self.conversions.0 += served.read;
        self.service[if self.ended.is_some() { 2 } else { 1 }].add(Service {
            read: served.read,
            lost: lost - before,
            longest_wait_seconds: served.longest.0.as_seconds(),
        });
    }

    /// Reads a line of the log.
    pub fn read(&mut self, line: &Line, execution: &Execution) {
        let now = execution.processor.now();
        if self.first.is_none() {
            self.first = Some((now, execution.processor.counts().masked.0));
            execution.processor.forget_masked();
        }
        if let Some(words) = NOTICES.iter().find(|words| line.words.contains(**words)) {
            *self.notices.entry((*words).to_owned()).or_insert(0) += 1;
        }
        if self.ended.is_none() {
            self.outcome.clone_from(&line.words);
            if is_step(&line.words) {
                self.steps.push(self.moment(execution));
                let since_latest = std::mem::take(&mut self.service[1]);
                self.service[0].add(since_latest);
            }
            if line.words.starts_with("azimuth ") || line.words.starts_with("no azimuth") {
                self.azimuth_deg = azimuth_deg(&line.words);
                self.ended = Some(now);
            }
        }
    }

    /// Hears what the link sends.
    pub fn hear(&mut self, bytes: &[u8]) {
        self.link.extend(bytes);
    }

    /// This moment.
    fn moment(&self, execution: &Execution) -> Moment {
        Moment {
            executed: execution.processor.with_blocks(Snapshot::of),
            read: self.conversions.0,
            time: execution.processor.now(),
            asleep: execution.processor.counts().asleep,
        }
    }

    /// The report of an execution that has ended.
    pub fn report(self, order: &Order, execution: &Execution) -> Report {
        let now = self.moment(execution);
        let start = Moment::default();
        let (first, last) = match &self.steps[..] {
            [first, .., last] => (first, last),
            _ => (&start, &now),
        };
        let samples = (last.read - first.read) / execution.world.converters();
        let by_origin = instructions(execution, [first, last], samples);
        let ended = self.ended.unwrap_or(now.time);
        let (first_line, masked_at_start) = self.first.unwrap_or((now.time, Time::ZERO));
        let masked = [masked_at_start, execution.processor.counts().masked.0];
        let used = execution.processor.with_controller(|controller| controller.flash.used);
        Report {
            carrier: order.carrier.name(),
            seed: order.seed,
            cycles_per_instruction: order.cycles,
            azimuth_deg: self.azimuth_deg,
            truth_deg: (execution.world.truth_deg)(ended.instant()),
            seconds: ended.as_seconds(),
            start_seconds: first_line.as_seconds(),
            samples,
            instructions_per_sample: by_origin.values().sum(),
            instructions_by_origin: by_origin,
            idle: (last.asleep - first.asleep).as_seconds() / (last.time - first.time).as_seconds(),
            service: self.service,
            faults: faults(&String::from_utf8_lossy(&self.link)),
            outcome: self.outcome,
            false_notices: self.notices,
            stack_bytes: execution.stack_bytes(),
            flash_bytes: execution.image.flash.len(),
            static_bytes: execution.image.static_bytes,
            masked_seconds: masked.map(Time::as_seconds),
            violations: violations(execution),
            flash_use: [used.rows, used.pages],
        }
    }
}

/// Whether a line is a step of the measurement.
fn is_step(words: &str) -> bool {
    STEPS.iter().any(|step| words.starts_with(step) || words.contains(&format!(" {step}")))
}

/// Azimuth, σ and limit of a line that concludes, °.
fn azimuth_deg(words: &str) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = words
        .split(|c: char| !(c.is_ascii_digit() || c == '.'))
        .filter_map(|number| number.parse().ok())
        .collect();
    match (words.starts_with("azimuth "), &numbers[..]) {
        // The number in "1σ" stands between.
        (true, [azimuth, sigma, _, limit, ..]) => Some([*azimuth, *sigma, *limit]),
        _ => None,
    }
}

/// Instructions of each of these samples between two moments, by their origin.
fn instructions(
    execution: &Execution,
    [first, last]: [&Moment; 2],
    samples: u64,
) -> BTreeMap<Origin, f64> {
    let mut origins = Origins::new(&execution.image);
    let sums = execution
        .processor
        .with_blocks(|blocks| last.executed.since(&first.executed, blocks, &mut origins));
    sums.into_iter().map(|(origin, sum)| (origin, sum as f64 / samples.max(1) as f64)).collect()
}

/// The faults that the last line of the link counts.
fn faults(link: &str) -> u64 {
    let mut counts =
        link.lines().filter_map(|line| line.rsplit("faults ").next()?.trim().parse().ok());
    counts.next_back().unwrap_or(0)
}

/// What was done to chips and buses that data sheets forbid.
fn violations(execution: &Execution) -> Vec<String> {
    let mut violations = execution.world.carrier.borrow_mut().violations();
    violations.extend(execution.processor.with_controller(|controller| controller.wiring.faults()));
    violations
}
