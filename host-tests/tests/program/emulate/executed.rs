//! Images that are executed: reports, what is complained of, the options of the program, misuse.

use execution::report::Report;
use firmware::platform::Platform;
use host::emulate::executed::{Executed, Options};
use host::output::executed;
use host::report::{Look, Verbosity};
use serde_json::{Value, json};

use crate::support::files::Scratch;
use crate::support::program::{assert_misuse, code, command, text};

/// The report of a stage of which all is right, as the program prints it.
fn sound() -> Value {
    let service = |lost: u64| json!({ "read": 100, "lost": lost, "longest_wait_seconds": 0.001 });
    json!({
        "carrier": "stage",
        "seed": 1,
        "cycles_per_instruction": 1.4,
        "azimuth_deg": [213.6, 0.1, 0.09],
        "truth_deg": 213.65,
        "outcome": "azimuth 213.6000° ± 0.1000° (1σ)",
        "seconds": 85.5,
        "start_seconds": 2.0,
        "resets": [],
        "samples": 33_868,
        "instructions_per_sample": 18_000.5,
        "instructions_by_origin": { "methods": 10_000.0, "store": 8000.5 },
        "idle": 0.1,
        "service": [service(0), service(0), service(0)],
        "false_notices": {},
        "faults": 2,
        "stack_bytes": 44_000,
        "flash_bytes": 300_000,
        "static_bytes": 30_000,
        "masked_seconds": [2.0, 0.0005],
        "violations": [],
        "flash_use": { "rows": 11, "rows_with_cache_on": 11, "pages": 0 },
    })
}

/// A report with other values of these keys, beside the azimuth of the host's run, °.
fn with<const N: usize>(other: [(&str, Value); N], host_deg: Option<f64>) -> Executed {
    let mut report = sound();
    for (key, value) in other {
        report[key] = value;
    }
    let report = Report::parse(report.to_string().as_bytes()).expect("a report");
    Executed { report, host_deg }
}

/// The complaint about an execution, and no other.
#[track_caller]
fn complaint(executed: &Executed) -> String {
    let complaints = executed.complaints();
    assert_eq!(complaints.len(), 1, "{complaints:?}");
    complaints.into_iter().next().unwrap_or_default()
}

#[test]
fn a_report_is_read_as_it_was_written() {
    let Executed { report, .. } = with([], None);
    assert_eq!(serde_json::to_value(&report).expect("an object"), sound());
    assert_eq!((report.false_notices(), report.lost_measuring()), (0, 0));
    assert!((report.longest_wait_seconds() - 0.001).abs() < 1e-12);
}

#[test]
fn what_is_no_report_is_an_error() {
    let mut shorter = sound();
    shorter.as_object_mut().expect("an object").remove("idle");
    let errors = ["", "board: done", "{}", &shorter.to_string()]
        .map(|text| Report::parse(text.as_bytes()).expect_err("it is no report"));
    let begins = |error: &String| error.starts_with("the report of an executed image: ");
    assert!(errors.iter().all(begins), "{errors:?}");
    assert!(errors[3].contains("missing field `idle`"), "{}", errors[3]);
}

#[test]
fn a_sound_execution_is_not_complained_of() {
    assert_eq!(with([], Some(213.58)).complaints(), [""; 0]);
}

#[test]
fn every_violation_of_a_data_sheet_is_complained_of() {
    let violations = json!(["two chips are selected at once", "a clock of 20 MHz"]);
    assert_eq!(
        with([("violations", violations)], Some(213.6)).complaints(),
        ["stage: two chips are selected at once", "stage: a clock of 20 MHz"]
    );
}

#[test]
fn resets_and_a_measurement_without_samples_are_complained_of() {
    let resets = json!(["Software", "Watchdog"]);
    assert_eq!(
        complaint(&with([("resets", resets)], Some(213.6))),
        "stage: reset after its power-on: Software, Watchdog"
    );
    let idle = [("carrier", json!("spin")), ("azimuth_deg", Value::Null), ("samples", json!(0))];
    assert_eq!(complaint(&with(idle, None)), "spin: no sample was read while measuring");
}

#[test]
fn a_refusal_is_complained_of_but_for_a_spinning_body_which_has_no_azimuth() {
    let refused = [("azimuth_deg", Value::Null), ("outcome", json!("no azimuth: it drove on"))];
    let executed = with(refused.clone(), Some(213.6));
    assert_eq!(
        (complaint(&executed), executed.distances()),
        ("stage: no azimuth: it drove on".to_owned(), None)
    );
    let [azimuth, outcome] = refused;
    assert_eq!(with([azimuth, outcome, ("carrier", json!("spin"))], None).complaints(), [""; 0]);
}

#[test]
fn an_azimuth_may_be_three_sigma_beside_the_truth_and_no_more() {
    for (truth, is_far) in [(213.31, false), (213.29, true), (213.89, false), (213.91, true)] {
        let executed = with([("truth_deg", json!(truth))], Some(213.6));
        assert_eq!(!executed.complaints().is_empty(), is_far, "{truth}");
    }
    let executed = with([("truth_deg", json!(213.2))], Some(213.6));
    assert_eq!(complaint(&executed), "stage: the azimuth is 4.00 σ beside the truth, 3 allowed");
}

