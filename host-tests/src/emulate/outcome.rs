//! What a run found, as bits, and where two runs differ.

use std::fmt;

use orientation::align::conclusion::Azimuth;
use orientation::align::rotating::turn::Turn;
use orientation::align::stops::stop::Stop;
use orientation::error::Refusal;
use orientation::keep::Report;
use orientation::signal::dwell::Dwell;

/// The numbers of a dwell that are compared, by their names in the log.
pub const FIELDS: [&str; 10] = [
    "stage",
    "middle",
    "seconds",
    "samples",
    "rate",
    "taper",
    "force_x",
    "force_y",
    "force_z",
    "temperature",
];

/// The numbers of a turn that are compared, by their names in the log.
pub const TURN_FIELDS: [&str; 13] = [
    "rate_cos",
    "rate_sin",
    "turning_cos",
    "turning_sin",
    "leak_cos",
    "leak_sin",
    "force_cos",
    "force_sin",
    "mean_force",
    "offset",
    "middle",
    "seconds",
    "speed",
];

/// The numbers of a stop that are compared, by their names in the log.
pub const STOP_FIELDS: [&str; 8] =
    ["from", "to", "turned_x", "turned_y", "turned_z", "force_x", "force_y", "force_z"];

/// The numbers that are kept, of which one is whole, by their names in the log.
pub const KEPT_FIELDS: [&str; 9] =
    ["time", "azimuth", "sigma", "pitch", "roll", "w", "x", "y", "z"];

/// The bits of what is absent: a NaN that no computation gives.
const ABSENT: u64 = u64::MAX;

/// The bits of the numbers of something, in the order of their names; [`None`] where one is absent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits<const N: usize>(pub [Option<u64>; N]);

/// Of a dwell, in the order of [`FIELDS`].
pub type DwellBits = Bits<{ FIELDS.len() }>;

/// Of a turn, in the order of [`TURN_FIELDS`].
pub type TurnBits = Bits<{ TURN_FIELDS.len() }>;

/// Of a stop, in the order of [`STOP_FIELDS`].
pub type StopBits = Bits<{ STOP_FIELDS.len() }>;

/// Of what is kept, in the order of [`KEPT_FIELDS`].
pub type KeptBits = Bits<{ KEPT_FIELDS.len() }>;

impl<const N: usize> Bits<N> {
    /// From hexadecimal texts; [`None`] where one is missing or is no number.
    #[must_use]
    pub fn parse<'t>(
        names: [&'static str; N],
        text: impl Fn(&'static str) -> Option<&'t str>,
    ) -> Option<Self> {
        let mut bits = [None; N];
        for (bits, name) in bits.iter_mut().zip(names) {
            let value = u64::from_str_radix(text(name)?, 16).ok()?;
            *bits = (value != ABSENT).then_some(value);
        }
        Some(Self(bits))
    }
}

impl From<&Dwell> for DwellBits {
    fn from(dwell: &Dwell) -> Self {
        let [x, y, z] = dwell.force.map_or([None; 3], |force| force.map(|f| Some(f.to_bits())));
        Self([
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
        ])
    }
}

impl From<&Turn> for TurnBits {
    fn from(turn: &Turn) -> Self {
        let [a, b] = turn.rate;
        let [c, d] = turn.turning;
        let [e, f] = turn.leak;
        let [g, h] = turn.force;
        let rest = [turn.mean_force, turn.offset, turn.middle, turn.seconds, turn.speed];
        let [i, j, k, l, m] = rest;
        Self([a, b, c, d, e, f, g, h, i, j, k, l, m].map(|value| Some(f64::from(value).to_bits())))
    }
}

impl From<&Stop> for StopBits {
    fn from(stop: &Stop) -> Self {
        let [x, y, z] = stop.turned.mean();
        let [forward, right, down] = stop.force.mean();
        let numbers = [stop.from, stop.to, x, y, z, forward, right, down];
        Self(numbers.map(|value| Some(value.to_bits())))
    }
}

impl From<&Report> for KeptBits {
    fn from(report: &Report) -> Self {
        let azimuth = report.azimuth.map(|azimuth| azimuth.angle.to_bits());
        let sigma = report.azimuth.map(|azimuth| azimuth.sigma.to_bits());
        let [pitch, roll] = [report.pitch, report.roll].map(|angle| Some(angle.to_bits()));
        let [w, x, y, z] = report.attitude.map(|part| Some(part.to_bits()));
        Self([Some(report.time.0), azimuth, sigma, pitch, roll, w, x, y, z])
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
    /// The dwells, of a run in positions.
    pub dwells: Vec<DwellBits>,
    /// The turns, of one on a platform that turns all the time.
    pub turns: Vec<TurnBits>,
    /// The stops, of one in a vehicle.
    pub stops: Vec<StopBits>,
    /// What was kept after it, second by second.
    pub kept: Vec<KeptBits>,
}

impl Outcome {
    /// Of a verdict, without what led to it.
    #[must_use]
    pub fn of(seed: u64, verdict: &Result<Azimuth, Refusal>) -> Self {
        let found = verdict.as_ref();
        Self {
            seed,
            azimuth_bits: found.ok().map(|azimuth| azimuth.angle.to_bits()),
            sigma_bits: found.ok().map(|azimuth| azimuth.sigma.to_bits()),
            reason: found.err().map(ToString::to_string),
            ..Self::default()
        }
    }
}

/// The first thing in which two runs differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// They had different seeds.
    Seed {
        /// The emulated run's.
        emulated: u64,
        /// The host's.
        host: u64,
    },
    /// A number of a dwell, a turn, a stop or a report.
    Number {
        /// What it is of.
        of: &'static str,
        /// Which of them, from one.
        number: usize,
        /// Name of the number.
        field: &'static str,
        /// Its bits in the emulated run.
        emulated: Option<u64>,
        /// Its bits on the host.
        host: Option<u64>,
    },
    /// How many dwells, turns or stops there were.
    Count {
        /// Of what.
        of: &'static str,
        /// In the emulated run.
        emulated: usize,
        /// On the host.
        host: usize,
    },
    /// The azimuth or its standard deviation.
    Result {
        /// Which.
        field: &'static str,
        /// Its bits in the emulated run.
        emulated: Option<u64>,
        /// Its bits on the host.
        host: Option<u64>,
    },
    /// The reason why there is no azimuth.
    Reason {
        /// The emulated run's.
        emulated: Option<String>,
        /// The host's.
        host: Option<String>,
    },
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seed { emulated, host } => {
                write!(f, "seed: {emulated} in the emulator, {host} on the host")
            }
            Self::Number { of, number, field, emulated, host } => {
                let [emulated, host] = [emulated, host].map(|bits| shown(field, *bits));
                write!(f, "{of} {number}, {field}: {emulated} in the emulator, {host} on the host")
            }
            Self::Count { of, emulated, host } => {
                write!(f, "{of}s: {emulated} in the emulator, {host} on the host")
            }
            Self::Result { field, emulated, host } => {
                let [emulated, host] = [emulated, host].map(|bits| shown(field, *bits));
                write!(f, "{field}: {emulated} in the emulator, {host} on the host")
            }
            Self::Reason { emulated, host } => {
                let [emulated, host] =
                    [emulated, host].map(|reason| reason.as_deref().unwrap_or("none"));
                write!(f, "reason: «{emulated}» in the emulator, «{host}» on the host")
            }
        }
    }
}

