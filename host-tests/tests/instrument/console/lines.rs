//! Commands as lines of text.

use std::cell::RefCell;

use firmware::event::Event;
use firmware::not_begun::NotBegun;
use firmware::settings::{self, Settings, StageSchedule};
use firmware::shared::Shared;
use orientation::device::{Device, Trouble};
use orientation::units::{Radians, Seconds};

use super::{Memory, REBOOTS, SERIAL, answers_in, conversed, record, settings};
use crate::support::link::sentences;

/// The answers to lines, of which each is sent a second after the one before.
fn answers(
    shared: &Shared<'_>,
    stated: Settings<StageSchedule>,
    lines: &[&str],
    memory: &RefCell<Memory>,
) -> Vec<String> {
    let typed: Vec<(u64, String)> =
        lines.iter().zip(1..).map(|(line, at)| (1000 * at, format!("{line}\n"))).collect();
    let typed: Vec<(u64, &[u8])> = typed.iter().map(|(at, line)| (*at, line.as_bytes())).collect();
    let until = 1000 * (lines.len() as u64 + 5);
    let shown = conversed((shared, stated), &typed, until, memory);
    answers_in(&String::from_utf8(shown).expect("text"))
}

/// The same of an instrument with an empty memory.
fn answered(lines: &[&str]) -> Vec<String> {
    answers(&Shared::new(&()), settings(), lines, &RefCell::default())
}

#[test]
fn a_setting_is_stated_and_changed_by_its_name_in_its_users_unit() {
    let lines =
        ["get latitude", "set dwell 12.5", "get dwell", "set autostart no", "set latitude none"];
    let expected = [
        "get,latitude,48",
        "set,dwell,12.5",
        "get,dwell,12.5",
        "set,autostart,no",
        "set,latitude,none",
    ];
    assert_eq!(answered(&lines), expected);
}

#[test]
fn what_is_no_command_or_no_value_is_refused_with_the_reason_and_changes_nothing() {
    let lines = [
        "hello",
        "set latitude",
        "set latitude 91",
        "set latitude x",
        "set nothing 1",
        "get nothing",
        "set hdt_rate 3",
        "azimuth 10",
        "azimuth 10 0",
        "azimuth 10 0.5",
        "$PMRDC,start*00",
        "get latitude",
        "get hdt_rate",
    ];
    let refused = answered(&lines);
    let [values @ .., latitude, rate] = &refused[..] else { panic!("{refused:?}") };
    assert!(values.iter().all(|answer| answer.contains(",refused,")), "{values:?}");
    assert_eq!(values.len(), lines.len() - 2);
    assert_eq!([latitude.as_str(), rate], ["get,latitude,48", "get,hdt_rate,1"]);
    let reason = |line: usize| values[line].rsplit(',').next().expect("a reason");
    assert_eq!(reason(0), "unknown command");
    assert_eq!(reason(3), "not a number");
    assert_eq!(reason(4), "no such setting");
    assert_eq!(reason(10), "checksum");
}

#[test]
fn a_sentence_with_a_checksum_is_a_command_like_a_line() {
    let sum = "PMRDC,get,latitude".bytes().fold(0, |sum, byte| sum ^ byte);
    assert_eq!(answered(&[&format!("$PMRDC,get,latitude*{sum:02X}")]), ["get,latitude,48"]);
}

#[test]
fn all_settings_are_listed_with_what_ends_the_list() {
    let all = answered(&["get"]);
    let count = <dyn settings::Editable>::count(&mut settings());
    let identity =
        ["get,carrier,stage", "get,serial,070707070707070707070707", "get,firmware,0.1.0"];
    assert_eq!(all[..3], identity);
    assert_eq!(answered(&["get serial"]), [identity[1]]);
    assert_eq!(all.len(), 3 + count + 1);
    assert_eq!(all.last().map(String::as_str), Some("get,ok"));
    for name in ["latitude", "baud", "gyro_scale", "encoder_sigma", "hold", "positions"] {
        let head = format!("get,{name},");
        assert!(all.iter().any(|answer| answer.starts_with(&head)), "{name} among {all:?}");
    }
}

