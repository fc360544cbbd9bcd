//! `meridian settings get`, `set` and `save`.

use serde_json::json;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fake::{Answering, Instrument, Shared, over_tcp, say, served};
use crate::support::files::Scratch;
use crate::support::program::{assert_misuse, code, meridian, object, reason, text, words};

/// An instrument, and its address.
fn instrument() -> (Shared, String) {
    let instrument = Instrument::new().shared();
    let port = served(&instrument);
    (instrument, port)
}

#[test]
fn all_settings_are_shown_below_what_the_instrument_is() {
    let (_, port) = instrument();
    let output = meridian(&["settings", &port, "get"]);
    let shown = text(&output.stdout);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert!(shown.starts_with(&format!("Settings of the instrument at {port}\n")), "{shown}");
    let told = words(&shown);
    for pair in ["carrier stage", "firmware 0.1.0", "latitude 47.58", "g_bias_x 0.50"] {
        assert!(told.contains(pair), "{pair} in {shown}");
    }
    let object = object(&meridian(&["settings", &port, "get", "--json"]));
    assert_eq!(object["identity"]["carrier"], json!("stage"));
    assert_eq!(object["settings"]["gyro_scale"], json!(-0.0125));
    assert_eq!(object["settings"]["holds"], json!("true"));
}

#[test]
fn named_settings_alone_are_asked_for() {
    let (instrument, port) = instrument();
    let output = meridian(&["settings", &port, "get", "latitude", "carrier", "--json"]);
    let object = object(&output);
    assert_eq!(object["settings"], json!({ "latitude": 47.58 }));
    assert_eq!(object["identity"], json!({ "carrier": "stage" }));
    assert_eq!(instrument.lock().expect("it is ours").got, ["get latitude", "get carrier"]);
    let output = meridian(&["settings", &port, "get", "latitude", "latitud"]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).ends_with("no such setting; 1 of 2 were done before: latitude"));
}

#[test]
fn settings_are_changed_as_pairs_of_words_or_with_an_equals_sign() {
    let (instrument, port) = instrument();
    let output =
        meridian(&["settings", &port, "set", "latitude", "-12.5", "dwell=20", "link", "mavlink"]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let shown = words(&text(&output.stdout));
    assert!(shown.contains("latitude -12.5"), "{shown}");
    assert!(shown.contains(&format!("`meridian send {port} save` keeps them")), "{shown}");
    let instrument = instrument.lock().expect("it is ours");
    assert_eq!(instrument.got, ["set latitude -12.5", "set dwell 20", "set link mavlink"]);
    assert!(instrument.flash.is_none(), "nothing is kept without being asked for");
}

#[test]
fn a_setting_that_is_refused_ends_the_command_and_says_what_was_changed_before() {
    let (instrument, port) = instrument();
    instrument.lock().expect("it is ours").refuses.insert("dwell".to_owned(), "out of range");
    let output =
        meridian(&["settings", &port, "set", "latitude=1", "dwell=0", "link=nmea", "--json"]);
    let object = object(&output);
    assert_eq!((code(&output), &object["status"]), (1, &json!("refused")));
    let why =
        "the instrument refuses `set dwell 0`: out of range; 1 of 3 were done before: latitude";
    assert_eq!(object["reason"], json!(why));
    assert_eq!(object["settings"], json!({ "latitude": 1 }));
    assert_eq!(instrument.lock().expect("it is ours").got.len(), 2, "nothing is sent behind it");
}

#[test]
fn a_value_that_is_kept_otherwise_is_told() {
    let rounding: Answering = Box::new(|_| vec![say("PMRDR,set,latitude,47.5799")]);
    let output = meridian(&["settings", &over_tcp(Vec::new(), rounding), "set", "latitude=47.58"]);
    assert_eq!(code(&output), 0);
    let said = text(&output.stderr);
    assert_eq!(said, "warning: latitude = 47.58 is kept as 47.5799\n");
    let same: Answering = Box::new(|_| vec![say("PMRDR,set,latitude,47.580")]);
    let output = meridian(&["settings", &over_tcp(Vec::new(), same), "set", "latitude=47.58"]);
    assert_eq!(text(&output.stderr), "");
}

#[test]
fn a_file_has_the_identity_and_every_setting_exactly_as_the_instrument_says_it() {
    let (instrument, port) = instrument();
    instrument.lock().expect("it is ours").memory.extend([
        ("zeros".to_owned(), "007".to_owned()),
        ("words".to_owned(), "a \"quoted\" word".to_owned()),
    ]);
    let scratch = Scratch::new("settings");
    let path = scratch.path("board.toml");
    let output = meridian(&["settings", &port, "save", &path, "--json"]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(object(&output)["settings"]["latitude"], json!(47.58));
    let written = scratch.read("board.toml");
    let expected = "carrier = \"stage\"\nserial = \"0123456789ABCDEF01234567\"\nfirmware = \"0.1.0\"\n\n\
                    [settings]\ndwell = 10\ng_bias_x = 0.50\ngyro_scale = -0.0125\nholds = \"true\"\n\
                    latitude = 47.58\nlink = \"nmea\"\nwords = \"a \\\"quoted\\\" word\"\nzeros = \"007\"\n";
    assert_eq!(written, expected);
    let table = DeTable::parse(&written).expect("it is TOML").into_inner();
    let settings = table.get("settings").map(Spanned::get_ref);
    let Some(DeValue::Table(settings)) = settings else { panic!("there are settings") };
    let bias = settings.get("g_bias_x").map(Spanned::get_ref);
    assert!(matches!(bias, Some(DeValue::Float(bias)) if bias.as_str() == "0.50"));
    let words = settings.get("words").and_then(|words| words.get_ref().as_str());
    assert_eq!(words, Some("a \"quoted\" word"));
}

#[test]
fn a_file_that_is_there_is_replaced_only_where_that_is_asked_for() {
    let (instrument, port) = instrument();
    let scratch = Scratch::new("settings");
    let path = scratch.with("board.toml", "mine");
    let output = meridian(&["settings", &port, "save", &path]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).contains("it is there already"), "{}", reason(&output));
    assert!(reason(&output).ends_with("by --overwrite"), "{}", reason(&output));
    assert_eq!(scratch.read("board.toml"), "mine");
    assert!(instrument.lock().expect("it is ours").got.is_empty(), "nobody was asked");
    let output = meridian(&["settings", &port, "save", &path, "--overwrite"]);
    assert_eq!(code(&output), 0, "{}", reason(&output));
    assert!(scratch.read("board.toml").starts_with("carrier"));
}

#[test]
fn a_file_that_cannot_be_written_is_named_before_anyone_is_asked() {
    let (instrument, port) = instrument();
    let output = meridian(&["settings", &port, "save", "/nowhere/board.toml"]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).contains("there is no such folder: /nowhere"), "{}", reason(&output));
    assert_misuse(
        &["settings", &port, "save", "board.txt"],
        "the name of the settings ends in .toml",
    );
    assert!(instrument.lock().expect("it is ours").got.is_empty());
}

