//! Recordings of inputs that are not what a run wrote: each error names file and line, and nothing panics.

use std::sync::LazyLock;

use host::instrument::Trial;
use host::instrument::recorder::Recorded;
use host::instrument::replay::Replayed;
use orientation::attitude::Report;
use proptest::prelude::*;
use serde::Serialize;
use simulated::hold::Hold;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;

use crate::support::inputs::{recorded, replayed};

/// The lines of a short run.
fn lines<C: Recorded<Sample: Serialize + Copy>>(carrier: &C) -> Vec<String> {
    let (_, text) = recorded(carrier, Trial::of(carrier));
    text.lines().map(str::to_owned).collect()
}

fn base() -> Scenario {
    let (positions, dwell_s, sample_rate_hz, hold) = (4, 2.0, 50.0, Hold::of(20.0));
    let usual = Scenario::usual(1);
    Scenario { positions, dwell_s, sample_rate_hz, hold, has_base_imu: true, ..usual }
}

/// A short run of each carrier.
static RUNS: LazyLock<[Vec<String>; 4]> = LazyLock::new(|| {
    let frames = FramesScenario { base: base(), passes: 1, ..FramesScenario::default() };
    let brief = TurntableScenario::brief(1);
    let turntable = TurntableScenario { base: base(), modulated_turns: 4, turns: 2, ..brief };
    let usual = VehicleScenario::usual(1);
    let hold = Hold::of(20.0);
    let vehicle = VehicleScenario {
        base: Scenario { sample_rate_hz: 50.0, hold, ..usual.base },
        stops: 2,
        stop_s: 30.0,
        drive_s: 100.0,
        ..usual
    };
    [lines(&base()), lines(&frames), lines(&turntable), lines(&vehicle)]
});

/// What was reported while the azimuth was kept.
fn reports(of: &Replayed) -> Vec<Report> {
    of.done.kept.points.iter().map(|point| point.report).collect()
}

/// The message of lines that are refused.
#[track_caller]
fn refused(lines: &[String]) -> String {
    let refused = replayed(&(lines.join("\n") + "\n"));
    refused.map(|_| ()).expect_err("it is refused").to_string()
}

/// The first run with one line changed: the message.
#[track_caller]
fn refused_with(number: usize, line: &str) -> String {
    let mut lines = RUNS[0].clone();
    line.clone_into(&mut lines[number - 1]);
    refused(&lines)
}

#[test]
fn a_header_that_is_none_is_refused_with_its_line() {
    for wrong in ["", "{}", "{\"sample\":{}}", "# kind: stage", "[1]", "\u{0}"] {
        let message = refused_with(1, wrong);
        let begin = "run.jsonl: line 1: is not the header";
        assert!(message.starts_with(begin) || wrong.is_empty(), "{message}");
    }
    assert!(refused(&RUNS[0][1..]).starts_with("run.jsonl: line 1: is not the header"));
    let newer = RUNS[0][0].replace("\"inputs\":1", "\"inputs\":2");
    let message = refused_with(1, &newer);
    assert!(message.contains("line 1: inputs of version 2, of meridian 0."), "{message}");
    let lacking = RUNS[0][0].replace("\"policy\"", "\"police\"");
    assert!(refused_with(1, &lacking).contains("line 1: the header does not do: unknown field"));
    let impossible = RUNS[0][0].replacen("\"sample_seconds\":0.02", "\"sample_seconds\":-1", 1);
    assert!(refused_with(1, &impossible).contains("line 1: the header does not do: "));
    let nothing = replayed("").map(|_| ()).expect_err("it is empty").to_string();
    assert!(nothing.contains("the file is empty"), "{nothing}");
}

