//! Configurations with a quantity that makes no sense, as a record of another's making may hold it: refused by name, or
//! harmless.

use std::fmt::Debug;

use host::recording::Given;
use orientation::alignment::setup::{Quantity, SetupError};
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::session::procedure::Procedure as Positions;
use orientation::alignment::stepwise::session::schedule::Schedule;
use orientation::alignment::stepwise::setting::Setting as OfPositions;
use orientation::alignment::{Input, Method, Request, rotating, stepwise, stops};
use orientation::earth::Latitude;
use orientation::roll;
use orientation::signal::{InertialSample, Sample, SpinSample};
use orientation::units::{
    Angle, AngleIncrement, AngularRate, Instant, Radians, RadiansPerSecond, Seconds, SpecificForce,
    SpinForce,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// Values that a quantity may be spoilt to.
const SPOILT: [f64; 7] = [-1e300, -1.0, 0.0, 1e-300, 5.0, 4_294_967_296.0, 1e300];
/// Samples that a session is fed: more than a dwell, a turn or a stop of these procedures needs.
const SAMPLES: u32 = 3000;
/// Sample period, µs.
const PERIOD: u32 = 10_000;

fn latitude() -> Latitude {
    Latitude::from_degrees(48.0).expect("it is one")
}

/// Noise that no sensor repeats.
fn noise(number: u32) -> i32 {
    (1000.0 * f64::from(number).sin()) as i32
}

/// The paths of all numbers in a value.
fn numbers(value: &Value, path: &str) -> Vec<String> {
    match value {
        Value::Number(_) => vec![path.to_owned()],
        Value::Array(list) => {
            let each = list.iter().enumerate();
            each.flat_map(|(index, value)| numbers(value, &format!("{path}/{index}"))).collect()
        }
        Value::Object(map) => {
            map.iter().flat_map(|(key, value)| numbers(value, &format!("{path}/{key}"))).collect()
        }
        _ => Vec::new(),
    }
}

/// Spoils each number of a configuration in turn, begins a session with what can be read of it and feeds that. Returns
/// how many were refused at the beginning.
fn spoil<C: Serialize + DeserializeOwned + Debug>(
    configuration: C,
    mut session: impl FnMut(C) -> Result<(), SetupError>,
) -> usize {
    let whole = serde_json::to_value(configuration).expect("it is numbers and words");
    let mut refused = 0;
    for path in numbers(&whole, "") {
        let name = path.split('/').rfind(|part| part.parse::<usize>().is_err());
        let name = name.expect("a field has a name");
        for value in SPOILT {
            let mut spoilt = whole.clone();
            *spoilt.pointer_mut(&path).expect("it was found there") = value.into();
            let Ok(read) = serde_json::from_value(spoilt) else { continue };
            let begun = session(read);
            refused += usize::from(begun.is_err());
            let is_positive = name.ends_with("_sigma") || name.ends_with("_seconds");
            if is_positive && value < 0.0 {
                let Err(SetupError::OutOfRange(Quantity { name: said, value: of, .. })) = begun
                else {
                    panic!("{path} of {value}: {begun:?}");
                };
                assert_eq!((said, of), (name, value), "{path}");
            }
        }
    }
    refused
}

/// Feeds samples until the session is over, then their end.
fn feed<S>(method: &mut impl Method<S>, sample: impl Fn(u32) -> S) {
    method.begin(&mut |_| ());
    for number in 1..=SAMPLES {
        if method.feed(Input::Sample(&sample(number))) == Request::Done {
            return;
        }
    }
    method.feed(Input::End);
}

/// A sample at rest on a platform at this angle, rad.
fn at_rest(number: u32, angle: f64) -> Sample {
    Sample {
        time: Instant((number * PERIOD).into()),
        stage: Angle::from_rad(angle),
        rate: AngularRate(50_000 + noise(number)),
        force: Some([0, noise(number), -9_810_000].map(SpecificForce)),
        ..Sample::default()
    }
}

#[test]
fn a_spoilt_configuration_of_positions_is_refused_by_name_or_harms_nothing() {
    let schedule = Schedule::closed_circle(4, Seconds(2.0));
    let procedure = Positions::new(schedule, Seconds(1e-6 * f64::from(PERIOD)));
    let given = Given::new(OfPositions::at(latitude()), procedure, None);
    let refused = spoil(given, |Given { setting, procedure, .. }| {
        feed(&mut stepwise::Session::new(setting, procedure)?, |number| at_rest(number, 0.0));
        Ok(())
    });
    assert!(refused > 60, "{refused}");
}

#[test]
fn a_spoilt_configuration_of_a_turning_platform_is_refused_by_name_or_harms_nothing() {
    let setting = rotating::Setting::new(Site::at(latitude()), rotating::Sensor::GYRO);
    let procedure = rotating::session::Procedure::new(
        &[RadiansPerSecond(1.0)],
        Seconds(1e-6 * f64::from(PERIOD)),
    );
    let refused =
        spoil(Given::new(setting, procedure, None), |Given { setting, procedure, .. }| {
            let turned = |number| at_rest(number, 0.01 * f64::from(number));
            feed(&mut rotating::Session::new(setting, procedure)?, turned);
            Ok(())
        });
    assert!(refused > 60, "{refused}");
}

#[test]
fn a_spoilt_configuration_of_stops_is_refused_by_name_or_harms_nothing() {
    let setting = stops::Setting::new(Site::at(latitude()));
    let procedure = stops::session::Procedure::new(2, Seconds(1e-6 * f64::from(PERIOD)));
    let refused =
        spoil(Given::new(setting, procedure, None), |Given { setting, procedure, .. }| {
            feed(&mut stops::Session::new(setting, procedure)?, |number| InertialSample {
                time: Instant((number * PERIOD).into()),
                turned: [noise(number), -noise(number), 1].map(AngleIncrement),
                force: Some([0, noise(number), -9_810_000].map(SpecificForce)),
            });
            Ok(())
        });
    assert!(refused > 40, "{refused}");
}

#[test]
fn a_spoilt_configuration_of_a_spinning_body_is_refused_by_name_or_harms_nothing() {
    let refused = spoil(roll::Setting::new(Seconds(1e-6 * f64::from(PERIOD))), |setting| {
        setting.check()?;
        let mut flight = roll::Flight::new(&setting, [Radians(0.0); 2], None);
        feed(&mut flight, |number| SpinSample {
            time: Instant((number * PERIOD).into()),
            turned: [100_000_000 + noise(number), 0, 0].map(AngleIncrement),
            force: Some([noise(number), -noise(number)].map(SpinForce)),
        });
        Ok(())
    });
    assert!(refused > 10, "{refused}");
}
