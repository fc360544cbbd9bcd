//! `meridian run --method siap`: the board in a vehicle that goes from stop to stop.

use std::path::Path;
use std::time::Instant as WallClock;

use bench::instrument::kept::{Kept, Point};
use bench::instrument::{Run, VehicleRun, align_stops};
use bench::outcome::Finished;
use bench::outcome::run::{KeptAzimuth, RunDetails};
use bench::output::degrees;
use bench::output::progress::Progress;
use bench::recording::Truth;
use bench::stops::{Method, Replay, Watched};
use clap::Args;
use firmware::event::Event;
use firmware::simulated::fault::Fault;
use firmware::simulated::scenario::Scenario;
use firmware::simulated::vehicle::{Place, VehicleScenario};
use hal_mock::vehicle::VehicleTruth;
use orientation::session::stops::Session;

use super::run::Terminal;
use super::{Shown, Told, whole};

/// What a vehicle is asked for.
#[derive(Args, Clone, Debug)]
pub struct DrivingOptions {
    /// With --method siap: how often the vehicle stops (3).
    #[arg(long, value_parser = whole::<2, 8>)]
    stops: Option<u64>,
    /// With --method siap: seconds for which the board levels at each stop (60).
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    stop_seconds: Option<f64>,
    /// With --method siap: seconds of driving from stop to stop (600).
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    drive_seconds: Option<f64>,
    /// With --method siap: nobody tells the board how far it has come.
    #[arg(long)]
    no_displacement: bool,
}

/// A time that a vehicle stands or drives.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if (10.0..=3600.0).contains(&seconds) => Ok(seconds),
        _ => Err("not a number of seconds from 10 to 3600".to_owned()),
    }
}

impl DrivingOptions {
    /// The scenario of a base, at the vehicle's own sample rate where none is stated.
    pub fn scenario(&self, base: &Scenario, rate_hz: Option<f64>) -> VehicleScenario {
        let usual = VehicleScenario::default();
        let sample_rate_hz = rate_hz.unwrap_or(usual.base.sample_rate_hz);
        VehicleScenario {
            base: Scenario { sample_rate_hz, ..*base },
            stops: self.stops.map_or(usual.stops, |stops| stops as usize),
            stop_s: self.stop_seconds.unwrap_or(usual.stop_s),
            drive_s: self.drive_seconds.unwrap_or(usual.drive_s),
            place: if self.no_displacement { Place::Unknown } else { usual.place },
        }
    }
}

/// What the pages and blocks call it.
const NAME: &str = "the simulated drive";
/// What a simulated board is told.
const ASSUMED: &str = "what the board is told of place and instrument";

/// Runs the board and tells what came of it.
pub fn run(
    scenario: &VehicleScenario,
    fault: Option<Fault>,
    report: Option<&Path>,
    as_json: bool,
) -> Result<Told, String> {
    let begun = WallClock::now();
    let watch = Terminal(Progress::new(0, "stops"));
    let setting = scenario.setting().ok_or("the latitude is outside ±90°")?;
    let beside = Session::new(setting, scenario.procedure()).map_err(|error| error.to_string())?;
    let mut watched = Watched::new(beside);
    let run = align_stops(scenario, fault, &mut watched, &watch);
    watch.0.finish();
    let VehicleRun { run, truth, kept } = run.map_err(|error| error.to_string())?;
    let wall = begun.elapsed();
    let criteria = watched.into_criteria();
    let assumed = vec![ASSUMED.to_owned()];
    let replay = Replay {
        method: Method::Siap,
        session: run.replay.clone(),
        zero_s: 0.0,
        criteria,
        assumed,
    };
    let truth = Truth {
        azimuth_deg: Some(degrees(concluded(&run, &kept, truth)).rem_euclid(360.0)),
        start_azimuth_deg: Some(scenario.base.azimuth_deg),
        ..Truth::default()
    };
    let details = RunDetails::of(&run, &kept, scenario.base.sample_rate_hz, wall);
    let finished: &dyn Finished =
        if replay.conclusion().is_some() { &replay } else { &KeptAzimuth };
    let outcome = finished.outcome(&truth).of_run(scenario.base.seed, details);
    Shown { name: NAME, outcome, finished, truth: &truth, body: None }.told(report, as_json)
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
