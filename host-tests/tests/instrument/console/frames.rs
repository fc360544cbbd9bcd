//! Parameters and commands of MAVLink.

use std::cell::RefCell;

use firmware::settings::{Editable, Format, Item, Output, Settings, StageSchedule};
use firmware::shared::Shared;
use mavlink::dialects::common::{
    COMMAND_LONG_DATA, GPS_RAW_INT_DATA, GpsFixType, MavCmd, MavMessage, MavParamType, MavResult,
    MavSeverity, PARAM_REQUEST_LIST_DATA, PARAM_REQUEST_READ_DATA, PARAM_SET_DATA,
    PARAM_VALUE_DATA,
};
use mavlink::{MAVLinkV2MessageRaw, MavHeader, Message};

use super::{Memory, REBOOTS, conversed, settings};
use crate::support::link::messages;

/// The instrument, and a ground station.
const TARGET: [u8; 2] = [1, 200];
const STATION: MavHeader = MavHeader { system_id: 255, component_id: 190, sequence: 0 };

/// Settings whose link speaks MAVLink.
fn speaking() -> Settings<StageSchedule> {
    let output = Output { format: Format::Mavlink, ..Output::default() };
    Settings { output, ..settings() }
}

/// A message of the ground station as it goes over the link.
pub(super) fn frame(message: &impl Message) -> Vec<u8> {
    let mut frame = MAVLinkV2MessageRaw::new();
    frame.serialize_message(STATION, message);
    frame.raw_bytes().to_vec()
}

/// What is sent to messages, of which each comes a second after the one before.
fn answers(asked: &[MavMessage], shared: &Shared<'_>, memory: &RefCell<Memory>) -> Vec<MavMessage> {
    let typed: Vec<(u64, Vec<u8>)> =
        asked.iter().zip(1..).map(|(message, at)| (1000 * at, frame(message))).collect();
    let typed: Vec<(u64, &[u8])> = typed.iter().map(|(at, bytes)| (*at, &bytes[..])).collect();
    let until = 1000 * (asked.len() as u64 + 4);
    messages(&conversed((shared, speaking()), &typed, until, memory))
}

/// The same of an instrument with an empty memory.
fn answered(asked: &[MavMessage]) -> Vec<MavMessage> {
    answers(asked, &Shared::new(&()), &RefCell::default())
}

/// The values of parameters among messages.
fn values(sent: &[MavMessage]) -> Vec<PARAM_VALUE_DATA> {
    let value = |message: &MavMessage| match message {
        MavMessage::PARAM_VALUE(value) => Some(value.clone()),
        _ => None,
    };
    sent.iter().filter_map(value).collect()
}

/// The warnings among messages.
fn warnings(sent: &[MavMessage]) -> Vec<String> {
    let warning = |message: &MavMessage| match message {
        MavMessage::STATUSTEXT(text) if text.severity == MavSeverity::MAV_SEVERITY_WARNING => {
            Some(text.text.to_str().expect("text").to_owned())
        }
        _ => None,
    };
    sent.iter().filter_map(warning).collect()
}

/// The results of commands among messages, all of which must be to the ground station.
fn results(sent: &[MavMessage]) -> Vec<(MavCmd, MavResult)> {
    let result = |message: &MavMessage| match message {
        MavMessage::COMMAND_ACK(found) => {
            assert_eq!([found.target_system, found.target_component], [255, 190]);
            Some((found.command, found.result))
        }
        _ => None,
    };
    sent.iter().filter_map(result).collect()
}

/// A command with its first parameters.
pub(super) fn command(number: MavCmd, first: [f32; 3]) -> MavMessage {
    let [param1, param2, param3] = first;
    let [target_system, target_component] = TARGET;
    MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        param1,
        param2,
        param3,
        command: number,
        target_system,
        target_component,
        ..COMMAND_LONG_DATA::default()
    })
}

