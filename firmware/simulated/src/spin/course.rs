//! How a simulated body flies, where nothing or something is wrong with that.

use crate::fault::Fault;

/// How long a lift that fades is gone, s.
const PASSING: f64 = 0.3;
/// How long a lift takes to fade, and a spin to stop, s.
const FADING: f64 = 0.02;

/// How spin and lift go over the time of a flight: rad/s and m/s² at some times, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    pub(super) spin: [(f64, f64); 4],
    pub(super) lift: [(f64, f64); 4],
}

/// How a body flies that spins so fast, rad/s, on such a lift, m/s², when something goes wrong at a time, s.
pub(super) fn course(fault: Option<Fault>, spin: f64, lift: f64, at: f64) -> Course {
    let gone = at + FADING;
    let back = gone + PASSING;
    let steady = |value: f64| [(0.0, value); 4];
    let lost = |value: f64| [(at, value), (gone, 0.0), (gone, 0.0), (gone, 0.0)];
    let mut course = Course { spin: steady(spin), lift: steady(lift) };
    match fault {
        Some(Fault::LiftFades) => {
            course.lift = [(at, lift), (gone, 0.0), (back, 0.0), (back + FADING, lift)];
        }
        Some(Fault::LiftGone) => course.lift = lost(lift),
        Some(Fault::SpinStops) => course.spin = lost(spin),
        _ => {}
    }
    course
}
