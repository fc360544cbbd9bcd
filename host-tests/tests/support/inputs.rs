//! Runs recorded as inputs in memory, and replayed.

use firmware::ports::{NoRecorder, Store};
use host::instrument::Trial;
use host::instrument::recorder::Recorded;
use host::instrument::replay::{Replayed, replay_lines};
use host::recording::ReadError;
use host::recording::inputs::{Reader, Writer};
use serde::Serialize;

/// A finished run of a carrier, and its inputs.
pub fn recorded<C: Recorded<Sample: Serialize + Copy>, T: Store>(
    carrier: &C,
    trial: Trial<'_, C, NoRecorder, T>,
) -> (C::Run, String) {
    let given = carrier.given().expect("a latitude");
    let writer = Writer::new(Vec::new(), 1, given).expect("memory takes it");
    let run = trial.record(&writer).watch(&writer).run().expect("the scenario is possible");
    let (kept, truth) = carrier.end_of(&run);
    let text = writer.finish(kept, &truth).expect("memory takes it");
    (run, String::from_utf8(text).expect("it is text"))
}

/// What came of inputs under the name `run.jsonl`.
pub fn replayed(text: &str) -> Result<Replayed, ReadError> {
    let (header, mut lines) = Reader::new("run.jsonl", text.as_bytes())?;
    replay_lines(&header.given, &mut lines)
}
