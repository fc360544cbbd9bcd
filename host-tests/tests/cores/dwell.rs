//! Averages of dwells whose samples bring a force or a temperature only now and then.

use hal_mock::noise::Generator;
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::schedule::Schedule;
use orientation::alignment::stepwise::session::{Phase, Session};
use orientation::alignment::stepwise::setting::Setting;
use orientation::alignment::{Input, Method};
use orientation::earth::Latitude;
use orientation::filter::Coefficients;
use orientation::signal::Sample;
use orientation::signal::dwell::{Dwell, DwellAverage};
use orientation::units::{AngularRate, Instant, Seconds, SpecificForce, Temperature};

const SAMPLE_SECONDS: f64 = 0.01;

/// A sample of noise alone, with neither force nor temperature.
fn bare(index: u64, noise: &mut Generator) -> Sample {
    Sample {
        time: Instant(index * 10_000),
        rate: AngularRate::from_rad_per_s(1e-6 * noise.gaussian()),
        ..Sample::default()
    }
}

/// The dwell of these samples.
fn averaged(samples: &[Sample]) -> Dwell {
    let low_pass = Coefficients::<3>::low_pass(10.0, 1.0 / SAMPLE_SECONDS).expect("it is one");
    let mut average = DwellAverage::begin(&low_pass, &samples[0]);
    for sample in &samples[1..] {
        average.push(&low_pass, sample);
    }
    average.finish(&low_pass, Seconds(SAMPLE_SECONDS)).expect("it is long enough")
}

fn mean(values: &[i32]) -> f64 {
    values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len() as f64
}

#[test]
fn forces_and_temperatures_are_averaged_over_the_samples_that_bring_them() {
    let mut noise = Generator::new(1);
    let mut samples: Vec<Sample> = (0..1000).map(|index| bare(index, &mut noise)).collect();
    let mut read = |usual: f64, scatter: f64| (usual + scatter * noise.gaussian()).round() as i32;
    let (mut forces, mut temperatures) = ([const { Vec::new() }; 3], Vec::new());
    for (index, sample) in samples.iter_mut().enumerate() {
        if index % 16 == 5 {
            let force = [10_000.0, -20_000.0, -9_810_000.0].map(|usual| read(usual, 1000.0));
            sample.force = Some(force.map(SpecificForce));
            forces.iter_mut().zip(force).for_each(|(axis, value)| axis.push(value));
        }
        if index % 50 == 0 {
            let temperature = read(25_000.0 + index as f64, 10.0);
            sample.temperature = Some(Temperature(temperature));
            temperatures.push(temperature);
        }
    }
    let dwell = averaged(&samples);
    let found = dwell.force.expect("some samples brought it");
    for (found, axis) in found.into_iter().zip(&forces) {
        assert!((found.0 - mean(axis) * 1e-6).abs() < 1e-12, "{found:?}");
    }
    let found = dwell.temperature.get().expect("some samples brought it");
    assert!((found - mean(&temperatures) * 1e-3).abs() < 1e-10, "{found}");
}

#[test]
fn a_dwell_whose_samples_bring_no_force_has_none() {
    let mut noise = Generator::new(2);
    let samples: Vec<Sample> = (0..200).map(|index| bare(index, &mut noise)).collect();
    let dwell = averaged(&samples);
    assert_eq!((dwell.force, dwell.temperature.get()), (None, None));
}

#[test]
fn the_platform_counts_as_level_only_once_a_force_has_said_so() {
    for (across, is_level) in [(0.0, true), (5.0, false)] {
        let setting = Setting::at(Latitude::from_degrees(50.0).expect("it is one"));
        let procedure = Procedure::new(Schedule::circle(12, Seconds(5.0)), Seconds(SAMPLE_SECONDS));
        let mut session = Session::new(setting, procedure).expect("it begins");
        let mut noise = Generator::new(3);
        // The look at the tilt is due after 125 samples.
        for index in 0..200 {
            session.feed(Input::Sample(&bare(index, &mut noise)));
            assert_eq!(session.phase, Phase::Level, "{index}");
        }
        let force = Some([across, 0.0, -9.81].map(SpecificForce::from_m_per_s2));
        session.feed(Input::Sample(&Sample { force, ..bare(200, &mut noise) }));
        assert_eq!(session.phase, if is_level { Phase::Dwell } else { Phase::Done });
        let verdict = session.conclusion().map(|conclusion| conclusion.verdict);
        assert_eq!(matches!(verdict, Some(Err(Refusal::TiltTooGreat { .. }))), !is_level);
    }
}
