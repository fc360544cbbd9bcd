//! `meridian emulate`: the firmware on an emulated Cortex-M4F.

use clap::Args;
use host::emulate::emulate;
use host::output::{emulation, say};

use super::Answer;

/// What to emulate.
#[derive(Args)]
pub struct EmulateOptions {
    /// What fixes everything random in the simulated world.
    #[arg(long, default_value_t = 1, value_parser = super::seed)]
    seed: u64,
}

/// Runs the firmware's images; whether all is as it must be.
pub fn run(options: &EmulateOptions, as_json: bool) -> Result<Answer, String> {
    let found = emulate(options.seed, |line| say(&line.to_string()))?;
    let object = emulation::object(&found);
    let refusal = (!found.is_right()).then(|| "not all is as it must be".to_owned());
    Answer::of(refusal, as_json, &object, || emulation::report(&found).text())
}
