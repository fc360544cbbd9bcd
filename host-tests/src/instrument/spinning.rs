//! Wires one simulated board on a spinning body to the instrument and runs it.

use std::cell::RefCell;

use firmware::acquire::{SpinAcquisition, acquire};
use firmware::event::Event;
use firmware::keep::NotKept;
use firmware::mechanism::Strapdown;
use firmware::ports::{Recorder, Store};
use hal_mock::spin::SpinTruth;
use hal_mock::spin::plant::SpinPlant;
use orientation::alignment::Progress;
use orientation::alignment::refusal::Refusal;
use orientation::roll::{self, Flight};
use orientation::signal::SpinSample;
use orientation::units::Instant;
use simulated::Wires;
use simulated::fault::{Fault, Injection};
use simulated::spin::{Course, SpinScenario};

use super::harness::Harness;
use super::recorder::Samples;
use super::trial::{Carrier, Trial};
use super::{Run, RunError};

/// Where a spinning body flies, and what goes wrong.
#[derive(Clone, Debug)]
pub struct FlightPlan {
    /// Its course, with what its sensors feel wrongly.
    pub course: Course,
    /// Faults of its chips.
    pub chips: Injection,
}

/// What was true of a flight, beside the samples that the board made of it.
#[derive(Clone, Debug)]
pub struct Flown {
    /// The samples that the board made.
    pub samples: Vec<SpinSample>,
    /// The true roll at each of them, rad.
    pub rolls_rad: Vec<f64>,
    /// What was true at the first sample.
    pub start: SpinTruth,
    /// What was true at the last.
    pub end: SpinTruth,
}

/// A finished flight.
pub type SpinRun = Run<Flight, Flown>;

impl SpinRun {
    /// Why the board gave the roll up, if it did: what it had by then is none of the end.
    #[must_use]
    pub fn ended(&self) -> Option<Refusal> {
        self.events.iter().find_map(|(_, event)| match event {
            Event::Alignment(Progress::Roll(roll::Progress::Ended(reason))) => Some(*reason),
            _ => None,
        })
    }
}

impl Carrier for SpinScenario {
    type Sample = SpinSample;
    type Plan = FlightPlan;
    type Run = SpinRun;

    fn plan(&self, fault: Option<Fault>) -> FlightPlan {
        FlightPlan { course: self.course(fault), chips: self.injection(fault) }
    }

    fn run<R: Recorder<SpinSample>, T: Store>(
        trial: Trial<'_, Self, R, T>,
    ) -> Result<SpinRun, RunError> {
        let Trial { carrier: scenario, plan, watch, traffic, recorder, .. } = trial;
        let FlightPlan { course, chips: injection } = &plan;
        let configuration = scenario.configuration().ok_or(RunError::Scale)?;
        let board = RefCell::new(scenario.board(course, injection));
        let (mut flight, mut kept) = (scenario.flight(), Samples::default());
        let harness = Harness::new(watch, traffic);
        let channels = harness.channels();
        let mut sensors = Wires(&board, injection).spinning();
        let ended = harness.run(
            acquire(&mut SpinAcquisition::new(&mut sensors, &configuration, &channels)),
            &mut Strapdown::new(&channels.shared),
            (&mut flight, NotKept),
            (&(), (&mut kept, recorder), ()),
            (scenario.settings(), &channels),
        )?;
        // Another body of the same course, which has not flown yet.
        let fresh = scenario.board(course, injection).plant;
        let at = |plant: &SpinPlant, time: Instant| {
            plant.truth_at(embassy_time::Instant::from_micros(time.0))
        };
        let time = |sample: Option<&SpinSample>| sample.map_or(Instant::default(), |s| s.time);
        let (start, flown) = (at(&fresh, time(kept.taken.first())), board.borrow());
        let roll = |sample: &SpinSample| at(&flown.plant, sample.time).roll_rad;
        let rolls_rad = kept.taken.iter().map(roll).collect();
        let end = at(&flown.plant, time(kept.taken.last()));
        let truth = Flown { samples: kept.taken, rolls_rad, start, end };
        drop((channels, flown));
        Ok(harness.clear(ended, &board, (flight, false), truth))
    }
}
