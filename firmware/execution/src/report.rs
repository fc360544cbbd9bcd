//! What an execution shows: one line of JSON, which `emulated-board` writes and `meridian emulate` reads.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

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
    /// The last line of the log that says how the alignment ended, or else the last line.
    pub outcome: String,
    /// Time from power-on to the result, s.
    pub seconds: f64,
    /// Time from power-on to the first line of the log, s.
    pub start_seconds: f64,
    /// Why the board was reset after its power-on, each time.
    pub resets: Vec<String>,
    /// Samples, of which each has a conversion of every converter, between the first and the last step of the measurement; where it has not
    /// two of them, from when all chips were configured to the end.
    pub samples: u64,
    /// Instructions for each of these samples, all in; none where there is no sample.
    pub instructions_per_sample: Option<f64>,
    /// Where they go, for each sample; empty where there is none.
    pub instructions_by_origin: BTreeMap<Origin, f64>,
    /// Part of the time of these samples that the core was asleep.
    pub idle: f64,
    /// How conversions were served: from when all chips were configured to the last step of the measurement, or to its
    /// end where it has no steps; from there to the result; after it.
    pub service: [Service; 3],
    /// Notices of the log that are false, by their words: chips and world are sound. Of samples that are said to be
    /// missing, those beyond the conversions that each converter lost.
    pub false_notices: BTreeMap<String, u64>,
    /// Faults that the link counts at the end.
    pub faults: u64,
    /// Bytes that the stack took at its deepest.
    pub stack_bytes: u32,
    /// Bytes of flash.
    pub flash_bytes: u32,
    /// Bytes of static RAM.
    pub static_bytes: u32,
    /// The longest time with interrupts held back: at the start, and after it, s.
    pub masked_seconds: [f64; 2],
    /// What was done to chips and buses that data sheets forbid, and a stack that reached the statics.
    pub violations: Vec<String>,
    /// What was done to the flash.
    pub flash_use: FlashUse,
}

/// How conversions were served for some time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Service {
    /// Conversions that were read.
    pub read: u64,
    /// Conversions that a newer one replaced before they were read.
    pub lost: u64,
    /// The longest time for which a converter waited to be read, s: from the end of the first conversion that was not
    /// read at once, whatever replaced it meanwhile, to the next reading, or to now, where it still waits.
    pub longest_wait_seconds: f64,
}

/// What the program does to its flash.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FlashUse {
    /// Rows that were programmed.
    pub rows: u64,
    /// Those whose programming began with the data cache on. The core runs from one bank and programs the other, which
    /// may then corrupt the cache: an erratum of this controller, described in `hal_mock::flash::data_cache`, whose
    /// remedy is to switch the cache off before a write and to reset it after it.
    pub rows_with_cache_on: u64,
    /// Pages that were erased.
    pub pages: u64,
}

/// Where instructions go, by the source that they come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// The methods: what is done with a sample.
    Methods,
    /// The instrument around them.
    Instrument,
    /// The drivers of the chips.
    Drivers,
    /// The peripherals' drivers, interrupts included.
    Peripherals,
    /// Channels, locks, tasks and wakers.
    Channels,
    /// Time and alarms.
    Time,
    /// Memory that is copied and cleared.
    Memory,
    /// Arithmetic that the core has no instructions for.
    Arithmetic,
    /// The log.
    Log,
    /// The store in flash.
    Store,
    /// What no line tells.
    Other,
}

impl Origin {
    /// All of them; those that most goes to come first.
    pub const ALL: [Self; 11] = [
        Self::Peripherals,
        Self::Channels,
        Self::Time,
        Self::Instrument,
        Self::Arithmetic,
        Self::Methods,
        Self::Drivers,
        Self::Memory,
        Self::Store,
        Self::Log,
        Self::Other,
    ];

    /// Its name, as reports have it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Methods => "methods",
            Self::Instrument => "instrument",
            Self::Drivers => "drivers",
            Self::Peripherals => "peripherals",
            Self::Channels => "channels",
            Self::Time => "time",
            Self::Memory => "memory",
            Self::Arithmetic => "arithmetic",
            Self::Log => "log",
            Self::Store => "store",
            Self::Other => "other",
        }
    }
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

impl Service {
    /// Adds what came later.
    pub fn add(&mut self, later: Self) {
        self.read += later.read;
        self.lost += later.lost;
        self.longest_wait_seconds = self.longest_wait_seconds.max(later.longest_wait_seconds);
    }
}
