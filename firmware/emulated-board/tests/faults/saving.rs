//! What a save of the heading costs the vehicle that does it.

use firmware::platform::Platform;

use crate::board::Board;
use crate::store::{nearly_full, world};

/// The core waits for the flash, so that samples of the gyros are lost: two where eleven rows are written, 36 where a page
/// is changed, too. What the vehicle turned meanwhile is lost to the alignment that goes on beside it, which ends. So
/// a vehicle that believes its heading of before the restart never aligns itself at that stop.
///
/// As it should be: no sample is lost while the flash is written, since its rows and pages are written without waiting.
#[test]
fn a_vehicle_that_saves_its_heading_ends_its_own_alignment() {
    for (earlier, missing) in
        [(0, "2 sample(s) missing"), (nearly_full().0, "36 sample(s) missing")]
    {
        let mut board = Board::within(Platform::Vehicle, world(earlier));
        let saved = board.until("recalled", 20.0);
        board.until("no azimuth: samples are missing", 2.0);
        let lines = board.lines(saved, f64::INFINITY);
        assert_eq!(lines[1], missing, "{board}");
    }
}
