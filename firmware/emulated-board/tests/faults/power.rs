//! The supply is lost while a vehicle writes its heading: between rows, and within rows and erasures.

use std::collections::BTreeMap;

use emulated_board::controller::flash::Cut;
use firmware::platform::Platform;
use hal_mock::noise::Generator;

use crate::board::Board;
use crate::store::{Item, ROWS, item, nearly_full, stored, world};

/// The longest time from the supply to the save, s: the crystal starts, and the vehicle stands for ten seconds.
const LONGEST: f64 = 20.0;
/// The line of the log by which a start has read the whole store.
const STARTED: &str = "keeping: level";
/// Its longest time after the first line of the log, s.
const STARTS: f64 = 1.0;

/// Has the supply be lost within the operation after so many, counted from now on.
fn cut(board: &Board, after: u32, reached: f64) {
    board.controller(|controller| {
        let before = controller.flash.used.rows + controller.flash.used.pages;
        controller.flash.cut = Some(Cut { after: before + u64::from(after), reached });
    });
}

/// Loses the supply in the save of a heading, into a store with so many earlier ones: the item that is there
/// afterwards, and whether the board starts again.
fn lose(earlier: usize, after: u32, reached: f64) -> (Item, bool) {
    let mut board = Board::within(Platform::Vehicle, world(earlier));
    board.until(STARTED, LONGEST);
    cut(&board, after, reached);
    let start = board.until("board: started by Supply", LONGEST);
    let item = board.controller(|controller| item(&controller.flash.array));
    board.run(STARTS);
    let is_started = board.lines(start, f64::INFINITY).contains(&STARTED);
    (item, is_started)
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
        assert_eq!(new != old, row == ROWS - 1, "after row {row}: {old:?}, {new:?}\n{board}");
    }
    assert!(!board.log.iter().any(|(_, line)| line.contains("cannot be kept")), "{board}");
}

/// A loss of supply at a random moment of a random row of a save, or of the erasure where a page is full; what is found
/// afterwards. Every third is in the erasure.
fn at_random(seed: u64) -> (Item, bool) {
    let mut noise = Generator::new(seed);
    let (earlier, effort) = nearly_full();
    let reached = noise.uniform();
    let any = |noise: &mut Generator, count: u32| (noise.next_u64() % u64::from(count)) as u32;
    match seed % 3 {
        // The page is erased before the item is written.
        0 => lose(earlier, effort - ROWS - 1, reached),
        1 => lose(earlier, any(&mut noise, effort), reached),
        _ => lose(0, any(&mut noise, ROWS), reached),
    }
}

/// How often each item is found where the board starts again, and where it does not.
fn tally(seeds: std::ops::Range<u64>) -> BTreeMap<(bool, Item), u32> {
    let all: Vec<_> = std::thread::scope(|scope| {
        let half = |odd: u64| {
            let seeds = seeds.clone().filter(move |seed| seed % 2 == odd);
            scope.spawn(move || seeds.map(at_random).collect::<Vec<_>>())
        };
        let halves = [half(0), half(1)];
        halves.into_iter().flat_map(|half| half.join().expect("it has not panicked")).collect()
    });
    let mut tally = BTreeMap::new();
    for (item, is_started) in all {
        *tally.entry((is_started, item)).or_insert(0) += 1;
    }
    tally
}

/// What losses within rows and erasures come to today: most leave a row that raises the non-maskable interrupt, for which
/// the image has no handler; the watchdog resets, and the next start reads the row again, for ever. Then nothing is
/// lost that a programmer could not read, and nothing wrong is ever used.
///
/// As it should be: the board starts after every loss, with the old heading or the new one.
#[test]
fn after_six_losses_of_supply_within_rows_and_erasures_two_boards_start_with_the_old_heading_and_four_never_do()
 {
    assert_eq!(
        tally(6..12),
        BTreeMap::from([((true, Item::Old), 2), ((false, Item::Unreadable), 4)])
    );
}

#[test]
#[ignore = "three minutes of computing; .ci/full runs it"]
fn after_fifty_losses_of_supply_within_rows_and_erasures_eleven_boards_start_with_the_old_heading_and_the_others_never_do()
 {
    assert_eq!(
        tally(0..50),
        BTreeMap::from([((true, Item::Old), 11), ((false, Item::Unreadable), 39)])
    );
}
