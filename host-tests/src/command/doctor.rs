//! `meridian doctor`: what is needed to build, flash and talk, and how to get what is missing.

use host::doctor::environment::{Environment, Here};
use host::doctor::{Finding, findings};
use host::output::manner::Manner;
use host::report::{Columns, Report};
use serde_json::{Value, json};

use super::{Answer, Failure};

/// Looks for everything on this computer.
pub fn run(manner: Manner) -> Result<Answer, Failure> {
    let found = findings(&Here);
    let missing = found.iter().filter(|finding| finding.stops_the_board());
    let missing: Vec<_> = missing.map(|finding| finding.what).collect();
    let refusal = (!missing.is_empty())
        .then(|| format!("`cargo board` lacks what it needs: {}", missing.join(", ")));
    let object = object(&found);
    Ok(Answer::reported(refusal, manner, &object, || report(&found))?)
}

/// What was found, and what to do, as tables: a command that is to be copied stands in one line.
fn report(found: &[Finding]) -> Report {
    let is_whole = !found.iter().any(Finding::stops_the_board);
    let title = if is_whole { "Ready for a board" } else { "Not ready for a board" };
    let table = Columns::of("", found)
        .column("what", |finding| finding.what)
        .column("", Finding::state)
        .column("needed for", |finding| finding.need.command())
        .column("which", Finding::words);
    let lacking: Vec<_> = found.iter().filter(|finding| finding.remedy().is_some()).collect();
    let remedies = Columns::of("What mends it", &lacking)
        .column("what", |finding| finding.what)
        .column("command or deed", |finding| finding.remedy().unwrap_or_default());
    let system = format!("on {}", Here.system().name());
    Report::new(format!("{title}, {system}"), [table.into(), remedies.into()])
}

/// What was found as one object.
fn object(found: &[Finding]) -> Value {
    let findings = found.iter().map(|finding| {
        json!({
            "what": finding.what,
            "state": finding.state(),
            "needed_for": finding.need.command(),
            "found": finding.words(),
            "remedy": finding.remedy(),
        })
    });
    json!({
        "status": "ok",
        "system": Here.system().name(),
        "findings": findings.collect::<Vec<_>>(),
    })
}
