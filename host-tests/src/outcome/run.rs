//! What only a simulated run has: how its board did, and what it kept after the alignment.

use std::time::Duration;

use embassy_time::Instant;
use firmware::event::Event;
use firmware::health::Health;
use firmware::remembered::Remembered;
use orientation::alignment::{Azimuth, Progress, stepwise};
use orientation::attitude::Report;
use orientation::units;
use serde::Serialize;

use super::figures;
use super::keys::Keys;
use crate::campaign::faults::notice;
use crate::campaign::statistics::rms;
use crate::instrument::Run;
use crate::instrument::kept::{Kept, Point, Realignments};
use crate::instrument::replay::Done;
use crate::interrupt;
use crate::output::{
    azimuth as in_circle, counted, degrees, in_number, positive_zero, seconds, signed,
};
use crate::report::{Lane, Lines, Part, Stretch, Table};

/// What only a simulated run has.
#[derive(Clone, Debug, Serialize)]
pub struct RunDetails {
    /// Further keys of the outcome.
    #[serde(flatten)]
    keys: Keys,
    /// What the board reported that is wrong, in words, where it did.
    #[serde(skip)]
    reported: Option<String>,
    /// What of that disturbed a measurement which the board then repeated.
    #[serde(skip)]
    repeated: Option<String>,
    /// What is said first of the result: label and value.
    #[serde(skip)]
    pub(super) facts: Vec<[String; 2]>,
    /// What takes from the result, in words.
    #[serde(skip)]
    pub(super) degradations: Vec<String>,
    /// Lines of the report, and figures of what was kept over time.
    #[serde(skip)]
    pub(super) parts: Vec<Part>,
    /// Rows of the timeline: what was kept how, and what went wrong.
    #[serde(skip)]
    pub(super) lanes: Vec<Lane>,
    /// What the keeper reported at last, where it did.
    #[serde(skip)]
    pub(super) kept: Option<Point>,
    /// When the latest alignment was refused, and why, where one was.
    #[serde(skip)]
    pub(super) refused: Option<String>,
    /// That an azimuth which was kept is not known any more, where it is so.
    #[serde(skip)]
    pub(super) lost: Option<String>,
    /// By how many σ the latest azimuth disagreed with what was kept, where neither is believed.
    #[serde(skip)]
    pub(super) disagreement: Option<f64>,
    /// That the run was interrupted, and how far it was.
    #[serde(skip)]
    pub(super) interruption: Option<String>,
    /// Why the alignment was concluded before its own end, where it was.
    #[serde(skip)]
    pub(super) cut_short: Option<String>,
}

/// What an alignment found, and the sample to which it belongs.
type Found = (units::Instant, Azimuth);

/// Why an alignment has no end in a file of inputs.
const BROKEN_OFF: &str = "the file breaks off before the alignment is over";

/// What only the run of a single platform has; nothing by default.
#[must_use]
#[derive(Clone, Debug, Default)]
pub struct OfPlatform {
    keys: Keys,
    recalled: Vec<String>,
    gyro: Option<String>,
}

impl OfPlatform {
    /// Of a turntable: the stored axis misalignments that its board used.
    pub fn recalled(found: &[Remembered]) -> Self {
        let keys = Keys::default().with("recalled", found.iter().map(recalled).collect::<Vec<_>>());
        Self { keys, recalled: found.iter().map(ToString::to_string).collect(), gyro: None }
    }

    /// Of two frames: whether the gyro stands vertical at the end, to keep the azimuth, and the true angle between its axis
    /// and the vertical then, °.
    pub fn stored(is_vertical: bool, off_deg: f64) -> Self {
        let keys = Keys::default().with("stored", is_vertical);
        let what = if is_vertical { "vertical, to store the azimuth" } else { "not stored" };
        Self {
            keys: keys.with("truth_off_vertical_deg", off_deg),
            recalled: Vec::new(),
            gyro: Some(format!("{what}: truly {off_deg:.4}° off the base's vertical")),
        }
    }
}

/// A stored axis misalignment.
fn recalled(found: &Remembered) -> Keys {
    Keys::default()
        .with("coupling_deg", found.angle)
        .with("speed_hz", found.rate / 360.0)
        .with("date", found.day.to_string())
        .with("temperature_c", found.temperature)
}

