//! What the dwells of a stage or the turns of a platform cannot tell, in words: every azimuth from them assumes it.

use orientation::session::{Session, rotating};

/// Dwells from which drift and motion show beside the Earth rate, where none is a repeat.
const ENOUGH: usize = 8;
/// Angle within which two dwells stand at one position, rad.
const SAME_POSITION: f64 = 0.01;
/// Tilt in its σ below which a stage is as good as level.
const LEVEL: f64 = 5.0;

/// What the azimuth of a session assumes that none of its data show; nothing where there is none.
#[must_use]
pub fn of(session: &Session) -> Vec<String> {
    let found = session.conclusion().filter(|conclusion| conclusion.verdict.is_ok());
    let Some((tilt, fit)) = found.and_then(|found| Some((&found.tilt, found.fit.as_ref()?))) else {
        return Vec::new();
    };
    let is_level =
        tilt.magnitude() < LEVEL * tilt.covariance[0][0].max(tilt.covariance[1][1]).sqrt();
    let few = session.dwells().len() < ENOUGH && !is_repeated(session);
    let untold = [
        (true, "no drift in step with the turn"),
        (true, "no turn of the base or slip of the encoder in the last quarter of the dwells"),
        (is_level, "sign of the gyro and sense of the stage, which no level stage shows"),
        (!fit.earth_rate_is_free(), "scale of the gyro, which no arc shows"),
        (few, "no drift and no motion beyond what is stated, which few positions do not show"),
    ];
    let words = untold.into_iter().filter(|(is_untold, _)| *is_untold);
    words.map(|(_, words)| words.to_owned()).collect()
}

/// Sine of the tilt below which an accelerometer in g instead of m/s² shows no impossible one: 1.5°.
const NEARLY_LEVEL: f64 = 0.026;

/// The same of the session of a platform that turns all the time, with an accelerometer along one axis or two.
#[must_use]
pub fn of_platform(session: &rotating::Session, has_across: bool) -> Vec<String> {
    let found = session.conclusion().filter(|conclusion| conclusion.verdict.is_ok());
    let Some(fit) = found.and_then(|found| found.fit.as_ref()) else { return Vec::new() };
    let untold = [
        (
            !has_across,
            "sense of the platform's angle, clockwise from above, which one axis does not show",
        ),
        (
            fit.tilt.size() < NEARLY_LEVEL,
            "accelerometer in m/s², which a platform that is nearly level does not show",
        ),
    ];
    let words = untold.into_iter().filter(|(is_untold, _)| *is_untold);
    words.map(|(_, words)| words.to_owned()).collect()
}

/// Whether the stage came to any position twice.
fn is_repeated(session: &Session) -> bool {
    let dwells = session.dwells();
    let is_same = |one: usize, other: usize| {
        (dwells[one].stage - dwells[other].stage).signed_rad().abs() < SAME_POSITION
    };
    (0..dwells.len()).any(|one| (0..one).any(|other| is_same(one, other)))
}
