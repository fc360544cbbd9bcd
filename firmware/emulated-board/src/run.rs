//! An image from power-on to its result and beyond, with what is measured on the way.

use std::collections::BTreeMap;
use std::rc::Rc;

use firmware::platform::Platform;
use serde::Serialize;

use crate::controller::flash::STORE;
use crate::controller::rcc::Oscillators;
use crate::controller::{Controller, ResetReason};
use crate::image::Image;
use crate::measure::{Origin, Origins, Snapshot};
use crate::probe::{Line, Probe};
use crate::processor::{PAINT, Processor, Unknown};
use crate::time::Time;
use crate::world::World;

/// How often the probe looks, and the link is served.
const LOOK: Time = Time::microseconds(1000);

/// What is executed.
#[derive(Clone, Copy, Debug)]
pub struct Order {
    /// The carrier.
    pub carrier: Platform,
    /// Seed of the world.
    pub seed: u64,
    /// Cycles that an instruction takes, flash wait states included.
    pub cycles: f64,
    /// How long it goes on after its result, s.
    pub afterwards: f64,
    /// The longest time until a result, s.
    pub longest: f64,
    /// Whether the crystal of 32 768 Hz oscillates.
    pub has_crystal: bool,
}

impl Order {
    /// The usual order for a carrier: 1.4 cycles an instruction, ten seconds after the result.
    #[must_use]
    pub fn usual(carrier: Platform, seed: u64) -> Self {
        // A spinning body has no result; its flight takes two seconds after the start of its converters.
        let longest = if carrier == Platform::Spin { 5.0 } else { 240.0 };
        Self { carrier, seed, cycles: 1.4, afterwards: 10.0, longest, has_crystal: true }
    }
}

/// A board that is executed.
pub struct Execution {
    /// The core with its controller.
    pub processor: Processor,
    /// The world around it.
    pub world: World,
    image: Rc<Image>,
    probe: Probe,
}

impl Execution {
    /// A board in a world whose supply comes up.
    ///
    /// # Errors
    /// An image without a log, or what Unicorn says.
    pub fn new(image: &Rc<Image>, order: &Order, mut world: World) -> Result<Self, String> {
        let probe = Probe::new(&image.elf, image.log)?;
        let oscillators = Oscillators { has_crystal: order.has_crystal, msi_error: 0.0 };
        let mut controller = Controller::new(oscillators, order.seed, Box::new(world.board()));
        controller.flash.array.burn(STORE.start, &world.store);
        let processor = Processor::new(Rc::clone(image), controller, order.cycles);
        let mut processor = processor.map_err(|error| format!("Unicorn: {error:?}"))?;
        processor.poke(crate::RAM, &vec![PAINT; crate::RAM_BYTES]);
        Ok(Self { processor, world, image: Rc::clone(image), probe })
    }

    /// Goes on for a millisecond; the log's lines of it.
    ///
    /// # Errors
    /// What the model does not know.
    pub fn step(&mut self) -> Result<Vec<Line>, Unknown> {
        let until = self.processor.now() + LOOK;
        self.processor.run(until)?;
        let mut lines = Vec::new();
        self.probe.poll(&mut self.processor, |line| lines.push(line));
        Ok(lines)
    }

    /// Bytes that the stack took at its deepest.
    #[must_use]
    pub fn stack_bytes(&self) -> u32 {
        let Image { stack_start, stack_end, .. } = *self.image;
        let mut stack = vec![0; (stack_start - stack_end) as usize];
        self.processor.peek(stack_end, &mut stack);
        let untouched = stack.iter().take_while(|byte| **byte == PAINT).count();
        stack_start - stack_end - untouched as u32
    }

    /// Takes the supply of the controller away for a moment: RAM is lost, what is written into the flash is torn. The
    /// chips keep theirs.
    pub fn lose_supply(&mut self) {
        self.processor.reset(ResetReason::Supply);
    }
}

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

/// What is gathered while an image is executed.
#[derive(Default)]
struct Gathered {
    steps: Vec<(Snapshot, u64, Time, Time)>,
    /// Conversions that were read until now.
    samples: u64,
    /// As [`Report::service`]; the second is what came since the latest step, which may be the last.
    service: [Service; 3],
    /// Conversions that were lost until now.
    lost: u64,
    notices: BTreeMap<String, u64>,
    azimuth: Option<([f64; 3], Time)>,
    outcome: String,
    ended: Option<Time>,
    first: Option<Time>,
    masked_at_start: Time,
}

impl Gathered {
    /// Whether the line is a step of the measurement.
    fn is_step(words: &str) -> bool {
        STEPS.iter().any(|step| words.starts_with(step) || words.contains(&format!(" {step}")))
            && !words.starts_with("turns")
    }

    /// Takes a line of the log.
    fn take(&mut self, line: &Line, execution: &Execution) {
        let now = execution.processor.now();
        if self.first.is_none() {
            self.first = Some(now);
            self.masked_at_start = execution.processor.counts().masked.0;
            execution.processor.forget_masked();
        }
        if self.ended.is_none() {
            self.outcome.clone_from(&line.words);
        }
        if Self::is_step(&line.words) && self.ended.is_none() {
            let snapshot = execution.processor.with_blocks(Snapshot::of);
            self.steps.push((snapshot, self.samples, now, execution.processor.counts().asleep));
            let since_latest = std::mem::take(&mut self.service[1]);
            self.service[0].add(since_latest);
        }
        if let Some(words) = NOTICES.iter().find(|words| line.words.contains(**words)) {
            *self.notices.entry((*words).to_owned()).or_insert(0) += 1;
        }
        if self.ended.is_none()
            && (line.words.starts_with("azimuth ") || line.words.starts_with("no azimuth"))
        {
            self.azimuth = azimuth(&line.words).map(|azimuth| (azimuth, now));
            self.ended = Some(now);
        }
    }

