//! Commands and settings over the link of the image that is flashed.

use emulated_board::run::Order;
use execution::report::Service;
use firmware::platform::Platform;
use firmware::settings::{Editable, Settings, StageSchedule, Stated};
use simulated::flood::Flood;
use simulated::scenario::Scenario;

use super::sound::azimuth;
use super::support::angles::distance;
use super::support::board::Board;
use super::support::executed::{execute_in, execute_told};
use super::support::line::{HEARS, MILLISECOND};
use super::support::sentences::{sentences, states};
use super::support::worlds::{stage_of_dwells, usual};

/// Settings by name and value, in their order.
fn stated(settings: &mut dyn Editable) -> Vec<Stated> {
    settings.all().collect()
}

/// Sends a line; the answer to it, as the fields of its sentence, within a second.
#[track_caller]
fn answer(board: &mut Board, line: &str) -> Vec<String> {
    let begin = board.seconds();
    board.execution.send(format!("{line}\r\n").as_bytes());
    board.run(1.0);
    let lines = board.sent(begin, f64::INFINITY);
    let answers = sentences(lines.iter().copied(), "PMRDR");
    let [answer] = &answers[..] else { panic!("{line}: {answers:?}\n{board}") };
    answer.iter().map(|field| (*field).to_owned()).collect()
}

/// The latest sentence of an address.
fn latest(board: &Board, address: &str) -> Vec<String> {
    let lines = board.sent(0.0, f64::INFINITY);
    let all = sentences(lines.iter().copied(), address);
    all.last().expect("it is sent").iter().map(|field| (*field).to_owned()).collect()
}

/// What was answered is done, even before the aligner has looked at its orders: `stop` above all.
#[test]
fn orders_that_are_sent_at_once_are_obeyed_in_their_order() {
    let mut board = Board::within(Platform::Stage, usual(Platform::Stage));
    board.until("begin: ", 5.0);
    assert_eq!(answer(&mut board, "stop"), ["stop", "ok"]);
    for orders in ["start stop", "start stop start realign stop", "start", "stop start stop"] {
        let begin = board.seconds();
        let lines = orders.replace(' ', "\r\n") + "\r\n";
        board.execution.send(lines.as_bytes());
        board.run(2.0);
        let lines = board.sent(begin, f64::INFINITY);
        let answers = sentences(lines.iter().copied(), "PMRDR");
        let expected: Vec<_> = orders.split(' ').map(|order| [order, "ok"]).collect();
        assert_eq!(answers, expected, "{board}");
        let state = if orders.ends_with("stop") { "failed" } else { "aligning" };
        assert_eq!(latest(&board, "PMRDS")[0], state, "{orders}: {board}");
    }
}

/// A board that has never been set up, with nothing but a terminal: what stands in `firmware/README.md`.
#[test]
fn a_board_as_it_is_shipped_is_set_up_started_and_finds_north_by_lines_alone() {
    let scenario = Scenario { positions: 3, dwell_s: 2.0, ..simulated::executed::stage(1) };
    let mut wanted = scenario.settings().expect("the scenario has a latitude");
    let mut board = Board::within(Platform::Stage, usual(Platform::Stage).with_store(Vec::new()));
    board.until("no latitude, settings of the image", 5.0);
    board.run(2.0);
    assert_eq!(latest(&board, "PMRDS")[0], "waiting");
    assert_eq!(latest(&board, "HEHDT"), ["", "T"]);
    assert_eq!(answer(&mut board, "start"), ["start", "refused", "no latitude is set"]);
    let factory = stated(&mut Settings::<StageSchedule>::default());
    for (setting, before) in stated(&mut wanted).iter().zip(&factory) {
        if setting.to_string() != before.to_string() {
            let value = setting.to_string();
            let said = answer(&mut board, &format!("set {} {value}", setting.name));
            assert_eq!(said, ["set", setting.name, &value]);
        }
    }
    assert_eq!(answer(&mut board, "save"), ["save", "ok"]);
    assert_eq!(answer(&mut board, "start"), ["start", "ok"]);
    let found = board.until("handed over: it is kept", 120.0);
    board.run(2.0);
    let [angle, mode] = &latest(&board, "HETHS")[..] else { panic!("two fields") };
    assert_eq!(mode, "A");
    let angle: f64 = angle.parse().expect("a heading");
    assert!(distance(angle, scenario.azimuth_deg) < 30.0, "{angle}°, with so short an alignment");
    // Its record holds from now on, and it begins by itself.
    board.execution.send(b"reboot\r\n");
    board.until("settings of a record in flash", 5.0);
    board.until("handed over: it is kept", 2.0 * found);
}

/// From when the port is open to after the conclusion, as fast as the line takes them. The dwells begin some samples earlier
/// or later than without, which brings other noise: of dwells of 20 s that is a twentieth of σ.
#[test]
fn a_hundred_thousand_bytes_that_are_no_command_disturb_nothing() {
    let order = Order { afterwards: 5.0, ..Order::usual(Platform::Stage, 1) };
    let quiet = execute_in(&order, stage_of_dwells(20.0));
    let (mut flood, mut milliseconds, mut sent) = (Flood::new(1), 0.., 0);
    let flooded = execute_told(&order, stage_of_dwells(20.0), || {
        let is_open = milliseconds.next().is_some_and(|now: usize| now >= HEARS);
        let many = if is_open { MILLISECOND } else { 0 };
        sent += many;
        flood.by_ref().take(many).collect()
    });
    assert!(sent > 500_000, "{sent} bytes were sent during the alignment");
    let report = &flooded.report;
    assert!(report.resets.is_empty(), "{:?}", report.resets);
    assert!(report.violations.is_empty() && report.faults == 0, "{:?}", report.violations);
    assert_eq!(report.service.map(|Service { lost, .. }| lost), [0; 3]);
    let ((found, sigma), (expected, _)) = (azimuth(report), azimuth(&quiet.report));
    let change = distance(found, expected);
    assert!(change <= 0.1 * sigma, "{change}° at a σ of {sigma}°");
    let lines = flooded.link.iter().map(String::as_str);
    let answers = sentences(lines.clone(), "PMRDR");
    assert!(answers.len() > 300, "{}", answers.len());
    assert!(answers.iter().all(|fields| fields[1] == "refused"), "{answers:?}");
    assert!(states(lines).len() > 20, "the state is told all the same");
}
