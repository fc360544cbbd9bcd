//! What a board did follows again from what came in, keeping included: the two pure halves, driven by one list
//! of inputs in their order, do it once more without a board.

use host::instrument::Trial;
use host::instrument::recorder::Recorded;
use serde::Serialize;
use simulated::hold::Hold;
use simulated::mount::FramesScenario;
use simulated::scenario::Scenario;
use simulated::turntable::TurntableScenario;
use simulated::vehicle::VehicleScenario;

use crate::support::inputs::{recorded, replayed};

/// Runs a board and drives its halves again by what came in: what was kept is the same, to the last bit.
fn assert_again<C: Recorded<Sample: Serialize + Copy>>(carrier: &C) {
    let (run, text) = recorded(carrier, Trial::of(carrier));
    let again = replayed(&text).unwrap_or_else(|error| panic!("{error}"));
    let (kept, truth) = carrier.end_of(&run);
    assert_eq!((&again.done.kept, again.done.truth, again.done.warning), (kept, truth, None));
    assert!(kept.points.len() > 300 && kept.with_azimuth().next().is_some());
    let is_ordered = |order| text.contains(&format!("{{\"aligner\":{{\"ordered\":\"{order}\"}}}}"));
    assert!(is_ordered("restart") || is_ordered("skip"));
}

/// How the runs go on: aligning anew, and with an azimuth from outside.
fn holds(seconds: f64) -> [Hold; 2] {
    let usual = Hold { realigns: true, drive_s: 100.0, ..Hold::of(seconds) };
    [usual, Hold { handover: Some(([213.6, 0.1], 20.0)), ..usual }]
}

fn base(hold: Hold) -> Scenario {
    let usual = Scenario::usual(2);
    Scenario { hold, has_base_imu: true, sample_rate_hz: 100.0, positions: 8, ..usual }
}

#[test]
fn a_stage_and_two_frames_do_again_what_came_of_their_inputs() {
    for hold in holds(500.0) {
        let base = base(hold);
        assert_again(&base);
        assert_again(&FramesScenario { base, passes: 2, ..FramesScenario::default() });
    }
}

#[test]
fn a_turntable_does_again_what_came_of_its_inputs() {
    for hold in holds(500.0) {
        let usual = TurntableScenario::brief(2);
        assert_again(&TurntableScenario { base: base(hold), turns: 4, ..usual });
    }
}

#[test]
fn a_vehicle_does_again_what_came_of_its_inputs() {
    for hold in holds(900.0) {
        let usual = VehicleScenario::usual(2);
        assert_again(&VehicleScenario { base: Scenario { hold, ..usual.base }, ..usual });
    }
}
