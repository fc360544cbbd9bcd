//! Platforms that turn when something goes wrong.

use std::cell::RefCell;
use std::rc::Rc;

use emulated_board::wiring::board::{Carrier, Parts};
use emulated_board::world::{World, nothing};
use firmware::platform::Platform;
use hal_mock::assembly::{Board as Assembly, Chips};
use hal_mock::gimbal::Gimbal;
use hal_mock::plant::Plant;
use simulated::executed;

use crate::board::Board;

/// A platform that turns.
pub struct TurningBoard {
    /// The board.
    pub board: Board,
    /// The rate of the platform, of two frames that of the faster one, °/s.
    pub turning: Box<dyn Fn(&Board) -> f64>,
}

impl TurningBoard {
    /// A turntable four seconds after it began its rate-modulated turns, of 72 °/s in the mean.
    pub fn new() -> Self {
        let chips = executed::turntable(1).board(None, nothing());
        let rate = |plant: &mut Plant<'_>| plant.truth().stage.rate_rad_s;
        Self::begun(Platform::Turntable, chips, rate, (&["stage: turns at 72.0 °/s"], 4.0))
    }

    /// A stage half a second after it began to turn to its second position.
    pub fn stage() -> Self {
        let chips = simulated::board(&executed::stage(1), None, nothing());
        let rate = |plant: &mut Plant<'_>| plant.truth().stage.rate_rad_s;
        Self::begun(Platform::Stage, chips, rate, (&["dwell 1 of", "stage: to"], 0.5))
    }

    /// Two frames half a second after they began to turn to their second orientation.
    pub fn two_frames() -> Self {
        let chips = executed::two_frames(1).board(None, nothing());
        let rate = |gimbal: &mut Gimbal<'_>| {
            let [outer, inner] = gimbal.frames().map(|frame| frame.rate_rad_s.abs());
            outer.max(inner)
        };
        Self::begun(Platform::TwoFrame, chips, rate, (&["dwell 1 of", "frame: to"], 0.5))
    }

    /// A carrier with these chips, so many seconds after it logged lines with these words.
    fn begun<P: 'static, C: Chips<P> + Parts + 'static>(
        carrier: Platform,
        chips: Assembly<'static, P, C>,
        rate: impl Fn(&mut P) -> f64 + 'static,
        (lines, after): (&[&str], f64),
    ) -> Self {
        let mut world = World::new(carrier, 1).expect("its settings are possible");
        let chips = Rc::new(RefCell::new(chips));
        world.carrier = Rc::clone(&chips) as Rc<RefCell<dyn Carrier>>;
        let mut board = Board::within(carrier, world);
        for words in lines {
            board.until(words, 60.0);
        }
        board.run(after);
        let turning = move |board: &Board| {
            let mut chips = chips.borrow_mut();
            chips.advance(board.execution.processor.now().instant());
            rate(&mut chips.plant).to_degrees()
        };
        Self { board, turning: Box::new(turning) }
    }
}
