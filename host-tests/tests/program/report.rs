//! The HTML report: a page that any browser reads, with every point where it belongs.

use std::path::{Path, PathBuf};

use host::report::{Axis, Figure, Part, Point, Report, Series, Style, Table};

use crate::support::files::Scratch;

/// A page written and read back.
fn page(name: &str, parts: Vec<Part>) -> String {
    let scratch = Scratch::new("report");
    let path = PathBuf::from(scratch.path(name));
    let subtitle = vec!["first line".to_owned(), "rate < 10 Hz & \"quoted\"".to_owned()];
    let report = Report { title: "A & B <i>".to_owned(), subtitle, parts };
    report.write(&path).expect("the folder is ours");
    scratch.read(name)
}

/// A figure over these axes.
fn figure(x: Axis, y: Axis, series: Vec<Series>) -> Figure {
    Figure { title: "Rate".to_owned(), x, y, series }
}

fn linear(series: Vec<Series>) -> Figure {
    figure(["time", "s"].into(), ["rate", "°/h"].into(), series)
}

fn logarithmic(series: Vec<Series>) -> Figure {
    let x = Axis::logarithmic("averaging time", "s");
    figure(x, Axis::logarithmic("deviation", "°/h"), series)
}

/// The values of an attribute, over all elements of this name that hold `with`.
fn attributes(text: &str, element: &str, with: &str, name: &str) -> Vec<String> {
    let start = format!("<{element} ");
    let elements = text.split(&start).skip(1).map(|rest| rest.split('>').next().unwrap_or(""));
    let key = format!(" {name}=\"");
    let value = |tag: &str| {
        let tag = format!(" {tag}");
        tag.split(&key).nth(1).and_then(|rest| rest.split('"').next()).map(str::to_owned)
    };
    elements.filter(|tag| tag.contains(with)).filter_map(value).collect()
}

/// The first series' colour, as only its own elements have it.
const FIRST: &str = "#0072B2";

/// The corners of a list `x,y x,y …`.
fn corners(points: &str) -> Vec<(f64, f64)> {
    let pair = |text: &str| {
        let (x, y) = text.split_once(',').expect("a pair");
        (x.parse().expect("a number"), y.parse().expect("a number"))
    };
    points.split_whitespace().map(pair).collect()
}

/// The corners of the only line of the first series.
fn line(text: &str) -> Vec<(f64, f64)> {
    let lines = attributes(text, "polyline", FIRST, "points");
    assert_eq!(lines.len(), 1, "{lines:?}");
    corners(&lines[0])
}

/// Panics unless every element is closed in order and every `&` starts an entity.
fn assert_well_formed(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    let body = text.strip_prefix("<!DOCTYPE html>").expect("it is HTML");
    for piece in body.split('<').skip(1) {
        let (tag, after) = piece.split_once('>').expect("a tag ends");
        assert!(!after.contains('>'), "a stray > in {after}");
        let name = tag.split_whitespace().next().expect("a tag has a name");
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
    }
    assert!(open.is_empty(), "{open:?}");
    for entity in body.split('&').skip(1) {
        let name = entity.split(';').next().unwrap_or("");
        assert!(["lt", "gt", "amp", "quot", "apos"].contains(&name), "&{name}");
    }
}

/// A point with its limits.
fn bar((x, y, limits): (f64, f64, [f64; 2])) -> Point {
    Point { x, y, limits: Some(limits) }
}

