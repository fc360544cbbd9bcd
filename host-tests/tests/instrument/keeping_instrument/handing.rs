//! The moment of the handing over, sample by sample.

use embassy_time::{Duration, Timer};
use firmware::configuration::{Alignment, KeepConfiguration, Realignment};
use firmware::keep::{Keep, Keeping, Motion};
use firmware::shared::Shared;
use host::virtual_time;
use orientation::attitude::{Gyro, Handover, Keeper, Setting};
use orientation::earth::Latitude;
use orientation::signal::InertialSample;
use orientation::units::{AngleIncrement, DEGREE, Instant, SpecificForce};

use super::{drive, vehicle};
use firmware::event::Event;
use firmware::simulated::keep::Hold;

/// Turn of a sample about down, rad: 10 °/s at 100 Hz.
const TURN: f64 = 0.1 * DEGREE;

fn sample(index: u64, turn: f64) -> InertialSample {
    InertialSample {
        time: Instant(index * 10_000),
        turned: [0.0, 0.0, turn].map(|angle| AngleIncrement::from_rad(angle, &mut 0.0)),
        force: Some([0.0, 0.0, -9.81].map(SpecificForce::from_m_per_s2)),
    }
}

/// The azimuth, °, after so many samples behind the session's last one, all of which waited in the queue
/// when the session's azimuth of 100° came.
fn azimuth_after(later: u64) -> f64 {
    let latitude = Latitude::from_degrees(45.0).expect("a latitude");
    let gyro = Gyro { scale_sigma: 1e-4, bias_sigma: 1e-6, ..Gyro::default() };
    let configuration = KeepConfiguration {
        hold: Duration::MAX,
        realignment: Realignment::Never,
        knows_stops: true,
        alignment: Alignment::Always,
        beside: gyro,
        precise: gyro,
    };
    let mut keeper = Keeper::new(&Setting::precise(latitude, 0.01, gyro));
    (1..=500).for_each(|index| keeper.push(&sample(index, 0.0)));
    let shared = Shared::new(&());
    let mut keeping = Keeping::new(&mut keeper, &configuration, (), ());
    let fed = async {
        Timer::after(Duration::from_millis(50)).await;
        // The session has all of them but the last ones, and is at work on its conclusion.
        shared.keep.is_behind.set(true);
        for index in 501..=505 + later {
            let motion = Motion::Moved(sample(index, TURN));
            shared.keep.motions.try_send(motion).expect("there is room");
        }
        Timer::after(Duration::from_millis(50)).await;
        let handover = Handover { azimuth: 100.0 * DEGREE, sigma: 0.01 * DEGREE };
        shared.keep.found.signal((Instant(505 * 10_000), handover));
        shared.keep.is_behind.set(false);
        shared.keep.caught_up.signal(());
        Timer::after(Duration::from_millis(200)).await;
    };
    virtual_time::run_beside(keeping.run(&shared), fed).expect("no deadlock");
    let azimuth = keeping.report().azimuth.expect("it was handed over");
    azimuth.angle.to_degrees()
}

#[test]
fn what_turns_between_the_sessions_last_sample_and_the_handing_over_counts() {
    for later in [0, 1, 3, 8] {
        let azimuth = azimuth_after(later);
        let expected = 100.0 + later as f64 * 0.1;
        assert!((azimuth - expected).abs() < 2e-3, "{later} later: {azimuth}°, not {expected}°");
    }
}

#[test]
fn the_azimuth_goes_on_from_the_sessions_last_sample_without_a_gap() {
    for seed in 1..=3 {
        let found = drive(&vehicle(seed, Hold::of(5.0)));
        let concluded = found.run.events.iter().find_map(|(at, event)| match event {
            Event::Concluded(azimuth, _, _) => Some((*at, *azimuth)),
            _ => None,
        });
        let (at, azimuth) = concluded.expect("a healthy run");
        let handed = found.run.events.iter().find_map(|(at, event)| match event {
            Event::HandedOver(..) => Some(*at),
            _ => None,
        });
        let late = handed.expect("it is handed over") - at;
        assert!(late <= Duration::from_millis(10), "{late:?}");
        // The vehicle stands: what is kept a moment later is what was found.
        let (point, [error, _]) = found.run.kept.with_azimuth().next().expect("it is kept");
        let truth = point.truth.azimuth_rad.to_degrees();
        let found_error = (azimuth - truth + 180.0).rem_euclid(360.0) - 180.0;
        assert!((error.to_degrees() - found_error).abs() < 0.01, "seed {seed}");
    }
}