#[test]
fn an_azimuth_may_be_0_6_sigma_beside_that_of_the_host_and_no_more() {
    for (host, is_far) in [(213.541, false), (213.539, true), (213.659, false), (213.661, true)] {
        assert_eq!(!with([], Some(host)).complaints().is_empty(), is_far, "{host}");
    }
    assert_eq!(
        complaint(&with([], Some(213.7))),
        "stage: the azimuth is -1.00 σ beside that of the host, 0.6 allowed"
    );
}

#[test]
fn conversions_that_were_lost_at_any_time_are_complained_of_and_in_the_table() {
    let service = |lost: u64| json!({ "read": 100, "lost": lost, "longest_wait_seconds": 0.0 });
    for (lost, words) in
        [([7, 0, 0], "7 of 307"), ([0, 1, 0], "1 of 301"), ([2, 4, 50], "56 of 356")]
    {
        let executed = with([("service", json!(lost.map(service)))], Some(213.6));
        let expected = format!("stage: {words} conversions were lost");
        assert_eq!(complaint(&executed), expected);
        let options = Options { seed: 1, cycles: 1.4, afterwards: None, link: None };
        let table = executed::report(&[executed], &options).text(Look::plain(Verbosity::Usual));
        let row = lost.map(|lost| lost.to_string()).join(" + ");
        assert!(table.contains(&row) && table.contains(&expected), "{table}");
    }
}

#[test]
fn false_notices_of_the_log_are_complained_of_each_by_its_words() {
    let notices = json!({ "sample(s) missing": 16, "beside its time": 18 });
    let executed = with([("false_notices", notices)], Some(213.6));
    assert_eq!(
        executed.complaints(),
        [
            "stage: \"beside its time\" in the log, falsely: 18",
            "stage: \"sample(s) missing\" in the log, falsely: 16"
        ]
    );
}

#[test]
fn distances_go_the_short_way_round_north() {
    for (azimuth, other, sigma) in
        [(0.1, 359.9, 2.0), (359.9, 0.1, -2.0), (0.0, 360.0, 0.0), (10.0, 20.0, -100.0)]
    {
        let executed = with(
            [("azimuth_deg", json!([azimuth, 0.1, 0.1])), ("truth_deg", json!(other))],
            Some(other),
        );
        for distance in executed.distances().expect("there is an azimuth") {
            let distance = distance.expect("there is another");
            assert!((distance - sigma).abs() < 1e-6, "{azimuth} {other}: {distance}");
        }
    }
    assert!(with([], None).distances().expect("there is an azimuth")[1].is_none());
}

#[test]
fn the_program_is_handed_what_was_asked_for() {
    let usual = Options { seed: 3, cycles: 1.4, afterwards: None, link: None };
    let always = ["--carrier=two-frame", "--seed=3", "--cycles=1.4"];
    assert_eq!(usual.arguments(Platform::TwoFrame), always);
    let all = Options { afterwards: Some(0.5), link: Some(5000), ..usual };
    let more = ["--afterwards=0.5", "--link=tcp:5000"];
    assert_eq!(all.arguments(Platform::TwoFrame), [&always[..], &more].concat());
}

#[test]
fn misuse_of_the_options_is_told_before_anything_is_built() {
    let board = ["emulate", "--board"];
    let several = "one carrier has one link";
    let cases: [(&[&str], &str); 12] = [
        (&["all", "--link", "tcp:5000"], several),
        (&["all", "--link", "tcp:5000", "--json"], several),
        (&["stage", "--link", "5000"], "tcp: and a port are meant, as in tcp:5000"),
        (&["stage", "--link", "tcp:65536"], "tcp: and a port are meant"),
        (&["stage", "--link", "udp:5000"], "tcp: and a port are meant"),
        (&["ship"], "stage, two-frame, turntable, vehicle, spin or all are meant"),
        (&["stage", "--cycles", "NaN"], "0.5 to 20 are meant"),
        (&["stage", "--cycles", "-1"], "0.5 to 20 are meant"),
        (&["stage", "--cycles", "inf"], "0.5 to 20 are meant"),
        (&["stage", "--afterwards", "-1"], "0 to 3600 are meant"),
        (&["stage", "--afterwards", "nan"], "0 to 3600 are meant"),
        (&["stage", "--afterwards", "3601"], "0 to 3600 are meant"),
    ];
    for (arguments, words) in cases {
        assert_misuse(&[&board[..], arguments].concat(), words);
    }
    for option in [["--link", "tcp:5000"], ["--cycles", "2"], ["--afterwards", "1"]] {
        assert_misuse(&[&["emulate"], &option[..]].concat(), "--board");
    }
}

#[cfg(unix)]
#[test]
fn a_build_that_fails_says_what_is_missing_where_cargo_does() {
    let scratch = Scratch::new("failing-build");
    let cargo = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/program/emulate/cargo.sh");
    for (says, hint) in [
        ("is `cmake` not installed?", "; cmake is missing (Debian: apt-get install cmake)"),
        (
            "Unable to find libclang: …",
            "; libclang is missing (Debian: apt-get install libclang-dev)",
        ),
        ("error[E0308]: mismatched types", ""),
    ] {
        let mut command = command();
        command.args(["emulate", "--board", "stage"]).env("CARGO", cargo).env("SAYS", says);
        let output = command.env("FOLDER", scratch.path("target")).output().expect("it starts");
        assert_eq!(
            (code(&output), text(&output.stderr)),
            (1, format!("{says}\nmeridian: the firmware does not build: cargo says why{hint}\n"))
        );
    }
}
