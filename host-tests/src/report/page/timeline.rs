//! Draws what was done when: lanes over a common time.

use super::chart::{TICKS, tick};
use super::markup::{element, escaped};
use super::span::Span;
use crate::report::{Axis, Kind, Lane, Stretch, Timeline};

/// Least width of a stretch, % of the whole: a moment is seen, too.
const LEAST: f64 = 0.3;

/// The timeline with its heading and its legend.
pub(super) fn timeline(timeline: &Timeline) -> String {
    let spans = || timeline.lanes.iter().flat_map(|lane| &lane.spans);
    let times = spans().flat_map(|span| [span.from_s, span.to_s]);
    let Some(span) = Span::of(&Axis::from(["time", "s"]), TICKS, times) else {
        return String::new();
    };
    let lanes: String = timeline.filled().map(|lane| of_lane(lane, &span)).collect();
    let heading = element("figcaption", &timeline.title);
    let (legend, labels) = (legend(timeline), labels(&span));
    format!(
        "<figure class=\"timeline\">{heading}{legend}<div class=\"lanes\">\n{lanes}\
         <div class=\"lane\"><span></span><div class=\"x-labels\">{labels}</div></div>\n</div>\n\
         <div class=\"x-title\">time, s</div>\n<div class=\"readout\"></div>\n</figure>\n"
    )
}

/// The kinds that there are.
fn legend(timeline: &Timeline) -> String {
    let has = |kind: &Kind| {
        timeline.lanes.iter().flat_map(|lane| &lane.spans).any(|span| span.kind == *kind)
    };
    let all =
        [Kind::Used, Kind::Between, Kind::Searching, Kind::Coasting, Kind::LeftOut, Kind::Wrong];
    let kinds = all.into_iter().filter(has);
    let entry = |kind: Kind| format!("<li><i class=\"{}\"></i>{}</li>\n", class(kind), kind.name());
    format!("<ul class=\"legend\">\n{}</ul>\n", kinds.map(entry).collect::<String>())
}

fn class(kind: Kind) -> &'static str {
    match kind {
        Kind::Used => "used",
        Kind::Between | Kind::Searching => "between",
        Kind::Coasting => "coasting",
        Kind::LeftOut => "left-out",
        Kind::Wrong => "wrong",
    }
}

fn of_lane(lane: &Lane, span: &Span) -> String {
    let stretches: String = lane.spans.iter().map(|stretch| of_stretch(stretch, span)).collect();
    let name = escaped(&lane.name);
    format!("<div class=\"lane\"><span>{name}</span><div class=\"track\">{stretches}</div></div>\n")
}

fn of_stretch(stretch: &Stretch, span: &Span) -> String {
    let [left, right] = [stretch.from_s, stretch.to_s].map(|at| 100.0 * span.part(at));
    let (class, words) = (class(stretch.kind), escaped(&stretch.words));
    let width = (right - left).max(LEAST);
    format!(
        "<i class=\"{class}\" style=\"left:{left:.2}%;width:{width:.2}%\" title=\"{words}\"></i>"
    )
}

/// The times below the lanes; a phone leaves out every other one.
fn labels(span: &Span) -> String {
    let labels = span
        .major
        .iter()
        .enumerate()
        .map(|(index, place)| tick(index, 100.0 * span.part(*place), &span.label(*place)));
    labels.collect()
}
