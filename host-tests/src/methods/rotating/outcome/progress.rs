//! How the azimuth of a turning platform came to stand, and what was done when.

use orientation::units::Radians;

use crate::methods::rotating::{Replay, again_until, of_stretch};
use crate::output::counted;
use crate::recording::RotatingRow;
use crate::report::{Figure, Kind, Lane, Milestone, Stretch, Timeline, convergence as figures};

/// How many conclusions are drawn.
const CONCLUSIONS: usize = 24;

/// The azimuth of more and more of the recording, from where the platform turns the other way for the first time.
pub(super) fn convergence(
    replay: &Replay,
    rows: &[RotatingRow],
    truth_deg: Option<f64>,
) -> Vec<Figure> {
    let begin = rows.len() / CONCLUSIONS;
    let ends = (1..=CONCLUSIONS).map(|part| begin.max(rows.len() * part / CONCLUSIONS));
    let all: Vec<Milestone> = ends.filter_map(|end| milestone(replay, &rows[..end])).collect();
    figures("Azimuth", &all, truth_deg)
}

/// What the first rows give; none where they give no azimuth.
fn milestone(replay: &Replay, rows: &[RotatingRow]) -> Option<Milestone> {
    let session = again_until(replay, rows)?;
    let conclusion = session.conclusion()?;
    let (fit, found) = (conclusion.fit.as_ref()?, conclusion.verdict.as_ref().ok()?);
    let [azimuth_deg, sigma_deg, limit_deg] =
        [found.angle, found.sigma, fit.limit].map(Radians::degrees);
    Some(Milestone { time_s: rows.last()?.time_s, azimuth_deg, sigma_deg, limit_deg })
}

/// When the platform turned evenly which way.
pub(super) fn timeline(replay: &Replay) -> Timeline {
    let stretches = &replay.session.turn_accumulator.stretches;
    let spans = stretches.iter().filter_map(|stretch| {
        let (from, to) = of_stretch(stretch)?;
        let hertz = stretch.speed().abs() / std::f64::consts::TAU;
        let words = format!(
            "{} {} at {hertz:.4} Hz",
            counted(stretch.count() as usize, "turn"),
            stretch.sense
        );
        let [from_s, to_s] = [from, to].map(|time| replay.zero_s + time);
        let kind = if stretch.count() > 0 { Kind::Used } else { Kind::Between };
        Some(Stretch { from_s, to_s, kind, words })
    });
    let mut spans: Vec<Stretch> = spans.collect();
    spans.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    // The rate-modulated turns show the axis misalignment.
    let is_felt = replay.session.conclusion().is_some_and(|all| !all.misalignments.is_empty());
    let first = spans.first().map(|first| Stretch {
        from_s: replay.zero_s,
        to_s: first.from_s,
        kind: if is_felt { Kind::Used } else { Kind::Between },
        words: "before the first even turn: rate-modulated turns".to_owned(),
    });
    let spans = first.into_iter().chain(spans);
    Timeline::of(vec![Lane::new("platform", spans)])
}
