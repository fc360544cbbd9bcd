//! Pages of `--report`: their figures as data, their drawings, and whether they are well-formed.

use serde_json::Value;

/// What stands between each of these beginnings and the end that follows it.
fn between<'a>(text: &'a str, begin: &'a str, end: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(begin).skip(1).filter_map(move |rest| rest.split_once(end).map(|(inner, _)| inner))
}

/// The numbers behind every figure of a page.
pub fn figures(page: &str) -> Vec<Value> {
    let texts = between(page, "<script type=\"application/json\">", "</script>");
    texts.map(|text| serde_json::from_str(text).expect("a figure's data are JSON")).collect()
}

/// The numbers of the figure with this heading.
#[track_caller]
pub fn figure(page: &str, title: &str) -> Value {
    let mut all = figures(page).into_iter();
    all.find(|figure| figure["title"].as_str().is_some_and(|found| found.starts_with(title)))
        .unwrap_or_else(|| panic!("no figure {title}"))
}

/// The points of a figure's series whose name begins so: x, y and limits of each.
#[track_caller]
pub fn series(figure: &Value, name: &str) -> Vec<Vec<f64>> {
    let all = figure["series"].as_array().expect("a figure has series");
    let found =
        all.iter().find(|series| series["name"].as_str().is_some_and(|it| it.starts_with(name)));
    let points = found.unwrap_or_else(|| panic!("no series {name}"))["points"].as_array();
    let numbers = |point: &Value| {
        let point = point.as_array().expect("a point is a list");
        point.iter().map(|number| number.as_f64().expect("a number")).collect()
    };
    points.expect("a series has points").iter().map(numbers).collect()
}

/// What the attribute `d` of every path of a class holds, in the drawing of the figure at this place.
pub fn paths(page: &str, figure: usize, class: &str) -> Vec<String> {
    let drawing = between(page, "<div class=\"area\">", "</svg>").nth(figure).unwrap_or_default();
    let begin = format!("<path class=\"{class}\" d=\"");
    between(drawing, &begin, "\"").map(str::to_owned).collect()
}

/// The corners of lines `M x y l dx dy …`, one line after the other.
pub fn corners(path: &str) -> Vec<Vec<[f64; 2]>> {
    let line = |text: &str| {
        let numbers: Vec<f64> = text
            .split(|c: char| c.is_whitespace() || c == 'l' || c == 'Z')
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().unwrap_or_else(|_| panic!("{word} of {path}")))
            .collect();
        let mut at = [0.0; 2];
        let step = |pair: &[f64]| {
            at = [at[0] + pair[0], at[1] + pair[1]];
            at
        };
        numbers.chunks_exact(2).map(step).collect()
    };
    path.split('M').filter(|text| !text.is_empty()).map(line).collect()
}

/// The dots `M x y h0 …`.
pub fn dots(path: &str) -> Vec<[f64; 2]> {
    corners(&path.replace("h0", "l0 0")).into_iter().map(|line| line[0]).collect()
}

/// Panics unless every element is closed in order and every `&` starts an entity; style and scripts are no markup.
pub fn assert_well_formed(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let body = page.strip_prefix("<!DOCTYPE html>").expect("it is HTML");
    for piece in body.split('<').skip(1) {
        if open.last().is_some_and(|name| ["style", "script"].contains(name))
            && !piece.starts_with('/')
        {
            continue;
        }
        let (tag, after) = piece.split_once('>').expect("a tag ends");
        let name = tag.split_whitespace().next().expect("a tag has a name");
        let is_code = ["style", "script"].contains(&name);
        assert!(is_code || !after.contains('>'), "a stray > in {after}");
        if let Some(name) = name.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        assert!(is_code || after.split('&').skip(1).all(is_entity), "{after}");
    }
    assert!(open.is_empty(), "{open:?}");
}

/// Whether what follows a `&` names an entity.
fn is_entity(rest: &str) -> bool {
    ["lt", "gt", "amp", "quot", "apos"].contains(&rest.split(';').next().unwrap_or(""))
}
