//! A terminal, to which results and errors come both: each thing stands there once, and the bar tells what is known.
#![cfg(target_os = "linux")]

use std::process::{Command, Stdio};

use crate::support::files::stored;
use crate::support::program::{code, meridian, object, text, words};

/// What a command shows on a terminal of its own, and its exit code.
fn shown(arguments: &str) -> (i32, String) {
    let line = format!("'{}' {arguments}", env!("CARGO_BIN_EXE_meridian"));
    let mut script = Command::new("script");
    let script =
        script.args(["-qec", &line, "/dev/null"]).env("TERM", "xterm").stdin(Stdio::null());
    let output = script.output().expect("there is script, of util-linux");
    (code(&output), plain(&text(&output.stdout)))
}

/// A text without the sequences that colour it and move the cursor (ECMA-48, CSI).
fn plain(shown: &str) -> String {
    let mut parts = shown.split("\x1b[");
    let first = parts.next().unwrap_or_default().to_owned();
    let is_end = |letter: char| letter.is_ascii_alphabetic();
    parts.filter_map(|part| part.split_once(is_end)).fold(first, |all, (_, text)| all + text)
}

/// The states of the bar, one after the other, once something is done: each begins with its share of the whole.
fn frames(shown: &str) -> Vec<String> {
    let is_share = |text: &str| text == "<1" || text.parse::<u8>().is_ok_and(|share| share > 0);
    let lines = states(shown);
    lines.filter(|line| line.split_once(" % ").is_some_and(|(share, _)| is_share(share))).collect()
}

/// All lines that were shown one after the other, without the bar before each.
fn states(shown: &str) -> impl Iterator<Item = String> {
    let is_bar = |letter: char| matches!(letter, '━' | '╸' | ' ');
    let lines = shown.split(['\r', '\n']).map(move |line| words(line.trim_start_matches(is_bar)));
    lines.filter(|line| !line.is_empty())
}

/// The reason of a command without a result, as its object has it.
fn reason(command: &str) -> String {
    let arguments: Vec<&str> = command.split(' ').chain(["--json"]).collect();
    object(&meridian(&arguments))["reason"].as_str().expect("a reason").to_owned()
}

/// Commands that are refused, each with its reason.
fn refused() -> Vec<(String, String)> {
    let stage = stored("stepwise-circle");
    let commands = [
        "run --latitude 89.9 --rate 50".to_owned(),
        "run --rate 100 --fault gyro-identity".to_owned(),
        "run --gyro mems --rate 50 --positions 4 --dwell 2 --hold 0".to_owned(),
        "run turntable --latitude 89.9 --rate 50".to_owned(),
        format!("replay {stage} --latitude 86"),
    ];
    commands.into_iter().map(|command| (command.clone(), reason(&command))).collect()
}

#[test]
fn a_refusal_stands_once_on_a_terminal_however_much_is_told() {
    for (command, reason) in refused() {
        for how in ["", "-q", "--json"] {
            let (code, shown) = shown(&format!("{command} {how}"));
            let times = words(&shown).matches(&words(&reason)).count();
            assert_eq!((code, times), (1, 1), "{command} {how}: {shown}");
        }
    }
}

#[test]
fn a_failure_stands_once_on_a_terminal_too() {
    for command in ["replay no-such-file.csv", "plan --arw 0.1 --latitude 89 --seconds 300"] {
        let reason = reason(command);
        for how in ["", "--json"] {
            let (code, shown) = shown(&format!("{command} {how}"));
            let times = words(&shown).matches(&words(&reason)).count();
            assert_eq!((code, times), (1, 1), "{command} {how}: {shown}");
        }
    }
}

#[test]
fn a_refusal_stands_in_both_streams_where_they_go_apart() {
    for (command, reason) in refused() {
        let output = meridian(&command.split(' ').collect::<Vec<_>>());
        let said = text(&output.stderr);
        assert!(words(&text(&output.stdout)).contains(&words(&reason)), "{command}");
        assert!(said.lines().last().is_some_and(|line| line.ends_with(&reason)), "{said}");
    }
}

/// Commands that show a bar, and have a result.
fn working() -> Vec<String> {
    let [drive, rest] = ["drive-ideal", "static-gyro-1h"].map(stored);
    vec![
        "run --rate 50 --dwell 2 --positions 6 --hold 10".to_owned(),
        "run two-frame --rate 50 --passes 1 --hold 0".to_owned(),
        "run turntable --rate 50 --turns 3 --hold 0".to_owned(),
        "run vehicle --rate 50 --stops 2 --hold 0".to_owned(),
        "run spin --flight-seconds 0.5".to_owned(),
        "campaign spin --runs 20".to_owned(),
        format!("replay {drive}"),
        format!("replay {drive} {drive}"),
        format!("allan {rest}"),
    ]
}

/// What a state of the bar says behind the time that is left.
fn behind_time(frame: &str) -> &str {
    let (_, said) = frame.split_once(" % ").expect("a share of the whole");
    let (time, words) = said.split_once(" left ").expect("a time");
    assert!(time.split(':').all(|digits| digits.parse::<u32>().is_ok()), "{frame}");
    words
}

#[test]
fn a_bar_says_what_it_begins_with_and_then_always_the_time_that_is_left() {
    let begins = ["start", "flight", "reading", "runs 0/20", "recordings 0/2"];
    for command in working() {
        let (code, shown) = shown(&command);
        let first = states(&shown).next().unwrap_or_default();
        assert_eq!(code, 0, "{command}: {shown}");
        assert!(begins.iter().any(|words| first.starts_with(words)), "{command}: {shown}");
        assert!(states(&shown).all(|state| !state.starts_with("0 %")), "{command}: {shown}");
        let frames = frames(&shown);
        assert!(frames.iter().all(|frame| !behind_time(frame).is_empty()), "{command}: {shown}");
    }
}

#[test]
fn all_that_a_bar_tells_stands_in_eighty_columns() {
    let recording = stored("stepwise-circle");
    let program = env!("CARGO_BIN_EXE_meridian");
    let line = format!("stty cols 80; '{program}' replay {recording}");
    let mut script = Command::new("script");
    let script =
        script.args(["-qec", &line, "/dev/null"]).env("TERM", "xterm").stdin(Stdio::null());
    let shown = plain(&text(&script.output().expect("there is script, of util-linux").stdout));
    let frames = frames(&shown);
    let telling: Vec<_> = frames.iter().filter(|frame| frame.contains("σ so far")).collect();
    assert!(!telling.is_empty(), "{shown}");
    let is_whole = |frame: &&String| {
        frame.rsplit_once("limit ").is_some_and(|(_, limit)| limit.trim().ends_with('°'))
    };
    assert!(telling.iter().all(is_whole), "{telling:?}");
}

#[test]
fn a_bar_names_what_is_counted_only_together_with_how_many() {
    for command in working() {
        for frame in frames(&shown(&command).1) {
            let mut words = behind_time(&frame).split([' ', ',']);
            let (first, second) = (words.next().unwrap_or_default(), words.next());
            let count = second.and_then(|count| count.split_once('/'));
            let is_count = count.is_some_and(|(done, all)| {
                [done, all].iter().all(|number| number.parse::<u64>().is_ok())
            });
            let is_part = ["start", "keeping", "flight", "reading", "computing"].contains(&first);
            assert!(is_count != is_part, "{command}: {frame}");
        }
    }
}
