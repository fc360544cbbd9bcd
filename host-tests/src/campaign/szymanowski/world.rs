//! A simulated vehicle's samples for the session, and the truth beside them.

use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Vehicle, VehicleConfiguration, VehicleSample};
use orientation::alignment::site::Site;
use orientation::alignment::stops::conclusion::Conclusion;
use orientation::alignment::stops::session::Procedure;
use orientation::alignment::stops::stop_detector::Rests;
use orientation::alignment::stops::{Session, Setting};
use orientation::alignment::{Input, Method, Refusal, Solution};
use orientation::units::{
    ForceNoise, Metres, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds,
};

use crate::campaign::site;
use crate::campaign::statistics::Answer;
use crate::methods::stops::averaging::Averages;
use crate::methods::stops::samples::Converter;
use crate::output::degrees;

/// Samples a second: enough for the motion of a body on a road.
pub const RATE_HZ: f64 = 50.0;

/// What one day gave.
#[derive(Clone, Debug)]
pub struct Day {
    /// What the session made of it.
    pub conclusion: Conclusion,
    /// True azimuth at the first sample, rad.
    pub start: f64,
    /// True azimuth at the last sample, rad.
    pub end: f64,
    /// Averages over the first stop.
    pub first: Averages,
    /// Averages over the whole day.
    pub whole: Averages,
    /// True biases of the gyros, rad/s.
    pub biases: [f64; 3],
}

impl Day {
    /// The azimuth at the end against the truth.
    ///
    /// # Errors
    /// Why there is none.
    pub fn answer(&self) -> Result<Answer, Refusal> {
        let limit = self.conclusion.found.as_ref().map_or(f64::NAN, |found| found.limit.0);
        let solution =
            self.conclusion.verdict.map(|azimuth| Solution { azimuth, limit: Radians(limit) });
        Answer::of(solution, degrees(self.end))
    }
}

/// What the session is given of a day.
#[derive(Clone, Debug)]
pub struct Known {
    /// When the vehicle stood, as stated or to be found.
    pub rests: Rests,
    /// Whether it is given how far they lie from each other.
    pub knows_displacement: bool,
}

/// Lives through a day. The session knows the sensors' noise and the 1σ of their biases.
pub fn live(day: &Scenario, seed: u64, known: Known) -> Day {
    let mut day = day.clone();
    day.vehicle.rate_hz = RATE_HZ;
    let configuration = day.configuration();
    let mut vehicle = Vehicle::new(&configuration, seed);
    let procedure = Procedure::recorded(known.rests, Seconds(1.0 / RATE_HZ));
    let mut session = Session::new(setting(&day), procedure).ok();
    let stops: Vec<[f64; 2]> = configuration.stops().collect();
    let first_s = stops.first().map_or(0.0, |stop| stop[1]);
    let mut middles = stops.iter().map(|[from, to]| 0.5 * (from + to)).peekable();
    let (mut first, mut whole) = (Averages::default(), Averages::default());
    let mut path = Converter::default();
    let mut start = None;
    while let Some(sample) = vehicle.next() {
        let truth = vehicle.truth();
        start.get_or_insert(truth.attitude.azimuth_rad);
        whole.push(sample.turned_rad, sample.force_m_s2);
        if sample.time_s <= first_s {
            first.push(sample.turned_rad, sample.force_m_s2);
        }
        let Some(session) = &mut session else { continue };
        let VehicleSample { time_s, turned_rad, force_m_s2, .. } = sample;
        session.feed(Input::Sample(&path.sample(time_s, turned_rad, force_m_s2)));
        if middles.next_if(|middle| *middle <= sample.time_s).is_some() && known.knows_displacement
        {
            session.feed(Input::Displaced(&truth.displacement_m.map(Metres)));
        }
    }
    if let Some(session) = &mut session {
        session.feed(Input::End);
    }
    let truth = vehicle.truth();
    let conclusion = session.as_ref().and_then(Session::conclusion).cloned();
    Day {
        conclusion: conclusion.unwrap_or(Conclusion::refused(Refusal::TimeExhausted)),
        start: start.unwrap_or(truth.attitude.azimuth_rad),
        end: truth.attitude.azimuth_rad,
        first,
        whole,
        biases: truth.gyro_bias_rad_s,
    }
}

/// What the session is given about place and sensors.
fn setting(day: &Scenario) -> Setting {
    let VehicleConfiguration { gyros: [gyro, ..], accelerometer, latitude_deg, .. } = day.vehicle;
    let site = Site {
        accelerometer_bias_sigma: MetresPerSecondSquared(accelerometer.bias_sigma_m_s2),
        ..site(latitude_deg, [gyro.n_deg_sqrt_h, 0.0, 0.0, 0.0])
    };
    Setting {
        bias_sigma: Some(RadiansPerSecond::from_degrees_per_hour(gyro.bias_sigma_deg_h)),
        force_noise: ForceNoise(accelerometer.noise_m_s2_sqrt_hz),
        ..Setting::new(site)
    }
}
