//! What every carrier owes, whatever its method and its mechanism: one contract, to which all are held.

use std::fmt::Write as _;

use crate::support::link::{sentences, words};
use host::emulate::outcome::Outcome;
use host::instrument::kept::Point;
use host::instrument::{Run, RunError, Trial};
use orientation::alignment::Method;
use orientation::signal::{InertialSample, Sample, SpinSample};
use simulated::fault::{Fault, Platform};
use simulated::hold::Hold;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::spin::SpinScenario;
use simulated::trace::{ABSENT, AZIMUTH, FLIGHT, Trace};
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;

/// Which run is made.
#[derive(Clone, Copy)]
struct Asked {
    latitude_deg: f64,
    hold_s: f64,
    fault: Option<Fault>,
}

const USUAL: Asked = Asked { latitude_deg: 48.0, hold_s: 0.0, fault: None };

/// What is seen of a run from outside.
struct Seen {
    outcome: Outcome,
    /// The sentences of the log.
    log: String,
    /// What the link carried.
    lines: String,
    faults: u32,
    violations: Vec<String>,
    kept: Vec<Point>,
}

/// A carrier as the contract sees it.
struct Carrier {
    platform: Platform,
    run: fn(Asked) -> Result<Seen, RunError>,
    /// A gyro without which nothing goes on, in the catalogue of faults and in the log.
    gyro: [&'static str; 2],
    /// What it finds.
    finds: &'static str,
    /// Whether it works at a latitude, so that there is one at which it does not.
    has_latitude: bool,
    /// Whether it keeps an azimuth after the alignment.
    keeps: bool,
}

const CARRIERS: [Carrier; 5] = [
    Carrier {
        platform: Platform::Stage,
        run: on_stage,
        gyro: ["gyro", "gyro"],
        finds: AZIMUTH,
        has_latitude: true,
        keeps: true,
    },
    Carrier {
        platform: Platform::TwoFrame,
        run: on_frames,
        gyro: ["gyro", "gyro"],
        finds: AZIMUTH,
        has_latitude: true,
        keeps: true,
    },
    Carrier {
        platform: Platform::Turntable,
        run: on_turntable,
        gyro: ["gyro", "gyro"],
        finds: AZIMUTH,
        has_latitude: true,
        keeps: true,
    },
    Carrier {
        platform: Platform::Vehicle,
        run: in_vehicle,
        gyro: ["right-gyro", "right gyro"],
        finds: AZIMUTH,
        has_latitude: true,
        keeps: true,
    },
    Carrier {
        platform: Platform::Spin,
        run: on_spinning_body,
        gyro: ["forward-gyro", "forward gyro"],
        finds: FLIGHT,
        has_latitude: false,
        keeps: false,
    },
];

fn base(asked: Asked) -> Scenario {
    Scenario {
        latitude_deg: asked.latitude_deg,
        hold: Hold::of(asked.hold_s),
        has_base_imu: asked.hold_s > 0.0,
        sample_rate_hz: 100.0,
        ..Scenario::usual(3)
    }
}

fn on_stage(asked: Asked) -> Result<Seen, RunError> {
    let run = Trial::of(&base(asked)).fault(asked.fault).run()?;
    Ok(seen::<Sample, _, _, _>(&run, &run.replay.session))
}

fn on_frames(asked: Asked) -> Result<Seen, RunError> {
    let scenario = FramesScenario { base: base(asked), passes: 2, ..FramesScenario::default() };
    let run = Trial::of(&scenario).fault(asked.fault).run()?;
    Ok(seen::<Sample, _, _, _>(&run, &run.replay.session))
}

fn on_turntable(asked: Asked) -> Result<Seen, RunError> {
    let scenario = TurntableScenario { base: base(asked), turns: 4, ..TurntableScenario::brief(3) };
    let run = Trial::of(&scenario).fault(asked.fault).run()?;
    Ok(seen::<Sample, _, _, _>(&run, &run.replay))
}

fn in_vehicle(asked: Asked) -> Result<Seen, RunError> {
    let usual = VehicleScenario::usual(3);
    let Asked { latitude_deg, hold_s, fault } = asked;
    let base = Scenario { latitude_deg, hold: Hold::of(hold_s), ..usual.base };
    let scenario = VehicleScenario { base, stops: 2, drive_s: 300.0, ..usual };
    let run = Trial::of(&scenario).fault(fault).run()?;
    Ok(seen::<InertialSample, _, _, _>(&run, &run.replay))
}

fn on_spinning_body(asked: Asked) -> Result<Seen, RunError> {
    let scenario = SpinScenario { seconds: 3.0, ..SpinScenario::default() };
    let run = Trial::of(&scenario).fault(asked.fault).run()?;
    Ok(seen::<SpinSample, _, _, _>(&run, &run.replay))
}

fn seen<S, R, T, M: Method<S> + Trace>(run: &Run<R, T>, method: &M) -> Seen {
    let mut log = String::new();
    for (_, event) in &run.events {
        writeln!(log, "{event}").expect("memory takes it");
    }
    Seen {
        outcome: Outcome::of(method, &[]),
        log,
        lines: run.lines.clone(),
        faults: run.health.faults(),
        violations: run.violations.clone(),
        kept: run.kept.points.clone(),
    }
}

impl Seen {
    /// The last words on the link.
    fn last_words(&self) -> String {
        words(&self.lines).pop().unwrap_or_default()
    }