#[test]
fn a_line_that_is_none_or_of_another_carrier_is_refused_with_its_number_and_column() {
    let middle = RUNS[0].len() / 2;
    for (wrong, words) in [
        ("{\"sample\"", "EOF while parsing"),
        ("{\"dwell\":1}", "unknown variant `dwell`"),
        ("{\"aligner\":{\"ordered\":\"stop\"}}", "unknown variant `stop`"),
        ("{\"sample\":{\"t\":-1,\"stage\":0,\"rate\":0}}", "invalid value: integer `-1`"),
        ("{\"sample\":{\"t\":1,\"stage\":0,\"rate\":0},\"truth\":0}", "expected value"),
        ("{\"navigator\":{\"passed\":1e5}}", "invalid type"),
    ] {
        let message = refused_with(middle, wrong);
        let begin =
            format!("run.jsonl: line {middle}: is no input of the carrier that the header names: ");
        assert!(message.starts_with(&begin) && message.contains("(column "), "{message}");
        assert!(message.contains(words), "{message}");
    }
    let mut exchanged = RUNS[3].clone();
    exchanged[0].clone_from(&RUNS[0][0]);
    assert!(refused(&exchanged).contains("unknown field `turned`"), "{}", refused(&exchanged));
}

#[test]
fn a_time_that_runs_backwards_or_is_beyond_belief_is_refused() {
    let samples = |line: &&String| line.starts_with("{\"sample\"");
    let at = RUNS[0].iter().rposition(|line| samples(&line)).expect("there are samples");
    let before = RUNS[0][..at].iter().rposition(|line| samples(&line)).expect("there are more");
    let mut exchanged = RUNS[0].clone();
    exchanged.swap(at, before);
    let message = refused(&exchanged);
    assert!(message.starts_with(&format!("run.jsonl: line {}: ", at + 1)), "{message}");
    assert!(message.ends_with(&format!(" of line {}", before + 1)), "{message}");
    let late = format!("{{\"aligner\":{{\"passed\":{}}}}}", u64::MAX);
    assert!(refused_with(at + 1, &late).contains("more than 35 years"));
}

#[test]
fn lines_that_do_not_follow_from_those_before_are_refused() {
    let found = |line: &String| line.contains("\"found\"");
    let at = RUNS[0].iter().position(found).expect("it found north");
    for wrong in [
        "{\"navigator\":{\"found\":[1,{\"angle\":1.0,\"sigma\":0.1}]}}",
        "{\"aligner\":{\"ordered\":\"restart\"}}",
    ] {
        let message = refused_with(at + 1, wrong);
        assert!(message.starts_with(&format!("run.jsonl: line {}: the replay has not", at + 1)));
    }
    let mut beyond = RUNS[0].clone();
    beyond.push("{\"navigator\":\"settled\"}".to_owned());
    assert!(refused(&beyond).contains("stands behind the line of the end"));
}

#[test]
fn a_run_that_was_broken_off_replays_as_far_as_its_whole_lines_go() {
    for lines in &*RUNS {
        let all = replayed(&(lines.join("\n") + "\n")).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(all.done.warning, None);
        let passed = |line: &String| line.contains("truth_");
        let known = lines.iter().position(passed).expect("it carries a truth");
        // In the middle of the last input, and of one long before it.
        for number in [known, known / 3] {
            let whole = lines[..number - 1].join("\n") + "\n";
            let cut = format!("{whole}{}", &lines[number - 1][..9]);
            let some = replayed(&cut).unwrap_or_else(|error| panic!("{error}"));
            let warning = some.done.warning.clone().expect("it says so");
            let words = format!("run.jsonl: line {number}: the inputs break off here");
            assert!(warning.starts_with(&words), "{warning}");
            assert!(reports(&all).starts_with(&reports(&some)));
            assert!(some.done.kept.points.iter().all(|point| point.truth.azimuth_rad.is_nan()));
            assert!(
                number < known || some.done.kept.points.len() + 1 >= all.done.kept.points.len()
            );
        }
    }
}

/// Lines whose last one states their checksum: that which Python's `zlib.crc32` gives, as of gzip.
fn sealed(mut lines: Vec<String>) -> Vec<String> {
    let end = lines.pop().expect("there is an end");
    let mut sum = flate2::Crc::new();
    for line in &lines {
        sum.update(format!("{line}\n").as_bytes());
    }
    let (begin, rest) = end.split_once("\"checksum\":\"").expect("it states one");
    lines.push(format!("{begin}\"checksum\":\"{:08x}{}", sum.sum(), &rest[8..]));
    lines
}

