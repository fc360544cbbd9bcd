//! What the firmware may cost: `firmware/budget.toml`.

use std::fs;
use std::path::Path;

/// The names of the limits.
pub const NAMES: [&str; 24] = [
    "filter_instructions",
    "filter_and_dwell_instructions",
    "match_instructions",
    "conclusion_instructions",
    "allan_instructions",
    "plan_instructions",
    "noise_fit_instructions",
    "turning_instructions",
    "strapdown_instructions",
    "inclination_instructions",
    "vertical_instructions",
    "vertical_greatest_instructions",
    "heading_instructions",
    "spin_instructions",
    "stops_instructions",
    "sample_instructions",
    "turning_sample_instructions",
    "stops_sample_instructions",
    "poll_instructions",
    "survey_poll_instructions",
    "idle_percent",
    "flash_bytes",
    "static_ram_bytes",
    "stack_bytes",
];

/// A limit for each of [`NAMES`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Budget([u64; NAMES.len()]);

impl Budget {
    /// Reads the file.
    ///
    /// # Errors
    /// Its path and what is wrong with it.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|error| error.to_string());
        let budget = text.and_then(|text| Self::parse(&text));
        budget.map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Reads lines `name = whole number`, with `_` between digits and remarks behind `#`.
    ///
    /// # Errors
    /// The line that is none, or the name that is missing.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut limits = [None; NAMES.len()];
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.split('#').next().unwrap_or_default().trim();
            if !line.is_empty() {
                put(&mut limits, line).map_err(|error| format!("line {number}: {error}"))?;
            }
        }
        let mut budget = [0; NAMES.len()];
        for ((place, limit), name) in budget.iter_mut().zip(limits).zip(NAMES) {
            *place = limit.ok_or_else(|| format!("{name} is missing"))?;
        }
        Ok(Self(budget))
    }

    /// The limit of one of [`NAMES`]; zero for another name.
    #[must_use]
    pub fn limit(&self, name: &str) -> u64 {
        NAMES.iter().position(|own| *own == name).map_or(0, |index| self.0[index])
    }
}

fn put(limits: &mut [Option<u64>; NAMES.len()], line: &str) -> Result<(), String> {
    let (name, value) = line.split_once('=').ok_or("not `name = number`")?;
    let (name, value) = (name.trim(), value.trim());
    let index = NAMES.iter().position(|own| *own == name);
    let index = index.ok_or_else(|| format!("`{name}` is no limit"))?;
    let value = value.replace('_', "").parse();
    let value = value.map_err(|_| format!("the limit of {name} is no whole number"))?;
    match limits[index].replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{name} stands twice")),
    }
}