#[test]
fn what_is_saved_is_a_record_of_the_settings_for_this_board_and_it_is_said_where_it_is_not() {
    let memory = RefCell::<Memory>::default();
    let lines = ["set dwell 12.5", "save"];
    let said = answers(&Shared::new(&()), settings(), &lines, &memory);
    assert_eq!(said, ["set,dwell,12.5", "save,ok"]);
    let (slot, kept) = memory.borrow().item.clone().expect("it was kept");
    let read: Settings<StageSchedule> = Settings::from_record(&kept, &SERIAL).expect("a record");
    assert_eq!(slot, settings::SLOT);
    assert_eq!(read.schedule.dwell, Seconds(12.5));
    memory.borrow_mut().is_full = true;
    let said = answers(&Shared::new(&()), settings(), &["save"], &memory);
    assert!(said[0].starts_with("save,refused,the store does not take the record"), "{said:?}");
}

#[test]
fn factory_settings_are_restored_whole() {
    let memory = RefCell::default();
    let lines = [
        "set dwell 12.5",
        "set hdt_rate 10",
        "restore",
        "get dwell",
        "get latitude",
        "get hdt_rate",
    ];
    let said = answers(&Shared::new(&()), settings(), &lines, &memory);
    assert_eq!(said[2..], ["restore,ok", "get,dwell,10", "get,latitude,none", "get,hdt_rate,1"]);
}

#[test]
fn what_the_link_sends_changes_at_once() {
    let typed: [(u64, &[u8]); 1] = [(5050, b"set hdt_rate 10\n")];
    let shared = Shared::new(&());
    let shown = conversed((&shared, settings()), &typed, 10_050, &RefCell::default());
    let shown = String::from_utf8(shown).expect("text");
    let sent = sentences(&shown, "HEHDT").len();
    assert!((53..=57).contains(&sent), "five in five seconds, then fifty: {sent}");
}

#[test]
fn the_log_is_read_record_by_record() {
    let memory = RefCell::<Memory>::default();
    memory.borrow_mut().log = vec![record(3, 0xA5), record(4, 0x5A), record(9, 0)];
    let said = answers(&Shared::new(&()), settings(), &["log"], &memory);
    let bytes = |byte: &str, count: usize| byte.repeat(count);
    let mut expected = Vec::new();
    for (number, byte) in [(3, "A5"), (4, "5A"), (9, "00")] {
        expected.push(format!("log,{number},0,{}", bytes(byte, 24)));
        expected.push(format!("log,{number},1,{}", bytes(byte, 24)));
        expected.push(format!("log,{number},2,{}", bytes(byte, 12)));
    }
    expected.push("log,ok".to_owned());
    assert_eq!(said, expected);
}

#[test]
fn the_self_tests_of_the_devices_are_told() {
    let shared = Shared::new(&());
    shared.report(Event::Started(Device::Gyro));
    shared.report(Event::Started(Device::OuterEncoder));
    shared.give_up(Device::Accelerometer, Trouble::Silent);
    let said = answers(&shared, settings(), &["test"], &RefCell::default());
    let expected =
        ["test,gyro,passed", "test,accelerometer,failed", "test,outer_encoder,passed", "test,ok"];
    assert_eq!(said, expected);
}

#[test]
fn an_instrument_that_waits_begins_by_an_order_once_it_has_a_latitude() {
    let shared = Shared::new(&());
    shared.wait_to_begin();
    let stated = Settings { latitude: None, ..settings() };
    let said =
        answers(&shared, stated, &["start", "set latitude 47.58", "start"], &RefCell::default());
    assert_eq!(said, ["start,refused,no latitude is set", "set,latitude,47.58", "start,ok"]);
    assert!(shared.begin.signaled());
}

/// One that states its latitude waits for an order all the same.
#[test]
fn the_latitude_of_a_satellite_receiver_begins_what_waits_for_nothing_else() {
    let gga = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47";
    for (latitude, starts, begins) in
        [(None, true, true), (None, false, false), (settings().latitude, true, false)]
    {
        let shared = Shared::new(&());
        shared.wait_to_begin();
        let stated = Settings { latitude, starts, ..settings() };
        let said = answers(&shared, stated, &[gga], &RefCell::default());
        assert!(said.is_empty(), "it is no command: {said:?}");
        assert_eq!(shared.begin.signaled(), begins, "{latitude:?} {starts}");
        let heard = shared.latitude.get().map(|heard| Radians(heard.rad()).degrees());
        assert!(heard.is_some_and(|heard| (heard - (48.0 + 7.038 / 60.0)).abs() < 1e-9));
    }
}

#[test]
fn an_instrument_that_could_not_begin_says_why_to_every_order() {
    let shared = Shared::new(&());
    shared.refuse_to_begin(NotBegun::NoScale);
    shared.is_kept.set(true);
    let said = answers(&shared, settings(), &["start", "realign", "stop"], &RefCell::default());
    assert_eq!(said[0], "start,refused,a sensor's scale factor is none");
    assert_eq!(said[1], "realign,refused,a sensor's scale factor is none");
    assert_eq!(said[2], "stop,refused,no alignment runs");
}

