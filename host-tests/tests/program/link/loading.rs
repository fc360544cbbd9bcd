//! `meridian settings load`: all of a file or nothing of it.

use std::collections::BTreeMap;
use std::process::Output;
use std::sync::{Arc, Mutex};

use serde_json::json;

use super::fake::{Answering, Instrument, Say, Shared, over_tcp, served};
use crate::support::files::Scratch;
use crate::support::program::{code, command, meridian, object, reason, text};

/// A file of the board that [`Instrument::new`] is, with other values of two settings.
const FILE: &str = "carrier = \"stage\"\nserial = \"0123456789ABCDEF01234567\"\nfirmware = \"0.1.0\"\n\n\
                    [settings]\ndwell = 20\ng_bias_x = 0.5\ngyro_scale = -0.0125\nholds = true\n\
                    latitude = -12.5\nlink = \"nmea\"\n";

/// What came of loading a file into an instrument.
struct Loaded {
    output: Output,
    instrument: Instrument,
}

impl Loaded {
    /// Loads it.
    fn of(file: &str, instrument: Instrument, options: &[&str]) -> Self {
        let instrument = instrument.shared();
        let output = loaded(file, &served(&instrument), options);
        let instrument = instrument.lock().expect("it is ours").clone();
        Self { output, instrument }
    }

    /// That nothing is changed, and why.
    #[track_caller]
    fn assert_refused(&self, words: &[&str]) {
        let why = reason(&self.output);
        assert_eq!(code(&self.output), 1, "{}", text(&self.output.stdout));
        for words in words {
            assert!(why.contains(words), "{words} in {why}");
        }
        assert!(why.contains("board.toml: "), "{why}");
        assert_eq!(self.instrument.memory, Instrument::new().memory);
        assert_eq!(self.instrument.flash, None, "nothing is saved");
    }

    /// The commands that change something.
    fn changes(&self) -> Vec<&str> {
        let all = self.instrument.got.iter().map(String::as_str);
        all.filter(|command| !command.starts_with("get")).collect()
    }
}

/// Loads a file at a port.
fn loaded(file: &str, port: &str, options: &[&str]) -> Output {
    let scratch = Scratch::new("load");
    let path = scratch.with("board.toml", file);
    meridian(&[&["settings", port, "load", &path], options].concat())
}

#[test]
fn what_differs_is_set_then_saved_and_read_back() {
    let loaded = Loaded::of(FILE, Instrument::new(), &["--json"]);
    let object = object(&loaded.output);
    assert_eq!(code(&loaded.output), 0, "{}", text(&loaded.output.stderr));
    assert_eq!(loaded.changes(), ["set dwell 20", "set latitude -12.5", "save"]);
    let last = loaded.instrument.got.last().map(String::as_str);
    assert_eq!(last, Some("get"), "it is read back");
    assert_eq!(loaded.instrument.flash, Some(loaded.instrument.memory));
    let changed = json!([
        { "name": "dwell", "before": 10, "now": 20 },
        { "name": "latitude", "before": 47.58, "now": -12.5 },
    ]);
    assert_eq!(
        [&object["changed"], &object["same"], &object["saved"]],
        [&changed, &json!(4), &json!(true)]
    );
}

/// Whatever their order: each is possible together with those that the others have then.
#[test]
fn settings_that_are_possible_after_others_alone_are_set_after_those() {
    for excludes in [["latitude", "47.58"], ["gyro_scale", "-0.0125"]] {
        let excludes = Some([["dwell", "20"], excludes]);
        let file = FILE.replace("-0.0125", "0.05");
        let loaded = Loaded::of(&file, Instrument { excludes, ..Instrument::new() }, &[]);
        assert_eq!(code(&loaded.output), 0, "{}", text(&loaded.output.stderr));
        let changes = ["set gyro_scale 0.05", "set latitude -12.5", "set dwell 20", "save"];
        assert_eq!(loaded.changes(), [&["set dwell 20"], &changes[..]].concat());
    }
}

