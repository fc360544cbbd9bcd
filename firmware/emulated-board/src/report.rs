//! What an execution shows: observed while it goes on, and told as one object.

use std::collections::{BTreeMap, BTreeSet};

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
    /// Samples, of all converters together, between the first and the last step of the measurement; where it has not
    /// two of them, from when all chips were configured to the end.
    pub samples: u64,
    /// Instructions for each of these samples, all in; none where there is no sample.
    pub instructions_per_sample: Option<f64>,
    /// Where they go, for each sample; empty where there is none.
    pub instructions_by_origin: BTreeMap<Origin, f64>,
    /// Part of the time of these samples that the core was asleep.
    pub idle: f64,
    /// How conversions were served: from when all chips were configured to the last step of the measurement, or to its
    /// end where it has no steps; from there to the result; after it.
    pub service: [Service; 3],
    /// Notices of the log that are false, by their words: chips and world are sound. Of samples that are said to be
    /// missing, those beyond the conversions that each converter lost.
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
    /// Rows of flash that were programmed, pages that were erased, and those of the rows that were programmed with the
    /// data cache on.
    pub flash_use: [u64; 3],
}

/// How conversions were served for some time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Service {
    /// Conversions that were read.
    pub read: u64,
    /// Conversions that a newer one replaced before they were read.
    pub lost: u64,
    /// The longest time for which a converter waited to be read, s: from the end of the first conversion that was not
    /// read at once, whatever replaced it meanwhile, to the next reading, or to now, where it still waits.
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

/// Words of lines that blame chips, buses, the store or the clocks of converters, which are all sound. Lines that a
/// sound world gives reason for, or samples that the image has lost, are none: "coasting", "without forces" and the like.
const NOTICES: [&str; 6] =
    ["beside its time", "out of step", "starting it again", "given up", "bus error", "cannot be"];
/// Words of a line that says of a base that it moves, which is false of one at rest.
const MOVES: &str = "drove on";
/// Words after the number of samples that are said to be missing.
const MISSING: &str = "sample(s) missing";
/// Words after the name of a chip that is at work.
const CONFIGURED: &str = ": identity and self-test passed, configured";

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
    /// The chips that were configured, and when the last of them was for the first time.
    configured: (BTreeSet<String>, Moment),
    /// The steps of the measurement.
    steps: Vec<Moment>,
    /// Conversions that were read, and that were lost, until now.
    conversions: (u64, u64),
    /// As [`Report::service`]; the second is what came since the latest step, which may be the last.
    service: [Service; 3],
    /// As [`Report::false_notices`], with all samples that are said to be missing.
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
        let now = execution.processor.now();
        let served =
            execution.processor.with_controller(|controller| controller.wiring.served(now));
        let lost = execution.world.carrier.borrow().lost();
        let before = std::mem::replace(&mut self.conversions.1, lost);
        self.conversions.0 += served.read;
        let (wait, ended) = served.longest;
        self.service[if self.ended.is_some() { 2 } else { 1 }].add(Service {
            read: served.read,
            lost: lost - before,
            // Before all chips are configured, no conversion is wanted.
            longest_wait_seconds: wait.min(ended - self.configured.1.time).as_seconds(),
        });
    }

    /// Reads a line of the log.
    pub fn read(&mut self, line: &Line, execution: &Execution) {
        let now = execution.processor.now();
        if self.first.is_none() {
            self.first = Some((now, execution.processor.counts().masked.0));
            execution.processor.forget_masked();
        }
        if let Some((words, count)) = notice(&line.words, execution.world.is_at_rest) {
            *self.notices.entry(words.to_owned()).or_insert(0) += count;
        }
        if let Some(chip) = line.words.strip_suffix(CONFIGURED)
            && self.configured.0.insert(chip.to_owned())
        {
            self.configured.1 = self.moment(execution);
            self.service[1] = Service::default();
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

    /// Weighs what was counted, once all is: a measurement without steps lasts to its end, and of the samples that are
    /// said to be missing those are that each of so many converters lost.
    fn weigh(&mut self, converters: u64) {
        if self.steps.is_empty() {
            self.service.swap(0, 1);
        }
        let lost: u64 = self.service.iter().map(|service| service.lost).sum();
        if let Some(missing) = self.notices.get_mut(MISSING) {
            *missing = missing.saturating_sub(lost / converters);
        }
        self.notices.retain(|_, count| *count > 0);
    }

    /// The report of an execution that has ended.
    pub fn report(mut self, order: &Order, execution: &Execution) -> Report {
        let now = self.moment(execution);
        self.weigh(execution.world.converters());
        let (first, last) = match &self.steps[..] {
            [first, .., last] => (first, last),
            _ => (&self.configured.1, &now),
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
            instructions_per_sample: (samples > 0).then(|| by_origin.values().sum()),
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
            flash_use: [used.rows, used.pages, used.rows_with_cache_on],
        }
    }
}

/// The words of a line that may be false, and how often it says so.
fn notice(line: &str, is_at_rest: bool) -> Option<(&'static str, u64)> {
    if let Some((count, MISSING)) = line.split_once(' ') {
        return Some((MISSING, count.parse().unwrap_or(1)));
    }
    let mut all = NOTICES.into_iter().chain(is_at_rest.then_some(MOVES));
    all.find(|words| line.contains(words)).map(|words| (words, 1))
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

/// Instructions of each of these samples between two moments, by their origin; none where there is no sample.
fn instructions(
    execution: &Execution,
    [first, last]: [&Moment; 2],
    samples: u64,
) -> BTreeMap<Origin, f64> {
    if samples == 0 {
        return BTreeMap::new();
    }
    let mut origins = Origins::new(&execution.image);
    let sums = execution
        .processor
        .with_blocks(|blocks| last.executed.since(&first.executed, blocks, &mut origins));
    sums.into_iter().map(|(origin, sum)| (origin, sum as f64 / samples as f64)).collect()
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