#[test]
fn it_is_started_anew_after_its_answer() {
    let before = REBOOTS.with_borrow(Vec::len);
    assert_eq!(answered(&["reboot"]), ["reboot,ok"]);
    assert_eq!(REBOOTS.with_borrow(Vec::len), before + 1);
}

/// What is said to bytes that come at times, ms.
fn said(shared: &Shared<'_>, typed: &[(u64, &[u8])]) -> Vec<String> {
    let shown = conversed((shared, settings()), typed, 10_000, &RefCell::default());
    answers_in(&String::from_utf8(shown).expect("text"))
}

#[test]
fn it_is_started_anew_once_settings_are_kept_that_were_being_kept() {
    let said = said(&Shared::new(&()), &[(1000, b"save\rreboot\r")]);
    assert_eq!(said, ["reboot,ok", "save,ok"]);
    let at = REBOOTS.with_borrow(|all| *all.last().expect("it was"));
    assert!((1300..1600).contains(&at.as_millis()), "{at}: they are kept at 1.3 s");
}

#[test]
fn an_answer_of_many_parts_says_so_where_another_takes_its_place() {
    let said = said(&Shared::new(&()), &[(1000, b"get\rtest\rlog\r")]);
    let refused = |it: &&String| it.contains("refused");
    let refused: Vec<_> = said.iter().filter(refused).collect();
    let expected =
        ["get", "test"].map(|word| format!("{word},refused,another answer was asked for"));
    assert_eq!(refused, expected.iter().collect::<Vec<_>>());
    assert_eq!(said.last().map(String::as_str), Some("log,ok"));
}

#[test]
fn every_device_has_a_name_in_an_answer() {
    let shared = Shared::new(&());
    for device in Device::ALL {
        shared.report(Event::Started(device));
    }
    let said = answers(&shared, settings(), &["test"], &RefCell::default());
    assert_eq!(said.len(), Device::ALL.len() + 1, "{said:?}");
    assert!(said.contains(&"test,right_accelerometer,passed".to_owned()), "{said:?}");
}

/// What was typed before is not done later, when more comes.
#[test]
fn a_frame_whose_end_does_not_come_keeps_no_line_from_its_answer() {
    for cut in [&b"\xFD\xFF\x00\x00\x00\xFF\xBE\x00\x00\x00"[..], b"\xFD\x20", b"\xFD"] {
        let line = b"\rget latitude\r";
        let said = said(&Shared::new(&()), &[(1000, cut), (1500, line), (3000, line)]);
        assert_eq!(said, ["get,latitude,48"; 2], "{cut:?}");
    }
}

/// An instrument that runs an alignment is asked to begin another one.
#[test]
fn settings_that_are_as_they_were_are_not_changed() {
    let lines = ["set dwell 12", "start", "set dwell 10", "start", "set hdt_rate 5", "start"];
    let said = answered(&lines);
    let [changed, runs] = ["settings were changed: save and reboot", "an alignment runs"];
    let expected = [changed, runs, runs].map(|reason| format!("start,refused,{reason}"));
    assert_eq!([&said[1], &said[3], &said[5]], expected.each_ref());
}

/// The settings could not state it either.
#[test]
fn a_latitude_of_a_receiver_beyond_the_greatest_is_not_taken() {
    for (latitude, is_taken) in [("8459.9", true), ("8500.1", false), ("9000.0", false)] {
        let shared = Shared::new(&());
        shared.wait_to_begin();
        let content = format!("GPGGA,123519,{latitude},N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,");
        let sum = content.bytes().fold(0, |sum, byte| sum ^ byte);
        let stated = Settings { latitude: None, ..settings() };
        answers(&shared, stated, &[&format!("${content}*{sum:02X}")], &RefCell::default());
        assert_eq!(shared.latitude.get().is_some(), is_taken, "{latitude}");
        assert_eq!(shared.begin.signaled(), is_taken, "{latitude}");
    }
}

/// Another instrument's sentences, noise and a line that was cut.
#[test]
fn what_is_meant_for_others_is_not_answered() {
    let lines = [
        "$GPZDA,201530.00,04,07,2002,00,00*60",
        "$PASHR,1,2",
        "!AIVDM,1,1,,A,13u?etPv2;0n:dDPwUM1U1Cb069D,0*24",
    ];
    assert_eq!(answered(&lines), [""; 0]);
}
