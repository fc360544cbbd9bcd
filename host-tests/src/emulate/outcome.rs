//! What a run found, as bits, and where two runs differ.

use orientation::alignment::Azimuth;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::turn::Turn;
use orientation::alignment::stops::stop::Stop;
use orientation::attitude::Report;
use orientation::signal::dwell::Dwell;
use thiserror::Error;

/// A kind of row of the log whose numbers are compared.
#[derive(Debug, PartialEq, Eq)]
pub struct Kind {
    /// The word with which its lines begin.
    pub word: &'static str,
    /// The names of its numbers in the log, with blanks between them.
    names: &'static str,
}

impl Kind {
    /// The names of its numbers in the log.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.names.split(' ')
    }
}

/// A dwell at a position.
pub static DWELL: Kind = Kind {
    word: "dwell",
    names: "stage middle seconds samples rate taper force_x force_y force_z temperature",
};

/// A turn of a platform that turns all the time.
pub static TURN: Kind = Kind {
    word: "turn",
    names: "rate_cos rate_sin turning_cos turning_sin leak_cos leak_sin force_cos force_sin mean_force offset middle seconds speed",
};

/// A stop of a vehicle.
pub static STOP: Kind =
    Kind { word: "stop", names: "from to turned_x turned_y turned_z force_x force_y force_z" };

/// What is kept at a second after the alignment.
pub static KEPT: Kind = Kind { word: "kept", names: "time azimuth sigma pitch roll w x y z" };

/// All kinds, in the order of cause and effect.
pub static KINDS: [&Kind; 4] = [&DWELL, &TURN, &STOP, &KEPT];

/// The bits of what is absent: a NaN that no computation gives.
const ABSENT: u64 = u64::MAX;

/// The bits of the numbers of something.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Kind of the row, which names its numbers.
    pub kind: &'static Kind,
    /// In the order of the kind's names; [`None`] where one is absent.
    pub bits: Vec<Option<u64>>,
}

impl Row {
    /// From hexadecimal texts by their names; [`None`] where one is missing or is no number.
    #[must_use]
    pub fn parse<'t>(kind: &'static Kind, text: impl Fn(&str) -> Option<&'t str>) -> Option<Self> {
        let bits = |name: &str| {
            let bits = u64::from_str_radix(text(name)?, 16).ok()?;
            Some((bits != ABSENT).then_some(bits))
        };
        Some(Self { kind, bits: kind.names().map(bits).collect::<Option<_>>()? })
    }
}

impl From<&Dwell> for Row {
    fn from(dwell: &Dwell) -> Self {
        let [x, y, z] = dwell.force.map_or([None; 3], |force| force.map(|f| Some(f.to_bits())));
        let bits = vec![
            Some(dwell.stage.0.into()),
            Some(dwell.middle.to_bits()),
            Some(dwell.seconds.to_bits()),
            Some(dwell.samples.into()),
            Some(dwell.rate.to_bits()),
            Some(dwell.taper.to_bits()),
            x,
            y,
            z,
            dwell.temperature.get().map(f64::to_bits),
        ];
        Self { kind: &DWELL, bits }
    }
}

impl From<&Turn> for Row {
    fn from(turn: &Turn) -> Self {
        let phasors = [turn.rate, turn.turning, turn.leak, turn.force].into_iter().flatten();
        let rest = [turn.mean_force, turn.offset, turn.middle, turn.seconds, turn.speed];
        let bits = phasors.chain(rest).map(|value| Some(f64::from(value).to_bits()));
        Self { kind: &TURN, bits: bits.collect() }
    }
}

impl From<&Stop> for Row {
    fn from(stop: &Stop) -> Self {
        let means = [stop.turned.mean(), stop.force.mean()].into_iter().flatten();
        let numbers = [stop.from, stop.to].into_iter().chain(means);
        Self { kind: &STOP, bits: numbers.map(|value| Some(value.to_bits())).collect() }
    }
}

impl From<&Report> for Row {
    fn from(report: &Report) -> Self {
        let azimuth = report.azimuth.map(|azimuth| azimuth.angle.to_bits());
        let sigma = report.azimuth.map(|azimuth| azimuth.sigma.to_bits());
        let angles = [report.pitch, report.roll].into_iter().chain(report.attitude);
        let angles = angles.map(|angle| Some(angle.to_bits()));
        let bits = [Some(report.time.0), azimuth, sigma].into_iter().chain(angles).collect();
        Self { kind: &KEPT, bits }
    }
}

