//! `meridian run vehicle`: the board in a vehicle that goes from stop to stop.

use clap::Args;
use firmware::event::Event;
use firmware::ports::Recorder;
use firmware::simulated::fault::Fault;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::vehicle::{self, VehicleScenario};
use hal_mock::vehicle::VehicleTruth;
use host::instrument::kept::{Kept, Point};
use host::instrument::{Run, VehicleRun, align_stops};
use host::methods::stops::{Method, Replay, Watched};
use host::outcome::Finished;
use host::outcome::run::{KeptAzimuth, RunDetails};
use host::output::degrees;
use host::recording::Truth;
use orientation::session::stops::Session;
use orientation::signal::InertialSample;

use super::keeping::KeepingOptions;
use super::options::{Common, Place, Wanted, seconds};
use super::{ASSUMED, Ran, Simulated, Terminal};
use crate::command::given::Given;
use crate::command::whole;

/// What is asked of a vehicle.
#[derive(Args, Clone, Debug)]
pub struct VehicleOptions {
    #[command(flatten)]
    common: Common,
    #[command(flatten)]
    place: Place,
    /// How often the vehicle stops (3).
    #[arg(long, value_parser = whole::<2, 8>)]
    stops: Option<u64>,
    /// Seconds for which the board levels at each stop (60).
    #[arg(long, value_name = "SECONDS", value_parser = seconds::<10, 3600>)]
    stop_seconds: Option<f64>,
    /// Seconds of driving from stop to stop (600).
    #[arg(long, value_name = "SECONDS", value_parser = seconds::<10, 3600>)]
    drive_seconds: Option<f64>,
    /// The board is not given how far it has come.
    #[arg(long)]
    no_displacement: bool,
    #[command(flatten)]
    keeping: KeepingOptions,
}

impl VehicleOptions {
    fn scenario(&self) -> VehicleScenario {
        let usual = VehicleScenario::default();
        let sample_rate_hz = self.place.rate.unwrap_or(usual.base.sample_rate_hz);
        let is_plain = self.common.record.is_some() || self.common.fault.is_some();
        let hold = self.keeping.hold(is_plain);
        let unknown = self.no_displacement.then_some(vehicle::Place::Unknown);
        VehicleScenario {
            base: Scenario { sample_rate_hz, hold, ..self.place.scenario(self.common.seed) },
            stops: self.stops.map_or(usual.stops, |stops| stops as usize),
            stop_s: self.stop_seconds.unwrap_or(usual.stop_s),
            drive_s: self.drive_seconds.unwrap_or(usual.drive_s),
            place: unknown.unwrap_or(usual.place),
        }
    }
}

/// What the session is seen to get: the stop criteria on the way, and the samples where they are recorded.
struct Seen {
    watched: Watched,
    wanted: Wanted<InertialSample>,
}

impl Recorder<InertialSample> for &mut Seen {
    async fn record(&mut self, sample: &InertialSample) {
        self.watched.push(sample);
        (&mut self.wanted).record(sample).await;
    }
}

impl Simulated for VehicleOptions {
    fn common(&self) -> &Common {
        &self.common
    }

    fn check(&self, given: &Given) -> Result<(), String> {
        let hold = self.scenario().base.hold;
        self.keeping.check(given, &hold, &self.common, &["stops", "no_displacement"])
    }

    fn run(&self, fault: Option<Fault>) -> Result<Ran, String> {
        let scenario = self.scenario();
        let setting = scenario.setting().ok_or("the latitude is outside ±90°")?;
        let beside = Session::new(setting, scenario.procedure());
        let watched = Watched::new(beside.map_err(|error| error.to_string())?);
        let mut seen = Seen { watched, wanted: self.common.wanted() };
        let (run, wall) =
            Terminal::watching("stops", |watch| align_stops(&scenario, fault, &mut seen, watch))?;
        let written = self.common.write(&scenario, &run, seen.wanted.samples());
        let VehicleRun { run, truth, kept } = run;
        let azimuth_rad = concluded(&run, &kept, truth);
        let truth = Truth {
            azimuth_deg: Some(degrees(azimuth_rad).rem_euclid(360.0)),
            start_azimuth_deg: Some(scenario.base.azimuth_deg),
            ..Truth::default()
        };
        let details = RunDetails::of(&run, &kept, scenario.base.sample_rate_hz, wall);
        let replay = Replay {
            method: Method::Siap,
            session: run.replay,
            zero_s: 0.0,
            criteria: seen.watched.into_criteria(),
            assumed: vec![ASSUMED.to_owned()],
        };
        let is_aligned = replay.session.conclusion().is_some();
        let finished: Box<dyn Finished> =
            if is_aligned { Box::new(replay) } else { Box::new(KeptAzimuth) };
        let (name, body) = ("the simulated drive", None);
        Ok(Ran { name, finished, truth, details, body, written })
    }
}

/// The true azimuth when the session concluded, rad: at the end, unless the vehicle went on.
fn concluded<R>(run: &Run<R>, kept: &Kept, truth: VehicleTruth) -> f64 {
    let is_conclusion = |event: &Event| matches!(event, Event::Concluded(..));
    let at = run.events.iter().find(|(_, event)| is_conclusion(event)).map(|(at, _)| *at);
    let later =
        |point: &&Point| at.is_some_and(|at| point.seconds() * 1e6 >= at.as_micros() as f64);
    let point = kept.points.iter().find(later);
    point.map_or(truth.attitude.azimuth_rad, |point| point.truth.azimuth_rad)
}
