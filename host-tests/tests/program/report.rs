//! Pages: a report that any browser reads, with every point where it belongs, and nothing loaded.

use std::path::{Path, PathBuf};

use host::output::azimuth_error;
use host::report::{
    Axis, Figure, Grade, Kind, Lane, Note, Part, Point, Report, Rose, Series, Share, Shares,
    Stretch, Style, Summary, Table, Timeline,
};

use crate::support::files::Scratch;
use crate::support::pages::{assert_well_formed, corners, dots, figures, paths};

/// A page written and read back.
fn written(name: &str, report: &Report) -> String {
    let scratch = Scratch::new("report");
    report.write(&PathBuf::from(scratch.path(name))).expect("the folder is ours");
    scratch.read(name)
}

/// A page of these parts.
fn page(name: &str, parts: Vec<Part>) -> String {
    written(name, &Report::new("A page", parts))
}

fn linear(series: Vec<Series>) -> Figure {
    Figure::new("Rate", ["time", "s"], ["rate", "°/h"], series)
}

fn logarithmic(series: Vec<Series>) -> Figure {
    let x = Axis::logarithmic("averaging time", "s");
    Figure::new("Deviation", x, Axis::logarithmic("deviation", "°/h"), series)
}

/// The only line of the first figure.
fn line(text: &str) -> Vec<[f64; 2]> {
    let lines = corners(&paths(text, 0, "line").concat());
    assert_eq!(lines.len(), 1, "{lines:?}");
    lines[0].clone()
}

/// A point with its limits.
fn bar((x, y, limits): (f64, f64, [f64; 2])) -> Point {
    Point { x, y, limits: Some(limits) }
}

const STYLES: [Style; 8] = [
    Style::Line,
    Style::Dashed,
    Style::Dotted,
    Style::Points,
    Style::Hollow,
    Style::Pale,
    Style::LineAndPoints,
    Style::Band,
];

/// A report with everything in it, in which every text holds what a browser could take for markup.
fn everything() -> Report {
    let series = STYLES.map(|style| {
        let points = (1..20).map(f64::from).map(|x| bar((x, x * x, [x, 2.0 * x * x])));
        Series::new(&format!("<{style:?}> & \"more\" </script>"), style, points)
    });
    let table = Table {
        title: "N < K".to_owned(),
        head: ["a & b", "°/√h", "c", "d", "e"].map(str::to_owned).to_vec(),
        rows: vec![["<1>", "2", "3", "4", "5"].map(str::to_owned).to_vec()],
    };
    let share = Share { name: "<noise>".to_owned(), value: "1 & 2".to_owned(), percent: 30.0 };
    let head = ["a", "<b>", "c"].map(str::to_owned);
    let sum = ["all".to_owned(), "3".to_owned()];
    let shares = Shares { title: "Who & what".to_owned(), head, rows: vec![share], sum };
    let stretch = |kind| Stretch { from_s: 1.0, to_s: 2.0, kind, words: "<here>".to_owned() };
    let kinds = [Kind::Used, Kind::Between, Kind::LeftOut, Kind::Wrong];
    let timeline = Timeline::of(vec![Lane::new("<lane>", kinds.map(stretch))]);
    let note = Note { x: 5.0, y: 25.0, text: "<note>".to_owned() };
    let parts = vec![
        Part::from(linear(series.to_vec()).noted([note])),
        logarithmic(series.to_vec()).into(),
        Part::from(table).detail(),
        Table::default().into(),
        shares.into(),
        timeline.into(),
    ];
    let summary = Summary {
        grade: Grade::Degraded,
        reasons: vec!["<reason>".to_owned()],
        remarks: vec!["a remark & more".to_owned()],
        found: Some(["azimuth <A>".to_owned(), "1° & 2°".to_owned()]),
        facts: vec![["limit".to_owned(), "<0.1°>".to_owned()]],
        circumstances: vec![["place".to_owned(), "\"here\"".to_owned()]],
        rose: Some(Rose {
            azimuth_deg: 213.7,
            sigma_deg: 0.04,
            limit_deg: Some(0.03),
            truth_deg: Some(213.6),
        }),
    };
    Report::new("A & B <i>", parts)
        .below(["first line", "rate < 10 Hz & \"quoted\""])
        .headed(summary)
}

