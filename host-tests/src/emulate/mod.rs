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

use std::fs;
use std::path::Path;
use std::time::Duration;

use self::collect::Collected;
use self::jobs::{JOBS, Job};
use self::outcome::{Difference, Outcome};
use self::sections::Memory;
use crate::refused;
use crate::work::Follower;

/// Longest time for an image to run: a hundred times what is usual, and never for ever.
const LONGEST: Duration = Duration::from_mins(10);

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
    pub figures: collect::Figures,
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

/// Steps of an emulation: each run of the instrument with that of the host, and the cores.
pub const STEPS: usize = JOBS.len() + 1;

/// Builds, runs, compares and checks; the log's lines go to `on_line` as they come, and `follower` is told of each step.
///
/// # Errors
/// One line that says what is missing or what went wrong.
pub fn emulate(
    seed: u64,
    mut on_line: impl FnMut(&decode::Line),
    follower: &dyn Follower,
) -> Result<Emulation, String> {
    qemu::require()?;
    let images = images::build()?;
    let elf = read(&images.emulator)?;
    let (mut outcomes, mut runs) = (Vec::new(), Vec::new());
    let mut comparison = Ok(());
    for job in JOBS {
        let order = format!("{seed}/{}", job.word);
        let (emulated, figures) = instrument(&images.emulator, &elf, &order, &mut on_line)?;
        let host = (job.on_host)(seed)?;
        comparison = comparison.and_then(|()| outcome::compare(&emulated, &host));
        outcomes.push(emulated);
        runs.push(Run { job, figures });
        follower.done();
    }
    let emulated = outcomes.swap_remove(0);
    let memory = Memory::of(&elf)?;
    let (cost, cost_is_right) = cores(&images.cost)?;
    follower.done();
    let checks = checks::all(&runs, &memory);
    Ok(Emulation { seed, emulated, comparison, runs, memory, cost, cost_is_right, checks })
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| refused::named(path.display(), &error))
}

/// Runs the image `emulator`.
fn instrument(
    image: &Path,
    elf: &[u8],
    order: &str,
    mut on_line: impl FnMut(&decode::Line),
) -> Result<(Outcome, collect::Figures), String> {
    let table = decode::table(elf)?;
    let mut stream = table.new_stream_decoder();
    let mut collected = Collected::default();
    let status = qemu::run(image, &["-append", order], LONGEST, |bytes| {
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
