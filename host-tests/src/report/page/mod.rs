//! The page around figures and tables: one file that loads nothing.

mod chart;
mod markup;
mod palette;
mod papers;
mod rose;
mod span;
mod timeline;

use self::markup::{element, escaped};
use self::palette::Palette;
use super::{Lines, Part, REMARKS, Report, Share, Shares, Summary, Table};

/// How the page looks, in light and dark, on paper and on a phone.
const STYLE: &str = include_str!("style.css");
/// Shows values under the pointer, and unfolds everything for paper.
const SCRIPT: &str = include_str!("script.js");
/// Columns of a table beyond which a phone shows each row as a card.
const NARROW: usize = 4;
/// Most rows of a table: more make a page too large to be sent around.
const ROWS: usize = 200;

/// The whole page.
pub(super) fn document(report: &Report) -> String {
    let title = escaped(&report.title);
    let head = match &report.summary {
        Some(summary) => headed(report, summary),
        None => format!("<h1>{title}</h1>\n"),
    };
    let subtitle: String = report.subtitle.iter().map(|line| element("p", line)).collect();
    let mut palette = Palette::default();
    let parts: String = report.parts.iter().map(|each| part(each, &mut palette)).collect();
    let papers = papers::papers(&format!("{head}{subtitle}{parts}"));
    let origin = origin();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n{head}\
         <div class=\"subtitle\">\n{subtitle}</div>\n{origin}</header>\n<main>\n{parts}{papers}</main>\n\
         <script>\n{SCRIPT}</script>\n</body>\n</html>\n"
    )
}

/// What was found or why nothing was, with the compass beside it.
fn headed(report: &Report, summary: &Summary) -> String {
    let Summary { grade, reasons, remarks, found, facts, circumstances, rose } = summary;
    let class = grade.word();
    // An answer to a question, as a plan is, was not found in anything.
    let is_answer = found.is_none() && reasons.is_empty() && remarks.is_empty();
    let badge = if is_answer {
        String::new()
    } else {
        format!("<span class=\"badge {class}\">{class}</span>\n")
    };
    let what = found.as_ref().map_or(String::new(), |[what, is]| {
        let (what, is) = (element("p class=\"what\"", what), element("p class=\"value\"", is));
        format!("{is}{what}")
    });
    let first = each("reason", reasons) + &what + &of_remarks(remarks);
    let lines: String = facts.iter().chain(circumstances).map(fact).collect();
    let compass = rose.as_ref().map(rose::rose).unwrap_or_default();
    let title = escaped(&report.title);
    format!(
        "<div class=\"head\"><div class=\"result\">\n{badge}<h1>{title}</h1>\n{first}\
         <dl class=\"facts\">\n{lines}</dl>\n</div>\n{compass}</div>\n"
    )
}

/// A paragraph of a class for each.
fn each(class: &str, all: &[String]) -> String {
    all.iter().map(|words| element(&format!("p class=\"{class}\""), words)).collect()
}

/// The first remarks; where there are many the others are folded away.
fn of_remarks(all: &[String]) -> String {
    let (first, others) = all.split_at(all.len().min(REMARKS));
    let more = if others.is_empty() {
        String::new()
    } else {
        let summary = element("summary", &format!("{} more", others.len()));
        format!("<details>\n{summary}{}</details>\n", each("remark", others))
    };
    each("remark", first) + &more
}

fn fact([label, value]: &[String; 2]) -> String {
    format!("<div>{}{}</div>\n", element("dt", label), element("dd", value))
}

/// Who made the page: program, version, and what was asked of it.
fn origin() -> String {
    // A name of a file need not be text.
    let words = std::env::args_os().skip(1);
    let arguments: Vec<String> = words.map(|word| quoted(&word.to_string_lossy())).collect();
    let command = escaped(&format!("meridian {}", arguments.join(" ")));
    format!("<p class=\"origin\">{}: <code>{command}</code></p>\n", escaped(crate::VERSION))
}