#[test]
fn a_page_with_everything_in_it_is_well_formed_and_needs_no_other_file() {
    let text = written("everything.html", &everything());
    assert_well_formed(&text);
    for reference in ["http", "src=", "href=", "url(", "@import", "fetch(", "import("] {
        assert!(!text.contains(reference), "{reference}");
    }
    for part in [
        "A &amp; B &lt;i&gt;",
        "rate &lt; 10 Hz",
        "&lt;1&gt;",
        "&lt;Band&gt; &amp;",
        "&lt;reason&gt;",
        "a remark &amp; more",
        "&lt;note&gt;",
        "&lt;lane&gt;",
        "&lt;noise&gt;",
    ] {
        assert!(text.contains(part), "{part}");
    }
    assert_eq!(figures(&text).len(), 2, "no name of a series ends its script");
}

#[test]
fn each_style_draws_what_it_says() {
    let drawn = |style| {
        let points = [(0.0, 1.0), (1.0, 3.0), (2.0, 2.0), (3.0, 4.0)];
        let text = page("style.html", vec![linear(vec![Series::new("a", style, points)]).into()]);
        let lines: usize = ["line", "line dashed", "line dotted"]
            .map(|class| paths(&text, 0, class).len())
            .iter()
            .sum();
        (lines, dots(&paths(&text, 0, "dots").concat()).len())
    };
    for style in [Style::Line, Style::Dashed, Style::Dotted] {
        assert_eq!(drawn(style), (1, 0), "{style:?}");
    }
    for style in [Style::Points, Style::Hollow, Style::Pale] {
        assert_eq!(drawn(style), (0, 4), "{style:?}");
    }
    assert_eq!(drawn(Style::LineAndPoints), (1, 4));
}

#[test]
fn a_linear_axis_keeps_differences_and_points_upward() {
    let points = [(0.0, 0.0), (1.0, 10.0), (3.0, -20.0)];
    let text =
        page("linear.html", vec![linear(vec![Series::new("a", Style::Line, points)]).into()]);
    let [a, b, c] = line(&text).try_into().expect("three corners");
    assert!(((c[0] - a[0]) / (b[0] - a[0]) - 3.0).abs() < 0.01);
    assert!(((c[1] - a[1]) / (b[1] - a[1]) + 2.0).abs() < 0.01);
    assert!(b[1] < a[1], "up is up");
}

#[test]
fn a_logarithmic_axis_keeps_ratios_and_leaves_out_what_is_not_above_zero() {
    let points = [(0.1, 1e-3), (1.0, 1e-2), (100.0, 1e-3), (0.0, 1.0), (2.0, 0.0), (3.0, -5.0)];
    let curve = Series::new("a", Style::Line, points);
    let text = page("logarithmic.html", vec![logarithmic(vec![curve]).into()]);
    let [a, b, c] = line(&text).try_into().expect("three corners");
    assert!(((c[0] - a[0]) / (b[0] - a[0]) - 3.0).abs() < 0.01);
    assert_eq!(a[1], c[1]);
}

#[test]
fn a_line_is_interrupted_where_a_point_is_not_finite() {
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    let points =
        [(0.0, 1.0), (0.5, 2.0), (nan, 2.0), (1.0, inf), (-inf, 3.0), (2.0, 5.0), (3.0, 1.0)];
    let text =
        page("finite.html", vec![linear(vec![Series::new("a", Style::Line, points)]).into()]);
    let lines = corners(&paths(&text, 0, "line").concat());
    assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
    assert!(!text.contains("NaN") && !text.contains("inf,"));
}

#[test]
fn a_figure_without_points_is_left_out() {
    let nothing = Series::new("a", Style::Line, [(f64::NAN, 1.0)]);
    let below = Series::new("b", Style::Points, [(1.0, -1.0)]);
    let parts =
        vec![linear(vec![]).into(), linear(vec![nothing]).into(), logarithmic(vec![below]).into()];
    let text = page("empty.html", parts);
    assert!(!text.contains("<figure"));
    assert_well_formed(&text);
}