#[test]
fn a_page_with_everything_in_it_is_well_formed_and_needs_no_other_file() {
    let styles = [Style::Line, Style::Dashed, Style::Points, Style::LineAndPoints, Style::Band];
    let series = styles.map(|style| {
        let points = (1..20).map(f64::from).map(|x| bar((x, x * x, [x, 2.0 * x * x])));
        Series::new(&format!("<{style:?}> & \"more\""), style, points)
    });
    let table = Table {
        title: "N < K".to_owned(),
        head: vec!["a & b".to_owned(), "°/√h".to_owned()],
        rows: vec![vec!["<1>".to_owned(), "2".to_owned()]],
    };
    let parts = vec![
        linear(series.to_vec()).into(),
        logarithmic(series.to_vec()).into(),
        table.into(),
        Table::default().into(),
    ];
    let text = page("everything.html", parts);
    assert_well_formed(&text);
    let outside = text.replace("http://www.w3.org/2000/svg", "");
    for reference in ["http", "src=", "href=", "url(", "@import"] {
        assert!(!outside.contains(reference), "{reference}");
    }
    for part in ["A &amp; B &lt;i&gt;", "rate &lt; 10 Hz", "&lt;1&gt;", "&lt;Band&gt; &amp;"] {
        assert!(text.contains(part), "{part}");
    }
}

#[test]
fn each_style_draws_what_it_says() {
    let drawn = |style| {
        let points = [(0.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 4.0)];
        let text = page(
            &format!("{style:?}.html"),
            vec![linear(vec![Series::new("a", style, points)]).into()],
        );
        let count = |element| attributes(&text, element, FIRST, "opacity").len();
        (count("polyline"), count("circle"))
    };
    assert_eq!(drawn(Style::Line), (1, 0));
    assert_eq!(drawn(Style::Points), (0, 4));
    assert_eq!(drawn(Style::LineAndPoints), (1, 4));
    let (dashes, dots) = drawn(Style::Dashed);
    assert!(dashes > 20 && dots == 0, "{dashes} dashes");
}

#[test]
fn a_linear_axis_keeps_differences_and_points_upward() {
    let points = [(0.0, 0.0), (1.0, 10.0), (3.0, -20.0)];
    let text =
        page("linear.html", vec![linear(vec![Series::new("a", Style::Line, points)]).into()]);
    let [a, b, c] = line(&text).try_into().expect("three corners");
    assert!(((c.0 - a.0) / (b.0 - a.0) - 3.0).abs() < 0.01);
    assert!(((c.1 - a.1) / (b.1 - a.1) + 2.0).abs() < 0.01);
    assert!(b.1 < a.1, "up is up");
}

#[test]
fn a_logarithmic_axis_keeps_ratios_and_leaves_out_what_is_not_above_zero() {
    let points = [(0.1, 1e-3), (0.0, 1.0), (1.0, 1e-2), (2.0, 0.0), (3.0, -5.0), (100.0, 1e-3)];
    let curve = Series::new("a", Style::Line, points);
    let text = page("logarithmic.html", vec![logarithmic(vec![curve]).into()]);
    let [a, b, c] = line(&text).try_into().expect("three corners");
    assert!(((c.0 - a.0) / (b.0 - a.0) - 3.0).abs() < 0.01);
    assert_eq!(a.1, c.1);
}

#[test]
fn points_that_are_not_finite_are_left_out() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let points = [(0.0, 1.0), (nan, 2.0), (1.0, inf), (-inf, 3.0), (1.0, nan), (2.0, 5.0)];
    let text =
        page("finite.html", vec![linear(vec![Series::new("a", Style::Line, points)]).into()]);
    assert_eq!(line(&text).len(), 2);
    assert!(!text.contains("NaN") && !text.contains("inf"));
}

#[test]
fn a_figure_without_points_says_so() {
    let nothing = Series::new("a", Style::Line, [(f64::NAN, 1.0)]);
    let below = Series::new("b", Style::Points, [(1.0, -1.0)]);
    let parts =
        vec![linear(vec![]).into(), linear(vec![nothing]).into(), logarithmic(vec![below]).into()];
    let text = page("empty.html", parts);
    assert_eq!(text.matches("There are no points to draw.").count(), 3);
    assert_well_formed(&text);
}

#[test]
fn one_point_alone_stands_in_the_middle() {
    let text =
        page("one.html", vec![linear(vec![Series::new("a", Style::Points, [(7.0, 0.0)])]).into()]);
    let [x, y] = ["cx", "cy"].map(|name| attributes(&text, "circle", FIRST, name)[0].clone());
    let place = |text: String| text.parse::<f64>().expect("a number");
    assert!((800.0..1200.0).contains(&place(x)) && (350.0..650.0).contains(&place(y)));
}