impl RunDetails {
    /// What a finished run of so many samples a second was like, which took so long on this machine.
    #[must_use]
    pub fn of<R, T>(run: &Run<R, T>, rate_hz: f64, wall: Duration, beside: OfPlatform) -> Self {
        let health =
            Keys::default().with_all(Some(&run.health)).with("violations", &run.violations);
        let keys = Keys::default().with("simulated_seconds", run.seconds).with("health", health);
        let keys = keys.with_all(Some(&beside.keys));
        let board = board(run, rate_hz, wall.as_secs_f64(), beside);
        let this = Self::with(keys, Some(board), (&run.kept, &run.earlier), &realignments(run));
        let uncounted = in_short(&run.events, is_uncounted).as_deref().map(on_the_way);
        let told = [faults(&run.health), uncounted].into_iter().flatten();
        let degradations = this.degradations.into_iter().chain(told).collect();
        let lanes = [this.lanes, figures::faults(&run.events)].concat();
        let cut_short = this.interruption.clone().filter(|_| run.is_cut_short);
        let reported = in_short(&run.events, notice::is_wrong);
        let repeated = in_short(&run.events, is_repeated);
        Self { reported, repeated, degradations, lanes, cut_short, ..this }
    }

    /// With what was made to go wrong, by its name, and what the board reported; what it mended by measuring again takes from
    /// the result, since it was no chance.
    #[must_use]
    pub fn made_wrong(mut self, fault: Option<&str>) -> Self {
        let Some(fault) = fault else { return self };
        self.keys = self.keys.with("fault", fault);
        let reported = self.reported.as_deref().unwrap_or("nothing wrong");
        let words = format!("{fault}, as asked for; the board reported {reported}");
        self.facts.push(["fault".to_owned(), words]);
        self.degradations.extend(self.repeated.as_deref().map(on_the_way));
        self
    }

    /// With something more that takes from the result.
    #[must_use]
    pub fn noting(mut self, words: Option<String>) -> Self {
        self.degradations.extend(words);
        self
    }

    /// What the inputs of a run did: what was kept, and how later azimuths agreed with it.
    #[must_use]
    pub fn of_inputs(done: &Done) -> Self {
        let (keys, kept) = (Keys::default(), (&done.kept, &*done.earlier));
        let this = Self::with(keys, None, kept, &done.realignments);
        let why = || this.interruption.clone().unwrap_or_else(|| BROKEN_OFF.to_owned());
        let cut_short = done.is_cut_short.then(why);
        Self { cut_short, ..this }
    }

    /// What was kept, with further keys, and lines behind those of what was kept.
    fn with(
        keys: Keys,
        board: Option<Lines>,
        (kept, earlier): (&Kept, &[Stretch]),
        later: &Realignments,
    ) -> Self {
        let last = kept.last().copied();
        let was_known = kept.with_azimuth().next().is_some();
        // Before an azimuth is known there is nothing to keep.
        let (kept, last_kept) = if was_known { (kept, last) } else { (&Kept::default(), None) };
        let lines = last_kept.iter().map(|last| Part::from(in_words(kept, last, later)));
        let board = board.map(|board| Part::from(board).detail());
        let lost = last_kept.filter(|last| last.report.azimuth.is_none()).and_then(|_| lost(kept));
        Self {
            reported: None,
            repeated: None,
            keys: keys
                .with_found("alignments", of_alignments(&later.found))
                .with_found("kept", last_kept.map(|last| of_kept(kept, &last, later.fused))),
            facts: refused_first(later).into_iter().chain(found_anew(later)).collect(),
            refused: later.refused.clone().or_else(|| later.first_refused.clone()),
            degradations: lost.iter().cloned().collect(),
            parts: lines
                .chain(alignments(&later.found).map(Part::from))
                .chain(figures::all(kept).into_iter().map(Part::from))
                .chain(board)
                .collect(),
            lanes: figures::earlier(earlier)
                .into_iter()
                .chain(figures::alignments(&later.found))
                .chain(figures::lanes(kept))
                .collect(),
            kept: last,
            lost,
            disagreement: later.disagreement,
            interruption: interrupt::ended(),
            cut_short: None,
        }
    }
}

/// What went wrong on the board, counted; nothing where nothing did.
fn faults(health: &Health) -> Option<String> {
    let all = [
        (health.missing, "missing sample"),
        (health.late, "late sample"),
        (health.overflowed, "discarded sample"),
        (sum(&health.lost), "lost reading"),
        (sum(&health.restarts), "device restart"),
    ];
    let there = all.into_iter().filter(|(count, _)| *count > 0);
    let words: Vec<String> = there.map(|(count, what)| counted(count as usize, what)).collect();
    (!words.is_empty()).then(|| format!("faults on the way: {}", words.join(", ")))
}

