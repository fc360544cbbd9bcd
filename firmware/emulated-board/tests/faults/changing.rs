//! The supply is lost while a board keeps its settings, row by row: it starts with the old ones or with the new ones.

use emulated_board::world::{SERIAL, World, stored};
use firmware::platform::Platform;
use firmware::settings::{Settings, save};
use orientation::earth::Latitude;

use crate::board::Board;
use crate::power::cut;

/// Rows of a record: 248 bytes, their sum, and its mark twice.
const ROWS: u32 = 34;
/// Operations of a save that changes pages: an erasure, the record that is carried, the header twice, and the record.
const OPERATIONS: u32 = 1 + ROWS + 2 + ROWS;
/// Records that a page takes.
const FULL: usize = 7;
/// The longest time from the supply to the settings, s: the crystal starts.
const LONGEST: f64 = 5.0;
/// The latitude before a save, and the one that is saved, °.
const LATITUDES: [f64; 2] = [40.0, -30.0];

/// A stage that waits for an order, whose settings were saved so many times.
fn waiting(saves: usize) -> Board {
    let stage = simulated::executed::stage(1);
    let usual = stage.settings().expect("the scenario has a latitude");
    let latitude = Latitude::from_degrees(LATITUDES[0]);
    let settings = Settings { latitude, starts: false, ..usual };
    let store = stored(async |store| {
        for _ in 0..saves {
            save(store, &settings, &SERIAL).await.map_err(|error| error.to_string())?;
        }
        Ok(())
    });
    let world = World::new(Platform::Stage, 1).expect("its settings are possible");
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

/// Whether the new settings hold after a save into which the supply is lost once this operation of it is done, into a store
/// with so many records.
fn is_new(saves: usize, operation: u32) -> bool {
    let [old, new] = LATITUDES;
    let mut board = waiting(saves);
    assert_eq!(started(&mut board), old);
    board.run(0.3);
    cut(&board, operation, 1.0);
    board.execution.send(format!("set latitude {new}\r\nsave\r\n").as_bytes());
    board.until("board: started by Supply", LONGEST);
    let found = started(&mut board);
    assert!(LATITUDES.contains(&found), "after {operation} of {saves}: {found}\n{board}");
    found == new
}

/// The record counts once its mark is whole, whose second writing is for the case that the first is torn.
#[test]
fn a_loss_of_supply_at_any_row_while_settings_are_kept_leaves_the_old_ones_or_the_new_ones() {
    for (saves, operations) in [(1, ROWS), (FULL, OPERATIONS)] {
        let new: Vec<bool> = (0..operations).map(|operation| is_new(saves, operation)).collect();
        let old = new.iter().take_while(|is_new| !**is_new).count();
        assert_eq!(old, operations as usize - 2, "{saves} saves: {new:?}");
        assert!(new[old..].iter().all(|is_new| *is_new), "{saves} saves: {new:?}");
    }
}

/// Then no operation is left in which it could be lost.
#[test]
fn a_save_has_no_more_operations_than_the_supply_was_lost_after() {
    for (saves, operations, pages) in [(1, ROWS, 0), (FULL, OPERATIONS, 1)] {
        let mut board = waiting(saves);
        started(&mut board);
        board.run(0.3);
        let used = |board: &Board| board.controller(|controller| controller.flash.used);
        let before = used(&board);
        board.execution.send(b"save\r\n");
        board.run(1.0);
        let [rows, erased] = [used(&board).rows - before.rows, used(&board).pages - before.pages];
        assert_eq!((rows + erased, erased), (operations.into(), pages), "{saves} saves");
    }
}
