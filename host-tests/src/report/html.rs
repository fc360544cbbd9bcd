//! The page around figures and tables.

use super::chart::{self, DrawError};
use super::{Figure, Lines, Part, Report, Series, Style, Table};

/// Everything that is drawn stands in the file, so it names no font and no other file.
const CSS: &str = "\
body{font:16px/1.5 sans-serif;color:#222;background:#fff;max-width:60rem;margin:2rem auto;\
padding:0 1rem}
h1{font-size:1.6rem;margin-bottom:.3rem}
h2{font-size:1.15rem;margin:2.2rem 0 .6rem}
.subtitle p{margin:0;color:#555}
.figure svg{width:100%;height:auto}
.legend{list-style:none;display:flex;flex-wrap:wrap;gap:.2rem 1.4rem;margin:.2rem 0 0;padding:0}
.legend svg{vertical-align:middle;margin-right:.4rem}
.empty{color:#777;font-style:italic}
.wide{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .9rem .2rem 0;text-align:right;border-bottom:1px solid #ddd}
th:first-child,td:first-child,.lines td{text-align:left}
";

/// The whole page. It is well-formed XML as well, which is how the tests read it.
pub(super) fn document(report: &Report) -> Result<String, DrawError> {
    let title = escaped(&report.title);
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width\"/>\n<title>{title}</title>\n\
         <style>\n{CSS}</style>\n</head>\n<body>\n<h1>{title}</h1>\n<div class=\"subtitle\">\n"
    );
    for line in &report.subtitle {
        page += &element("p", line);
    }
    page += "</div>\n";
    for part in &report.parts {
        page += &match part {
            Part::Figure(figure) => of_figure(figure)?,
            Part::Table(table) => of_table(table),
            Part::Lines(lines) => of_lines(lines),
        };
    }
    page += "</body>\n</html>\n";
    Ok(page)
}

fn of_figure(figure: &Figure) -> Result<String, DrawError> {
    let heading = element("h2", &figure.title);
    let Some(svg) = chart::svg(figure)? else {
        return Ok(format!("{heading}<p class=\"empty\">There are no points to draw.</p>\n"));
    };
    let entries = figure.series.iter().enumerate();
    let legend: String = entries.map(|(index, series)| entry(series, index)).collect();
    Ok(format!(
        "{heading}<div class=\"figure\">\n{svg}</div>\n<ul class=\"legend\">\n{legend}</ul>\n"
    ))
}

/// A line of the legend: a sample of how the series is drawn, and its name.
fn entry(series: &Series, index: usize) -> String {
    let colour = chart::colour(index);
    let colour = format!("rgb({},{},{})", colour.0, colour.1, colour.2);
    let line =
        |more: &str| format!("<path d=\"M0 7H30\" stroke=\"{colour}\" stroke-width=\"2\"{more}/>");
    let dot = format!("<circle cx=\"15\" cy=\"7\" r=\"3.5\" fill=\"{colour}\"/>");
    let sample = match series.style {
        Style::Line => line(""),
        Style::Dashed => line(" stroke-dasharray=\"6 4\""),
        Style::Points => dot,
        Style::LineAndPoints => line("") + &dot,
        Style::Band => {
            format!("<rect width=\"30\" height=\"14\" fill=\"{colour}\" opacity=\"0.2\"/>")
        }
    };
    let name = escaped(&series.name);
    format!("<li><svg width=\"30\" height=\"14\">{sample}</svg>{name}</li>\n")
}

fn of_lines(Lines { title, lines }: &Lines) -> String {
    let heading = if title.is_empty() { String::new() } else { element("h2", title) };
    let rows: String = lines.iter().map(|line| row("td", line)).collect();
    format!("{heading}<div class=\"wide\">\n<table class=\"lines\">\n{rows}</table>\n</div>\n")
}

fn of_table(table: &Table) -> String {
    let mut text = element("h2", &table.title) + "<div class=\"wide\">\n<table>\n";
    text += &row("th", &table.head);
    if table.rows.is_empty() {
        text += &row("td", &["no rows".to_owned()]);
    }
    for cells in &table.rows {
        text += &row("td", cells);
    }
    text + "</table>\n</div>\n"
}

fn row(tag: &str, cells: &[String]) -> String {
    let cells: String = cells.iter().map(|cell| element(tag, cell)).collect();
    format!("<tr>\n{cells}</tr>\n")
}

fn element(tag: &str, text: &str) -> String {
    format!("<{tag}>{}</{tag}>\n", escaped(text))
}

/// The text without what a browser would take for markup.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '&' => safe += "&amp;",
            '"' => safe += "&quot;",
            other => safe.push(other),
        }
    }
    safe
}