/// The first event of a kind in its own words, and how many more there are; nothing where there is none.
fn in_short(events: &[(Instant, Event)], is_meant: fn(&Event) -> bool) -> Option<String> {
    let mut meant = events.iter().map(|(_, event)| event).filter(|event| is_meant(event));
    let first = in_number(&meant.next()?.to_string());
    Some(match meant.count() {
        0 => format!("\"{first}\""),
        more => format!("\"{first}\" and {more} more"),
    })
}

/// What was reported, as something that takes from a result.
fn on_the_way(reported: &str) -> String {
    format!("reported on the way: {reported}")
}

/// Whether an event reports a device or the memory which did wrong, and is in no count of the board's health.
fn is_uncounted(event: &Event) -> bool {
    matches!(
        event,
        Event::Clipped(_)
            | Event::Corrected(..)
            | Event::Blocked(_)
            | Event::CalibrationUnreadable(_)
            | Event::CalibrationNotSaved(_)
            | Event::HeadingNotKept(_)
            | Event::LinkSilent
    )
}

/// Whether an event reports a disturbed measurement that is taken again.
fn is_repeated(event: &Event) -> bool {
    matches!(event, Event::Alignment(Progress::Stepwise(stepwise::Progress::Repeated(..))))
}

/// How long an azimuth was kept until it was last known, s, and its 1σ then, °.
fn latest_known(kept: &Kept) -> Option<[f64; 2]> {
    let (point, [_, sigma]) = kept.with_azimuth().last()?;
    Some([point.report.seconds.0, sigma.to_degrees()])
}

/// That an azimuth which was kept is lost, and how well it was known at last.
fn lost(kept: &Kept) -> Option<String> {
    let [seconds, sigma_deg] = latest_known(kept)?;
    let at_last = format!("it was kept for {seconds:.0} s, at last ± {sigma_deg:.2}° (1σ)");
    Some(format!("the azimuth is not known any more: {at_last}"))
}

/// Of all devices together.
fn sum(counts: &[u16]) -> u32 {
    counts.iter().map(|count| u32::from(*count)).sum()
}

/// How the board did.
fn board<R, T>(run: &Run<R, T>, rate: f64, wall: f64, beside: OfPlatform) -> Lines {
    let (seconds, ratio) = (run.seconds, run.seconds / wall);
    let simulated =
        format!("{seconds:.1} s at {rate} Hz in {wall:.2} s: {ratio:.0} times real time");
    let Health { samples, missing, late, overflowed, lost, restarts, .. } = &run.health;
    let taken = format!("{samples} taken, {missing} missing, {late} late, {overflowed} overflowed");
    let lost = counted(sum(lost) as usize, "lost reading");
    let restarts = counted(sum(restarts) as usize, "restart");
    Lines::new("The simulated board")
        .with_found("recalled", beside.recalled)
        .with("simulated", simulated)
        .with("samples", taken)
        .with("devices", format!("{lost}, {restarts}"))
        .with_found("forbidden", &run.violations)
        .with_found("gyro", beside.gyro)
}

/// What was kept at last, and how well on the way.
fn of_kept(kept: &Kept, last: &Point, realigned: usize) -> Keys {
    let azimuth = last.azimuth_deg();
    let Report { seconds, pitch, roll, level_sigma, .. } = last.report;
    Keys::default()
        .with("seconds", seconds)
        .with("azimuth_deg", azimuth.map(|[azimuth, ..]| azimuth))
        .with("sigma_deg", azimuth.map(|[_, sigma, _]| sigma))
        .with("error_deg", azimuth.map(|[.., error]| error))
        .with("greatest_sigmas", greatest_sigmas(kept))
        .with("pitch_deg", pitch.degrees())
        .with("roll_deg", roll.degrees())
        .with("level_sigma_deg", level_sigma.degrees())
        .with("level_error_deg", last.level_error().map(degrees))
        .with("level_rms_deg", level_rms(kept).map(degrees))
        .with("state", last.report.state.to_string())
        .with("realigned", realigned)
}

