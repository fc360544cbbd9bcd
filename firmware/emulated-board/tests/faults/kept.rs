//! What the log has told of a failure is found after a loss of supply, without a probe having been there meanwhile.

use emulated_board::controller::flash::{Cut, LOG};
use execution::kept;
use firmware::platform::Platform;

use crate::board::Board;
use crate::figure::within;
use crate::images::image;
use crate::sentences::words;
use crate::store::{RECALLED, nearly_full, recalled_sigma, world};
use crate::turning::TurningBoard;

/// Where there is nothing.
const NOWHERE: u32 = 0x6000_0000;
/// Rows of a record.
const ROWS: u64 = 9;

/// The words of the lines that the flash of a board holds.
fn lines(carrier: Platform, board: &Board) -> Vec<String> {
    let range = LOG.start as usize..LOG.end as usize;
    let pages = board.controller(|controller| controller.flash.array.bytes()[range].to_vec());
    let lines = kept::lines(&image(carrier).elf, &pages).expect("it is an image");
    lines.into_iter().map(|line| line.words).collect()
}

/// Has the supply be lost within the operation on the pages of the log after so many, counted from now on.
fn cut(board: &Board, after: u64, reached: f64) {
    board.controller(|controller| {
        let after = controller.flash.log_operations + after;
        controller.flash.cut = Some(Cut { is_in_log: true, after, reached });
    });
}

#[test]
fn a_fault_before_a_loss_of_supply_is_told_by_the_next_start_and_found_in_the_flash() {
    let mut board = Board::new(Platform::Vehicle);
    let powered = board.until("board: started by Supply", 3.0);
    board.until("keeping: level", 5.0);
    board.run(1.0);
    board.execution.processor.jump(NOWHERE);
    let faulted = board.until("board: started by Software", 1.0);
    board.until("keeping: level", 5.0);
    board.run(1.0);
    board.execution.switch_off();
    let start = board.until("board: started by Supply", 3.0);
    board.until("keeping: level", 5.0);
    let told = |from, until| {
        let log =
            board.lines(from, until).into_iter().find(|line| line.contains("of the log in flash"));
        let is_sent = words(board.sent(from, until)).contains(&"log in flash".to_owned());
        (log.map(str::to_owned), is_sent)
    };
    assert_eq!(told(powered, faulted), (None, false), "{board}");
    let (log, is_sent) = told(start, f64::INFINITY);
    assert!(log.is_some() && is_sent, "{board}");
    assert!(!board.lines(start, f64::INFINITY).concat().contains("last reset"), "RAM has lost it");
    let lines = lines(Platform::Vehicle, &board);
    let found = |words: &str| lines.iter().position(|line| line.starts_with(words));
    let order = [
        "board: started by Supply",
        "board: started by Software",
        "board: last reset: fault of the core",
        "board: PC",
        "board: CFSR",
    ];
    let places = order.map(found);
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?} of {lines:#?}");
}

#[test]
fn a_sensor_that_fails_and_the_azimuth_that_is_recalled_are_found_in_the_flash() {
    let mut board = Board::within(Platform::Vehicle, world(0));
    board.until("keeping: level", 5.0);
    board.controller(|controller| controller.spi[0].hangs = true);
    board.until("recalled", 20.0);
    board.run(0.5);
    let lines = lines(Platform::Vehicle, &board);
    assert!(lines.iter().any(|line| line.ends_with("reading lost: its bus hangs")), "{lines:#?}");
    let sigma = lines.iter().find_map(|line| recalled_sigma(line));
    assert!(sigma.is_some_and(|sigma| RECALLED.contains(&sigma)), "{lines:#?}");
}

/// The lines of a bus that hangs again and again before it are many.
#[test]
fn motors_that_were_not_brought_to_rest_are_found_in_the_flash() {
    let TurningBoard { mut board, .. } = TurningBoard::new();
    board.controller(|controller| controller.spi[1].is_stuck = true);
    let told = "not brought to rest: the motors' current is taken away";
    board.until(told, 12.0);
    board.run(0.5);
    let lines = lines(Platform::Turntable, &board);
    assert!(lines.iter().any(|line| line.contains(told)), "{lines:#?}");
}

/// One board, whose supply is lost at every start in a later row of the first record that it writes. At first it is lost in
/// the erasure of a page.
#[test]
fn a_loss_of_supply_amid_a_line_leaves_all_others_and_the_next_start_writes_on() {
    let mut board = Board::new(Platform::Vehicle);
    let mut left = Vec::new();
    for operation in 0..ROWS {
        for reached in [0.5, 1.0] {
            cut(&board, operation, reached);
            board.until("board: started by", 3.0);
            board.until("board: started by Supply", 6.0);
            let lines = lines(Platform::Vehicle, &board);
            assert!(lines.starts_with(&left), "{reached} of {operation}: {left:#?}, {lines:#?}");
            left = lines;
            board.execution.switch_off();
        }
    }
    board.until("keeping: level", 9.0);
    board.run(1.0);
    let lines = lines(Platform::Vehicle, &board);
    assert!(lines.len() > left.len() && lines.starts_with(&left), "{lines:#?}");
    assert!(left.iter().all(|line| line.starts_with("board: ")), "{left:#?}");
}

/// Readings that hang are told and repeated; the store changes pages beside that.
#[test]
fn no_sample_is_lost_while_lines_are_written() {
    let mut board = Board::within(Platform::Vehicle, world(nearly_full()));
    board.until("keeping: level", 5.0);
    let begun = board.seconds();
    for _ in 0..8 {
        board.controller(|controller| controller.spi[0].hangs = true);
        board.run(0.5);
    }
    board.until("recalled", 20.0);
    board.run(3.0);
    let missing =
        board.lines(begun, f64::INFINITY).iter().filter(|line| line.contains("missing")).count();
    within(
        missing as f64,
        0.0..=0.0,
        "lines tell of samples that are missing while lines are written",
    );
}
