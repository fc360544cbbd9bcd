//! Who knows where the simulated vehicle is.

use core::cell::RefCell;

use embassy_time::Instant;
use hal_mock::noise::Generator;
use hal_mock::vehicle::board::VehicleBoard;

use crate::ports::PositionAiding;

/// A stream of random numbers that no source of noise has.
const STREAM: u64 = 1001;

/// Source of the displacement of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// The displacement of a stop is not known.
    Unknown,
    /// A satellite receiver, or an odometer with a map.
    Known {
        /// 1σ of either part of the displacement from the first stop, m.
        sigma_m: f64,
    },
}

/// What a simulated receiver shows: the truth with its error.
pub struct KnownPlace<'r, 'a> {
    board: &'r RefCell<VehicleBoard<'a>>,
    place: Place,
    errors: Generator,
}

impl<'r, 'a> KnownPlace<'r, 'a> {
    /// A receiver in the vehicle of a board.
    #[must_use]
    pub fn new(board: &'r RefCell<VehicleBoard<'a>>, place: Place, seed: u64) -> Self {
        Self { board, place, errors: Generator::stream(seed, STREAM) }
    }
}

impl PositionAiding for KnownPlace<'_, '_> {
    fn displacement(&mut self) -> Option<[f64; 2]> {
        let Place::Known { sigma_m } = self.place else { return None };
        let truth = self.board.borrow().plant.truth_at(Instant::now());
        Some(truth.displacement_m.map(|part| part + sigma_m * self.errors.gaussian()))
    }
}