#[test]
fn every_axis_names_its_unit_and_every_series_stands_in_the_legend() {
    let curves =
        ["fit", "data"].map(|name| Series::new(name, Style::Line, [(1.0, 1.0), (2.0, 3.0)]));
    let text = page("units.html", vec![logarithmic(curves.to_vec()).into()]);
    for part in ["averaging time, s", "deviation, °/h", "</svg>fit</li>", "</svg>data</li>"] {
        assert!(text.contains(part), "{part}");
    }
}

/// The numbers beside the axes, in the order in which they are drawn.
fn numbers(text: &str) -> Vec<String> {
    let texts = text.split("<text ").skip(1);
    let inner = texts.filter_map(|rest| rest.split_once('>')?.1.split('<').next());
    inner.map(|number| number.trim().to_owned()).collect()
}

#[test]
fn ticks_carry_round_numbers() {
    let wide = Series::new("a", Style::Line, [(0.01, 1e-6), (5e4, 2e3)]);
    let found = numbers(&page("ticks.html", vec![logarithmic(vec![wide]).into()]));
    for tick in ["0.01", "1", "10⁴", "10⁻⁶", "10⁻⁴"] {
        assert!(found.iter().any(|number| number == tick), "{tick} is not in {found:?}");
    }
    let narrow = Series::new("a", Style::Line, [(1.5, 0.02), (6.0, 0.3)]);
    let found = numbers(&page("narrow.html", vec![logarithmic(vec![narrow.clone()]).into()]));
    assert_eq!(found[2..], ["0.02", "0.05", "0.1", "0.2", "2", "5"], "{found:?}");
    let found = numbers(&page("decimals.html", vec![linear(vec![narrow]).into()]));
    for tick in ["2", "5", "0.05", "0.30"] {
        assert!(found.iter().any(|number| number == tick), "{tick} is not in {found:?}");
    }
}

#[test]
fn limits_become_bars_that_are_cut_at_the_edge() {
    let points =
        [(1.0, 2.0, [1.0, 4.0]), (10.0, 3.0, [0.0, f64::INFINITY]), (20.0, 3.0, [f64::NAN, 5.0])];
    let bars = Series::new("a", Style::Points, points.map(bar));
    let text = page("bars.html", vec![logarithmic(vec![bars]).into()]);
    let uprights: Vec<_> = attributes(&text, "polyline", FIRST, "points")
        .iter()
        .map(|points| corners(points))
        .filter(|corners| corners[0].0 == corners[1].0)
        .collect();
    assert_eq!(uprights.len(), 2, "the third point has no limits");
    let height = |bar: &[(f64, f64)]| bar[0].1 - bar[1].1;
    assert!(height(&uprights[1]) > height(&uprights[0]));
    assert!(uprights.iter().flatten().all(|(_, y)| (0.0..=1000.0).contains(y)));
}

#[test]
fn a_band_runs_along_its_lower_limits_and_back_along_the_upper_ones() {
    let points = [(0.0, 2.0, [1.0, 3.0]), (1.0, 2.0, [1.5, 2.5])];
    let text = page(
        "band.html",
        vec![linear(vec![Series::new("a", Style::Band, points.map(bar))]).into()],
    );
    let [a, b, c, d] = corners(&attributes(&text, "polygon", FIRST, "points")[0])
        .try_into()
        .expect("four corners");
    assert_eq!((a.0, b.0), (d.0, c.0));
    assert!(a.1 > b.1 && b.1 > c.1 && c.1 > d.1);
}

#[test]
fn a_path_that_cannot_be_written_is_named() {
    let missing = Path::new("/no/such/folder/report.html");
    let scratch = Scratch::new("folder");
    for (path, reason) in [
        (missing, "there is no such folder: /no/such/folder"),
        (scratch.folder(), "it is a directory; name a file in it"),
    ] {
        let error = Report::default().write(path).expect_err("it cannot be written");
        let expected = format!("{}: the report cannot be written: {reason}", path.display());
        assert_eq!(error, expected);
    }
}
