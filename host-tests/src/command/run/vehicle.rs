//! `meridian run vehicle`: the board in a vehicle that goes from stop to stop.

use clap::Args;
use host::instrument::Trial;
use host::instrument::recorder::{Recorded as _, driven_rows};
use host::methods::stops::{Replay, SIAP};
use host::outcome::kept::finished;
use host::outcome::run::{OfPlatform, RunDetails};
use host::recording::{Body, GIVEN};
use orientation::alignment::stops::session::Session;
use simulated::hold::STOP_SECONDS;
use simulated::scenario::Scenario;
use simulated::vehicle::{self, VehicleScenario};

use super::keeping::{KeepingOptions, lasting};
use super::options::{COURSE, Common, Place, seconds};
use super::{Begun, Ran, Shown, Simulated, Terminal};
use crate::command::stated::Stated;
use crate::command::whole;

/// What is asked of a vehicle.
#[derive(Args, Clone, Debug)]
pub struct VehicleOptions {
    #[command(flatten)]
    place: Place,
    /// How often the vehicle stops (3).
    #[arg(long, value_parser = whole::<2, 8>, help_heading = COURSE)]
    stops: Option<u64>,
    /// Seconds for which the board levels at each stop (60).
    #[arg(long, value_name = "SECONDS", value_parser = seconds(10.0..=3600.0), help_heading = COURSE)]
    stop_seconds: Option<f64>,
    /// Seconds of driving from stop to stop (600), at least 30: a drive has six turns.
    #[arg(long, value_name = "SECONDS", value_parser = seconds(30.0..=3600.0), help_heading = COURSE)]
    drive_seconds: Option<f64>,
    /// The board is not given how far it has come.
    #[arg(long, help_heading = COURSE)]
    no_displacement: bool,
    #[command(flatten)]
    keeping: KeepingOptions,
    #[command(flatten)]
    pub(super) common: Common,
}

impl VehicleOptions {
    fn scenario(&self) -> VehicleScenario {
        let usual = VehicleScenario::default();
        let sample_rate_hz = self.place.rate.unwrap_or(usual.base.sample_rate_hz);
        let hold = self.keeping.hold(self.common.fault.is_some(), true);
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

/// How long an alignment from stop to stop takes, s.
fn alignment_seconds(scenario: &VehicleScenario) -> f64 {
    let VehicleScenario { stops, stop_s, drive_s, .. } = scenario;
    *stops as f64 * (stop_s + drive_s) - drive_s
}

impl Simulated for VehicleOptions {
    fn check(&self, stated: &Stated) -> Result<(), String> {
        let hold = self.scenario().base.hold;
        self.keeping.check(
            stated,
            (&hold, STOP_SECONDS),
            &self.common,
            &["stops", "no_displacement"],
        )
    }

    fn run(&self, begun: &Begun) -> Result<Ran, String> {
        let Begun { fault, manner, record } = begun;
        let mut scenario = self.scenario();
        scenario.base.hold = self.place.going_on(scenario.base.hold);
        let setting = scenario.setting().ok_or("the latitude is outside ±90°")?;
        let beside = Session::new(setting, scenario.procedure());
        let beside = beside.map_err(|error| error.to_string())?;
        let mut seen = Replay::of(SIAP, beside, 0.0, vec![GIVEN.to_owned()]);
        let (mut wanted, inputs) = self.common.wanted(record.as_ref(), scenario.given())?;
        // Figures show them.
        wanted.is_idle = self.common.report.is_none() && wanted.is_idle;
        let expected_s = lasting(&scenario.base.hold, alignment_seconds(&scenario));
        let watched = (*manner, "stops", expected_s);
        let (run, wall) = Terminal::watching(watched, &inputs, |watch| {
            let recorder = (&mut seen, (&mut wanted, inputs.as_ref()));
            Trial::of(&scenario).fault(*fault).record(recorder).watch(watch).run()
        })?;
        let written = Common::write(record.as_ref(), &scenario, &run, (&wanted.taken, inputs));
        let (_, truth) = scenario.end_of(&run);
        let details =
            RunDetails::of(&run, scenario.base.sample_rate_hz, wall, OfPlatform::default());
        let replay = Replay { session: run.replay, ..seen };
        let period_s = replay.session.procedure.sample_seconds.0;
        let site = replay.session.setting.site;
        let finished = finished(replay.session.conclusion().is_some(), &site, replay);
        let body = Some(Body::Imu(driven_rows(&wanted.taken, period_s)));
        let shown = Shown { name: "the simulated drive", finished, truth, body };
        Ok(Ran { shown, details, written })
    }
}
