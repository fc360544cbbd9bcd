//! What the image's log says to the host.

use host::emulate::collect::{Collected, Figures, Task};
use host::emulate::decode::Line;
use host::emulate::outcome::{Outcome, Row};
use simulated::trace::{ABSENT, AZIMUTH};

fn printed(words: &str) -> Line {
    Line { time: "1.5".to_owned(), level: None, words: words.to_owned() }
}

fn whole_log() -> Vec<String> {
    vec![
        "row stop from to [4602678819172646912, 18446744073709551615]".to_owned(),
        "row azimuth angle sigma [4608308318706860032, 4602678819172646912]".to_owned(),
        "effort instructions=1000 stand-ins=300 simulation=200 samples=10 microseconds=5000"
            .to_owned(),
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
    let stop = Row::new("stop from to", &[0.5_f64.to_bits(), ABSENT]);
    let azimuth = Row::new(AZIMUTH, &[1.25_f64, 0.5].map(f64::to_bits));
    assert_eq!(outcome, Outcome { rows: vec![stop, azimuth], reason: None });
    assert_eq!(outcome.azimuth(), Some([1.25, 0.5]));
    let tasks =
        vec![Task { name: "the instrument".into(), polls: 30, instructions: 900, worst: 100 }];
    let expected = Figures {
        instructions: 1000,
        stand_ins: 300,
        simulation: 200,
        samples: 10,
        microseconds: 5000,
        stack_bytes: 4096,
        tasks,
    };
    assert_eq!(figures, expected);
}

#[test]
fn a_refusal_brings_its_reason_whole() {
    let mut log = whole_log();
    log[1] = "reason σ would be 12.5°, above the accepted 10°".to_owned();
    let (outcome, _) = collect(&log).expect("a whole log");
    assert_eq!(outcome.reason.as_deref(), Some("σ would be 12.5°, above the accepted 10°"));
    assert_eq!(outcome.azimuth(), None);
}

#[test]
fn a_log_that_lacks_a_line_says_which() {
    for name in ["row", "effort", "task", "stack"] {
        let mut log = whole_log();
        log.retain(|line| !line.starts_with(name));
        let error = collect(&log).expect_err("incomplete");
        assert_eq!(error, format!("the emulator's log has no line `{name}`"));
    }
}

#[test]
fn a_line_that_is_not_understood_ends_the_reading() {
    for line in [
        "row stop from to [1]",
        "row stop from to [1, 2, 3]",
        "row stop from to [1, x]",
        "row stop from to [1, 2",
        "row stop from to",
        "row [1]",
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
    let line = Line { level: Some("info"), ..printed("row nonsense") };
    assert_eq!(Collected::default().take(&line), Ok(()));
    assert_eq!(line.to_string(), "         1.5 info  row nonsense");
}
