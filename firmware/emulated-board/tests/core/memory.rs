//! What is in RAM after resets.

use emulated_board::controller::ResetReason;
use emulated_board::processor::memory::RAM_FILL;
use emulated_board::{RAM, RAM_BYTES, RAM2, RAM2_BYTES};

use crate::images::Board;

/// Whether all RAM holds what it holds after the supply came up.
fn is_filled(board: &Board) -> bool {
    [(RAM, RAM_BYTES), (RAM2, RAM2_BYTES)].into_iter().all(|(start, bytes)| {
        let mut held = vec![0; bytes];
        board.processor.peek(start, &mut held) && held.iter().all(|byte| *byte == RAM_FILL)
    })
}

#[test]
fn both_parts_of_ram_are_lost_with_the_supply_and_with_nothing_else() -> Result<(), String> {
    let mut board = Board::new()?;
    assert!(is_filled(&board), "before the start");
    for (start, bytes) in [(RAM, RAM_BYTES), (RAM2, RAM2_BYTES)] {
        for address in [start, start + bytes as u32 - 4] {
            for reason in [ResetReason::Watchdog, ResetReason::Software, ResetReason::Pin] {
                assert!(board.processor.poke(address, &[1, 2, 3, 4]));
                board.processor.reset(reason);
                let mut held = [0; 4];
                board.processor.peek(address, &mut held);
                assert_eq!(held, [1, 2, 3, 4], "{address:#x} after {reason:?}");
            }
            board.processor.switch_off();
            assert!(is_filled(&board), "{address:#x}");
        }
    }
    Ok(())
}
