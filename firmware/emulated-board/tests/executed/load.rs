//! The images at the full load of their links, one way and both ways.

use emulated_board::run::Order;
use execution::report::{Report, Service};
use firmware::budget;
use firmware::platform::Platform;
use firmware::settings::{Editable, FASTEST, Format, ITEMS};
use simulated::flood::Flood;

use super::support::executed::{Executed, execute_image, execute_told, fast_image};
use super::support::figure::within;
use super::support::images::image;
use super::support::line::{HEARS, MILLISECOND};
use super::support::sentences::sentences;
use super::support::worlds::at_full_load;

/// Most bytes of a message.
const LONGEST: usize = 280;
/// Number of the message that has the state of the sensors.
const SYS_STATUS: u32 = 1;
/// Place of the count of faults in it (`errors_count1`).
const FAULTS: usize = 22;
/// Bytes of a message behind what it carries.
const CHECKSUM: usize = 2;
/// Bytes of commands that may wait for their answers, and the time in which they have them, ms.
const WAITING: (usize, usize) = (200, 250);

/// The image of a carrier, which is the one of 2 400 samples a second where it has such a one, and sends all that it may of a
/// format.
fn loaded(carrier: Platform, format: Format) -> Executed {
    let image = match carrier {
        Platform::Stage | Platform::Turntable | Platform::TwoFrame => fast_image(carrier),
        Platform::Vehicle | Platform::Spin => image(carrier),
    };
    execute_image(&image, &Order::usual(carrier, 1), at_full_load(carrier, format), Vec::new)
}

/// Nothing was lost, and nothing said that something was wrong.
#[track_caller]
fn sound(report: &Report) {
    let Report { service, false_notices, violations, faults, resets, .. } = report;
    assert_eq!(service.map(|Service { lost, .. }| lost), [0; 3]);
    assert_eq!(
        (false_notices.len(), violations.len(), *faults),
        (0, 0, 0),
        "{false_notices:?} {violations:?}"
    );
    assert!(resets.is_empty(), "{resets:?}");
}

/// The messages that were sent by their numbers, with what they carry; all are whole.
fn messages(mut bytes: &[u8]) -> Vec<(u32, &[u8])> {
    let mut messages = Vec::new();
    while let [0xFD, length, _, _, _, 1, 200, low, middle, high, ref rest @ ..] = *bytes {
        let Some((payload, rest)) = rest.split_at_checked(length.into()) else { break };
        messages.push((u32::from_le_bytes([low, middle, high, 0]), payload));
        bytes = rest.get(CHECKSUM..).unwrap_or_default();
    }
    // The end may come amid a message.
    assert!(bytes.len() < LONGEST, "{} messages, then {bytes:?}", messages.len());
    messages
}

/// How often the messages tell of the sensors, and none tells of a fault.
#[track_caller]
fn sound_messages(bytes: &[u8]) -> usize {
    let messages = messages(bytes);
    let states = messages.iter().filter(|(number, _)| *number == SYS_STATUS);
    // Zeros at the end of a message are not sent.
    let faults = |payload: &[u8]| payload.get(FAULTS..FAULTS + 2).map_or(0, |it| it[0] | it[1]);
    states.inspect(|(_, payload)| assert_eq!(faults(payload), 0, "{payload:?}")).count()
}

/// Sends all of a format ten times a second, loses nothing, and takes no more than its budget for a sample.
#[track_caller]
fn holds(carrier: Platform, most: u64) {
    for format in [Format::Nmea, Format::Mavlink] {
        let Executed { report, link, log, bytes } = loaded(carrier, format);
        sound(&report);
        let sample = report.instructions_per_sample.expect("it has measured");
        let words = "instructions a sample takes, with all that the link may send of";
        within(sample, 0.0..=most as f64, &format!("{words} {format:?} on {carrier}"));
        let many = match format {
            Format::Nmea => sentences(link.iter().map(String::as_str), "PMRDS").len(),
            Format::Mavlink => sound_messages(&bytes),
        };
        let end = log.last().map_or(0.0, |entry| entry.seconds);
        assert!(many as f64 > 9.0 * (end - 3.0), "{many} states in {end} s of {format:?}");
    }
}

#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn a_stage_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Stage, budget::BOARD_STAGE_SAMPLE_INSTRUCTIONS);
}

#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn a_turntable_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Turntable, budget::BOARD_TURNTABLE_SAMPLE_INSTRUCTIONS);
}