#[test]
fn settings_that_are_impossible_together_are_refused_and_the_others_set_back() {
    let excludes = Some([["dwell", "20"], ["latitude", "-12.5"]]);
    let loaded = Loaded::of(FILE, Instrument { excludes, ..Instrument::new() }, &[]);
    loaded.assert_refused(&["`set latitude -12.5`: not together", "are set again"]);
}

#[test]
fn what_was_saved_loads_without_any_change() {
    let instrument = Instrument::new().shared();
    let port = served(&instrument);
    let scratch = Scratch::new("load");
    let path = scratch.path("board.toml");
    assert_eq!(code(&meridian(&["settings", &port, "save", &path])), 0);
    let output = meridian(&["settings", &port, "load", &path]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("the same already   6"), "{}", text(&output.stdout));
    assert_eq!(text(&output.stderr), "");
    let got = &instrument.lock().expect("it is ours").got;
    assert!(!got.iter().any(|command| command.starts_with("set")), "{got:?}");
    assert!(got.iter().any(|command| command == "save"), "what is in memory is kept in flash");
}

#[test]
fn settings_of_another_carrier_are_refused_with_both_names() {
    let file = FILE.replace("\"stage\"", "\"vehicle\"");
    let loaded = Loaded::of(&file, Instrument::new(), &[]);
    loaded.assert_refused(&[
        "of the carrier vehicle",
        "on the carrier stage",
        "nothing was changed",
    ]);
    let file = FILE.replace("carrier = \"stage\"\n", "");
    Loaded::of(&file, Instrument::new(), &[]).assert_refused(&["the file states no carrier"]);
}

#[test]
fn calibrations_of_another_board_are_refused_with_both_serial_numbers() {
    let file = FILE.replace("0123456789ABCDEF01234567", "FFFF");
    let loaded = Loaded::of(&file, Instrument::new(), &[]);
    let both = ["of the board FFFF", "this is the board 0123456789ABCDEF01234567"];
    loaded.assert_refused(&both);
    loaded.assert_refused(&["g_bias_x, gyro_scale", "--other-board loads all but these"]);
    let without = FILE.replace("serial = \"0123456789ABCDEF01234567\"\n", "");
    Loaded::of(&without, Instrument::new(), &[]).assert_refused(&["of the board unknown"]);
}

#[test]
fn of_another_board_all_but_its_calibrations_is_loaded_where_that_is_asked_for() {
    let file = FILE.replace("0123456789ABCDEF01234567", "FFFF").replace("-0.0125", "7");
    let loaded = Loaded::of(&file, Instrument::new(), &["--other-board", "--json"]);
    assert_eq!(code(&loaded.output), 0, "{}", text(&loaded.output.stderr));
    assert_eq!(loaded.changes(), ["set dwell 20", "set latitude -12.5", "save"]);
    assert_eq!(object(&loaded.output)["left_out"], json!(["g_bias_x", "gyro_scale"]));
    let said = text(&loaded.output.stderr);
    assert!(said.contains("were left out: g_bias_x, gyro_scale"), "{said}");
}

#[test]
fn a_file_of_another_board_without_calibrations_is_loaded() {
    let file = "carrier = \"stage\"\nserial = \"FFFF\"\n[settings]\ndwell = 20\n";
    let loaded = Loaded::of(file, Instrument::new(), &[]);
    assert_eq!(code(&loaded.output), 0, "{}", reason(&loaded.output));
    assert_eq!(loaded.changes(), ["set dwell 20", "save"]);
    let said = text(&loaded.output.stderr);
    assert!(
        said.contains("left as they are: g_bias_x, gyro_scale, holds, latitude, link"),
        "{said}"
    );
}

#[test]
fn a_setting_that_the_instrument_does_not_have_stops_all() {
    let file = format!("{FILE}no_such = 1\nnor_this = 2\n");
    let loaded = Loaded::of(&file, Instrument::new(), &[]);
    loaded.assert_refused(&["has no setting no_such, nor_this; nothing was changed"]);
    assert!(loaded.changes().is_empty());
}

