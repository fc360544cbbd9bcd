//! What a scenario means for a run that goes on after its alignment: where the vehicle goes, and what
//! the keeper of the attitude is given.

use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::sensor_fault::SensorFault;
use hal_mock::vehicle::{Leg, Stop};
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::attitude as keep;
use orientation::earth::Latitude;
use orientation::navigation::{Policy, Realignment};
use orientation::units::{MetresPerSecondSquared, RadiansPerSecond, Seconds};

use super::base;
use super::hold::{Hold, STAND_SECONDS};
use super::scenario::{self, Aim, Scenario};

/// What a movement of a stage takes at most on a usual schedule, s; the way back from the last position is one.
const MOVEMENT_SECONDS: f64 = 1.7;

impl Scenario {
    /// What the board is given about its precise gyro.
    #[must_use]
    pub fn precise(&self) -> keep::Gyro {
        keep::Gyro {
            noise: self.gyro.noise(),
            bias_sigma: RadiansPerSecond::from_degrees_per_hour(self.gyro.bias_sigma_deg_h),
            scale_sigma: scenario::SCALE_SIGMA,
        }
    }

    /// What the keeper on a base is given about place and gyros; none where the latitude is none.
    #[must_use]
    pub fn keeper(&self) -> Option<keep::Setting> {
        let latitude = Latitude::from_degrees(self.latitude_deg)?;
        let (gyros, force_bias_sigma) = base::gyros(self);
        let force_bias_sigma = MetresPerSecondSquared(force_bias_sigma);
        let sample_seconds = Seconds(base::period(self));
        Some(keep::Setting { latitude, gyros, force_bias_sigma, sample_seconds })
    }

    /// How the instrument on a base goes on.
    #[must_use]
    pub fn policy(&self) -> Policy {
        let ([_, _, down], _) = base::gyros(self);
        self.hold.policy(Realignment::AtStops(Seconds(STAND_SECONDS)), down, self.precise())
    }

    /// How long an alignment on a stage takes, s.
    #[must_use]
    pub fn alignment_seconds(&self) -> f64 {
        let rest_s = scenario::ROTATION.rest.0 + scenario::RINGS_SECONDS;
        self.seconds_of(&self.procedure(), rest_s)
    }

    /// How long an alignment by a procedure takes, where each movement takes about `rest_s` beside the
    /// ramp, s.
    pub(super) fn seconds_of(&self, procedure: &Procedure, rest_s: f64) -> f64 {
        let schedule = &procedure.schedule;
        let movements = schedule.len() as f64 * (rest_s + MOVEMENT_SECONDS);
        let usual = schedule.seconds().0 + movements;
        self.survey_s
            + match self.aim {
                Aim::Circle => usual,
                Aim::Time(seconds) | Aim::Accuracy { seconds, .. } => seconds.max(usual),
            }
    }

    /// Where the base goes after an alignment that takes so many seconds; none comes before an azimuth from outside.
    pub fn day(&self, alignment_s: f64) -> Day {
        let first_s = if self.hold.handover.is_some() { 0.0 } else { alignment_s };
        let seconds = f64::from(self.hold.standing_s) + first_s;
        let Self { pitch_deg, roll_deg, latitude_deg, azimuth_deg, .. } = *self;
        let stop = Stop { seconds, pitch_deg, roll_deg, ..Stop::default() };
        let mut day = Day::standing(latitude_deg, azimuth_deg, stop);
        let Hold { seconds, drive_s, .. } = self.hold;
        day.go_on(self.seed, seconds, drive_s, self.hold.stop_seconds(alignment_s));
        day
    }
}

/// A day of a vehicle that carries a base.
pub type Day = hal_mock::vehicle::scenario::Scenario;

/// The way of a base on such a day, with what goes wrong with its coarse sensors.
#[must_use]
pub fn journey<'a>(day: &'a Day, faults: &'a [SensorFault]) -> JourneyConfiguration<'a> {
    let stands_s = day.legs.first().map_or(0.0, Leg::seconds);
    let departs_s = stands_s - 1.0;
    JourneyConfiguration { departs_s, legs: &day.legs, events: &day.events, faults }
}
