//! What the image's log says to the host.

use host::emulate::collect::{Collected, Figures, Task};
use host::emulate::decode::Line;
use host::emulate::outcome::{self, Kind, Outcome, Row, STOP, TURN};

fn printed(words: &str) -> Line {
    Line { time: "1.5".to_owned(), level: None, words: words.to_owned() }
}

const DWELL: &str = "stage=40000000 middle=3fe0000000000000 seconds=3ff0000000000000 samples=64 \
    rate=bef0000000000000 taper=3ff0000000000000 force_x=ffffffffffffffff \
    force_y=ffffffffffffffff force_z=ffffffffffffffff temperature=4039000000000000";

fn whole_log() -> Vec<String> {
    vec![
        format!("dwell number=1 {DWELL}"),
        format!("dwell number=2 {DWELL}"),
        "outcome seed=9 azimuth=3ff4000000000000 sigma=3fe0000000000000".to_owned(),
        "effort instructions=1000 simulation=200 samples=10 microseconds=5000".to_owned(),
        "task polls=30 instructions=900 worst=100 name=the instrument".to_owned(),
        "stack bytes=4096".to_owned(),
    ]
}

fn collect(lines: &[String]) -> Result<(Outcome, Figures), String> {
    let mut collected = Collected::default();
    lines.iter().try_for_each(|line| collected.take(&printed(line)))?;
    collected.finish()
}

#[test]
fn the_log_gives_back_the_bits_and_the_figures() {
    let (outcome, figures) = collect(&whole_log()).expect("a whole log");
    assert_eq!((outcome.seed, outcome.reason), (9, None));
    assert_eq!(outcome.azimuth_bits, Some(1.25_f64.to_bits()));
    assert_eq!(outcome.sigma_bits, Some(0.5_f64.to_bits()));
    let [half, one] = [0.5_f64, 1.0].map(|number| Some(number.to_bits()));
    let rate = Some((-1.0 / 65_536.0_f64).to_bits());
    let temperature = Some(25.0_f64.to_bits());
    let stage = Some(1 << 30);
    let bits = vec![stage, half, one, Some(100), rate, one, None, None, None, temperature];
    let dwell = Row { kind: &outcome::DWELL, bits };
    assert_eq!(outcome.rows, [dwell.clone(), dwell]);
    let tasks =
        vec![Task { name: "the instrument".into(), polls: 30, instructions: 900, worst: 100 }];
    let expected = Figures {
        instructions: 1000,
        simulation: 200,
        samples: 10,
        microseconds: 5000,
        stack_bytes: 4096,
        tasks,
    };
    assert_eq!(figures, expected);
}

/// A row all of whose numbers are a half.
fn halves(kind: &'static Kind) -> Row {
    Row { kind, bits: vec![Some(0.5_f64.to_bits()); kind.names().count()] }
}

#[test]
fn turns_and_stops_come_in_their_order_with_all_their_numbers() {
    for (kind, name) in [(&TURN, "offset="), (&STOP, "turned_y=")] {
        let names: Vec<_> = kind.names().map(|name| format!("{name}=3fe0000000000000")).collect();
        let (names, word) = (names.join(" "), kind.word);
        let mut log = whole_log();
        log.drain(..2);
        log.insert(0, format!("{word} number=1 {names}"));
        log.insert(1, format!("{word} number=2 {names}"));
        let (outcome, _) = collect(&log).expect("a whole log");
        assert_eq!(outcome.rows, [halves(kind), halves(kind)]);
        log.remove(0);
        assert!(collect(&log).is_err(), "the first is missing");
        log[0] = format!("{word} number=1 {}", names.replace(name, "other="));
        assert!(collect(&log).is_err(), "a number is missing");
    }
}

#[test]
fn a_refusal_brings_its_reason_whole() {
    let mut log = whole_log();
    log[2] = "outcome seed=9 reason=σ would be 12.5°, above the accepted 10°".to_owned();
    let (outcome, _) = collect(&log).expect("a whole log");
    assert_eq!(outcome.reason.as_deref(), Some("σ would be 12.5°, above the accepted 10°"));
    assert_eq!((outcome.azimuth_bits, outcome.sigma_bits), (None, None));
}

#[test]
fn a_log_that_lacks_a_line_says_which() {
    for (index, name) in [(2, "outcome"), (3, "effort"), (4, "task"), (5, "stack")] {
        let mut log = whole_log();
        log.remove(index);
        let error = collect(&log).expect_err("incomplete");
        assert_eq!(error, format!("the emulator's log has no line `{name}`"));
    }
}

#[test]
fn a_line_that_is_not_understood_ends_the_reading() {
    for line in [
        "dwell number=2 stage=0",
        &format!("dwell number=1 {}", DWELL.replace("force_x=f", "force_x=x")),
        &format!("dwell number=2 {DWELL}"),
        "outcome seed=9 azimuth=3ff4000000000000",
        "outcome azimuth=3ff4000000000000 sigma=0",
        "effort instructions=1000",
        "task polls=1 instructions=2 worst=3",
        "stack bytes=many",
        "something else",
        "",
    ] {
        let error = Collected::default().take(&printed(line)).expect_err("not understood");
        assert_eq!(error, format!("not understood: {line}"));
    }
}

#[test]
fn lines_with_a_level_are_for_people() {
    let line = Line { level: Some("info"), ..printed("outcome nonsense") };
    assert_eq!(Collected::default().take(&line), Ok(()));
    assert_eq!(line.to_string(), "         1.5 info  outcome nonsense");
}
