//! The table of the images that were executed.

use execution::report::{Origin, Report as Execution};
use serde_json::{Value, json};

use crate::emulate::executed::{Executed, Options};
use crate::report::{Columns, Lines, Part, Report};

/// What the images found, and what they took.
pub fn report(all: &[Executed], options: &Options) -> Report {
    let complaints: Vec<String> = all.iter().flat_map(Executed::complaints).collect();
    let verdict = if complaints.is_empty() { "Executed" } else { "FAILED" };
    let title =
        format!("{verdict}: the images that are flashed, behind a model of the microcontroller");
    let mut lines = Lines::default().with("seed", options.seed.to_string()).with(
        "time",
        format!("instructions × {} cycles at the clock that the image sets", options.cycles),
    );
    for complaint in complaints {
        lines = lines.with("not right", complaint);
    }
    let parts = [lines.into(), of_results(all), of_time(all), of_instructions(all), of_memory(all)];
    Report::new(title, parts)
}

/// What was found.
fn of_results(all: &[Executed]) -> Part {
    let distance = |of: usize| {
        move |executed: &Executed| match executed.distances().and_then(|distances| distances[of]) {
            Some(distance) => format!("{distance:+.2} σ"),
            None => "-".to_owned(),
        }
    };
    Columns::of("Results, against the truth and the host's run of the same seed", all)
        .column("carrier", |executed| &executed.report.carrier)
        .column("azimuth", |executed| match executed.report.azimuth_deg {
            Some([azimuth, sigma, _]) => format!("{azimuth:.3}° ± {sigma:.3}°"),
            None => "none".to_owned(),
        })
        .column("limit", |executed| match executed.report.azimuth_deg {
            Some([.., limit]) => format!("{limit:.3}°"),
            None => "-".to_owned(),
        })
        .column("off truth", distance(0))
        .column("off host", distance(1))
        .column("lost measuring", |executed| match executed.report.azimuth_deg {
            Some(_) => executed.report.lost_measuring().to_string(),
            None => "-".to_owned(),
        })
        .column("after", |executed| format!("{:.1} s", executed.report.seconds))
        .column("", |executed| &executed.report.outcome)
        .into()
}

/// How conversions were served, and what the log says of it.
fn of_time(all: &[Executed]) -> Part {
    let of = |figure: fn(&Execution) -> String| move |executed: &Executed| figure(&executed.report);
    Columns::of("Time: conversions lost while measuring, until the result, and after it", all)
        .column("carrier", |executed| &executed.report.carrier)
        .column(
            "read",
            of(|report| report.service.iter().map(|service| service.read).sum::<u64>().to_string()),
        )
        .column(
            "lost",
            of(|report| report.service.map(|service| service.lost.to_string()).join(" + ")),
        )
        .column("longest wait", of(|report| milliseconds(report.longest_wait_seconds())))
        .column("false notices", of(|report| report.false_notices().to_string()))
        .column("faults on the link", of(|report| report.faults.to_string()))
        .column("interrupts off", of(|report| milliseconds(report.masked_seconds[1])))
        .column("at the start", of(|report| milliseconds(report.masked_seconds[0])))
        .column("first line after", of(|report| milliseconds(report.start_seconds)))
        .into()
}

/// Seconds as milliseconds.
fn milliseconds(seconds: f64) -> String {
    format!("{:.2} ms", seconds * 1e3)
}

/// Instructions of a sample, by where they go.
fn of_instructions(all: &[Executed]) -> Part {
    let columns = Columns::of(
        "INSTRUCTIONS (not cycles) a sample while measuring, all in, by where they go",
        all,
    )
    .column("carrier", |executed| &executed.report.carrier)
    .column("samples", |executed| executed.report.samples)
    .column("idle", |executed| format!("{:.0} %", 100.0 * executed.report.idle))
    .column("all in", |executed| instructions(executed.report.instructions_per_sample));
    let columns = Origin::ALL.into_iter().fold(columns, |columns, origin| {
        columns.column(origin.name(), move |executed| {
            let Execution { instructions_per_sample, instructions_by_origin, .. } =
                &executed.report;
            let some = instructions_by_origin.get(&origin).copied().unwrap_or(0.0);
            instructions(instructions_per_sample.map(|_| some))
        })
    });
    columns.into()
}

/// Instructions of a sample, where there is one.
fn instructions(count: Option<f64>) -> String {
    count.map_or_else(|| "-".to_owned(), |count| format!("{count:.0}"))
}

/// Memory, and what the flash was used for.
fn of_memory(all: &[Executed]) -> Part {
    Columns::of("Memory, bytes", all)
        .column("carrier", |executed| &executed.report.carrier)
        .column("flash", |executed| executed.report.flash_bytes)
        .column("static RAM", |executed| executed.report.static_bytes)
        .column("stack at its deepest", |executed| executed.report.stack_bytes)
        .column("rows programmed", |executed| executed.report.flash_use.rows)
        .column("with the data cache on", |executed| executed.report.flash_use.rows_with_cache_on)
        .column("pages erased", |executed| executed.report.flash_use.pages)
        .into()
}

/// The executions as one JSON object.
#[must_use]
pub fn object(all: &[Executed]) -> Value {
    let complaints: Vec<String> = all.iter().flat_map(Executed::complaints).collect();
    let carriers = all.iter().map(|executed| {
        let [from_truth, from_host] = executed.distances().unwrap_or([None; 2]);
        json!({
            "execution": executed.report,
            "host_azimuth_deg": executed.host_deg,
            "from_truth_sigma": from_truth,
            "from_host_sigma": from_host,
        })
    });
    json!({
        "status": if complaints.is_empty() { "ok" } else { "failed" },
        "complaints": complaints,
        "carriers": carriers.collect::<Vec<_>>(),
    })
}
