//! Recordings of all that came to both halves of an instrument, keeping included: JSON, one input a line.
//!
//! The first line is the [`Header`]: what both halves are given, and which program wrote it. Then come the
//! inputs in the order of their arrival, each with its own time, so that the halves do again what they did, to the last
//! bit. What only a simulator knows and the end come last: a file without them is that of a run that was broken off, and
//! replays as far as it goes. What a board was given stands before what it has done, so that nothing need be held in
//! memory while it is written or read.

mod reader;
mod writer;

use std::path::Path;

use orientation::alignment::{rotating, stepwise, stops};
use orientation::attitude;
use orientation::navigation::{self, Policy, aligner};
use serde::{Deserialize, Serialize};

pub use reader::Reader;
pub use writer::Writer;

/// Version of the format. A line that changes its meaning, or goes, raises it.
pub const VERSION: u32 = 1;

/// Endings of the names of such files, the second of a compressed one.
const ENDINGS: [&str; 2] = [".jsonl", ".jsonl.gz"];

/// Whether a file of this name holds inputs.
#[must_use]
pub fn is_named(path: &Path) -> bool {
    let name = path.to_string_lossy().to_lowercase();
    ENDINGS.iter().any(|ending| name.ends_with(ending))
}

/// The first line.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Version of the format, [`VERSION`].
    pub inputs: u32,
    /// Program that wrote the file, with its version.
    pub program: String,
    /// What fixed everything random in the run.
    pub seed: u64,
    /// What both halves were given.
    pub given: Given,
}

/// What both halves of an instrument are given.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Given {
    /// What carries the sensors, with the setting and the procedure of its alignment.
    pub carrier: Carrier,
    /// Site and sensors of the attitude.
    pub attitude: attitude::Setting,
    /// For how long an azimuth is held, and when it is renewed.
    pub policy: Policy,
}

/// Setting and procedure of an alignment, by what carries the sensors.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Carrier {
    /// A stage that stops at positions.
    Stage(Box<(stepwise::setting::Setting, stepwise::session::procedure::Procedure)>),
    /// A mount of two frames.
    TwoFrame(Box<(stepwise::setting::Setting, stepwise::session::procedure::Procedure)>),
    /// A platform that turns all the time.
    Turntable(Box<(rotating::Setting, rotating::session::Procedure)>),
    /// A vehicle that goes from stop to stop.
    Vehicle(Box<(stops::Setting, stops::session::Procedure)>),
}

/// A line below the header, of an instrument whose samples are of the type `S`.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Line<S> {
    /// A sample that the aligner took.
    Sample(S),
    /// Another input of the aligner.
    Aligner(aligner::Input),
    /// An input of the navigator. One that changes nothing is left out: that an alignment runs, or none does, where that
    /// stood before, and that no increment is late where no azimuth waits.
    Navigator(navigation::Input),
    /// True azimuth, pitch and roll at a report, rad: a line each, in their order; for errors alone.
    TruthAttitude([f64; 3]),
    /// The run is over.
    End(End),
}

/// The end of a run: what was written, and what was true then.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct End {
    /// CRC-32 of gzip (RFC 1952) over all lines before, each with its line feed, in hexadecimal digits.
    pub checksum: String,
    /// Azimuth of body x when the latest alignment ended, °.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub truth_azimuth_deg: Option<f64>,
    /// Azimuth of body x at the begin of the first one, °.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub truth_start_azimuth_deg: Option<f64>,
}
