//! What is observed of an image while it is executed, up to the report of it.

use std::collections::{BTreeMap, BTreeSet};

use execution::report::{Origin, Report, Service};

use crate::measure::{Origins, Snapshot};
use crate::probe::Line;
use crate::run::{Execution, Order};
use crate::time::Time;

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
    /// When the first line of the log came, and the longest time with interrupts held back until then.
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
        Report {
            carrier: order.carrier.name().to_owned(),
            seed: order.seed,
            cycles_per_instruction: order.cycles,
            azimuth_deg: self.azimuth_deg,
            truth_deg: (execution.world.truth_deg)(ended.instant()),
            seconds: ended.as_seconds(),
            start_seconds: first_line.as_seconds(),
            resets: resets(execution),
            samples,
            instructions_per_sample: (samples > 0).then(|| by_origin.values().sum()),
            instructions_by_origin: by_origin,
            idle: (last.asleep - first.asleep).as_seconds() / (last.time - first.time).as_seconds(),
            service: self.service,
            faults: faults(&String::from_utf8_lossy(&self.link)),
            outcome: self.outcome,
            false_notices: self.notices,
            stack_bytes: execution.stack_bytes(),
            flash_bytes: execution.image.flash.len() as u32,
            static_bytes: execution.image.static_bytes,
            masked_seconds: masked.map(Time::as_seconds),
            violations: violations(execution),
            flash_use: execution.processor.with_controller(|controller| controller.flash.used),
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

/// The faults that the last sentence of the link counts that has the instrument's state.
fn faults(link: &str) -> u64 {
    let counts = link.lines().filter_map(|line| line.strip_prefix("$PMRDS,")?.split(',').nth(4));
    counts.filter_map(|count| count.parse().ok()).next_back().unwrap_or(0)
}

/// Why the board was reset, each time.
fn resets(execution: &Execution) -> Vec<String> {
    let resets = execution.processor.with_controller(|controller| controller.resets.clone());
    resets.into_iter().map(|reason| format!("{reason:?}")).collect()
}

/// What was done to chips and buses that data sheets forbid, and a stack that ran into the statics.
fn violations(execution: &Execution) -> Vec<String> {
    let mut violations = execution.world.carrier.borrow_mut().violations();
    violations.extend(execution.processor.with_controller(|controller| controller.wiring.faults()));
    let end = execution.image.stack_end;
    if execution.processor.counts().lowest_stack.is_some_and(|lowest| lowest < end) {
        violations.push("the stack reached the statics".to_owned());
    }
    violations
}
