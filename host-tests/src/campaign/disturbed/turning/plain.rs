//! The plain mean of all turns of a platform: nothing is checked, nothing left out.

use orientation::alignment::rotating::Session;
use orientation::alignment::rotating::level::Lean;
use orientation::alignment::rotating::misalignment::{self, AxisMisalignment};
use orientation::alignment::rotating::molecular::{self, Halves};
use orientation::alignment::rotating::turn::{Sense, Stretch, Turn};
use orientation::math::Complex;

use crate::output::degrees;

/// Variance that is taken for every phasor, (rad/s)²: so small that nothing counts as noise.
const VARIANCE: f64 = 1e-20;
/// Turns in which a sensor that is not flat settles.
const SETTLING: usize = 2;

/// Clockwise and counter-clockwise at one speed.
type Pair<'a> = [&'a Stretch; 2];

/// The azimuth, °; `None` where a stretch has no turns.
pub(super) fn azimuth_deg(session: &Session) -> Option<f64> {
    let latitude = session.setting.site.latitude;
    let pairs = pairs(&session.turn_accumulator.stretches)?;
    let first = *pairs.first()?;
    let force = |stretch: &Stretch| average(stretch, 0, |turn| Complex::of_signal(turn.force));
    let tilt = mean(first.map(force)).scaled(1.0 / latitude.gravity().0);
    let felt = tilt.scaled(latitude.vertical_rate().0);
    let misalignments = &session.conclusion()?.misalignments;
    let sensor = session.setting.sensor;
    let azimuth = if sensor.is_flat {
        let earth = mean(first.map(|stretch| rate(stretch, misalignments, 0)));
        Lean::of(tilt).azimuth(earth - felt).0
    } else {
        let half = |pair: &Pair| {
            let phasors = pair.map(|stretch| rate(stretch, misalignments, SETTLING));
            Halves::of(pair[0].speed(), phasors, [VARIANCE; 2], 0.0)
        };
        let halves: Vec<Halves> = pairs.iter().map(half).collect();
        let angle = molecular::freed(&halves, sensor.molecular_sigma.0)?.angle;
        let felt = felt.scaled(1.0 / latitude.horizontal_rate().0);
        Lean::of(tilt).azimuth_towards(angle, felt)?.0
    };
    Some(degrees(azimuth))
}

/// The stretches with turns in pairs; `None` where one has no other.
fn pairs(stretches: &[Stretch]) -> Option<Vec<Pair<'_>>> {
    let turned = || stretches.iter().filter(|stretch| !stretch.turns.is_empty());
    let of = |sense: Sense| turned().filter(move |stretch| stretch.sense == sense);
    let both = of(Sense::Clockwise).zip(of(Sense::CounterClockwise));
    let pairs: Vec<Pair> = both.map(|(clockwise, counter)| [clockwise, counter]).collect();
    (2 * pairs.len() == turned().count()).then_some(pairs)
}

fn mean([one, other]: [Complex; 2]) -> Complex {
    (one + other).scaled(0.5)
}

/// A stretch's phasor without what its unevenness lets the sensor feel.
fn rate(stretch: &Stretch, misalignments: &[AxisMisalignment], settling: usize) -> Complex {
    let frequency = stretch.sense.signed(stretch.speed());
    let misalignment = misalignment::nearest(misalignments, frequency);
    let response = misalignment.map_or(Complex::default(), |found| found.response(frequency));
    average(stretch, settling, |turn| {
        Complex::of_signal(turn.rate) - response * Complex::of_signal(turn.turning)
    })
}

/// The mean of something over a stretch's turns, but the first ones.
fn average(stretch: &Stretch, settling: usize, of: impl Fn(&Turn) -> Complex) -> Complex {
    let turns = &stretch.turns;
    let turns = turns.get(settling..).filter(|turns| !turns.is_empty()).unwrap_or(turns);
    let sum = turns.iter().map(of).fold(Complex::default(), |sum, part| sum + part);
    sum.scaled(1.0 / turns.len().max(1) as f64)
}
