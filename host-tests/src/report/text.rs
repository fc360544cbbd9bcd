//! A report as text for a terminal.

use super::{Lines, Part, Report, Table};

/// Width of a label, characters.
const LABEL: usize = 18;

/// Heading, lines below it, labelled lines and tables; figures are left out.
pub(super) fn document(report: &Report) -> String {
    let mut text = format!("\n{}\n", report.title);
    text.extend(report.subtitle.iter().flat_map(|line| [line.as_str(), "\n"]));
    for part in &report.parts {
        match part {
            Part::Lines(lines) => text += &of_lines(lines),
            Part::Table(table) => text += &of_table(table),
            Part::Figure(_) => {}
        }
    }
    text.trim_end().to_owned()
}

fn of_lines(Lines { title, lines }: &Lines) -> String {
    let line = |[label, value]: &[String; 2]| format!("  {label:<LABEL$} {value}\n");
    heading(title) + &lines.iter().map(line).collect::<String>()
}

/// A blank line and the heading, if there is one.
fn heading(title: &str) -> String {
    if title.is_empty() { "\n".to_owned() } else { format!("\n  {title}\n") }
}

/// Columns as wide as their widest cell: names and words to the left, numbers to the right.
fn of_table(Table { title, head, rows }: &Table) -> String {
    let width = |column: usize| {
        let cells = rows.iter().chain([head]).filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let holds_words = |column: usize| rows.iter().any(|row| is_prose(&row[column]));
    let is_left: Vec<bool> =
        (0..head.len()).map(|column| column == 0 || holds_words(column)).collect();
    let mut text = heading(title);
    for row in [head].into_iter().chain(rows) {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if is_left[column] { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        text += format!("    {}", cells.collect::<Vec<_>>().join("  ")).trim_end();
        text += "\n";
    }
    text
}

/// Whether a cell holds words rather than a number.
fn is_prose(cell: &str) -> bool {
    cell.chars().filter(|character| character.is_alphabetic()).count() > 3
}