/// What was kept at last, in words.
fn in_words(kept: &Kept, last: &Point, later: &Realignments) -> Lines {
    let Report { pitch, roll, level_sigma, .. } = last.report;
    let azimuth = last.azimuth_deg().map_or_else(
        || "not known any more".to_owned(),
        |[azimuth, sigma, _]| format!("{}° ± {sigma:.4}° (1σ)", in_circle(azimuth, 4)),
    );
    let known = last.azimuth_deg().filter(|[.., error]| !error.is_nan());
    let error = known.map(|[_, sigma, error]| {
        let (sigmas, greatest) = (error / sigma, greatest_sigmas(kept).unwrap_or(0.0));
        let [error, sigmas] = [signed(error, 4), signed(sigmas, 2)];
        format!("{error}°, {sigmas} σ; {greatest:.2} σ at most on the way")
    });
    let [pitch, roll] = [pitch, roll].map(|angle| positive_zero(angle.degrees(), 5e-4));
    let sigma = level_sigma.degrees();
    let [pitch_rms, roll_rms] = level_rms(kept).map(degrees);
    let level_rms = format!("{pitch_rms:.3}°, {roll_rms:.3}° RMS on the way");
    let known_s = latest_known(kept).map_or(0.0, |[seconds, _]| seconds);
    Lines::new(&format!("Kept for {known_s:.0} s"))
        .with("azimuth of body x", azimuth)
        .with_found("its error", error)
        .with("pitch, roll", format!("{pitch:.3}°, {roll:.3}°, each ± {sigma:.3}° (1σ)"))
        .with_found("their errors", (!last.truth.pitch_rad.is_nan()).then_some(level_rms))
        .with("state", last.report.state.to_string())
        .with_found("aligned anew", aligned_anew(later))
}

/// How often it was aligned anew, and why not the last time.
fn aligned_anew(Realignments { fused, refused, .. }: &Realignments) -> Option<String> {
    let times = if *fused == 0 { "not at all".to_owned() } else { counted(*fused, "time") };
    match refused {
        Some(why) => Some(format!("{times}; the last attempt was refused {why}")),
        None => (*fused > 0).then_some(times),
    }
}

/// Which of several alignments an azimuth is of.
fn found_anew(Realignments { found, first_refused, .. }: &Realignments) -> Option<[String; 2]> {
    let (at, _) = found.last().filter(|_| found.len() > 1 || first_refused.is_some())?;
    Some(["found".to_owned(), format!("at {:.1} s, by the latest alignment", at.seconds())])
}

/// Why the first of several alignments was refused.
fn refused_first(later: &Realignments) -> Option<[String; 2]> {
    let Realignments { found, first_refused, refused, .. } = later;
    let is_one_of_several = !found.is_empty() || refused.is_some();
    let why = first_refused.as_ref().filter(|_| is_one_of_several)?;
    Some(["first alignment".to_owned(), format!("refused {why}")])
}

/// What each of several alignments found.
fn of_alignments(found: &[Found]) -> Option<Vec<Keys>> {
    let keys = |(at, Azimuth { angle, sigma }): &Found| {
        Keys::default()
            .with("at_s", at.seconds())
            .with("azimuth_deg", angle.degrees())
            .with("sigma_deg", sigma.degrees())
    };
    (found.len() > 1).then(|| found.iter().map(keys).collect())
}

/// What each of several alignments found, as a table.
fn alignments(found: &[Found]) -> Option<Table> {
    let row = |(at, Azimuth { angle, sigma }): &Found| {
        let angle = in_circle(angle.degrees(), 4);
        vec![format!("{:.1}", at.seconds()), angle, format!("{:.4}", sigma.degrees())]
    };
    let rows = (found.len() > 1).then(|| found.iter().map(row).collect());
    let head = ["at, s", "azimuth of body x, °", "1σ, °"].map(str::to_owned).to_vec();
    rows.map(|rows| Table { title: "Alignments".to_owned(), head, rows })
}

/// The greatest error of the azimuth on the way, over its σ of the moment.
fn greatest_sigmas(kept: &Kept) -> Option<f64> {
    kept.with_azimuth().map(|(_, [error, sigma])| error.abs() / sigma).reduce(f64::max)
}

/// How later azimuths of a run agreed with what was kept.
fn realignments<R, T>(run: &Run<R, T>) -> Realignments {
    let mut found = Realignments { found: run.found.clone(), ..Realignments::default() };
    let mut is_first = true;
    for (at, event) in &run.events {
        match event {
            Event::Navigation(progress) => found.take(progress),
            Event::Alignment(Progress::Concluded(_)) => (is_first, found.refused) = (false, None),
            Event::Alignment(Progress::Refused(reason)) => {
                let why = Some(format!("at {:.1} s: {reason}", seconds(*at)));
                if core::mem::replace(&mut is_first, false) {
                    found.first_refused = why;
                } else {
                    found.refused = why;
                }
            }
            _ => {}
        }
    }
    found
}

/// RMS of the errors of pitch and roll on the way, rad.
fn level_rms(kept: &Kept) -> [f64; 2] {
    [0, 1].map(|axis: usize| rms(kept.with_azimuth().map(|(point, _)| point.level_error()[axis])))
}