#[test]
fn where_a_setting_is_refused_those_before_it_are_set_back() {
    let mut instrument = Instrument::new();
    instrument.refuses.insert("latitude".to_owned(), "out of range");
    let loaded = Loaded::of(FILE, instrument, &[]);
    loaded.assert_refused(&["refuses `set latitude -12.5`: out of range", "are set again"]);
    assert_eq!(loaded.changes(), ["set dwell 20", "set latitude -12.5", "set dwell 10"]);
    let mut instrument = Instrument::new();
    instrument.refuses.insert("dwell".to_owned(), "out of range");
    let loaded = Loaded::of(FILE, instrument, &[]);
    loaded.assert_refused(&["refuses `set dwell 20`: out of range", "are set again"]);
    let tried = ["set dwell 20", "set latitude -12.5", "set dwell 20", "set latitude 47.58"];
    assert_eq!(loaded.changes(), tried);
    let mut instrument = Instrument::new();
    instrument.refuses.extend(["dwell", "latitude"].map(|name| (name.to_owned(), "read only")));
    let loaded = Loaded::of(FILE, instrument, &[]);
    loaded.assert_refused(&["nothing was changed, and nothing saved"]);
}

#[test]
fn where_saving_is_refused_all_are_set_back() {
    let mut instrument = Instrument::new();
    instrument.refuses.insert("save".to_owned(), "the flash is worn");
    let loaded = Loaded::of(FILE, instrument, &[]);
    loaded.assert_refused(&["refuses `save`: the flash is worn", "are set again"]);
    let back = ["set latitude 47.58", "set dwell 10"];
    assert_eq!(loaded.changes()[3..], back);
}

/// An instrument whose answer to one command is another one.
fn but(instrument: &Shared, command: &'static str, said: Vec<Say>) -> Answering {
    let instrument = Arc::clone(instrument);
    Box::new(move |words| {
        let answered = instrument.lock().expect("it is ours").answer(words);
        if words.join(" ") == command { said.clone() } else { answered }
    })
}

#[test]
fn a_setting_whose_answer_is_lost_is_set_back_too() {
    let instrument = Instrument::new().shared();
    let port = over_tcp(Vec::new(), but(&instrument, "set latitude -12.5", Vec::new()));
    let output = loaded(FILE, &port, &["--wait", "0.5"]);
    assert_eq!(code(&output), 1);
    assert!(
        reason(&output).ends_with("are set again, and nothing was saved"),
        "{}",
        reason(&output)
    );
    let instrument = instrument.lock().expect("it is ours");
    assert_eq!((&instrument.memory, &instrument.flash), (&Instrument::new().memory, &None));
}

#[test]
fn an_instrument_that_goes_away_amid_the_settings_leaves_what_cannot_be_set_back_named() {
    let instrument = Instrument::new().shared();
    let port = over_tcp(Vec::new(), but(&instrument, "set latitude -12.5", vec![Say::HangUp]));
    let output = loaded(FILE, &port, &[]);
    assert_eq!(code(&output), 1);
    let why = reason(&output);
    assert!(why.contains("latitude, dwell could not be set back"), "{why}");
    assert!(why.contains("until the instrument starts anew; nothing was saved"), "{why}");
}

#[test]
fn where_saving_is_not_answered_it_is_said_that_nobody_knows() {
    let instrument = Instrument::new().shared();
    let port = over_tcp(Vec::new(), but(&instrument, "save", Vec::new()));
    let output = loaded(FILE, &port, &["--wait", "0.5"]);
    assert_eq!(code(&output), 1);
    let why = reason(&output);
    assert!(why.contains("whether they are saved is not known: load them once more"), "{why}");
}

#[test]
fn what_reads_back_otherwise_is_named() {
    let instrument = Instrument::new().shared();
    let forgetting: Answering = {
        let instrument = Arc::clone(&instrument);
        Box::new(move |words| {
            let mut instrument = instrument.lock().expect("it is ours");
            let answered = instrument.answer(words);
            if words == ["save"] {
                instrument.memory = Instrument::new().memory;
            }
            answered
        })
    };
    let output = loaded(FILE, &over_tcp(Vec::new(), forgetting), &[]);
    assert_eq!(code(&output), 1);
    let why = reason(&output);
    assert!(
        why.contains("read back otherwise: dwell is 10 and not 20, latitude is 47.58"),
        "{why}"
    );
}

