//! How the azimuth of a turning platform converged, and what was done when.

use orientation::alignment::rotating::average::Average;
use orientation::alignment::rotating::session::Session;
use orientation::alignment::rotating::turn;

use super::DISTURBED;
use super::fold::nearest;
use crate::methods::rotating::{Replay, again_until, span};
use crate::output::counted;
use crate::recording::RotatingRow;
use crate::report::{Figure, Kind, Lane, Milestone, Stretch, Timeline, convergence as figures};

/// How many conclusions are drawn.
const CONCLUSIONS: usize = 24;
/// What a further speed adds to what is solved for.
const FURTHER_SPEED: &str = "second speed: more unknowns";

/// The azimuth of more and more of the recording, from where the platform turns the other way for the first time.
pub(super) fn convergence(
    replay: &Replay,
    rows: &[RotatingRow],
    truth_deg: Option<f64>,
) -> Vec<Figure> {
    let begin = rows.len() / CONCLUSIONS;
    let ends = (1..=CONCLUSIONS).map(|part| begin.max(rows.len() * part / CONCLUSIONS));
    let mut speeds = 0;
    let of_rows = |end: usize| {
        let (found, many) = milestone(replay, &rows[..end])?;
        let is_further = speeds > 0 && many > speeds;
        speeds = many;
        Some(Milestone { remark: is_further.then_some(FURTHER_SPEED), ..found })
    };
    let all: Vec<Milestone> = ends.filter_map(of_rows).collect();
    figures("Azimuth", &all, truth_deg)
}

/// What the first rows give, and of how many speeds; none where they give no azimuth.
fn milestone(replay: &Replay, rows: &[RotatingRow]) -> Option<(Milestone, usize)> {
    let session = again_until(replay, rows)?;
    let conclusion = session.conclusion()?;
    let (fit, found) = (conclusion.fit.as_ref()?, conclusion.verdict.as_ref().ok()?);
    let found = Milestone::new(rows.last()?.time_s, [found.angle, found.sigma, fit.limit]);
    Some((found, conclusion.pairs.len()))
}

/// When the platform turned evenly which way, and which turns at either end of that were left out.
pub(super) fn timeline(replay: &Replay) -> Timeline {
    let conclusion = replay.session.conclusion();
    let spans = even(&replay.session, replay.zero_s);
    // The rate-modulated turns show the axis misalignment.
    let is_felt = conclusion.is_some_and(|all| !all.misalignments.is_empty());
    let first = spans.first().map(|first| Stretch {
        from_s: replay.zero_s,
        to_s: first.from_s,
        kind: if is_felt { Kind::Used } else { Kind::Between },
        words: "before the first even turn: rate-modulated turns".to_owned(),
    });
    Timeline::of(vec![Lane::new("platform", first.into_iter().chain(spans))])
}

/// The even turns of a session that began at a time, s.
pub(super) fn even(session: &Session, zero_s: f64) -> Vec<Stretch> {
    let conclusion = session.conclusion();
    let stretches = session.turn_accumulator.stretches.iter();
    let spans = stretches.flat_map(|stretch| {
        let average = conclusion.and_then(|conclusion| nearest(conclusion, stretch));
        of_turns(stretch, average, zero_s)
    });
    let mut spans: Vec<Stretch> = spans.collect();
    spans.sort_by(|a, b| a.from_s.total_cmp(&b.from_s));
    spans
}

/// The turns of a stretch, from the recording's zero on: those from the first that took part to the last, and those that
/// were left out before and after.
fn of_turns(
    stretch: &turn::Stretch,
    average: Option<&Average>,
    zero_s: f64,
) -> impl Iterator<Item = Stretch> {
    let turns = &stretch.turns;
    let joined = stretch.count() as usize / turns.len().max(1);
    let [before, after] = average.map_or([0; 2], |average| average.ends.map(usize::from));
    let last = turns.len().saturating_sub(after).max(before);
    let within = average.map_or(0, |average| average.left_out as usize);
    let within = within.saturating_sub((before + turns.len() - last) * joined);
    let parts = [(0..before, true), (before..last, false), (last..turns.len(), true)];
    parts.into_iter().filter_map(move |(part, is_left_out)| {
        let turns = turns.get(part)?;
        let (from_s, to_s) = span(turns, stretch.since)?;
        let words = in_words(stretch, turns.len() * joined);
        let (kind, words) = match (is_left_out, within) {
            (true, _) => (Kind::LeftOut, format!("{words}, left out: {DISTURBED}")),
            (_, 0) => (Kind::Used, words),
            (_, some) => (Kind::Used, format!("{words}, {some} of them left out")),
        };
        Some(Stretch { from_s: zero_s + from_s, to_s: zero_s + to_s, kind, words })
    })
}

/// So many turns of a stretch.
fn in_words(stretch: &turn::Stretch, turns: usize) -> String {
    let hertz = stretch.speed().abs() / std::f64::consts::TAU;
    format!("{} {} at {hertz:.4} Hz", counted(turns, "turn"), stretch.sense)
}