    /// Takes how conversions were served in the last millisecond.
    fn look(&mut self, execution: &Execution) {
        let served = execution.processor.with_controller(|controller| controller.wiring.served());
        let lost = execution.world.carrier.borrow().lost();
        self.samples += served.read;
        self.service[if self.ended.is_some() { 2 } else { 1 }].add(Service {
            read: served.read,
            lost: lost - std::mem::replace(&mut self.lost, lost),
            longest_wait_seconds: served.longest.0.as_seconds(),
        });
    }
}

/// Azimuth, σ and limit of a line that concludes, °.
fn azimuth(words: &str) -> Option<[f64; 3]> {
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

/// Executes an image in a world to its result and some time beyond; lines of the log go to `on_line`, bytes of the link to
/// `on_link`, which may return what the other side sends.
///
/// # Errors
/// What the model does not know, or an image that is none.
pub fn execute(
    image: &Rc<Image>,
    order: &Order,
    world: World,
    mut on_line: impl FnMut(&Line),
    mut on_link: impl FnMut(&[u8]) -> Vec<u8>,
) -> Result<Report, String> {
    let mut execution = Execution::new(image, order, world)?;
    let (mut gathered, mut link) = (Gathered::default(), Vec::new());
    let end = |gathered: &Gathered| {
        gathered
            .ended
            .map_or(Time::seconds(order.longest), |ended| ended + Time::seconds(order.afterwards))
    };
    while execution.processor.now() < end(&gathered) {
        let lines = execution.step().map_err(|error| error.to_string())?;
        gathered.look(&execution);
        for line in &lines {
            on_line(line);
            gathered.take(line, &execution);
        }
        let sent = execution
            .processor
            .with_controller(|controller| std::mem::take(&mut controller.usart.sent));
        let received = on_link(&sent);
        let now = execution.processor.now();
        execution.processor.with_controller(|controller| controller.hear(&received, now));
        link.extend(sent);
    }
    Ok(report(image, order, &execution, gathered, &String::from_utf8_lossy(&link)))
}

/// The report of an execution that has ended.
fn report(
    image: &Image,
    order: &Order,
    execution: &Execution,
    gathered: Gathered,
    link: &str,
) -> Report {
    let now = execution.processor.now();
    let (by_origin, idle, samples) = window(image, execution, &gathered);
    let ended = gathered.ended.unwrap_or(now);
    let used = execution.processor.with_controller(|controller| controller.flash.used);
    let mut violations = execution.world.carrier.borrow_mut().violations();
    violations.extend(execution.processor.with_controller(|controller| controller.wiring.faults()));
    let faults = link
        .lines()
        .filter_map(|line| line.rsplit("faults ").next()?.trim().parse().ok())
        .next_back();
    Report {
        carrier: order.carrier.name(),
        seed: order.seed,
        cycles_per_instruction: order.cycles,
        azimuth_deg: gathered.azimuth.map(|(azimuth, _)| azimuth),
        truth_deg: (execution.world.truth_deg)(ended.instant()),
        outcome: gathered.outcome,
        seconds: ended.as_seconds(),
        start_seconds: gathered.first.unwrap_or(now).as_seconds(),
        samples,
        instructions_per_sample: by_origin.values().sum(),
        instructions_by_origin: by_origin,
        idle,
        service: gathered.service,
        false_notices: gathered.notices,
        faults: faults.unwrap_or(0),
        stack_bytes: execution.stack_bytes(),
        flash_bytes: image.flash.len(),
        static_bytes: image.static_bytes,
        masked_seconds: [gathered.masked_at_start, execution.processor.counts().masked.0]
            .map(Time::as_seconds),
        violations,
        flash_use: [used.rows, used.pages],
    }
}

/// Instructions for a sample by their origin, and the idle part of the time, between the first and the last step of
/// the measurement, or from the start on where there are no two; and the samples of that time.
fn window(
    image: &Image,
    execution: &Execution,
    gathered: &Gathered,
) -> (BTreeMap<Origin, f64>, f64, u64) {
    let asleep = execution.processor.counts().asleep;
    let now = (
        execution.processor.with_blocks(Snapshot::of),
        gathered.samples,
        execution.processor.now(),
        asleep,
    );
    let start = (Snapshot::default(), 0, Time::ZERO, Time::ZERO);
    let (first, last) = match &gathered.steps[..] {
        [first, .., last] => (first, last),
        _ => (&start, &now),
    };
    let samples = (last.1 - first.1) / execution.world.converters();
    let mut origins = Origins::new(image);
    let sums =
        execution.processor.with_blocks(|blocks| last.0.since(&first.0, blocks, &mut origins));
    let each = sums.into_iter().map(|(origin, sum)| (origin, sum as f64 / samples.max(1) as f64));
    let idle = (last.3 - first.3).as_seconds() / (last.2 - first.2).as_seconds().max(1e-9);
    (each.collect(), idle, samples)
}
