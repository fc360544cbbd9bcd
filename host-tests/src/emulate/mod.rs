//! `meridian emulate`: the firmware on an emulated Cortex-M4F, against the host and its budget.
//!
//! ```text
//!  images (cargo) ─▶ qemu ─bytes─▶ decode ─lines─▶ collect ─▶ outcome ◀─compare─ jobs
//!        │                                            └─▶ figures ─▶ checks ◀─ budget.toml
//!        └─ELF─▶ sections ──────────────────────────────────────────────▲
//! ```
//!
//! The image `emulator` runs the instrument on simulated chips and says what it found, bit by bit,
//! and what it took; the image `cost` counts the cores alone.

pub mod checks;
pub mod collect;
pub mod cost;
pub mod decode;
pub mod executed;
pub mod images;
pub mod jobs;
pub mod outcome;
pub mod qemu;
pub mod sections;

use std::collections::VecDeque;
use std::fs;
use std::path::Path;
use std::time::Duration;

use self::collect::{Collected, Figures};
use self::decode::Line;
use self::jobs::{JOBS, Job};
use self::outcome::{Difference, Outcome};
use self::sections::Memory;
use crate::refused;
use crate::work::{Follower, side_by_side};

/// Longest time for an image to run: five times what the longest run takes on a slow computer, and never for ever.
const LONGEST: Duration = Duration::from_mins(10);
/// Lines of a log that are kept, to be shown where its run ends badly.
const LAST: usize = 10;

/// All that an emulation showed.
#[derive(Clone, Debug)]
pub struct Emulation {
    /// The seed of every run.
    pub seed: u64,
    /// What the emulated instrument on a stage found.
    pub emulated: Outcome,
    /// Whether the host found the same in every run.
    pub comparison: Result<(), Difference>,
    /// What the instrument took in each run.
    pub runs: Vec<Run>,
    /// Where its memory goes.
    pub memory: Memory,
    /// What the cores take.
    pub cost: Vec<cost::Row>,
    /// Whether the image `cost` found everything right.
    pub cost_is_right: bool,
    /// The figures against the budget.
    pub checks: Vec<checks::Check>,
}

/// A run of the image, and what the instrument took in it.
#[derive(Clone, Debug)]
pub struct Run {
    /// Which one.
    pub job: &'static Job,
    /// What was taken.
    pub figures: Figures,
}

impl Emulation {
    /// Whether the results agree and the budget is kept.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.comparison.is_ok()
            && self.cost_is_right
            && self.checks.iter().all(checks::Check::is_kept)
    }
}

/// Why there is no emulation.
#[derive(Clone, Debug)]
pub struct Failed {
    /// What is missing or what went wrong, in one line.
    pub reason: String,
    /// The last lines that the run said which ended badly, if one did.
    pub last: VecDeque<Line>,
}

impl From<String> for Failed {
    fn from(reason: String) -> Self {
        Self { reason, last: VecDeque::new() }
    }
}

/// Takes the lines of a run's log as they come; several runs are made at a time.
pub type OnLine<'l> = &'l (dyn Fn(&Job, &Line) + Sync);

/// Steps of an emulation: each run of the instrument with that of the host, and the cores.
pub const STEPS: usize = JOBS.len() + 1;

/// Builds, runs side by side, compares and checks; `follower` is told of each step.
///
/// # Errors
/// What is missing or what went wrong; of several runs that did, the first.
pub fn emulate(seed: u64, on_line: OnLine, follower: &dyn Follower) -> Result<Emulation, Failed> {
    qemu::require()?;
    let images = images::build()?;
    let elf = read(&images.emulator)?;
    let instrument = Instrument { image: &images.emulator, elf: &elf, seed, on_line };
    let (both, cost) = rayon::join(
        || side_by_side(JOBS.iter(), follower, |job| instrument.on_both(job)),
        || cores(&images.cost).inspect(|_| follower.done()),
    );
    let both: Vec<_> = both.into_iter().collect::<Result<_, _>>()?;
    let (cost, cost_is_right) = cost?;
    let comparison =
        both.iter().try_for_each(|(_, emulated, host)| outcome::compare(emulated, host));
    let emulated = both[0].1.clone();
    let runs: Vec<_> = both.into_iter().map(|(run, ..)| run).collect();
    let memory = Memory::of(&elf)?;
    let checks = checks::all(&runs, &memory);
    Ok(Emulation { seed, emulated, comparison, runs, memory, cost, cost_is_right, checks })
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| refused::named(path.display(), &error))
}

/// The image `emulator`, and what is asked of it.
struct Instrument<'i> {
    image: &'i Path,
    elf: &'i [u8],
    seed: u64,
    on_line: OnLine<'i>,
}

impl Instrument<'_> {
    /// A run, what came of it, and what comes of it on the host.
    fn on_both(&self, job: &'static Job) -> Result<(Run, Outcome, Outcome), Failed> {
        let (emulated, figures) = self.run(job)?;
        let host = (job.on_host)(self.seed)?;
        Ok((Run { job, figures }, emulated, host))
    }

    /// Runs the image.
    fn run(&self, job: &Job) -> Result<(Outcome, Figures), Failed> {
        let mut last = VecDeque::new();
        let run = self.collected(job, |line| {
            (self.on_line)(job, line);
            last.push_back(line.clone());
            last.drain(..last.len().saturating_sub(LAST));
        });
        run.map_err(|reason| Failed { reason: format!("{}: {reason}", job.word), last })
    }

    /// Runs the image and collects what it says.
    fn collected(
        &self,
        job: &Job,
        mut on_line: impl FnMut(&Line),
    ) -> Result<(Outcome, Figures), String> {
        let table = decode::table(self.elf)?;
        let mut stream = table.new_stream_decoder();
        let mut collected = Collected::default();
        let order = format!("{}/{}", self.seed, job.word);
        let status = qemu::run(self.image, &["-append", &order], LONGEST, |bytes| {
            decode::take(&mut *stream, bytes, |line| {
                on_line(line);
                collected.take(line)
            })
        })?;
        if !status.success() {
            return Err(format!("the image `emulator` failed ({status}): its last lines say why"));
        }
        collected.finish()
    }
}

/// Runs the image `cost`.
fn cores(image: &Path) -> Result<(Vec<cost::Row>, bool), String> {
    let mut output = Vec::new();
    let status = qemu::run(image, &[], LONGEST, |bytes| {
        output.extend_from_slice(bytes);
        Ok(())
    })?;
    let rows = cost::parse(&String::from_utf8_lossy(&output))?;
    Ok((rows, status.success()))
}
