//! What a simulated vehicle is aided with from outside.

use core::cell::RefCell;

use embassy_time::Instant;
use hal_mock::noise::Generator;
use hal_mock::vehicle::plant::VehicleBoard;
use orientation::alignment::Azimuth;
use orientation::units::Metres;

use super::VehicleScenario;
use crate::hold::HandoverAiding;
use firmware::ports::Aiding;

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

/// What a simulated vehicle is aided with: the displacement that a receiver shows, which is the truth
/// with its error, and an azimuth that may be handed over.
pub struct VehicleAiding<'r, 'a> {
    board: &'r RefCell<VehicleBoard<'a>>,
    place: Place,
    errors: RefCell<Generator>,
    handover: HandoverAiding,
}

impl<'r, 'a> VehicleAiding<'r, 'a> {
    /// The aiding of the vehicle of a board.
    #[must_use]
    pub fn new(board: &'r RefCell<VehicleBoard<'a>>, scenario: &VehicleScenario) -> Self {
        let errors = RefCell::new(Generator::stream(scenario.base.seed, STREAM));
        let handover = scenario.base.hold.aiding();
        Self { board, place: scenario.place, errors, handover }
    }
}

impl Aiding for VehicleAiding<'_, '_> {
    fn azimuth(&self) -> Option<Azimuth> {
        self.handover.azimuth()
    }

    fn displacement(&self) -> Option<[Metres; 2]> {
        let Place::Known { sigma_m } = self.place else { return None };
        let truth = self.board.borrow().plant.truth_at(Instant::now());
        let mut errors = self.errors.borrow_mut();
        Some(truth.displacement_m.map(|part| Metres(part + sigma_m * errors.gaussian())))
    }
}
