//! `meridian send` where an instrument answers.

use serde_json::{Value, json};

use super::fake::{Instrument, answering, digits, over_tcp, say, served};
use crate::support::program::{code, meridian, object, reason, text};

/// What is printed for a command that is done.
#[track_caller]
fn printed(port: &str, words: &str) -> String {
    let words: Vec<_> = words.split(' ').collect();
    let output = meridian(&[&["send", port], &words[..]].concat());
    assert_eq!(code(&output), 0, "{words:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// Every kind of command, and what is printed.
const COMMANDS: [(&str, &str); 6] = [
    ("start", "start: done\n"),
    ("azimuth 213.7 0.5", "azimuth 213.7 0.5: done\n"),
    ("get latitude", "latitude = 47.58\n"),
    ("set latitude -47.58", "latitude = -47.58\n"),
    ("get carrier", "carrier = stage\n"),
    ("save", "save: done\n"),
];

#[test]
fn a_command_is_answered_over_tcp_among_everything_else_that_is_sent() {
    let instrument = Instrument::new().shared();
    let port = served(&instrument);
    for (words, said) in COMMANDS {
        assert_eq!(printed(&port, words), said);
    }
    let got = &instrument.lock().expect("it is ours").got;
    assert_eq!(*got, COMMANDS.map(|(words, _)| words.to_owned()), "each is sent once");
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_is_answered_at_a_serial_port_among_everything_else_that_is_sent() {
    use super::fake::{at_terminal, chatter};
    let instrument = Instrument::new().shared();
    let port = at_terminal(chatter(), answering(&instrument));
    for (words, said) in COMMANDS {
        assert_eq!(printed(&port, words), said);
    }
}

#[test]
fn words_in_one_argument_are_those_of_one_command() {
    let port = served(&Instrument::new().shared());
    let output = meridian(&["send", &port, "set latitude 12.5"]);
    assert_eq!((code(&output), text(&output.stdout)), (0, "latitude = 12.5\n".to_owned()));
}

#[test]
fn all_settings_and_the_log_are_printed_line_by_line() {
    let port = served(&Instrument::new().shared());
    let settings = printed(&port, "get");
    assert_eq!(settings.lines().count(), 9, "{settings}");
    assert!(settings.contains("\ngyro_scale = -0.0125\n"), "{settings}");
    let bytes = digits(&(0..60).collect::<Vec<u8>>());
    assert_eq!(printed(&port, "log"), format!("record 412: {bytes}\n"));
}

#[test]
fn an_object_has_numbers_as_numbers_and_an_identity_as_text() {
    let port = served(&Instrument::new().shared());
    let all = object(&meridian(&["send", &port, "get", "--json"]));
    assert_eq!(
        [&all["schema"], &all["status"], &all["command"], &all["port"]],
        [&json!(1), &json!("ok"), &json!("get"), &json!(port)]
    );
    assert_eq!(all["values"]["latitude"], json!(47.58));
    assert_eq!(all["values"]["dwell"], json!(10));
    assert_eq!(all["values"]["link"], json!("nmea"));
    assert_eq!(all["values"]["serial"], json!("0123456789ABCDEF01234567"));
    let log = object(&meridian(&["send", &port, "log", "--json"]));
    assert_eq!(log["records"][0]["record"], json!(412));
    assert_eq!(log["records"][0]["bytes"].as_str().map(str::len), Some(120));
    let done = object(&meridian(&["send", &port, "stop", "--json"]));
    assert_eq!([&done["values"], &done["records"]], [&Value::Null, &Value::Null]);
}

#[test]
fn what_the_instrument_refuses_is_a_refusal_with_its_reason() {
    let mut instrument = Instrument::new();
    instrument.refuses.insert("start".to_owned(), "an alignment runs already");
    let port = served(&instrument.shared());
    let output = meridian(&["send", &port, "start"]);
    assert_eq!(code(&output), 1);
    let words = "the instrument refuses `start`: an alignment runs already";
    assert_eq!(reason(&output), format!("meridian: {words}"));
    assert_eq!(text(&output.stdout), "");
    let output = meridian(&["send", &port, "start", "--json"]);
    let object = object(&output);
    assert_eq!((code(&output), &object["status"]), (1, &json!("refused")));
    assert_eq!(object["reason"], json!(words));
    let output = meridian(&["send", &port, "get", "no_such"]);
    assert!(reason(&output).ends_with("refuses `get no_such`: no such setting"));
}

#[test]
fn answers_to_the_commands_of_others_are_passed_over() {
    let strays = |_: &[&str]| {
        vec![
            say("PMRDR,save,refused,not yours"),
            say("PMRDR,get,dwell,10"),
            say("PMRDR,set,latitude,1"),
            say("PMRDR,get,ok"),
            say("PMRDR,log,1,0,00"),
            say("PMRDR,get,latitude,47.58"),
        ]
    };
    let port = over_tcp(Vec::new(), Box::new(strays));
    let output = meridian(&["send", &port, "get", "latitude"]);
    assert_eq!(text(&output.stdout), "latitude = 47.58\n", "{}", text(&output.stderr));
    assert_eq!(text(&output.stderr), "");
}