/// An order to give a parameter a value.
fn set(name: &str, param_value: f32) -> MavMessage {
    let [target_system, target_component] = TARGET;
    MavMessage::PARAM_SET(PARAM_SET_DATA {
        param_value,
        target_system,
        target_component,
        param_id: name.into(),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32,
    })
}

#[test]
fn every_parameter_is_listed_with_its_number_and_can_be_set_to_what_it_is() {
    let [target_system, target_component] = TARGET;
    let list =
        MavMessage::PARAM_REQUEST_LIST(PARAM_REQUEST_LIST_DATA { target_system, target_component });
    let listed = values(&answered(&[list]));
    let count = <dyn Editable>::count(&mut speaking());
    assert_eq!(listed.len(), count);
    for (number, value) in listed.iter().enumerate() {
        assert_eq!([value.param_index, value.param_count], [number, count].map(|it| it as u16));
        assert_eq!(value.param_type, MavParamType::MAV_PARAM_TYPE_REAL32);
    }
    let orders: Vec<MavMessage> = listed
        .iter()
        .map(|value| set(value.param_id.to_str().expect("text"), value.param_value))
        .collect();
    let shared = Shared::new(&());
    let sent = answers(&orders, &shared, &RefCell::default());
    let confirmed = values(&sent);
    assert_eq!(warnings(&sent), [""; 0], "none is refused");
    for (before, after) in listed.iter().zip(&confirmed) {
        assert_eq!(before.param_id, after.param_id);
        assert_eq!(before.param_value.to_bits(), after.param_value.to_bits());
    }
    assert_eq!(confirmed.len(), listed.len());
}

#[test]
fn a_number_of_single_precision_is_the_decimal_number_that_it_stands_for() {
    let [target_system, target_component] = TARGET;
    let read = MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
        param_index: -1,
        target_system,
        target_component,
        param_id: "latitude".into(),
    });
    let typed = [frame(&set("latitude", 47.58)), frame(&read), b"get latitude\n".to_vec()].concat();
    let sent =
        conversed((&Shared::new(&()), speaking()), &[(1000, &typed)], 3000, &RefCell::default());
    let text = String::from_utf8_lossy(&sent);
    assert!(text.contains("$PMRDR,get,latitude,47.58*"), "{text}");
}

#[test]
fn a_parameter_that_is_refused_is_answered_by_its_value_and_the_reason() {
    let sent = answered(&[set("latitude", 91.0), set("nothing", 1.0)]);
    let values = values(&sent);
    assert_eq!((values.len(), values[0].param_value), (1, 48.0));
    let words = warnings(&sent);
    assert!(words[0].starts_with("latitude: "), "{words:?}");
    assert_eq!(words[1], "nothing: no such setting");
}