    /// Whether an azimuth, or a roll, was found, with its σ.
    fn has_found(&self, head: &str) -> bool {
        let row = self.outcome.rows.iter().find(|row| row.head == head);
        let mut numbers = row.into_iter().flat_map(|row| row.names().zip(&row.bits));
        numbers.any(|(name, bits)| name == "sigma" && *bits != ABSENT)
    }
}

impl Carrier {
    /// The run, which must come to an end.
    fn seen(&self, asked: Asked) -> Seen {
        (self.run)(asked).unwrap_or_else(|error| panic!("{}: {error}", self.platform))
    }

    /// A fault of its gyro.
    fn fault(&self, of_gyro: &str) -> Fault {
        let name = format!("{}-{of_gyro}", self.gyro[0]);
        let found = Fault::all(self.platform).find(|fault| fault.to_string() == name);
        found.unwrap_or_else(|| panic!("{}: no fault {name}", self.platform))
    }
}

#[test]
fn every_carrier_finds_what_it_is_for_and_its_drivers_keep_to_the_data_sheets() {
    for carrier in CARRIERS {
        let (seen, name) = (carrier.seen(USUAL), carrier.platform);
        assert!(seen.has_found(carrier.finds), "{name}: {:?}", seen.outcome.reason);
        let Seen { log, lines, faults, violations, .. } = seen;
        assert_eq!((faults, violations.as_slice()), (0, [].as_slice()), "{name}:\n{log}");
        assert!(log.starts_with("begin: "), "{name}:\n{log}");
        assert!(lines.lines().count() >= 2, "{name} says nothing on its link: {lines}");
    }
}

#[test]
fn a_gyro_that_falls_silent_ends_every_alignment_with_its_name_and_without_an_azimuth() {
    for carrier in CARRIERS {
        let fault = Some(carrier.fault("silent"));
        let (seen, name) = (carrier.seen(Asked { fault, ..USUAL }), carrier.platform);
        assert!(!seen.has_found(AZIMUTH), "{name}");
        assert!(seen.last_words().starts_with("no "), "{name}: {}", seen.lines);
        let log = seen.log;
        let last = log.lines().rfind(|line| line.starts_with("no ")).unwrap_or_default();
        assert!(last.contains(carrier.gyro[1]), "{name}: «{last}» of\n{log}");
    }
}

#[test]
fn a_gyro_that_is_silent_for_a_moment_costs_an_answer_only_where_what_was_turned_meanwhile_is_lost()
{
    for carrier in CARRIERS {
        let fault = Some(carrier.fault("silent-once"));
        let seen = carrier.seen(Asked { fault, ..USUAL });
        let reason = seen.outcome.reason.clone().unwrap_or_default();
        let is_lost = reason.starts_with("samples are missing");
        let is_found = seen.has_found(carrier.finds);
        assert!(is_found || is_lost, "{}:\n{}", carrier.platform, seen.log);
        assert!(seen.faults > 0, "{}:\n{}", carrier.platform, seen.log);
    }
}

#[test]
fn every_alignment_refuses_a_latitude_at_which_the_earth_turns_about_the_vertical() {
    for latitude_deg in [-86.0, 89.0] {
        let mut reasons = Vec::new();
        for carrier in CARRIERS.iter().filter(|carrier| carrier.has_latitude) {
            let seen = carrier.seen(Asked { latitude_deg, ..USUAL });
            assert!(!seen.has_found(AZIMUTH), "{}", carrier.platform);
            let is_said = seen.last_words().starts_with("no azimuth");
            assert!(is_said, "{}: {}", carrier.platform, seen.lines);
            reasons.push(seen.outcome.reason.unwrap_or_default());
        }
        assert!(reasons[0].contains("latitude"), "{reasons:?}");
        assert!(reasons.iter().all(|reason| *reason == reasons[0]), "{reasons:?}");
    }
}

#[test]
fn every_carrier_that_keeps_its_azimuth_keeps_it_within_five_sigma() {
    for carrier in CARRIERS.iter().filter(|carrier| carrier.keeps) {
        let kept = carrier.seen(Asked { hold_s: 60.0, ..USUAL }).kept;
        let found = kept.iter().filter_map(Point::azimuth_error);
        let [count, beyond] = found.fold([0, 0], |[count, beyond], [error, sigma]| {
            [count + 1, beyond + usize::from(error.abs() > 5.0 * sigma)]
        });
        assert!(count >= 59 && beyond == 0, "{}: {beyond} of {count}", carrier.platform);
    }
}

#[test]
fn what_keeps_an_azimuth_keeps_pitch_and_roll_even_where_the_alignment_is_refused_at_once() {
    for carrier in CARRIERS.iter().filter(|carrier| carrier.keeps) {
        let seen = carrier.seen(Asked { latitude_deg: 86.0, hold_s: 20.0, ..USUAL });
        assert!(seen.kept.len() >= 19, "{}: {}", carrier.platform, seen.kept.len());
        assert!(seen.kept.iter().all(|point| point.report.azimuth.is_none()));
        let levels = sentences(&seen.lines, "PHTRO").len();
        assert!(levels >= 19, "{}: {}", carrier.platform, seen.lines);
        assert!(sentences(&seen.lines, "HEHDT").iter().all(|heading| heading[0].is_empty()));
    }
}