/// Bits, and the number that they are.
fn shown(field: &str, bits: Option<u64>) -> String {
    match bits {
        None => "none".to_owned(),
        Some(bits) if ["stage", "samples", "time"].contains(&field) => format!("{bits:#x}"),
        Some(bits) => format!("{bits:#018x} ({:e})", f64::from_bits(bits)),
    }
}

/// Whether two runs found the same, bit for bit; in the order of cause and effect, so that the
/// difference told is where it began.
///
/// # Errors
/// The first difference.
pub fn compare(emulated: &Outcome, host: &Outcome) -> Result<(), Difference> {
    if emulated.seed != host.seed {
        return Err(Difference::Seed { emulated: emulated.seed, host: host.seed });
    }
    rows("dwell", FIELDS, &emulated.dwells, &host.dwells)?;
    rows("turn", TURN_FIELDS, &emulated.turns, &host.turns)?;
    rows("stop", STOP_FIELDS, &emulated.stops, &host.stops)?;
    rows("report", KEPT_FIELDS, &emulated.kept, &host.kept)?;
    result("azimuth", emulated.azimuth_bits, host.azimuth_bits)?;
    result("sigma", emulated.sigma_bits, host.sigma_bits)?;
    let [one, other] = [emulated, host].map(|run| run.reason.as_deref().map(short));
    if one == other {
        return Ok(());
    }
    Err(Difference::Reason { emulated: emulated.reason.clone(), host: host.reason.clone() })
}

/// Compares dwells, turns or stops, and how many there are.
fn rows<const N: usize>(
    of: &'static str,
    names: [&'static str; N],
    emulated: &[Bits<N>],
    host: &[Bits<N>],
) -> Result<(), Difference> {
    for (number, (emulated, host)) in (1..).zip(emulated.iter().zip(host)) {
        let mut numbers = names.into_iter().zip(emulated.0.into_iter().zip(host.0));
        if let Some((field, (emulated, host))) = numbers.find(|(_, (one, other))| one != other) {
            return Err(Difference::Number { of, number, field, emulated, host });
        }
    }
    let [emulated, host] = [emulated, host].map(<[_]>::len);
    if emulated == host { Ok(()) } else { Err(Difference::Count { of, emulated, host }) }
}

fn result(field: &'static str, emulated: Option<u64>, host: Option<u64>) -> Result<(), Difference> {
    if emulated == host { Ok(()) } else { Err(Difference::Result { field, emulated, host }) }
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
