//! The table that the image `cost` prints.

use serde::Serialize;

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Row {
    /// Heading of the table in which it stands.
    pub heading: String,
    /// What was counted.
    pub what: String,
    /// The count.
    pub count: u64,
    /// Greatest cost that is allowed, where there is a limit.
    pub budget: Option<u64>,
    /// `ok`, or what is wrong; empty without limit.
    pub verdict: String,
}

/// Columns of a row before its name: count, budget, verdict.
const NAME: usize = 28;

/// Reads the table.
///
/// # Errors
/// A line that belongs to no table, or that there is no row.
pub fn parse(text: &str) -> Result<Vec<Row>, String> {
    let (mut heading, mut rows) = ("", Vec::new());
    for line in text.lines().filter(|line| !line.is_empty() && !is_summary(line)) {
        let columns = columns(line).ok_or_else(|| format!("the image `cost` says: {line}"))?;
        if let ["count", .., name] = columns {
            heading = name;
        } else {
            let row = row(heading, columns);
            rows.push(row.ok_or_else(|| format!("no row of a table: {line}"))?);
        }
    }
    if rows.is_empty() { Err("the image `cost` printed no table".to_owned()) } else { Ok(rows) }
}

fn is_summary(line: &str) -> bool {
    ["FAILED", "all within budget"].contains(&line)
}

/// Count, budget, verdict and name.
fn columns(line: &str) -> Option<[&str; 4]> {
    let (left, name) = line.split_at_checked(NAME)?;
    let mut words = left.split_whitespace();
    Some([words.next()?, words.next()?, words.next().unwrap_or(""), name])
}

fn row(heading: &str, [count, budget, verdict, what]: [&str; 4]) -> Option<Row> {
    let budget = if budget == "-" { None } else { Some(budget.parse().ok()?) };
    Some(Row {
        heading: heading.to_owned(),
        what: what.to_owned(),
        count: count.parse().ok()?,
        budget,
        verdict: verdict.to_owned(),
    })
}
