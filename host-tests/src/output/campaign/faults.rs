//! The report of `campaign faults`.

use std::fmt::Display;

use super::Columns;
use crate::campaign::faults::Row;
use crate::report::Report;

/// What came of every fault on every platform.
pub(crate) fn report(rows: &[Row]) -> Report {
    let table = Columns::of("Faults", rows)
        .column("platform", |row| row.platform)
        .column("fault", |row| &row.fault)
        .column("outcome", |row| row.outcome)
        .column("error, σ", |row| or_dash(row.error_sigmas.map(|sigmas| format!("{sigmas:+.2}"))))
        .column("faults", |row| row.faults)
        .column("repeated", |row| or_dash(row.repeated))
        .column("left out", |row| or_dash(row.left_out))
        .fixed("after, s", 1, |row| row.seconds)
        .column("noticed", |row| or_dash(row.is_noticed.map(|is| if is { "yes" } else { "NO" })))
        .column("what the board noticed first → why it refused", |row| {
            let reason = row.reason.as_ref().map(|reason| format!(" → {reason}"));
            let first = row.noticed.as_deref().unwrap_or("nothing");
            format!("{first}{}", reason.unwrap_or_default())
        });
    let title = "Every fault on every platform".to_owned();
    Report { title, subtitle: Vec::new(), parts: vec![table.into()] }
}

fn or_dash(value: Option<impl Display>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| value.to_string())
}