/// What a run found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// The seed of the run.
    pub seed: u64,
    /// Bits of the azimuth, rad.
    pub azimuth_bits: Option<u64>,
    /// Bits of its standard deviation, rad.
    pub sigma_bits: Option<u64>,
    /// Why there is no azimuth.
    pub reason: Option<String>,
    /// Dwells, turns or stops, and what was kept after them, second by second.
    pub rows: Vec<Row>,
}

impl Outcome {
    /// The outcome of a verdict and what led to it.
    #[must_use]
    pub fn of(
        seed: u64,
        verdict: &Result<Azimuth, Refusal>,
        rows: impl Iterator<Item = Row>,
    ) -> Self {
        let found = verdict.as_ref();
        Self {
            seed,
            azimuth_bits: found.ok().map(|azimuth| azimuth.angle.to_bits()),
            sigma_bits: found.ok().map(|azimuth| azimuth.sigma.to_bits()),
            reason: found.err().map(ToString::to_string),
            rows: rows.collect(),
        }
    }

    /// The rows of a kind, in their order.
    pub fn rows_of(&self, kind: &'static Kind) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.kind == kind)
    }
}

/// The first thing in which two runs differ.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{what}: {} in the emulator, {} on the host", values[0], values[1])]
pub struct Difference {
    /// Name of the number that differs.
    pub what: String,
    /// Value in the emulated run, then on the host.
    pub values: [String; 2],
}

/// Whether two runs found the same, bit for bit; in the order of cause and effect, so that the
/// difference reported is where it began.
///
/// # Errors
/// The first difference.
pub fn compare(emulated: &Outcome, host: &Outcome) -> Result<(), Difference> {
    let runs = [emulated, host];
    same("seed".to_owned(), runs.map(|run| run.seed.to_string()))?;
    KINDS.into_iter().try_for_each(|kind| rows(kind, runs))?;
    same("azimuth".to_owned(), runs.map(|run| shown("azimuth", run.azimuth_bits)))?;
    same("sigma".to_owned(), runs.map(|run| shown("sigma", run.sigma_bits)))?;
    let reason = |run: &Outcome| {
        run.reason.as_deref().map_or("none".to_owned(), |reason| format!("«{}»", short(reason)))
    };
    same("reason".to_owned(), runs.map(reason))
}

fn same(what: String, values: [String; 2]) -> Result<(), Difference> {
    if values[0] == values[1] { Ok(()) } else { Err(Difference { what, values }) }
}

/// Compares the rows of a kind, and how many there are.
fn rows(kind: &'static Kind, runs: [&Outcome; 2]) -> Result<(), Difference> {
    let pairs = runs[0].rows_of(kind).zip(runs[1].rows_of(kind));
    for (number, (emulated, host)) in (1..).zip(pairs) {
        let both = emulated.bits.iter().zip(&host.bits);
        for (name, (emulated, host)) in kind.names().zip(both) {
            let what = format!("{} {number}, {name}", kind.word);
            same(what, [emulated, host].map(|bits| shown(name, *bits)))?;
        }
    }
    let counts = runs.map(|run| run.rows_of(kind).count().to_string());
    same(format!("rows of kind {}", kind.word), counts)
}

/// Bits, and the number that they are.
fn shown(field: &str, bits: Option<u64>) -> String {
    match bits {
        None => "none".to_owned(),
        Some(bits) if ["stage", "samples", "time"].contains(&field) => format!("{bits:#x}"),
        Some(bits) => format!("{bits:#018x} ({:e})", f64::from_bits(bits)),
    }
}

/// A sentence with its decimals cut to what they say: the log's formatter leaves out zeros at the
/// end that the host's writes.
fn short(sentence: &str) -> String {
    sentence.split_inclusive(|c: char| !c.is_ascii_digit() && c != '.').map(shortened).collect()
}

/// One number with what stands behind it, without zeros at its end.
fn shortened(word: &str) -> String {
    let end = word.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(word.len());
    let (number, behind) = word.split_at(end);
    match number.split_once('.') {
        Some((whole, places)) if !places.is_empty() && !places.contains('.') => {
            let places = places.trim_end_matches('0');
            let point = if places.is_empty() { "" } else { "." };
            format!("{whole}{point}{places}{behind}")
        }
        _ => word.to_owned(),
    }
}