#[test]
fn one_point_alone_stands_in_the_middle() {
    let text =
        page("one.html", vec![linear(vec![Series::new("a", Style::Points, [(7.0, 0.0)])]).into()]);
    let [x, y] = dots(&paths(&text, 0, "dots").concat())[0];
    assert!((4500.0..5500.0).contains(&x) && (4500.0..5500.0).contains(&y), "{x}, {y}");
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

/// The numbers beside both axes of the first figure.
fn numbers(text: &str) -> Vec<String> {
    let labels = ["<div class=\"y-labels\">", "<div class=\"x-labels\">"].map(|begin| {
        let inner = text.split_once(begin).and_then(|(_, rest)| rest.split_once("</div>"));
        inner.map_or("", |(inner, _)| inner)
    });
    let spans = labels.iter().flat_map(|inner| inner.split("<span").skip(1));
    spans
        .filter(|span| span.contains("style="))
        .filter_map(|span| span.split_once('>')?.1.split('<').next().map(str::to_owned))
        .collect()
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
    assert_eq!(found[..4], ["0.02", "0.05", "0.1", "0.2"], "{found:?}");
    let found = numbers(&page("decimals.html", vec![linear(vec![narrow]).into()]));
    for tick in ["2", "5", "0.05", "0.30"] {
        assert!(found.iter().any(|number| number == tick), "{tick} is not in {found:?}");
    }
}

#[test]
fn a_logarithmic_axis_bears_numbers_however_little_it_spans() {
    for (low, high) in [(0.055, 0.084), (1.0, 1.001), (3.1, 4.9), (211.0, 213.0), (7e-6, 7.2e-6)] {
        let curve = Series::new("a", Style::Line, [(1.0, low), (2.0, high)]);
        let text = page("short.html", vec![logarithmic(vec![curve]).into()]);
        let data = &figures(&text)[0];
        let [low, high] =
            ["low", "high"].map(|end| 10_f64.powf(data["y"][end].as_f64().expect("it")));
        let labels = text.split_once("<div class=\"y-labels\">").expect("they are there").1;
        let inner = labels.split_once("</div>").expect("they end").0;
        let found: Vec<f64> = inner
            .split("<span style")
            .skip(1)
            .filter_map(|span| span.split_once('>')?.1.split('<').next()?.parse().ok())
            .collect();
        assert!(found.len() >= 3, "{low} to {high}: {found:?}");
        let is_inside = |value: &f64| *value >= 0.999 * low && *value <= 1.001 * high;
        assert!(found.iter().all(is_inside), "{low} to {high}: {found:?}");
        let differ = found.windows(2).all(|pair| pair[0] != pair[1]);
        assert!(differ, "two ticks with the same number: {found:?}");
    }
}

#[test]
fn limits_become_bars_that_are_cut_at_the_edge() {
    let points =
        [(1.0, 2.0, [1.0, 4.0]), (10.0, 3.0, [0.0, f64::INFINITY]), (20.0, 3.0, [f64::NAN, 5.0])];
    let bars = Series::new("a", Style::Points, points.map(bar));
    let text = page("bars.html", vec![logarithmic(vec![bars]).into()]);
    let path = paths(&text, 0, "bars").concat();
    let uprights: Vec<[f64; 2]> = path
        .split('M')
        .filter_map(|piece| {
            let (from, to) = piece.split_once('V')?;
            Some([from.split_once(' ')?.1.parse().ok()?, to.parse().ok()?])
        })
        .collect();
    assert_eq!(uprights.len(), 2, "the third point has no limits");
    let height = |bar: [f64; 2]| bar[0] - bar[1];
    assert!(height(uprights[1]) > height(uprights[0]));
    assert!(uprights.iter().flatten().all(|y| (0.0..=10_000.0).contains(y)));
}

#[test]
fn a_band_runs_along_its_lower_limits_and_back_along_the_upper_ones() {
    let points = [(0.0, 2.0, [1.0, 3.0]), (1.0, 2.0, [1.5, 2.5])];
    let text = page(
        "band.html",
        vec![linear(vec![Series::new("a", Style::Band, points.map(bar))]).into()],
    );
    let [outline] = corners(&paths(&text, 0, "band").concat()).try_into().expect("one outline");
    let [a, b, c, d] = outline.try_into().expect("four corners");
    assert!(a[0] < b[0] && b[0] == c[0] && c[0] > d[0] && d[0] == a[0]);
    assert!(a[1] > b[1] && b[1] > c[1] && c[1] > d[1]);
}

#[test]
fn what_is_drawn_stands_where_the_numbers_under_the_pointer_say() {
    let points = [(0.3, 4.2), (1.7, 5.1), (2.9, -3.3), (7.7, 0.01)];
    let curves = [Style::Line, Style::Points].map(|style| Series::new("a", style, points));
    let text = page("numbers.html", vec![linear(curves.to_vec()).into()]);
    let data = &figures(&text)[0];
    let end = |axis: &str, end: &str| data[axis][end].as_f64().expect("a number");
    let part = |axis: &str, value: f64| {
        (value - end(axis, "low")) / (end(axis, "high") - end(axis, "low"))
    };
    let drawn = [line(&text), dots(&paths(&text, 0, "dots").concat())];
    for (series, drawn) in drawn.iter().enumerate() {
        for (point, drawn) in
            data["series"][series]["points"].as_array().expect("it").iter().zip(drawn)
        {
            let [x, y] = [0, 1].map(|at: usize| point[at].as_f64().expect("a number"));
            let expected = [1e4 * part("x", x), 1e4 * (1.0 - part("y", y))];
            let off = (drawn[0] - expected[0]).hypot(drawn[1] - expected[1]);
            assert!(off < 2.0, "{point}: {drawn:?} is not {expected:?}");
        }
    }
}

#[test]
fn a_page_that_refuses_says_why_before_anything_else() {
    let summary = Summary {
        grade: Grade::Refused,
        reasons: vec!["the gyro gives no data".to_owned()],
        ..Summary::default()
    };
    let report = Report::new("No azimuth", [linear(vec![]).into()]).headed(summary);
    let text = written("refused.html", &report);
    let at = |words: &str| text.find(words).unwrap_or_else(|| panic!("{words}"));
    assert!(at(">refused</span>") < at("the gyro gives no data"));
    assert!(at("the gyro gives no data") < at("<main>"));
}

#[test]
fn a_wedge_is_drawn_wider_by_a_round_number_and_never_over_a_quarter_turn() {
    for sigma_deg in [1e-6, 3e-4, 0.0393, 0.9, 1.7, 20.0, 60.0] {
        let rose = Rose { azimuth_deg: 10.0, sigma_deg, limit_deg: None, truth_deg: None };
        let summary = Summary { rose: Some(rose), ..Summary::default() };
        let text = written("rose.html", &Report::new("A", []).headed(summary));
        let times = text.split_once("drawn ").map_or(1.0, |(_, rest)| {
            rest.split(' ').next().and_then(|word| word.parse().ok()).expect("a number")
        });
        let half: f64 = 3.0 * sigma_deg * times;
        assert!(half <= 40.0 || times == 1.0, "{sigma_deg}: {times}");
        assert!(half >= 5.0, "{sigma_deg}: {times} is too little to be seen");
    }
}

/// The direction, °, in which a page with this rose draws the truth, and the words below the rose.
fn drawn_truth(rose: Rose) -> (f64, String) {
    let summary = Summary { rose: Some(rose), ..Summary::default() };
    let text = written("truth.html", &Report::new("A", []).headed(summary));
    let between = |from: &str, to: &str| {
        let (_, behind) = text.split_once(from).expect("it begins");
        behind.split_once(to).expect("it ends").0.to_owned()
    };
    let line = between("class=\"truth\" d=\"M", "\"");
    let (_, end) = line.split_once('L').expect("a line");
    let (x, y) = end.split_once(' ').expect("a point");
    let [x, y] = [x, y].map(|number| number.parse::<f64>().expect("a number"));
    (x.atan2(-y).to_degrees().rem_euclid(360.0), between("<figcaption>", "</figcaption>"))
}

#[test]
fn a_truth_is_drawn_as_far_off_as_the_words_say_or_where_it_is() {
    let cases = [
        (0.04, 213.6, 213.8, "the truth, 200 times as far off"),
        (0.04, 33.3, 211.4, "the truth, where it is"),
        (0.04, 350.0, 20.0, "the truth, where it is"),
        (20.0, 33.3, 211.4, "the truth"),
    ];
    for (sigma_deg, azimuth_deg, truth_deg, ending) in cases {
        let rose = Rose { azimuth_deg, sigma_deg, limit_deg: None, truth_deg: Some(truth_deg) };
        let (drawn_deg, words) = drawn_truth(rose);
        let times = if ending.contains("times") { 200.0 } else { 1.0 };
        let expected_deg = azimuth_deg + times * azimuth_error(truth_deg, azimuth_deg);
        let off = azimuth_error(drawn_deg, expected_deg).abs();
        assert!(off < 0.1 && words.ends_with(ending), "{drawn_deg}° of {expected_deg}°: {words}");
    }
}

/// The colours of the series of a page's only figure, by their names.
fn colours(names: &[&str]) -> Vec<(String, String)> {
    let series = names.iter().map(|name| Series::new(name, Style::Line, [(0.0, 1.0), (1.0, 2.0)]));
    let page = page("colours.html", vec![linear(series.collect()).into()]);
    let figure = figures(&page).remove(0);
    let all = figure["series"].as_array().expect("series").iter();
    let text = |value: &serde_json::Value| value.as_str().expect("a text").to_owned();
    all.map(|series| (text(&series["name"]), text(&series["class"]))).collect()
}

#[test]
fn a_quantity_has_its_colour_on_every_page_whatever_else_is_drawn_before_it() {
    let pages = [
        &["kept ±1σ", "kept", "truth"][..],
        &["something", "σ", "limit (Cramér–Rao)", "truth"],
        &["a", "b", "c", "pitch", "roll", "±1σ", "kept"],
        &["error", "truth", "what is known by then", "the final one ± the limit"],
    ];
    let all: Vec<_> = pages.into_iter().flat_map(colours).collect();
    let of = |name: &str| -> Vec<&str> {
        all.iter().filter(|(other, _)| other == name).map(|(_, colour)| &colour[..]).collect()
    };
    for (same, count) in [("truth", 3), ("kept", 2)] {
        assert_eq!(of(same), vec![of(same)[0]; count], "{same}");
    }
    for [one, other] in [
        ["kept", "kept ±1σ"],
        ["kept", "what is known by then"],
        ["σ", "±1σ"],
        ["limit (Cramér–Rao)", "the final one ± the limit"],
    ] {
        assert_eq!(of(one)[0], of(other)[0], "{one} and {other}");
    }
    for page in pages {
        let classes = colours(page).into_iter().map(|(_, colour)| colour);
        let different: std::collections::BTreeSet<_> = classes.collect();
        assert!(different.len() + usize::from(page[0] == "kept ±1σ") == page.len(), "{page:?}");
    }
}

#[test]
fn the_papers_that_a_page_names_stand_on_it_with_their_titles() {
    let figure = |title: &str| Figure { title: title.to_owned(), ..linear(line_of("a")) };
    let named = page("papers.html", vec![figure("Stops (Szymanowski 2003, Fig. 6)").into()]);
    assert!(named.contains("Static Initial Azimuth Update Method in Land Navigation Systems"));
    assert!(!named.contains("Sokolov"), "no other paper");
    let none = page("none.html", vec![figure("Stops").into()]);
    assert!(!none.contains("<h2>Papers</h2>"));
}

/// A series of this name.
fn line_of(name: &str) -> Vec<Series> {
    vec![Series::new(name, Style::Line, [(0.0, 1.0), (1.0, 2.0)])]
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