/// A word of a command line, in quotes where a shell would take it for several.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_=./:,+%@".contains(c);
    let is_safe = !word.is_empty() && word.chars().all(is_plain);
    if is_safe { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

fn part(part: &Part, palette: &mut Palette) -> String {
    match part {
        Part::Figure(figure) => chart::figure(figure, palette),
        Part::Timeline(timeline) => timeline::timeline(timeline),
        Part::Table(table) => section(&table.title, &of_table(table)),
        Part::Lines(lines) => section(&lines.title, &of_lines(lines)),
        Part::Shares(shares) => section(&shares.title, &of_shares(shares)),
        Part::Detail(part) => of_detail(part, palette),
    }
}

/// A part under its heading, if it has one.
fn section(title: &str, content: &str) -> String {
    let heading = if title.is_empty() { String::new() } else { element("h2", title) };
    format!("<section>\n{heading}{content}</section>\n")
}

/// A part that is folded away under its heading.
fn of_detail(detail: &Part, palette: &mut Palette) -> String {
    let (title, content) = match detail {
        Part::Table(table) => (&table.title, of_table(table)),
        Part::Lines(lines) => (&lines.title, of_lines(lines)),
        Part::Shares(shares) => (&shares.title, of_shares(shares)),
        Part::Figure(figure) => (&figure.title, chart::figure(figure, palette)),
        Part::Timeline(timeline) => (&timeline.title, timeline::timeline(timeline)),
        Part::Detail(inner) => return of_detail(inner, palette),
    };
    format!("<details>\n{}{content}</details>\n", element("summary", title))
}

fn of_lines(Lines { lines, .. }: &Lines) -> String {
    let lines: String = lines.iter().map(fact).collect();
    format!("<dl class=\"facts\">\n{lines}</dl>\n")
}

/// A share with its bar.
fn of_share(share: &Share) -> String {
    let (name, value) = (element("td", &share.name), element("td", &share.value));
    let (percent, width) = (share.in_percent(), share.percent.clamp(0.0, 100.0));
    format!(
        "<tr>\n{name}{value}<td><i class=\"bar\" style=\"width:{width:.1}%\"></i>\
         <span>{percent} %</span></td>\n</tr>\n"
    )
}

/// Shares with a bar each, the greatest first; those that round to nothing are left out.
fn of_shares(Shares { head, rows, sum, .. }: &Shares) -> String {
    let mut rows: Vec<_> = rows.iter().filter(|share| share.is_seen()).collect();
    rows.sort_by(|a, b| b.percent.total_cmp(&a.percent));
    let bars: Vec<String> = rows.into_iter().map(of_share).collect();
    let bars = bars.concat();
    let [name, value] = sum.each_ref().map(|text| element("td", text));
    let sum = format!("<tr class=\"sum\">\n{name}{value}<td></td>\n</tr>\n");
    format!("<table class=\"shares\">\n{}{bars}{sum}</table>\n", row("th", head, head))
}

/// A table; nothing but its columns' names where it has no rows, and where it has many only the first ones.
fn of_table(Table { head, rows, .. }: &Table) -> String {
    let class = if head.len() > NARROW { " class=\"cards\"" } else { "" };
    let body: String = rows.iter().take(ROWS).map(|cells| row("td", cells, head)).collect();
    let none = if rows.is_empty() { row("td", &["none".to_owned()], head) } else { String::new() };
    let more = rows.len().saturating_sub(ROWS);
    let more = if more > 0 {
        element("p", &format!("{more} more rows are not shown."))
    } else {
        String::new()
    };
    let head = row("th", head, head);
    format!(
        "<table{class}>\n<thead>\n{head}</thead>\n<tbody>\n{body}{none}</tbody>\n</table>\n{more}"
    )
}

/// A row; each cell knows the name of its column, for where it stands without its head.
fn row(tag: &str, cells: &[String], head: &[String]) -> String {
    let names = head.iter().map(|name| escaped(name)).chain(std::iter::repeat(String::new()));
    let cell = |(cell, name): (&String, String)| {
        let opening = format!("{tag} data-column=\"{name}\"");
        element(if tag == "td" { &opening } else { tag }, cell)
    };
    let cells: String = cells.iter().zip(names).map(cell).collect();
    format!("<tr>\n{cells}</tr>\n")
}