#[test]
fn numbers_may_be_written_in_any_way_that_the_format_knows() {
    let file = FILE
        .replace("dwell = 20", "dwell = 0x14")
        .replace("latitude = -12.5", "latitude = -1.25e1")
        .replace("0.5\n", "+0.5\n");
    let loaded = Loaded::of(&file, Instrument::new(), &[]);
    assert_eq!(code(&loaded.output), 0, "{}", reason(&loaded.output));
    assert_eq!(loaded.changes(), ["set dwell 20", "set latitude -12.5", "save"]);
}

#[test]
fn a_malformed_file_is_named_with_line_and_column_before_anyone_is_asked() {
    let head = "carrier = \"stage\"\n";
    for (file, place, words) in [
        (format!("{head}serial = \n"), "line 2, column 10", ""),
        (format!("{head}[settings]\ndwell = 1\ndwell = 2\n"), "line 4, column 1", "duplicate key"),
        (format!("{head}speed = 1\n"), "line 2, column 1", "speed is none of carrier, serial"),
        (format!("{head}[settings]\ndwell = [1]\n"), "line 3, column 9", "a number or a text"),
        (format!("{head}[settings]\ndwell = inf\n"), "line 3, column 9", "inf is no number"),
        (format!("{head}[settings]\ndwell = 0.1234567890123456\n"), "line 3, column 9", "fifteen"),
        (format!("{head}[settings]\nlink = \"a,b\"\n"), "line 3, column 8", "may not have"),
        (format!("{head}[settings]\nlink = \"\"\n"), "line 3, column 8", "is empty"),
        (format!("{head}[settings]\nserial = \"1\"\n"), "line 3, column 1", "cannot be set"),
        (format!("{head}[settings]\nDwell = 1\n"), "line 3, column 1", "no name of a setting"),
    ] {
        let loaded = Loaded::of(&file, Instrument::new(), &[]);
        loaded.assert_refused(&[&format!("board.toml: {place}: "), words]);
        assert!(loaded.instrument.got.is_empty(), "{file}");
    }
    let output = meridian(&["settings", "tcp:9", "load", "no-such.toml"]);
    assert!(reason(&output).contains("no-such.toml: there is no such file"), "{}", reason(&output));
}

#[cfg(unix)]
#[test]
fn a_load_that_is_interrupted_sets_back_what_it_had_changed() {
    let (instrument, process) = (Instrument::new().shared(), Arc::new(Mutex::new(0_u32)));
    let interrupting: Answering = {
        let (instrument, process) = (Arc::clone(&instrument), Arc::clone(&process));
        Box::new(move |words| {
            if words == ["set", "dwell", "20"] {
                let process = process.lock().expect("it is ours").to_string();
                let killed = std::process::Command::new("kill").args(["-INT", &process]).status();
                assert!(killed.is_ok_and(|status| status.success()));
                // It takes the program a moment to notice.
                std::thread::sleep(std::time::Duration::from_millis(300));
            }
            instrument.lock().expect("it is ours").answer(words)
        })
    };
    let scratch = Scratch::new("load");
    let path = scratch.with("board.toml", FILE);
    let port = over_tcp(Vec::new(), interrupting);
    let mut held = process.lock().expect("it is ours");
    let pipe = std::process::Stdio::piped;
    let child =
        command().args(["settings", &port, "load", &path]).stderr(pipe()).stdout(pipe()).spawn();
    let child = child.expect("it starts");
    *held = child.id();
    drop(held);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(code(&output), 1);
    let why = reason(&output);
    assert!(why.contains("interrupted; the values that were there before are set again"), "{why}");
    let memory: BTreeMap<_, _> = instrument.lock().expect("it is ours").memory.clone();
    assert_eq!(memory, Instrument::new().memory);
}
