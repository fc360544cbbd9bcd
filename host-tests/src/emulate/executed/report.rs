//! What the program that executes images reports, as one line of JSON.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// How conversions were served for some time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Service {
    /// Conversions that were read.
    pub read: u64,
    /// Conversions that a newer one replaced before they were read.
    pub lost: u64,
    /// The longest time for which a converter waited to be read, s, whatever it converted meanwhile.
    pub longest_wait_seconds: f64,
}

/// What an execution showed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// The carrier.
    pub carrier: String,
    /// Seed of the world.
    pub seed: u64,
    /// Cycles that an instruction takes.
    pub cycles_per_instruction: f64,
    /// The azimuth with its 1σ and limit, °; none where there is none.
    pub azimuth_deg: Option<[f64; 3]>,
    /// The true azimuth at its time, °.
    pub truth_deg: f64,
    /// The line of the log with which the alignment ended, or else the last one.
    pub outcome: String,
    /// Time from power-on to the result, s.
    pub seconds: f64,
    /// Time from power-on to the first line of the log, s.
    pub start_seconds: f64,
    /// Samples, of all converters together, between the first and the last step of the measurement.
    pub samples: u64,
    /// Instructions for each of these samples, all in; none where there is no sample.
    pub instructions_per_sample: Option<f64>,
    /// Where they go, for each sample; empty where there is none.
    pub instructions_by_origin: BTreeMap<String, f64>,
    /// Part of the time between these steps that the core was asleep.
    pub idle: f64,
    /// How conversions were served until the last step of the measurement, or to its end where it has no steps; from
    /// there to the result; after it.
    pub service: [Service; 3],
    /// Notices of the log that are false, by their words.
    pub false_notices: BTreeMap<String, u64>,
    /// Faults that the link counts at the end.
    pub faults: u64,
    /// Bytes that the stack took at its deepest.
    pub stack_bytes: u64,
    /// Bytes of flash.
    pub flash_bytes: u64,
    /// Bytes of static RAM.
    pub static_bytes: u64,
    /// The longest time with interrupts off: at the start, and after it, s.
    pub masked_seconds: [f64; 2],
    /// What was done to chips and buses that data sheets forbid.
    pub violations: Vec<String>,
    /// Rows of flash that were programmed, pages that were erased, and those of the rows that were programmed with the
    /// data cache on.
    pub flash_use: [u64; 3],
}

impl Report {
    /// Reads a report.
    ///
    /// # Errors
    /// Where it is none.
    pub fn parse(line: &[u8]) -> Result<Self, String> {
        serde_json::from_slice(line)
            .map_err(|error| format!("the report of an executed image: {error}"))
    }

    /// The longest time for which a converter waited to be read, s.
    #[must_use]
    pub fn longest_wait_seconds(&self) -> f64 {
        self.service.iter().map(|service| service.longest_wait_seconds).fold(0.0, f64::max)
    }

    /// Conversions that were lost until the last step of the measurement: the azimuth is made without them.
    #[must_use]
    pub fn lost_measuring(&self) -> u64 {
        self.service[0].lost
    }

    /// Notices of the log that are false.
    #[must_use]
    pub fn false_notices(&self) -> u64 {
        self.false_notices.values().sum()
    }
}
