//! The supply is lost while a board keeps its settings, row by row: it starts with the old ones or with the new ones.

use emulated_board::world::{SERIAL, stored};
use firmware::platform::Platform;
use firmware::settings::{Settings, save};

use crate::board::Board;
use crate::power::cut;

/// Rows of a save: the record of 248 bytes, its sum, and its mark twice.
const ROWS: u32 = 34;
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

/// Loses the supply so many times in a save, each time after `step` rows more than the time before. How often the old
/// settings, and how often the new ones, held afterwards.
fn kept(losses: u32, step: u32) -> [u32; 2] {
    let mut old = 40.0;
    let mut board = waiting(old);
    assert_eq!(started(&mut board), old);
    let mut counts = [0; 2];
    for number in 0..losses {
        let new = f64::from(number) - 30.0;
        board.run(0.3);
        board.execution.send(format!("set latitude {new}\r\nsave\r\n").as_bytes());
        cut(&board, number * step % ROWS, 1.0);
        board.until("board: started by Supply", LONGEST);
        let found = started(&mut board);
        assert!([old, new].contains(&found), "after row {number}: {found}\n{board}");
        counts[usize::from(found == new)] += 1;
        old = found;
    }
    counts
}

#[test]
fn a_loss_of_supply_while_settings_are_kept_leaves_the_old_ones_or_the_new_ones() {
    // The supply is lost after every eleventh row, round and round; about seven records fill a page.
    let [old, new] = kept(10, 11);
    assert!(old > 0 && old + new == 10, "{old} old, {new} new");
}

#[test]
#[ignore = "a minute of computing; .ci/full runs it"]
fn fifty_losses_of_supply_at_every_row_of_a_save_leave_the_old_settings_or_the_new_ones() {
    let [old, new] = kept(50, 1);
    assert!(old >= 30 && new > 0, "{old} old, {new} new");
}