#[test]
fn commands_are_acknowledged_by_what_becomes_of_them() {
    use MavCmd as C;
    use MavResult as R;
    let sent = answered(&[
        command(C::MAV_CMD_PREFLIGHT_STORAGE, [1.0, 0.0, 0.0]),
        command(C::MAV_CMD_PREFLIGHT_STORAGE, [9.0, 0.0, 0.0]),
        command(C::MAV_CMD_RUN_PREARM_CHECKS, [0.0; 3]),
        command(C::MAV_CMD_SET_MESSAGE_INTERVAL, [31.0, 200_000.0, 0.0]),
        command(C::MAV_CMD_SET_MESSAGE_INTERVAL, [31.0, 300_000.0, 0.0]),
        command(C::MAV_CMD_SET_MESSAGE_INTERVAL, [32.0, 200_000.0, 0.0]),
        command(C::MAV_CMD_REQUEST_MESSAGE, [1.0, 0.0, 0.0]),
        command(C::MAV_CMD_REQUEST_MESSAGE, [244.0, 31.0, 0.0]),
        command(C::MAV_CMD_NAV_TAKEOFF, [0.0; 3]),
        command(C::MAV_CMD_PREFLIGHT_CALIBRATION, [0.0, 0.0, 1.0]),
        command(C::MAV_CMD_PREFLIGHT_CALIBRATION, [0.0; 3]),
        command(C::MAV_CMD_PREFLIGHT_CALIBRATION, [1.0, 0.0, 0.0]),
    ]);
    let expected = [
        (C::MAV_CMD_PREFLIGHT_STORAGE, R::MAV_RESULT_DENIED),
        (C::MAV_CMD_PREFLIGHT_STORAGE, R::MAV_RESULT_ACCEPTED),
        (C::MAV_CMD_RUN_PREARM_CHECKS, R::MAV_RESULT_ACCEPTED),
        (C::MAV_CMD_SET_MESSAGE_INTERVAL, R::MAV_RESULT_ACCEPTED),
        (C::MAV_CMD_SET_MESSAGE_INTERVAL, R::MAV_RESULT_DENIED),
        (C::MAV_CMD_SET_MESSAGE_INTERVAL, R::MAV_RESULT_DENIED),
        (C::MAV_CMD_REQUEST_MESSAGE, R::MAV_RESULT_ACCEPTED),
        (C::MAV_CMD_REQUEST_MESSAGE, R::MAV_RESULT_ACCEPTED),
        (C::MAV_CMD_NAV_TAKEOFF, R::MAV_RESULT_UNSUPPORTED),
        (C::MAV_CMD_PREFLIGHT_CALIBRATION, R::MAV_RESULT_DENIED),
        (C::MAV_CMD_PREFLIGHT_CALIBRATION, R::MAV_RESULT_ACCEPTED),
        (C::MAV_CMD_PREFLIGHT_CALIBRATION, R::MAV_RESULT_ACCEPTED),
    ];
    let mut found = results(&sent);
    // That settings are kept is said once the store has done so, which another answer may come before.
    let order = |found: &(MavCmd, MavResult)| {
        expected.iter().position(|expected| expected == found).unwrap_or(usize::MAX)
    };
    found.sort_by_key(order);
    assert_eq!(found, expected);
    let interval = sent.iter().find_map(|message| match message {
        MavMessage::MESSAGE_INTERVAL(interval) => Some((interval.message_id, interval.interval_us)),
        _ => None,
    });
    assert_eq!(interval, Some((31, 200_000)));
}

#[test]
fn a_command_to_another_component_does_nothing() {
    let reboots = REBOOTS.with_borrow(Vec::len);
    let to = |target_component, first: [f32; 3]| {
        let MavMessage::COMMAND_LONG(order) =
            command(MavCmd::MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, first)
        else {
            panic!("it is a command")
        };
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { target_component, ..order })
    };
    // To the autopilot, and to all: the first parameter is the autopilot's.
    let sent = answered(&[to(1, [1.0, 0.0, 0.0]), to(0, [1.0, 0.0, 0.0])]);
    assert_eq!(results(&sent), []);
    assert_eq!(REBOOTS.with_borrow(Vec::len), reboots);
    let sent = answered(&[to(200, [1.0, 0.0, 0.0])]);
    assert_eq!(results(&sent).len(), 1);
    assert_eq!(REBOOTS.with_borrow(Vec::len), reboots + 1);
}

/// None that is not done is answered to all components: it might pass for the autopilot's answer.
#[test]
fn a_command_to_all_is_answered_where_it_is_done_alone() {
    let to_all = |number, first| {
        let MavMessage::COMMAND_LONG(order) = command(number, first) else {
            panic!("it is a command")
        };
        MavMessage::COMMAND_LONG(COMMAND_LONG_DATA { target_component: 0, param5: -33.9, ..order })
    };
    let sent = answered(&[
        to_all(MavCmd::MAV_CMD_REQUEST_MESSAGE, [148.0, 0.0, 0.0]),
        to_all(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [33.0, 1e5, 0.0]),
        to_all(MavCmd::MAV_CMD_DO_SET_GLOBAL_ORIGIN, [0.0; 3]),
        to_all(MavCmd::MAV_CMD_REQUEST_MESSAGE, [1.0, 0.0, 0.0]),
        MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            param_index: -1,
            target_system: 1,
            target_component: 200,
            param_id: "latitude".into(),
        }),
    ]);
    let accepted = (MavCmd::MAV_CMD_REQUEST_MESSAGE, MavResult::MAV_RESULT_ACCEPTED);
    assert_eq!(results(&sent), [accepted]);
    assert_eq!(values(&sent)[0].param_value, 48.0, "it keeps its latitude");
}

