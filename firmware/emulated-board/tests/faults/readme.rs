//! The log of a power-on in `firmware/README.md` is what the executed image logs.
//!
//! `MERIDIAN_GOLDEN=write cargo test -p emulated-board --test faults readme` writes it anew; a commit that does so says why.

use std::path::{Path, PathBuf};

use emulated_board::world::{SERIAL, World, stored};
use firmware::platform::Platform;
use firmware::settings::{Settings, StageSchedule, save};
use orientation::earth::Latitude;

use crate::board::Board;

/// What stands before the block, and what ends it.
const BEGIN: &str = "<!-- the log of a power-on -->\n```text\n";
const END: &str = "```\n";
/// The line with which the block ends: it shows that the instrument measures.
const LAST: &str = "dwell 1 of 25";

/// The page.
fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md")
}

/// The latitude of the world, which is all that was stated of the settings, °.
const LATITUDE: f64 = 47.58;

/// The log of a board that has the factory settings and a latitude.
fn logged() -> String {
    let latitude = Latitude::from_degrees(LATITUDE);
    let settings = Settings::<StageSchedule> { latitude, ..Settings::default() };
    let store = stored(async |store| {
        save(store, &settings, &SERIAL).await.map_err(|error| error.to_string())
    });
    let world = World::new(Platform::Stage, 1).expect("its settings are possible");
    let world = world.with_store(store.expect("a store takes settings"));
    let mut board = Board::within(Platform::Stage, world);
    board.until(LAST, 60.0);
    let last = board.printed.iter().position(|line| line.contains(LAST)).expect("it has come");
    board.printed[..=last].iter().flat_map(|line| [line.as_str(), "\n"]).collect()
}

/// Whether two words are the same, or numbers that nearly are: where an image is built moves its code, and with it, by
/// microseconds, when it reads its sensors.
fn are_alike(kept: &str, found: &str) -> bool {
    let number = |word: &str| {
        let digits = word.trim_end_matches(['°', ',']);
        let (_, decimals) = digits.split_once('.')?;
        Some((digits.parse::<f64>().ok()?, decimals.chars().fold(1.0, |step, _| 0.1 * step)))
    };
    match (number(kept), number(found)) {
        (Some((kept, step)), Some((found, _))) => {
            (kept - found).abs() <= 1.5 * step + 0.02 * found.abs()
        }
        _ => kept == found,
    }
}

#[test]
fn the_log_of_a_power_on_in_the_readme_is_what_the_executed_image_logs() {
    let text = std::fs::read_to_string(page()).expect("the page is there");
    let (before, rest) = text.split_once(BEGIN).expect("the page has the block");
    let (kept, after) = rest.split_once(END).expect("the block has an end");
    let found = logged();
    if std::env::var_os("MERIDIAN_GOLDEN").is_some_and(|what| what == "write") {
        std::fs::write(page(), [before, BEGIN, &found, END, after].concat())
            .expect("the page is ours");
        return;
    }
    for (kept, found) in kept.lines().zip(found.lines()) {
        let [ours, theirs] = [kept, found].map(|line| line.split_whitespace().collect::<Vec<_>>());
        let is_same = ours.len() == theirs.len()
            && ours.iter().zip(&theirs).all(|(kept, found)| are_alike(kept, found));
        assert!(
            is_same,
            "{kept}\n{found}\nfirmware/README.md; MERIDIAN_GOLDEN=write writes it anew"
        );
    }
    assert_eq!(kept.lines().count(), found.lines().count(), "{found}");
}
