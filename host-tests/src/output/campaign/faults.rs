//! The report of `campaign faults`.

use crate::campaign::faults::Row;
use crate::report::{Report, Table};

/// What came of every fault on every platform.
#[must_use]
pub fn report(rows: &[Row]) -> Report {
    let head = [
        "platform",
        "fault",
        "outcome",
        "error, σ",
        "faults",
        "repeated",
        "left out",
        "after, s",
        "noticed",
        "what the board noticed first → why it refused",
    ];
    let table = Table::new("Faults", &head);
    let table = Table { rows: rows.iter().map(line).collect(), ..table };
    let title = "Every fault on every platform".to_owned();
    Report { title, subtitle: Vec::new(), parts: vec![table.into()] }
}

fn line(row: &Row) -> Vec<String> {
    let none = || "-".to_owned();
    let count = |count: Option<usize>| count.map_or_else(none, |count| count.to_string());
    let is_noticed = match row.is_noticed {
        None => "-",
        Some(true) => "yes",
        Some(false) => "NO",
    };
    let first = row.noticed.as_deref().unwrap_or("nothing");
    let reason = row.reason.as_ref().map(|reason| format!(" → {reason}"));
    vec![
        row.platform.to_string(),
        row.fault.clone(),
        row.outcome.to_string(),
        row.error_sigmas.map_or_else(none, |sigmas| format!("{sigmas:+.2}")),
        row.faults.to_string(),
        count(row.repeated),
        count(row.left_out),
        format!("{:.1}", row.seconds),
        is_noticed.to_owned(),
        format!("{first}{}", reason.unwrap_or_default()),
    ]
}
