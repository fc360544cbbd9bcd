//! The supply is lost while a vehicle writes its heading: after each row, and, after random sequences of saves, at random
//! moments of rows and erasures. The sequences are the first of those that the tests of the host play by the thousand
//! (`hal_mock::flash::sequence`), on the same model of the flash.

use std::sync::LazyLock;

use emulated_board::controller::flash::{Cut, STORE};
use firmware::platform::Platform;
use orientation::attitude::restart::Remembered;

use crate::board::Board;
use crate::figure::within;
use crate::store::{Interrupted, Item, MARK, ROWS, item, stored, world};

/// The longest time from the supply to the save, s: the crystal starts, and the vehicle stands for ten seconds.
const LONGEST: f64 = 20.0;
/// The line of the log by which a start has read the whole store.
const STARTED: &str = "keeping: level";
/// Its longest time after the first line of the log, s.
const STARTS: f64 = 1.0;

/// Has the supply be lost within the operation after so many, counted from now on.
pub fn cut(board: &Board, after: u32, reached: f64) {
    board.controller(|controller| {
        let before = controller.flash.used.rows + controller.flash.used.pages;
        controller.flash.cut =
            Some(Cut { is_in_log: false, after: before + u64::from(after), reached });
    });
}

/// One board, whose supply is lost at every start after one row more. The log shows that the board itself finds a
/// heading at every start.
#[test]
fn a_loss_of_supply_after_any_row_leaves_the_old_heading_or_the_new_one_and_the_board_starts() {
    let mut board = Board::within(Platform::Vehicle, world(0));
    let heading = |board: &Board| {
        let stored = board.controller(|controller| stored(&controller.flash.array));
        stored.expect("the store can be read").expect("a heading is there")
    };
    for row in 0..ROWS {
        board.until(STARTED, LONGEST);
        let old = heading(&board);
        cut(&board, row, 1.0);
        board.until("board: started by Supply", LONGEST);
        assert_eq!(
            board.log.iter().filter(|(_, line)| line.contains("recalled")).count(),
            row as usize + 1,
            "{board}"
        );
        let new = heading(&board);
        assert_eq!(new != old, row >= MARK, "after row {row}: {old:?}, {new:?}\n{board}");
    }
    assert!(!board.log.iter().any(|(_, line)| line.contains("cannot be kept")), "{board}");
}

/// The heading that the vehicle saves.
static SAVED: LazyLock<Remembered> = LazyLock::new(|| {
    let mut board = Board::within(Platform::Vehicle, world(0));
    board.until("recalled", LONGEST);
    board.run(STARTS);
    let stored = board.controller(|controller| stored(&controller.flash.array));
    stored.expect("the store can be read").expect("a heading is there")
});

/// The save of a heading after a random sequence, executed: the item that is there afterwards, and whether the board starts
/// again. All of it is as on the host, to the last byte of the store. The board is given the sequence's store once it has
/// started, so that every board saves at the same moment, and the same heading.
fn executed(seed: u64) -> (Item, bool) {
    let Interrupted { flash, operation, reached, left, starts } = Interrupted::new(seed, &SAVED);
    let mut board = Board::within(Platform::Vehicle, world(0));
    board.until(STARTED, LONGEST);
    board.controller(|controller| controller.flash.array = flash.flash);
    cut(&board, operation, reached);
    let start = board.until("board: started by Supply", LONGEST);
    let flash = board.controller(|controller| controller.flash.array.clone());
    board.run(STARTS);
    let is_started = board.lines(start, f64::INFINITY).contains(&STARTED);
    let context = format!("seed {seed}, {reached} of operation {operation}, on the host");
    // The board writes lines of its log into other pages.
    let store = STORE.start as usize;
    assert!(flash.bytes()[store..] == left.flash.bytes()[store..], "another store: {context}");
    assert_eq!(is_started, starts, "{context}");
    (item(&flash), is_started)
}

/// How many of these boards are without a heading afterwards, and how many of them never start again. Nothing wrong is used.
fn bare(seeds: std::ops::Range<u64>) -> [f64; 2] {
    let all: Vec<_> = std::thread::scope(|scope| {
        let half = |odd: u64| {
            let seeds = seeds.clone().filter(move |seed| seed % 2 == odd);
            scope.spawn(move || seeds.map(executed).collect::<Vec<_>>())
        };
        let halves = [half(0), half(1)];
        halves.into_iter().flat_map(|half| half.join().expect("it has not panicked")).collect()
    });
    let is_bare = |(item, _): &&(Item, bool)| matches!(item, Item::Lost | Item::Unreadable);
    let is_dead = |(item, starts): &&(Item, bool)| *item == Item::Unreadable && !starts;
    let counts = [all.iter().filter(is_bare).count(), all.iter().filter(is_dead).count()];
    assert!(all.iter().filter(|(_, starts)| !starts).count() == counts[1], "{all:?}");
    counts.map(|count| count as f64)
}

#[test]
fn six_boards_have_their_heading_after_a_loss_of_supply_amid_a_random_sequence() {
    let [bare, dead] = bare(0..6);
    let words = format!(
        "of six boards are without a heading after a loss of supply amid a random sequence, {dead} of them for ever without a start"
    );
    within(bare, 0.0..=0.0, &words);
}

#[test]
#[ignore = "four minutes of computing; .ci/full runs it"]
fn fifty_boards_have_their_heading_after_a_loss_of_supply_amid_a_random_sequence() {
    let [bare, dead] = bare(0..50);
    let words = format!(
        "of fifty boards are without a heading after a loss of supply amid a random sequence, {dead} of them for ever without a start"
    );
    within(bare, 0.0..=0.0, &words);
}