#[test]
fn an_interval_is_one_of_those_that_there_are_or_the_usual_one() {
    use MavResult::{MAV_RESULT_ACCEPTED as ACCEPTED, MAV_RESULT_DENIED as DENIED};
    let intervals = [
        (1e6, ACCEPTED),
        (5e6, DENIED),
        (f32::INFINITY, DENIED),
        (f32::NAN, DENIED),
        (-2.0, DENIED),
        (1.0, DENIED),
        (-1.0, ACCEPTED),
        (0.0, ACCEPTED),
    ];
    let number = MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL;
    let mut asked: Vec<_> =
        intervals.iter().map(|(interval, _)| command(number, [31.0, *interval, 0.0])).collect();
    asked.push(command(MavCmd::MAV_CMD_REQUEST_MESSAGE, [244.0, 31.0, 0.0]));
    let sent = answered(&asked);
    let found: Vec<_> = results(&sent).into_iter().map(|(_, result)| result).collect();
    let expected = intervals.iter().map(|(_, result)| *result).chain([ACCEPTED]);
    assert_eq!(found, expected.collect::<Vec<_>>());
    let interval = sent.iter().find_map(|message| match message {
        MavMessage::MESSAGE_INTERVAL(interval) => Some(interval.interval_us),
        _ => None,
    });
    assert_eq!(interval, Some(100_000), "the usual one at the end");
}

#[test]
fn a_parameter_of_another_type_is_answered_by_the_value_that_it_keeps() {
    let MavMessage::PARAM_SET(order) = set("dwell", 12.0) else { panic!("it is an order") };
    let param_type = MavParamType::MAV_PARAM_TYPE_INT32;
    let sent = answered(&[MavMessage::PARAM_SET(PARAM_SET_DATA { param_type, ..order })]);
    assert_eq!(values(&sent).iter().map(|it| it.param_value).collect::<Vec<_>>(), [10.0]);
}

#[test]
fn the_latitude_of_a_satellite_receiver_is_taken_where_it_was_measured() {
    for (fix_type, is_taken) in [
        (GpsFixType::GPS_FIX_TYPE_3D_FIX, true),
        (GpsFixType::GPS_FIX_TYPE_RTK_FIXED, true),
        (GpsFixType::GPS_FIX_TYPE_2D_FIX, false),
        (GpsFixType::GPS_FIX_TYPE_NO_FIX, false),
        (GpsFixType::GPS_FIX_TYPE_STATIC, false),
    ] {
        let shared = Shared::new(&());
        let fix = GPS_RAW_INT_DATA { lat: 475_800_000, fix_type, ..GPS_RAW_INT_DATA::default() };
        answers(&[MavMessage::GPS_RAW_INT(fix)], &shared, &RefCell::default());
        assert_eq!(shared.latitude.get().is_some(), is_taken, "{fix_type:?}");
    }
}

#[test]
fn what_is_switched_off_is_not_sent() {
    let off = command(MavCmd::MAV_CMD_SET_MESSAGE_INTERVAL, [1.0, -1.0, 0.0]);
    let sent = answered(&[off, command(MavCmd::MAV_CMD_RUN_PREARM_CHECKS, [0.0; 3])]);
    let count = sent.iter().filter(|it| matches!(it, MavMessage::SYS_STATUS(_))).count();
    assert_eq!(count, 2, "one before, and the one that was asked for");
    assert_eq!(Item::of_message(1), Some(Item::SysStatus));
}
