//! A turntable that turns when something goes wrong.

use std::cell::RefCell;
use std::rc::Rc;

use emulated_board::wiring::board::Carrier;
use emulated_board::world::World;
use firmware::platform::Platform;
use simulated::executed;
use simulated::fault::Injection;

use crate::board::Board;

/// A turntable amid its rate-modulated turns, of 72 °/s in the mean.
pub struct TurningBoard {
    /// The board, four seconds after the platform began to turn.
    pub board: Board,
    /// The rate of the platform, °/s.
    pub turning: Box<dyn Fn(&Board) -> f64>,
}

impl TurningBoard {
    /// Has a turntable begin.
    pub fn new() -> Self {
        let mut world = World::new(Platform::Turntable, 1).expect("its settings are possible");
        let chips = executed::turntable(1).board(None, Box::leak(Box::new(Injection::NONE)));
        let chips = Rc::new(RefCell::new(chips));
        world.carrier = Rc::clone(&chips) as Rc<RefCell<dyn Carrier>>;
        let mut board = Board::within(Platform::Turntable, world);
        board.until("stage: turns at 72.0 °/s", 10.0);
        board.run(4.0);
        let turning = move |board: &Board| {
            let mut chips = chips.borrow_mut();
            chips.advance(board.execution.processor.now().instant());
            chips.plant.truth().stage.rate_rad_s.to_degrees()
        };
        Self { board, turning: Box::new(turning) }
    }
}
