//! A report as text for a terminal.

use super::{Grade, Lines, Look, Part, REMARKS, Report, Share, Shares, Summary, Table, Verbosity};

/// Least width of a label, characters.
const LABEL: usize = 18;
/// Width of a terminal, characters; tables are as wide as they are.
const WIDTH: usize = 80;

/// Heading, what was found, lines below it, labelled lines and tables; figures are left out.
pub(super) fn document(report: &Report, look: Look) -> String {
    let grade = report.summary.as_ref().map(|summary| summary.grade);
    let mut text = format!("{}\n", look.title(&report.title, grade));
    text.extend(report.subtitle.iter().flat_map(|line| [line.as_str(), "\n"]));
    text.extend(report.summary.iter().map(|summary| of_summary(summary, look)));
    let is_enough = report.summary.is_some() && look.verbosity == Verbosity::Quiet;
    for part in report.parts.iter().filter(|_| !is_enough) {
        text += &of_part(part, look.verbosity);
    }
    if look.verbosity == Verbosity::Usual {
        text += &unshown(&report.parts);
    }
    text.trim_end().to_owned()
}

/// What else there is.
fn unshown(parts: &[Part]) -> String {
    let title = |part: &Part| match part {
        Part::Detail(part) => part.title().map(str::to_owned),
        _ => None,
    };
    let titles: Vec<String> = parts.iter().filter_map(title).collect();
    if titles.is_empty() {
        return String::new();
    }
    "\n".to_owned() + &aligned(&[["--verbose adds".to_owned(), titles.join("; ")]])
}

impl Look {
    /// The heading, in the colour of what came of it.
    fn title(self, title: &str, grade: Option<Grade>) -> String {
        match grade {
            Some(Grade::Found) => self.coloured(title, "1;32"),
            Some(Grade::Degraded) => self.coloured(title, "1;33"),
            Some(Grade::Refused | Grade::Interrupted) => self.coloured(title, "1;31"),
            None => self.coloured(title, "1"),
        }
    }

    /// A text in these colours of ECMA-48 (SGR), where there are to be colours.
    fn coloured(self, text: &str, codes: &str) -> String {
        if self.is_coloured { format!("\x1b[{codes}m{text}\x1b[0m") } else { text.to_owned() }
    }
}

/// What was found, or why nothing was; of what it was found where everything is asked for.
fn of_summary(summary: &Summary, look: Look) -> String {
    let Summary { reasons, remarks, found, facts, circumstances, .. } = summary;
    let named = |label: &'static str, all: &[String]| -> Vec<[String; 2]> {
        all.iter().map(|words| [label.to_owned(), words.clone()]).collect()
    };
    let mut lines: Vec<[String; 2]> = Vec::new();
    lines.extend(found.iter().map(|[what, is]| [what.clone(), look.coloured(is, "1")]));
    lines.extend(named("reason", reasons));
    if look.verbosity != Verbosity::Quiet {
        lines.extend(noted(remarks, look.verbosity));
        lines.extend(facts.iter().cloned());
    }
    if look.verbosity == Verbosity::Verbose {
        lines.extend(circumstances.iter().cloned());
    }
    aligned(&lines)
}

/// The remarks, of many only the first ones unless everything is asked for.
fn noted(remarks: &[String], verbosity: Verbosity) -> Vec<[String; 2]> {
    let most = if verbosity == Verbosity::Verbose { usize::MAX } else { REMARKS };
    let others = remarks.len().saturating_sub(most);
    let more = (others > 0).then(|| format!("{others} more, which --verbose tells"));
    let all = remarks.iter().take(most).cloned().chain(more);
    all.map(|words| ["noted".to_owned(), words]).collect()
}

/// A part, where it is to be shown.
fn of_part(part: &Part, verbosity: Verbosity) -> String {
    match part {
        Part::Lines(lines) => of_lines(lines),
        Part::Table(table) => of_table(table),
        Part::Shares(shares) => of_table(&table(shares, verbosity)),
        Part::Detail(part) if verbosity == Verbosity::Verbose => of_part(part, verbosity),
        Part::Detail(_) | Part::Figure(_) | Part::Timeline(_) => String::new(),
    }
}

/// Labels and their values, one below the other.
fn aligned(lines: &[[String; 2]]) -> String {
    let widest = lines.iter().map(|[label, _]| label.chars().count()).max().unwrap_or(0);
    let width = widest.max(LABEL);
    let line =
        |[label, value]: &[String; 2]| format!("  {label:<width$} {}\n", wrapped(value, width + 3));
    lines.iter().map(line).collect()
}

/// Words in lines that fit into a terminal, all of them indented but the first, which stands there already.
fn wrapped(words: &str, indent: usize) -> String {
    let most = WIDTH.saturating_sub(indent);
    let (mut text, mut width) = (String::new(), 0);
    for word in words.split(' ') {
        let long = word.chars().count();
        if width > 0 && width + 1 + long > most {
            text.push('\n');
            text.extend(std::iter::repeat_n(' ', indent));
            width = 0;
        } else if width > 0 {
            text.push(' ');
            width += 1;
        }
        text += word;
        width += long;
    }
    text
}

fn of_lines(Lines { title, lines }: &Lines) -> String {
    heading(title) + &aligned(lines)
}

/// Shares as a table, those that round to nothing only where everything is asked for.
fn table(Shares { title, head, rows, sum }: &Shares, verbosity: Verbosity) -> Table {
    let shown = rows.iter().filter(|share| verbosity == Verbosity::Verbose || share.is_seen());
    let cells = |share: &Share| vec![share.name.clone(), share.value.clone(), share.in_percent()];
    let [name, value] = sum.clone();
    let rows = shown.map(cells).chain([vec![name, value, String::new()]]).collect();
    Table { title: title.clone(), head: head.to_vec(), rows }
}

/// A blank line and the heading, if there is one.
fn heading(title: &str) -> String {
    if title.is_empty() { "\n".to_owned() } else { format!("\n  {}\n", wrapped(title, 2)) }
}

/// Columns as wide as their widest cell: names and words to the left, numbers to the right; nothing of a table without
/// rows.
fn of_table(Table { title, head, rows }: &Table) -> String {
    if rows.is_empty() {
        return String::new();
    }
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
