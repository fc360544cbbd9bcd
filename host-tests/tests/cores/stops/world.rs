//! Drives simulated vehicles past a session.

use hal_mock::noise::Generator;
use hal_mock::sensor_fault::SensorFault;
use hal_mock::vehicle::scenario::Scenario;
use hal_mock::vehicle::{Vehicle, VehicleSample};
use orientation::alignment::site::Site;
use orientation::alignment::stops::Setting;
use orientation::alignment::stops::conclusion::{Conclusion, Found};
use orientation::alignment::stops::residual::Residual;
use orientation::alignment::stops::session::{Procedure, Session};
use orientation::alignment::stops::stop::Stop;
use orientation::alignment::stops::stop_detector::Rests;
use orientation::alignment::{Input, Method, Request};
use orientation::earth::Latitude;
use orientation::noise::model::{GyroNoise, StatedNoise};
use orientation::signal::InertialSample;
use orientation::units::{
    AngleIncrement, ForceNoise, Instant, Metres, RadiansPerSecond, Seconds, SpecificForce,
};

/// Stream of the errors of position fixes.
const FIXES: u64 = 7001;

/// What is stated of where the vehicle stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Nothing.
    Nothing,
    /// The truth, with an error of this 1σ, m, on either axis.
    Fix(f64),
    /// The truth, whenever the session asks for it.
    Asked,
    /// The truth and so much, m, north and east, at every stop but the first.
    Wrong([f64; 2]),
}

/// A simulated day and what is done with it.
pub struct Day {
    pub scenario: Scenario,
    pub faults: Vec<SensorFault>,
    pub seed: u64,
    pub setting: Setting,
    pub place: Place,
    /// The stops of the scenario are stated, found, or all is one.
    pub rests: Kind,
}

/// Where stops come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Found,
    Stated,
    At(&'static [[f64; 2]]),
    Whole,
}

/// How it went.
pub struct Outcome {
    pub conclusion: Conclusion,
    pub stops: Vec<Stop>,
    /// What the solution leaves of them.
    pub residuals: Vec<Option<Residual>>,
    /// True azimuth at the start and at the end, rad.
    pub azimuths: [f64; 2],
    /// True biases, rad/s.
    pub biases: [f64; 3],
}

impl Outcome {
    pub fn found(&self) -> &Found {
        match &self.conclusion.found {
            Some(found) if self.conclusion.verdict.is_ok() => found,
            _ => panic!("{:?}", self.conclusion.verdict),
        }
    }

    /// Errors of the azimuth at the start and at the end, rad.
    pub fn errors(&self) -> [f64; 2] {
        let found = self.found();
        [
            apart(found.start.angle.0, self.azimuths[0]),
            apart(found.azimuth.angle.0, self.azimuths[1]),
        ]
    }

    /// Errors of the azimuth at the start and at the end over their σ.
    pub fn ratios(&self) -> [f64; 2] {
        let found = self.found();
        let [start, end] = self.errors();
        [start / found.start.sigma.0, end / found.azimuth.sigma.0]
    }
}

/// The angle from b to a, rad, the short way.
pub fn apart(a: f64, b: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    (a - b + 0.5 * turn).rem_euclid(turn) - 0.5 * turn
}

/// What is known of [`hal_mock::vehicle::scenario::fog`] and `silicon` at a latitude, °.
pub fn known(latitude_deg: f64, n_deg_sqrt_h: f64, bias_deg_h: Option<f64>) -> Setting {
    let latitude = Latitude::from_degrees(latitude_deg).expect("a latitude");
    let site = Site {
        noise: StatedNoise::Whole(GyroNoise::from_field_units(n_deg_sqrt_h, 0.0, 0.0, 0.0)),
        ..Site::at(latitude)
    };
    Setting {
        bias_sigma: bias_deg_h.map(RadiansPerSecond::from_degrees_per_hour),
        force_noise: ForceNoise(0.002_828_427),
        ..Setting::new(site)
    }
}

impl Day {
    /// A scenario whose sensors are known as they are; 25 samples a second suffice.
    pub fn new(mut scenario: Scenario, seed: u64) -> Self {
        scenario.vehicle.rate_hz = 25.0;
        let [gyro, ..] = scenario.vehicle.gyros;
        let bias = Some(gyro.bias_sigma_deg_h);
        let setting = known(scenario.vehicle.latitude_deg, gyro.n_deg_sqrt_h, bias);
        Self {
            scenario,
            faults: Vec::new(),
            seed,
            setting,
            place: Place::Fix(5.0),
            rests: Kind::Found,
        }
    }

