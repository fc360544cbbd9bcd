//! Feeds the session from the simulated world: on a fixed schedule, or with a stage that obeys.

use hal_mock::disturbance::{self, Disturbance};
use hal_mock::instruments::{Instruments, InstrumentsConfiguration, Sample as Reading};
use hal_mock::stage::{StageState, minimum_jerk};
use orientation::alignment::stepwise::session::{Phase, Session};
use orientation::alignment::{Input, Method, Request};
use orientation::planner::Rotation;
use orientation::signal::Sample;
use orientation::units::{Angle, AngularRate, Instant, Radians, SpecificForce, Temperature};

/// A reading of the simulated instruments in the stage path's units.
#[must_use]
pub fn stage_path(reading: &Reading) -> Sample {
    Sample {
        time: Instant::from_seconds(reading.time_s),
        stage: Angle::from_rad(reading.stage_rad),
        rate: AngularRate::from_rad_per_s(reading.rate_rad_s),
        force: Some(reading.force_m_s2.map(SpecificForce::from_m_per_s2)),
        temperature: Some(Temperature::from_celsius(reading.temperature_c)),
        elevation: None,
    }
}

/// A stage that goes where it is sent, in the time that the angle takes.
#[derive(Clone, Copy, Debug)]
struct ObedientStage {
    from: f64,
    to: f64,
    since: f64,
    rotation: Rotation,
}

impl ObedientStage {
    fn send(&mut self, to: f64, now: f64) {
        *self = Self { from: self.to, to, since: now, ..*self };
    }

    fn state(&self, now: f64) -> StageState {
        let seconds = self.rotation.seconds(Radians(self.to - self.from));
        if now - self.since >= seconds.0 {
            return StageState { angle_rad: self.to, rate_rad_s: 0.0 };
        }
        minimum_jerk(self.from, self.to, seconds.0, now - self.since)
    }
}

/// Runs a session to its end with a stage that obeys it; gives the angles it was sent to.
///
/// The loop is bounded: a session that does not end within `longest_s` is given the end.
pub fn run(
    session: &mut Session,
    configuration: &InstrumentsConfiguration,
    disturbances: &[Disturbance],
    rotation: Rotation,
    longest_s: f64,
    seed: u64,
) -> Vec<f64> {
    let mut instruments = Instruments::new(configuration, seed);
    let mut stage = ObedientStage { from: 0.0, to: 0.0, since: 0.0, rotation };
    let mut sent = Vec::new();
    let samples = (longest_s * configuration.rate_hz) as u64;
    for index in 0..samples {
        let now = index as f64 / configuration.rate_hz;
        instruments.turn(stage.state(now));
        let reading = instruments.sample(now, &disturbance::total(disturbances, now));
        match session.feed(Input::Sample(&stage_path(&reading))) {
            Request::Point(to) => {
                sent.push(to.0);
                stage.send(to.0, now);
            }
            Request::Done => break,
            _ => {}
        }
    }
    if session.phase != Phase::Done {
        session.feed(Input::End);
    }
    sent
}
