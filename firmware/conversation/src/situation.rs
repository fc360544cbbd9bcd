//! The report of which all that is sent is made, out of what the instrument's parts have stated.

use embassy_time::Instant;
use orientation::attitude::Trust;
use orientation::navigation::navigator::Attitude;
use orientation::roll::Condition;
use orientation::units::{self, Radians, Seconds};
use protocol::report::{Degradation, Level, Origin, Report, Roll, State};

use firmware::shared::Shared;
use firmware::status::Status;

/// The report of this moment.
pub(super) fn report(shared: &Shared<'_>) -> Report {
    let status = shared.shown_status();
    let now = units::Instant(Instant::now().as_micros());
    let report = Report {
        time: shared.clocks.instant(now),
        faults: shared.health.get().faults(),
        failed: shared.failed.get(),
        progress: match status {
            Status::Measuring(progress) => Some(progress),
            _ => None,
        },
        origin: if shared.is_simulated { Origin::Simulation } else { Origin::Gyros },
        ..Report::default()
    };
    match (status, shared.attitude.get()) {
        (Status::Rolling(angle, condition), _) => Report {
            state: state_of_roll(angle.is_some(), condition),
            spin: Some(Roll { angle, condition }),
            ..report
        },
        (Status::Concluded(azimuth, at), None) => Report {
            state: State::Degraded(Degradation::Unwatched),
            azimuth: Some(azimuth),
            since_alignment: Some(Seconds(at.elapsed().as_micros() as f64 * 1e-6)),
            ..report
        },
        (_, Some(attitude)) => kept(report, &attitude, shared),
        (_, None) => Report { state: without_azimuth(shared), ..report },
    }
}

/// The state without an azimuth.
fn without_azimuth(shared: &Shared<'_>) -> State {
    match shared.status.get() {
        Status::Waiting => State::Waiting,
        _ if shared.has_none() => State::Failed,
        _ => State::Aligning,
    }
}

/// The state of an instrument that tracks a roll.
fn state_of_roll(is_known: bool, condition: Condition) -> State {
    match condition {
        Condition::Locked if is_known => State::Ready,
        Condition::Holding if is_known => State::Degraded(Degradation::Coasting),
        _ if is_known => State::Degraded(Degradation::Uncertain),
        // It waits for turns that show it.
        Condition::Searching | Condition::NotSpinning | Condition::RotationLost => State::Aligning,
        _ => State::Failed,
    }
}

/// Age of an attitude beyond which it is not stated any more, µs: that of three that did not come. ArduPilot takes a source
/// of attitudes for lost after as long.
const STALE: u64 = 300_000;
/// Standard deviation of a level, 1σ, beyond which pitch and roll are of no use: 5°.
const TILTED: Radians = Radians::from_degrees(5.0);

/// The report with an attitude that is kept.
fn kept(report: Report, attitude: &Attitude, shared: &Shared<'_>) -> Report {
    let Attitude { azimuth, pitch, roll, level_sigma: sigma, .. } = *attitude;
    // Nothing is known of what happens since.
    let is_old = report.time.0.saturating_sub(attitude.time.0) > STALE;
    let trust = attitude.state.filter(|_| !is_old).map(|state| state.trust);
    let azimuth = azimuth.filter(|_| !is_old);
    let state = match trust.filter(|_| azimuth.is_some()) {
        Some(trust) => usable(attitude, trust, shared),
        None => without_azimuth(shared),
    };
    let has_level = !matches!(trust, None | Some(Trust::Starting | Trust::RotationLost));
    let is_outside = report.origin == Origin::Gyros && attitude.is_from_outside;
    Report {
        time: attitude.time,
        state,
        azimuth,
        origin: if is_outside { Origin::Outside } else { report.origin },
        level: has_level.then_some(Level { pitch, roll, sigma }).filter(|_| sigma < TILTED),
        rate_of_turn: attitude.rate_of_turn.filter(|_| !is_old),
        rates: attitude.rates.filter(|_| !is_old),
        resets: attitude.resets,
        since_alignment: attitude.since_aligned,
        ..report
    }
}

/// Standard deviation of a level that gyros alone carry, 1σ, beyond which the azimuth is used with care: more than
/// accelerometers leave that nobody has calibrated. Good gyros do not reach it in an hour, coarse ones within a minute.
const COASTED: Radians = Radians::from_degrees(2.0);

/// How far an azimuth that is kept may be relied upon. Its standard deviation has what the level's error does to it.
fn usable(attitude: &Attitude, trust: Trust, shared: &Shared<'_>) -> State {
    let is_beyond =
        |required: Radians| attitude.azimuth.is_some_and(|azimuth| azimuth.sigma > required);
    match trust {
        _ if attitude.is_recalled => State::Degraded(Degradation::Recalled),
        _ if shared.required.get().is_some_and(is_beyond) => {
            State::Degraded(Degradation::Uncertain)
        }
        Trust::Level => State::Ready,
        Trust::Coasting | Trust::FreeFall if attitude.level_sigma < COASTED => State::Ready,
        Trust::Coasting | Trust::FreeFall => State::Degraded(Degradation::Coasting),
        Trust::NoForce | Trust::RotationLost | Trust::Starting => {
            State::Degraded(Degradation::Uncertain)
        }
    }
}
