//! The catalogue of faults: what each does to a part that the board of its platform has.

use std::collections::BTreeMap;

use firmware::ports::Frames;
use hal_mock::chip::Select;
use simulated::fault::{Chip, Fault, Injection, Platform};
use simulated::spin::SpinScenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;

/// What a fault injects, or nothing, and how the vehicle drives or the body flies then.
fn injection(platform: Platform, fault: Option<Fault>) -> (Injection, String) {
    match platform {
        Platform::Stage | Platform::TwoFrame => (Injection::of(fault), String::new()),
        Platform::Turntable => (TurntableScenario::default().injection(fault), String::new()),
        Platform::Vehicle => {
            let scenario = VehicleScenario::default();
            (scenario.injection(fault), format!("{:?}", scenario.day(fault)))
        }
        Platform::Spin => {
            let scenario = SpinScenario::default();
            (scenario.injection(fault), format!("{:?}", scenario.course(fault)))
        }
    }
}

/// All of it that comes to a part of the platform's board, in words that can be compared.
fn injected(platform: Platform, fault: Option<Fault>) -> String {
    let (injection, way) = injection(platform, fault);
    let Injection { buses, ready, late, coarse_imu, blackouts, .. } = &injection;
    let Injection { sensors, axes, caught, disturbances, hang, .. } = &injection;
    let has = |select: Select| Chip::all(platform).any(|chip| chip.select == Some(select));
    let chips = (
        buses.iter().filter(|(select, _)| has(*select)).collect::<Vec<_>>(),
        ready.iter().filter(|(select, _)| has(*select)).collect::<Vec<_>>(),
        late.filter(|(select, _)| has(*select)),
        blackouts.iter().filter(|blackout| has(blackout.select)).collect::<Vec<_>>(),
    );
    let outer = (&axes.outer, caught.outer);
    let on_base = (coarse_imu, disturbances, hang);
    match platform {
        Platform::Stage | Platform::Turntable => format!("{:?}", (chips, outer, on_base)),
        Platform::TwoFrame => {
            let frames = Frames { outer, inner: (&axes.inner, caught.inner) };
            format!("{:?}", (chips, frames, on_base))
        }
        Platform::Vehicle => format!("{:?}", (chips, sensors, hang, way)),
        Platform::Spin => format!("{:?}", (chips, sensors, way)),
    }
}

#[test]
fn every_fault_does_something_of_its_own_to_a_part_that_the_board_of_its_platform_has() {
    for platform in Platform::ALL {
        let mut known = BTreeMap::from([(injected(platform, None), "no fault".to_owned())]);
        for fault in Fault::all(platform) {
            let alike = known.insert(injected(platform, Some(fault)), fault.to_string());
            assert_eq!(alike, None, "{platform}: as much as {fault}");
        }
    }
}
