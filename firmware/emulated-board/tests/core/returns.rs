//! Returns from exceptions, and faults of code, that no image of the checks can bring about.

use emulated_board::RAM;
use emulated_board::exceptions::{FIRST_INTERRUPT, USAGE_FAULT};
use emulated_board::time::Time;

use crate::images::Board;

/// The interrupt whose handler returns.
const NUMBER: u32 = FIRST_INTERRUPT + 3;
/// Where the vectors are, and the code of handler, fault and thread.
const VECTORS: u32 = RAM;
const HANDLER: u32 = RAM + 0x400;
const FAULT: u32 = RAM + 0x500;
const THREAD: u32 = RAM + 0x600;
/// A branch to itself.
const LOOP: [u8; 2] = [0xFE, 0xE7];
/// `CFSR`: an instruction for a unit that is off, a return that fails a check, a state that is not that of Thumb.
const NO_COPROCESSOR: u32 = 1 << 19;
const INVALID_RETURN: u32 = 1 << 18;
const INVALID_STATE: u32 = 1 << 17;

/// A board whose interrupt has been taken from a thread that does nothing, by a handler at this address.
fn interrupted(handler: u32) -> Result<Board, String> {
    let mut board = Board::new()?;
    for code in [HANDLER, FAULT, THREAD] {
        assert!(board.processor.poke(code, &LOOP));
    }
    for (number, vector) in [(NUMBER, handler), (USAGE_FAULT, FAULT | 1)] {
        assert!(board.processor.poke(VECTORS + 4 * number, &vector.to_le_bytes()));
    }
    board.processor.jump(THREAD);
    board.processor.with_controller(|controller| {
        controller.system.vectors = VECTORS;
        for number in [NUMBER, USAGE_FAULT] {
            controller.exceptions.enabled.put(number, true);
        }
        controller.exceptions.priorities[NUMBER as usize] = 0x40;
        controller.exceptions.pending.put(NUMBER, true);
    });
    board.go_on(Time::microseconds(20))?;
    Ok(board)
}

/// What became of it: `CFSR`, and whether interrupt and usage fault are active.
fn outcome(board: &Board) -> (u32, [bool; 2]) {
    board.processor.with_controller(|controller| {
        let active = controller.exceptions.active;
        (controller.system.faults[0], [NUMBER, USAGE_FAULT].map(|number| active.has(number)))
    })
}

/// Has the handler return by this link: `ldr r0, [pc]`, `bx r0`.
fn return_by(board: &mut Board, link: u32) -> Result<(), String> {
    let code = HANDLER + 0x10;
    let mut bytes = vec![0x00, 0x48, 0x00, 0x47];
    bytes.extend(link.to_le_bytes());
    assert!(board.processor.poke(code, &bytes));
    board.processor.jump(code);
    board.go_on(Time::microseconds(20)).map(|_| ())
}

#[test]
fn a_handler_that_is_active_returns() -> Result<(), String> {
    let mut board = interrupted(HANDLER | 1)?;
    assert_eq!(outcome(&board), (0, [true, false]));
    return_by(&mut board, 0xFFFF_FFF9)?;
    assert_eq!(outcome(&board), (0, [false, false]));
    Ok(())
}

#[test]
fn a_return_from_a_handler_that_is_not_active_is_a_usage_fault() -> Result<(), String> {
    let mut board = interrupted(HANDLER | 1)?;
    board.processor.with_controller(|controller| controller.exceptions.leave(NUMBER));
    return_by(&mut board, 0xFFFF_FFF9)?;
    assert_eq!(outcome(&board), (INVALID_RETURN, [false, true]));
    Ok(())
}

#[test]
fn a_return_that_the_manual_leaves_open_ends_the_execution_with_its_link() -> Result<(), String> {
    for link in [0xFFFF_FFC9_u32, 0xFF00_0009] {
        let mut board = interrupted(HANDLER | 1)?;
        let error = return_by(&mut board, link).expect_err("it is unpredictable");
        assert!(error.contains(&format!("EXC_RETURN {link:#x}")), "{error}");
    }
    Ok(())
}

#[test]
fn a_handler_whose_vector_is_not_that_of_thumb_code_is_a_usage_fault() -> Result<(), String> {
    let board = interrupted(HANDLER)?;
    assert_eq!(outcome(&board), (INVALID_STATE, [true, true]));
    Ok(())
}

#[test]
fn floating_point_code_is_a_usage_fault_at_its_instruction_until_the_unit_is_on()
-> Result<(), String> {
    for (coprocessors, expected) in
        [(0, (NO_COPROCESSOR, [false, true])), (0xF << 20, (0, [false, false]))]
    {
        let mut board = interrupted(HANDLER | 1)?;
        return_by(&mut board, 0xFFFF_FFF9)?;
        board.processor.with_controller(|controller| {
            controller.system.coprocessors = coprocessors;
        });
        let code = THREAD + 0x20;
        // movs r1, #7; vmov.f32 s0, s0; movs r1, #9; a branch to itself.
        assert!(
            board
                .processor
                .poke(code, &[0x07, 0x21, 0xB0, 0xEE, 0x40, 0x0A, 0x09, 0x21, 0xFE, 0xE7])
        );
        board.processor.jump(code);
        board.go_on(Time::microseconds(20))?;
        assert_eq!(outcome(&board), expected);
    }
    Ok(())
}
