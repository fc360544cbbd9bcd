//! The supply is lost while a board keeps its settings, row by row: it starts with the old ones or with the new ones.

use emulated_board::world::{SERIAL, stored};
use firmware::platform::Platform;
use firmware::settings::{Settings, save};

use crate::board::Board;
use crate::power::cut;

/// Rows of a record: 248 bytes, their sum, and its mark twice.
const ROWS: u32 = 34;
/// Operations of a save that changes pages: an erasure, the record that is carried, the header twice, and the record.
const OPERATIONS: u32 = 1 + ROWS + 2 + ROWS;
/// The longest time from the supply to the settings, s: the crystal starts.
const LONGEST: f64 = 5.0;

/// A stage that waits for an order, with a latitude, °.
fn waiting(latitude: f64) -> Board {
    let stage = simulated::executed::stage(1);
    let usual = stage.settings().expect("the scenario has a latitude");
    let settings = Settings {
        latitude: orientation::earth::Latitude::from_degrees(latitude),
        starts: false,
        ..usual
    };
    let store = stored(async |store| {
        save(store, &settings, &SERIAL).await.map_err(|error| error.to_string())
    });
    let world = emulated_board::world::World::new(Platform::Stage, 1);
    let world = world.expect("its settings are possible");
    Board::within(Platform::Stage, world.with_store(store.expect("a store takes a record")))
}

/// The latitude with which the board starts, °.
#[track_caller]
fn started(board: &mut Board) -> f64 {
    board.until("settings of a record in flash", LONGEST);
    let (_, line) = board.log.last().expect("there is a line");
    let (_, latitude) = line.split_once("latitude ").expect("it states the latitude");
    let (latitude, _) = latitude.split_once('°').expect("in degrees");
    latitude.parse().expect("a number")
}

/// Loses the supply so many times in a save, each time after `step` operations more than the time before, or once the save is
/// over. How often the old settings, and how often the new ones, held afterwards.
fn kept(losses: u32, step: u32) -> [u32; 2] {
    let mut old = 40.0;
    let mut board = waiting(old);
    assert_eq!(started(&mut board), old);
    let mut counts = [0; 2];
    for number in 0..losses {
        let new = f64::from(number) - 30.0;
        board.run(0.3);
        board.execution.send(format!("set latitude {new}\r\nsave\r\n").as_bytes());
        let after = number * step % OPERATIONS;
        cut(&board, after, 1.0);
        board.run(0.5);
        let is_over = board.controller(|controller| controller.flash.cut.take().is_some());
        if is_over {
            board.execution.lose_supply();
        }
        board.until("board: started by Supply", LONGEST);
        let found = started(&mut board);
        let is_possible = found == new || (found == old && !is_over);
        assert!(is_possible, "after {after}, over: {is_over}: {found}\n{board}");
        counts[usize::from(found == new)] += 1;
        old = found;
    }
    counts
}

/// After every operation of a save that changes pages, and so after every row of one that does not, round and round: about
/// seven records fill a page.
#[test]
fn a_loss_of_supply_at_any_row_while_settings_are_kept_leaves_the_old_ones_or_the_new_ones() {
    let [old, new] = kept(OPERATIONS, 11);
    assert!(old > 20 && new > 20, "{old} old, {new} new");
}