#[test]
fn a_file_is_left_alone_where_the_instrument_does_not_answer() {
    let port = over_tcp(Vec::new(), Box::new(|_| Vec::new()));
    let scratch = Scratch::new("settings");
    let path = scratch.with("board.toml", "mine");
    let arguments = ["settings", &port, "save", &path, "--overwrite", "--wait", "0.3"];
    assert_eq!(code(&meridian(&arguments)), 1);
    assert_eq!(scratch.read("board.toml"), "mine");
}

/// Answers to `get` of which the setting of a name is missing in every second one, as where the sentence was lost.
fn forgetful() -> Answering {
    let mut count = 0;
    Box::new(move |_| {
        count += 1;
        let dwell = (count % 2 == 0).then(|| say("PMRDR,get,dwell,10"));
        let rest = [say("PMRDR,get,latitude,47.58"), say("PMRDR,get,ok")];
        dwell.into_iter().chain(rest).collect()
    })
}

#[test]
fn settings_of_which_a_sentence_is_lost_unseen_are_not_believed() {
    let scratch = Scratch::new("settings");
    let path = scratch.path("board.toml");
    let output = meridian(&["settings", &over_tcp(Vec::new(), forgetful()), "save", &path]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).contains("no two of 4 readings of all settings agree"));
    assert!(!scratch.folder().join("board.toml").exists());
}

#[test]
fn a_damaged_reading_is_made_once_more() {
    let mut count = 0;
    let answering: Answering = Box::new(move |_| {
        count += 1;
        let latitude =
            if count == 1 { "PMRDR,get,latitude,47" } else { "PMRDR,get,latitude,47.58" };
        let cut = super::fake::Say::Bytes(format!("${latitude}").into_bytes());
        let first = if count == 1 { cut } else { say(latitude) };
        vec![first, say("PMRDR,get,dwell,10"), say("PMRDR,get,ok")]
    });
    let output = meridian(&["settings", &over_tcp(Vec::new(), answering), "get", "--json"]);
    assert_eq!(object(&output)["settings"], json!({ "dwell": 10, "latitude": 47.58 }));
}