    /// Follows it to the end.
    pub fn run(&self) -> Outcome {
        self.run_through(|_| true)
    }

    /// Drives with samples that something changes, or that are lost where it says false.
    pub fn run_through(&self, change: impl FnMut(&mut VehicleSample) -> bool) -> Outcome {
        self.watch(change, |_, _| ())
    }

    /// Drives and looks at the session after every sample, with its time, s.
    pub fn watch(
        &self,
        mut change: impl FnMut(&mut VehicleSample) -> bool,
        mut look: impl FnMut(&Session, f64),
    ) -> Outcome {
        let configuration = hal_mock::vehicle::VehicleConfiguration {
            faults: &self.faults,
            ..self.scenario.configuration()
        };
        let stops: Vec<[f64; 2]> = configuration.stops().collect();
        let rests = match self.rests {
            Kind::Found => Rests::Found,
            Kind::Stated => Rests::Stated(stops.iter().map(|stop| stop.map(Seconds)).collect()),
            Kind::At(stops) => Rests::Stated(stops.iter().map(|stop| stop.map(Seconds)).collect()),
            Kind::Whole => Rests::Whole,
        };
        let period = 1.0 / configuration.rate_hz;
        let procedure = Procedure::recorded(rests, Seconds(period));
        let mut session = Session::new(self.setting, procedure).expect("a procedure");
        let mut vehicle = Vehicle::new(&configuration, self.seed);
        let mut fixes = Generator::stream(self.seed, FIXES);
        let mut carried = [0.0; 3];
        let mut next = 0;
        let start = vehicle.truth().attitude.azimuth_rad;
        while let Some(mut sample) = vehicle.next() {
            if change(&mut sample) {
                let taken = converted(&sample, &mut carried, period, &configuration);
                let request = session.feed(Input::Sample(&taken));
                if self.place == Place::Asked && request == Request::Locate {
                    session.feed(Input::Displaced(&vehicle.truth().displacement_m.map(Metres)));
                }
            }
            look(&session, sample.time_s);
            if stops.get(next).is_some_and(|stop| sample.time_s + 0.5 * period >= stop[1]) {
                if let Some(there) = self.fix(next, vehicle.truth().displacement_m, &mut fixes) {
                    session.feed(Input::Displaced(&there.map(Metres)));
                }
                next += 1;
            }
        }
        session.feed(Input::End);
        let truth = vehicle.truth();
        Outcome {
            conclusion: session.conclusion().expect("it has ended").clone(),
            stops: session.stops().to_vec(),
            residuals: (0..session.stops().len()).map(|stop| session.residual(stop)).collect(),
            azimuths: [start, truth.attitude.azimuth_rad],
            biases: truth.gyro_bias_rad_s,
        }
    }

    fn fix(&self, stop: usize, there: [f64; 2], fixes: &mut Generator) -> Option<[f64; 2]> {
        match self.place {
            Place::Nothing | Place::Asked => None,
            _ if stop == 0 => Some([0.0; 2]),
            Place::Fix(sigma) => Some(there.map(|part| part + sigma * fixes.gaussian())),
            Place::Wrong(by) => Some([there[0] + by[0], there[1] + by[1]]),
        }
    }
}

/// A sample as the core takes it.
fn converted(
    sample: &VehicleSample,
    carried: &mut [f64; 3],
    period: f64,
    configuration: &hal_mock::vehicle::VehicleConfiguration,
) -> InertialSample {
    let most = configuration.gyro_full_scale_rad_s * period;
    let turned = std::array::from_fn(|axis| {
        let angle = sample.turned_rad[axis];
        let angle = if angle.abs() >= most { 1e3 * angle.signum() } else { angle };
        AngleIncrement::from_rad(angle, &mut carried[axis])
    });
    let full = configuration.accelerometer.full_scale_m_s2.unwrap_or(f64::INFINITY);
    let is_clipped = sample.force_m_s2.iter().any(|force| force.abs() >= full);
    let force = (!is_clipped).then(|| sample.force_m_s2.map(SpecificForce::from_m_per_s2));
    InertialSample { time: Instant::from_seconds(sample.time_s), turned, force }
}