#[test]
fn a_line_that_is_missing_or_changed_anywhere_is_noticed_at_the_end() {
    for lines in &*RUNS {
        assert_eq!(sealed(lines.clone()), *lines);
        let quiet = |line: &String| line.contains("\"passed\"") || line.contains("truth_attitude");
        let at = lines.iter().position(quiet).expect("there are such lines");
        let mut missing = lines.clone();
        missing.remove(at);
        let forged = lines[0].replacen("\"scale_sigma\":0.0", "\"scale_sigma\":0.1", 1);
        assert_ne!(forged, lines[0]);
        let changed = [&[forged], &lines[1..]].concat();
        let spaced = [&[lines[0].replacen(':', ": ", 1)], &lines[1..]].concat();
        for lines in [missing, spaced, changed] {
            let message = refused(&lines);
            let is_seen = message.contains("missing or was changed since the run")
                || message.contains("has not come to this");
            assert!(is_seen, "{message}");
        }
    }
}

#[test]
fn the_truth_decides_nothing_but_errors() {
    let lines = RUNS[0].iter();
    let bare: Vec<_> = lines.filter(|line| !line.contains("truth_attitude")).cloned().collect();
    let bare =
        replayed(&(sealed(bare).join("\n") + "\n")).unwrap_or_else(|error| panic!("{error}"));
    let whole = replayed(&(RUNS[0].join("\n") + "\n")).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reports(&bare), reports(&whole));
    let found = |of: &Replayed| of.finished.outcome(&of.done.truth).azimuth_deg;
    assert_eq!(found(&bare), found(&whole));
}

/// What is done to a line.
#[derive(Clone, Debug)]
enum Harm {
    Deleted,
    Doubled,
    Cut(prop::sample::Index),
    /// A character in the place of another.
    Altered(prop::sample::Index, char),
    /// A number in the place of another.
    Renumbered(prop::sample::Index, &'static str),
}

/// Numbers that are hard to bear.
const NUMBERS: [&str; 10] =
    ["0", "-1", "1e-320", "1e300", "-1e300", "1e999", "4294967295", "-2147483648", "null", "0.5"];

fn harm() -> impl Strategy<Value = Harm> {
    let place = any::<prop::sample::Index>;
    prop_oneof![
        Just(Harm::Deleted),
        Just(Harm::Doubled),
        place().prop_map(Harm::Cut),
        (place(), any::<char>()).prop_map(|(at, to)| Harm::Altered(at, to)),
        (place(), prop::char::range('0', '9')).prop_map(|(at, to)| Harm::Altered(at, to)),
        (place(), prop::sample::select(&NUMBERS[..])).prop_map(|(at, to)| Harm::Renumbered(at, to)),
    ]
}

/// The lines after harm to one of them.
fn harmed(lines: &[String], at: usize, harm: &Harm) -> Vec<String> {
    let (line, mut lines) = (&lines[at], lines.to_vec());
    match harm {
        Harm::Deleted => drop(lines.remove(at)),
        Harm::Doubled => lines.insert(at, line.clone()),
        Harm::Cut(to) => lines[at].truncate(to.index(line.len())),
        Harm::Altered(place, to) => {
            let place = place.index(line.len());
            lines[at] = format!("{}{to}{}", &line[..place], &line[place + 1..]);
        }
        Harm::Renumbered(place, to) => {
            let is_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
            let digits: Vec<_> = line.match_indices(|c: char| c.is_ascii_digit()).collect();
            if let Some((place, _)) = digits.get(place.index(digits.len().max(1))) {
                let begin = line[..*place].rfind(|c| !is_number(c)).map_or(0, |at| at + 1);
                let end =
                    line[*place..].find(|c| !is_number(c)).map_or(line.len(), |at| place + at);
                lines[at] = format!("{}{to}{}", &line[..begin], &line[end..]);
            }
        }
    }
    lines
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn a_line_that_was_harmed_gives_an_error_that_names_a_line_or_breaks_the_run_off(
        run in 0_usize..4,
        at in prop_oneof![1 => Just(None), 3 => any::<prop::sample::Index>().prop_map(Some)],
        harm in harm(),
    ) {
        let lines = &RUNS[run];
        let lines = harmed(lines, at.map_or(0, |at| at.index(lines.len())), &harm);
        match replayed(&(lines.join("\n") + "\n")) {
            Ok(again) => {
                prop_assert!(lines == RUNS[run] || again.done.warning.is_some());
                drop(again.finished.outcome(&again.done.truth));
            }
            Err(error) => prop_assert!(error.to_string().starts_with("run.jsonl: line "), "{error}"),
        }
    }
}
