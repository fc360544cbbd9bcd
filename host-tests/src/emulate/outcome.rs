//! What a run found, as bits, and where two runs differ.

use orientation::alignment::{Method, Solution};
use simulated::trace::{ABSENT, AZIMUTH, Trace};
use thiserror::Error;

/// The numbers of something, as the bits of 64-bit floats or integers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row {
    /// Its kind, then the names of the numbers, with blanks between them.
    pub head: String,
    /// The numbers; [`ABSENT`] where there is none.
    pub bits: Vec<u64>,
}

impl Row {
    /// A row of which everything is known.
    #[must_use]
    pub fn new(head: &str, bits: &[u64]) -> Self {
        Self { head: head.to_owned(), bits: bits.to_vec() }
    }

    /// From a line of the log: `dwell stage middle … [12, 34, …]`; [`None`] where the numbers are not
    /// as many as their names.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let (head, bits) = text.strip_suffix(']')?.split_once(" [")?;
        let bits =
            bits.split(", ").map(|number| number.parse().ok()).collect::<Option<Vec<_>>>()?;
        let row = Self::new(head, &bits);
        (row.names().count() == bits.len()).then_some(row)
    }

    /// The word that says what it is.
    #[must_use]
    pub fn kind(&self) -> &str {
        self.head.split(' ').next().unwrap_or_default()
    }

    /// The names of its numbers.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.head.split(' ').skip(1)
    }
}

/// What a run found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Outcome {
    /// What was kept, second by second, then dwells, turns or stops, then the azimuth.
    pub rows: Vec<Row>,
    /// Why there is no azimuth.
    pub reason: Option<String>,
}

impl Outcome {
    /// The outcome of a method that has come to its end, with the rows of others in front.
    pub fn of<S>(method: &(impl Method<S> + Trace), others: &[&dyn Trace]) -> Self {
        let mut rows = Vec::new();
        let mut add = |head: &str, bits: &[u64]| rows.push(Row::new(head, bits));
        for other in others {
            other.trace(&mut add);
        }
        method.trace(&mut add);
        let verdict = method.verdict();
        if let Some(Ok(Solution { azimuth, .. })) = &verdict {
            add(AZIMUTH, &[azimuth.angle.0, azimuth.sigma.0].map(f64::to_bits));
        }
        let reason = verdict.and_then(Result::err).map(|reason| reason.to_string());
        Self { rows, reason }
    }

    /// The azimuth and its standard deviation, rad.
    #[must_use]
    pub fn azimuth(&self) -> Option<[f64; 2]> {
        let row = self.rows.iter().find(|row| row.head == AZIMUTH)?;
        let [angle, sigma] = row.bits[..] else { return None };
        Some([angle, sigma].map(f64::from_bits))
    }

    /// The number of rows of a kind.
    #[must_use]
    pub fn count(&self, head: &str) -> usize {
        self.rows.iter().filter(|row| row.head == head).count()
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

/// Whether two runs found the same, bit for bit, row by row, so that the difference reported is where
/// it began.
///
/// # Errors
/// The first difference.
pub fn compare(emulated: &Outcome, host: &Outcome) -> Result<(), Difference> {
    for (number, (emulated, host)) in (1..).zip(emulated.rows.iter().zip(&host.rows)) {
        same(format!("kind of row {number}"), [emulated, host].map(|row| row.head.clone()))?;
        let (kind, numbers) = (host.kind(), emulated.bits.iter().zip(&host.bits));
        for (name, (emulated, host)) in host.names().zip(numbers) {
            let what = format!("row {number}, {kind}, {name}");
            same(what, [emulated, host].map(|bits| shown(*bits)))?;
        }
    }
    let runs = [emulated, host];
    same("number of rows".to_owned(), runs.map(|run| run.rows.len().to_string()))?;
    let reason = |run: &Outcome| {
        run.reason.as_deref().map_or("none".to_owned(), |reason| format!("«{}»", short(reason)))
    };
    same("reason".to_owned(), runs.map(reason))
}

fn same(what: String, values: [String; 2]) -> Result<(), Difference> {
    if values[0] == values[1] { Ok(()) } else { Err(Difference { what, values }) }
}

/// Bits, and the number that they are.
fn shown(bits: u64) -> String {
    match bits {
        ABSENT => "none".to_owned(),
        bits => format!("{bits:#018x} ({:e})", f64::from_bits(bits)),
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
