//! `meridian emulate --board`: the very image that is flashed, executed behind a model of its microcontroller.
//!
//! ```text
//!  board's image (cargo) ─▶ program `emulated-board` ─log─▶ standard error
//!                                  └─one line of JSON─▶ report ◀─compare─ the host's run of the same world
//! ```
//!
//! The program links Unicorn, whose licence is the GPL-2.0: it is built and started, and talked to by a pipe.

mod host;

use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use execution::built::{self, executable, image, root};
use execution::report::Report;
use firmware::platform::Platform;
use rayon::prelude::*;

use crate::refused;
use crate::work::Follower;

/// Greatest distance of an azimuth from the truth, in its own σ.
const FROM_TRUTH: f64 = 3.0;
/// Greatest distance of an azimuth from that of the host's run, in its own σ, on a platform. An image comes to its dwells
/// some milliseconds earlier or later than the host, and each of them with another part of the noise: by 0.2 σ (1σ).
const FROM_HOST: f64 = 0.6;
/// The same in a vehicle, whose image begins two seconds of a stop of 15 s later, once its crystal oscillates: by 0.7 σ (1σ).
const FROM_HOST_IN_A_VEHICLE: f64 = 2.1;

/// How images are executed.
#[derive(Clone, Debug)]
pub struct Options {
    /// Seed of the world.
    pub seed: u64,
    /// Cycles that an instruction takes.
    pub cycles: f64,
    /// How long an image goes on after its result, s; as the program has it where nothing is stated.
    pub afterwards: Option<f64>,
    /// The port at which the link is offered to a client.
    pub link: Option<u16>,
}

impl Options {
    /// These options, as the program takes them, for an image of a carrier.
    #[must_use]
    pub fn arguments(&self, carrier: Platform) -> Vec<String> {
        let Self { seed, cycles, afterwards, link } = self;
        let always = [
            format!("--carrier={carrier}"),
            format!("--seed={seed}"),
            format!("--cycles={cycles}"),
        ];
        let afterwards = afterwards.map(|seconds| format!("--afterwards={seconds}"));
        let link = link.map(|port| format!("--link=tcp:{port}"));
        always.into_iter().chain(afterwards).chain(link).collect()
    }
}

/// An image that was executed.
#[derive(Clone, Debug)]
pub struct Executed {
    /// What the execution showed.
    pub report: Report,
    /// The azimuth that the host finds in the same world, °; none where it finds none.
    pub host_deg: Option<f64>,
}

impl Executed {
    /// Distances of the azimuth from the truth and from the host's, in its own σ.
    #[must_use]
    pub fn distances(&self) -> Option<[Option<f64>; 2]> {
        let [azimuth, sigma, _] = self.report.azimuth_deg?;
        let distance = |other: f64| ((azimuth - other + 540.0).rem_euclid(360.0) - 180.0) / sigma;
        Some([Some(distance(self.report.truth_deg)), self.host_deg.map(distance)])
    }

    /// What is not as it must be, as sentences.
    #[must_use]
    pub fn complaints(&self) -> Vec<String> {
        let Report { carrier, violations, resets, samples, .. } = &self.report;
        let mut complaints: Vec<String> =
            violations.iter().map(|violation| format!("{carrier}: {violation}")).collect();
        if !resets.is_empty() {
            complaints.push(format!("{carrier}: reset after its power-on: {}", resets.join(", ")));
        }
        if *samples == 0 {
            complaints.push(format!("{carrier}: no sample was read while measuring"));
        }
        complaints.extend(self.losses());
        let Some([from_truth, from_host]) = self.distances() else {
            // A spinning body has no azimuth.
            if *carrier != Platform::Spin.name() {
                complaints.push(format!("{carrier}: {}", self.report.outcome));
            }
            return complaints;
        };
        let mut hold = |distance: Option<f64>, greatest: f64, of: &str| {
            if let Some(distance) = distance.filter(|distance| distance.abs() > greatest) {
                complaints.push(format!(
                    "{carrier}: the azimuth is {distance:.2} σ beside {of}, {greatest} allowed"
                ));
            }
        };
        hold(from_truth, FROM_TRUTH, "the truth");
        let is_vehicle = *carrier == Platform::Vehicle.name();
        let from_host_most = if is_vehicle { FROM_HOST_IN_A_VEHICLE } else { FROM_HOST };
        hold(from_host, from_host_most, "that of the host");
        complaints
    }

    /// Conversions that were lost at any time, and notices of the log that are false, as sentences.
    fn losses(&self) -> impl Iterator<Item = String> {
        let Report { carrier, service, false_notices, .. } = &self.report;
        let [read, lost] = service
            .iter()
            .fold([0, 0], |[read, lost], service| [read + service.read, lost + service.lost]);
        let losses = (lost > 0)
            .then(|| format!("{carrier}: {lost} of {} conversions were lost", read + lost));
        let false_ones = false_notices.iter().map(move |(words, count)| {
            format!("{carrier}: \"{words}\" in the log, falsely: {count}")
        });
        losses.into_iter().chain(false_ones)
    }
}

/// Builds the images of carriers and the program, executes them side by side, and makes the same runs on the host. The
/// log of a single image goes to standard error as it comes where that is asked for, or where a client of its link is waited
/// for.
///
/// # Errors
/// What is missing or does not build, or what the model does not know.
pub fn execute(
    carriers: &[Platform],
    options: &Options,
    asks_log: bool,
    follower: &dyn Follower,
) -> Result<Vec<Executed>, String> {
    let images: Vec<PathBuf> =
        carriers.iter().map(|carrier| image(*carrier)).collect::<Result<_, _>>()?;
    let program = program()?;
    let shows_log = carriers.len() == 1 && (asks_log || options.link.is_some());
    let pairs: Vec<_> = carriers.iter().zip(&images).collect();
    pairs
        .par_iter()
        .map(|(carrier, image)| {
            let report = report(&program, image, **carrier, options, shows_log)?;
            let host_deg = host::azimuth_deg(**carrier, options.seed)?;
            follower.done();
            Ok(Executed { report, host_deg })
        })
        .collect()
}

/// The program that executes images.
fn program() -> Result<PathBuf, String> {
    executable(&built::of(&["--package", "emulated-board", "--release"])?, "emulated-board")
}

/// Executes an image. The program ends with its standard input, which this one holds open for as long as it lives.
fn report(
    program: &Path,
    image: &Path,
    carrier: Platform,
    options: &Options,
    shows_log: bool,
) -> Result<Report, String> {
    let mut command = Command::new(program);
    command.current_dir(root()).arg(image).args(options.arguments(carrier)).arg("--while-stdin");
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    command.stderr(if shows_log { Stdio::inherit() } else { Stdio::piped() });
    let failed = |error: io::Error| refused::named(program.display(), &error);
    let mut child = command.spawn().map_err(failed)?;
    let held_open = child.stdin.take();
    let output = child.wait_with_output().map_err(failed)?;
    drop(held_open);
    if output.status.success() {
        return Report::parse(&output.stdout);
    }
    let log = String::from_utf8_lossy(&output.stderr);
    let last = log.lines().next_back().unwrap_or("its log says why");
    let last = last.strip_prefix("error: ").unwrap_or(last);
    Err(format!("the image of {carrier} was not executed: {last}"))
}
