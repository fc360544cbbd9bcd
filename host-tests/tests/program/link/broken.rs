//! `meridian send` where no answer comes, or not a whole one: what was heard, and what to do.

use serde_json::json;

use super::fake::{Answering, Say, chatter, frame, over_tcp, say, sentence};
use crate::support::program::{code, meridian, object, reason, text};

/// How long the tests wait for an instrument that does not answer, s.
const WAIT: &str = "0.5";

/// Says nothing to any command.
fn mute() -> Answering {
    Box::new(|_| Vec::new())
}

/// Answers every command so.
fn always(said: Vec<Say>) -> Answering {
    Box::new(move |_| said.clone())
}

/// Why a command has failed at a port.
#[track_caller]
fn why(port: &str, words: &str) -> String {
    let words: Vec<_> = words.split(' ').collect();
    let output = meridian(&[&["send", port, "--wait", WAIT], &words[..]].concat());
    assert_eq!(code(&output), 1, "{}", text(&output.stdout));
    assert_eq!(text(&output.stdout), "");
    reason(&output)
}

/// Bytes at another baud rate, as they look: hardly any of them printable.
fn noise() -> Vec<u8> {
    (0..200_u32).map(|index| (index * index * 7 + 131) as u8 | 0x80).collect()
}

#[test]
fn without_an_answer_it_is_said_what_was_heard_meanwhile_and_what_to_do() {
    for (idle, says, to_do) in [
        (Vec::new(), "nothing was heard", "what serves it is no instrument"),
        (noise(), "of noise were heard", "what serves it is no instrument"),
        (chatter(), "the instrument was heard", "flash it anew with `cargo board`"),
        (sentence("GPHDT,12.3,T"), "another device was heard, as `$GPHDT", "name the port"),
        (frame(200), "the instrument was heard", "check the wire"),
        (frame(1), "the component 1 of a MAVLink network", "name the port"),
        (b"\nmeasuring 0/25, faults 0\n".to_vec(), "`measuring 0/25, faults 0`", "cargo board"),
    ] {
        let port = over_tcp(idle, mute());
        let why = why(&port, "save");
        let begins = format!("meridian: {port}: no answer to `save` in {WAIT} s; ");
        assert!(why.starts_with(&begins), "{why}");
        assert!(why.contains(says) && why.contains(to_do), "{why}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn at_a_serial_port_silence_and_noise_name_the_baud_rate() {
    use super::fake::at_terminal;
    let silent = why(&at_terminal(Vec::new(), mute()), "save");
    assert!(silent.contains("another baud rate than 115200 baud (--baud)"), "{silent}");
    assert!(silent.contains("`meridian doctor` lists the ports"), "{silent}");
    let port = at_terminal(noise(), mute());
    let output = meridian(&["send", &port, "save", "--wait", WAIT, "--baud", "9600"]);
    let noisy = reason(&output);
    assert!(noisy.contains("the instrument has another baud rate than 9600 baud"), "{noisy}");
}

#[test]
fn an_answer_that_was_cut_is_shown_and_no_answer() {
    for damaged in [
        &b"$PMRDR,save,o$HEHDT,1.0,T*00\r\n"[..],
        b"$PMRDR,save,ok*00\r\n",
        b"$PMRDR,sav\x00e,ok*00\r\n",
        b"$PMRDR,save,ok",
    ] {
        let port = over_tcp(Vec::new(), always(vec![Say::Bytes(damaged.to_vec())]));
        let why = why(&port, "save");
        assert!(why.contains("no whole answer to `save`"), "{why}");
        assert!(why.contains("came damaged: `$PMRDR,sav"), "{why}");
        assert!(why.contains("send it once more"), "{why}");
    }
}

#[test]
fn a_cut_sentence_beside_the_answer_is_told_of() {
    let said = vec![Say::Bytes(b"$PMRDR,get,lat\xFF".to_vec()), say("PMRDR,save,ok")];
    let port = over_tcp(Vec::new(), always(said));
    let output = meridian(&["send", &port, "save"]);
    assert_eq!((code(&output), text(&output.stdout)), (0, "save: done\n".to_owned()));
    assert!(text(&output.stderr).contains("came damaged: `$PMRDR,get,lat`"));
}

#[test]
fn a_list_of_which_a_sentence_was_damaged_is_not_whole() {
    let said = vec![
        say("PMRDR,get,latitude,47.58"),
        Say::Bytes(b"$PMRDR,get,dwell,1*00\r\n".to_vec()),
        say("PMRDR,get,ok"),
    ];
    let port = over_tcp(Vec::new(), always(said));
    let output = meridian(&["send", &port, "get", "--json"]);
    let object = object(&output);
    assert_eq!((code(&output), &object["status"]), (1, &json!("failed")));
    assert!(reason(&output).contains("the answer to `get` is not whole"), "{}", reason(&output));
    assert_eq!(object["values"], json!({ "latitude": 47.58 }));
}

#[test]
fn a_record_of_the_log_that_lacks_a_part_is_named() {
    let part = |number: u32| say(format!("PMRDR,log,7,{number},{}", "AB".repeat(20)));
    let said = vec![part(0), part(2), say("PMRDR,log,ok")];
    let output = meridian(&["send", &over_tcp(Vec::new(), always(said)), "log"]);
    assert_eq!(code(&output), 1);
    assert!(reason(&output).contains("parts of record 7 are missing"), "{}", reason(&output));
}

#[test]
fn an_answer_that_stops_on_the_way_says_how_far_it_came() {
    let said = vec![say("PMRDR,get,latitude,47.58"), say("PMRDR,get,dwell,10")];
    let why = why(&over_tcp(Vec::new(), always(said)), "get");
    assert!(why.contains("the answer to `get` ends after 2 sentences"), "{why}");
}

#[test]
fn an_other_side_that_goes_away_is_told_with_how_far_the_answer_was() {
    let port = over_tcp(chatter(), always(vec![Say::HangUp]));
    let before = why(&port, "start");
    assert!(
        before.contains("`start` was sent, and before its answer the port was lost"),
        "{before}"
    );
    let said =
        vec![say("PMRDR,get,latitude,47.58"), Say::Bytes(b"$PMRDR,get,dw".to_vec()), Say::HangUp];
    let amid = why(&over_tcp(chatter(), always(said)), "get");
    assert!(amid.contains("after 1 sentence of its answer the port was lost"), "{amid}");
    assert!(amid.contains("came damaged: `$PMRDR,get,dw`"), "{amid}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_serial_port_that_goes_away_amid_an_answer_is_told() {
    use super::fake::at_terminal;
    let said = vec![say("PMRDR,get,latitude,47.58"), Say::HangUp];
    let why = why(&at_terminal(Vec::new(), always(said)), "get");
    assert!(why.contains("the port was lost"), "{why}");
}

#[test]
fn a_port_that_cannot_be_opened_says_why_and_what_mends_it() {
    let nobody = std::net::TcpListener::bind(("127.0.0.1", 0)).and_then(|it| it.local_addr());
    let port = format!("tcp:{}", nobody.expect("a port is free").port());
    let refused = why(&port, "start");
    assert!(refused.contains(&format!("emulate --board stage --link {port}")), "{refused}");
    let missing = why("/dev/no-such-port", "start");
    assert!(
        missing
            .starts_with("meridian: /dev/no-such-port: there is no such port; this computer has")
    );
    let file = why(env!("CARGO_MANIFEST_PATH"), "start");
    assert!(file.ends_with("it is a file and no serial port"), "{file}");
}