#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn two_frames_hold_their_budget_whatever_their_link_sends() {
    holds(Platform::TwoFrame, budget::BOARD_TWO_FRAME_SAMPLE_INSTRUCTIONS);
}

#[test]
fn a_vehicle_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Vehicle, budget::BOARD_VEHICLE_SAMPLE_INSTRUCTIONS);
}

#[test]
fn a_spinning_body_holds_its_budget_whatever_its_link_sends() {
    holds(Platform::Spin, budget::BOARD_SPIN_SAMPLE_INSTRUCTIONS);
}

/// Both ways at once: whoever sends without a pause has no command among it, and is answered all the same.
#[test]
#[ignore = "minutes of computing; .ci/full runs it"]
fn no_carrier_loses_anything_while_its_link_is_full_both_ways() {
    for carrier in Platform::ALL {
        let mut flood = Flood::new(1);
        let told = || flood.by_ref().take(MILLISECOND).collect();
        let shown =
            execute_told(&Order::usual(carrier, 1), at_full_load(carrier, Format::Nmea), told);
        println!(
            "{carrier}: {:?} instructions a sample, asleep for {:?}",
            shown.report.instructions_per_sample, shown.report.idle
        );
        sound(&shown.report);
        let answers = sentences(shown.link.iter().map(String::as_str), "PMRDR");
        assert!(answers.len() > 5, "{carrier}: {} answers", answers.len());
        assert!(answers.iter().all(|fields| fields[1] == "refused"), "{carrier}: {answers:?}");
    }
}

/// Commands that change nothing, of every kind that there is, in bursts as great as the port takes: each setting is given the
/// value that it has.
fn bursts(mut settings: impl Editable) -> Vec<Vec<u8>> {
    let settings: &mut dyn Editable = &mut settings;
    let mut commands: Vec<String> =
        settings.all().map(|it| format!("set {} {it}\r\n", it.name)).collect();
    let others = ["get", "log", "test", "get course", "start", "save"];
    commands.extend(others.map(|command| format!("{command}\r\n")));
    let mut bursts = vec![Vec::new()];
    for command in commands {
        if bursts.last().is_some_and(|burst| burst.len() + command.len() > WAITING.0) {
            bursts.push(Vec::new());
        }
        bursts.last_mut().expect("there is one").extend(command.bytes());
    }
    bursts
}

/// A spinning body has the least to spare: its samples are taken up beside the store, below the link.
#[test]
fn a_spinning_body_loses_nothing_while_it_is_given_commands_in_bursts() {
    let mut settings = simulated::executed::spin(1).settings().expect("it has settings");
    settings.output.rates = [FASTEST; ITEMS];
    let bursts = bursts(settings);
    let mut milliseconds = 0..;
    let mut asked = Vec::new();
    let told = || {
        let now: usize = milliseconds.next().expect("it goes on");
        let since = now.saturating_sub(HEARS);
        let burst = &bursts[since / WAITING.1 % bursts.len()];
        let begin = (since % WAITING.1 * MILLISECOND).min(burst.len());
        let end = (begin + MILLISECOND).min(burst.len());
        let sent = if now < HEARS { &[] } else { &burst[begin..end] };
        asked.extend(sent);
        sent.to_vec()
    };
    let shown = execute_told(
        &Order::usual(Platform::Spin, 1),
        at_full_load(Platform::Spin, Format::Nmea),
        told,
    );
    sound(&shown.report);
    let answers = sentences(shown.link.iter().map(String::as_str), "PMRDR");
    let refused: Vec<_> = answers.iter().filter(|fields| fields[1] == "refused").collect();
    let count = |word: &str| answers.iter().filter(|fields| fields[0] == word).count();
    let asked = String::from_utf8(asked).expect("commands");
    let latest = bursts.iter().map(Vec::len).max().unwrap_or(0) / "set a 1\r\n".len();
    let sets = asked.matches("set ").count() - latest;
    assert!(sets > 50 && count("set") >= sets, "{} answers to {sets}: {answers:?}", count("set"));
    let is_expected = |fields: &[&str]| match fields[0] {
        "start" => fields[2] == "an alignment runs",
        "get" | "log" | "test" => fields[2] == "another answer was asked for",
        _ => false,
    };
    assert!(refused.len() > 1 && refused.iter().all(|it| is_expected(it)), "{refused:?}");
}
