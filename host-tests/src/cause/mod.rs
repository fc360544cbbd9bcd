//! What a refusal of a recording is likely to come from: a column in another unit, a noise that is not the gyro's, a
//! sensor that is stuck, an encoder that slipped, a key that is missing.
//!
//! What the columns prove is named at once. Else the recording is tried as it may have been meant: where it then gives
//! an azimuth that passes every test, that is named. The azimuth itself is not given: the recording is to be put right.
//! A recording that is merely too short is not tried: almost anything would pass.

mod keys;
mod slip;
mod stuck;
mod units;
mod vehicle;
mod warming;

use orientation::alignment::refusal::Refusal;
use orientation::alignment::rotating::Refusal as Rotating;
use orientation::alignment::stepwise::Refusal as Stepwise;
use orientation::alignment::stepwise::session::Session;
use orientation::alignment::stops::Refusal as Stops;

use crate::methods::asked::Question;
use crate::methods::{is_answered, rotating, stepwise};
use crate::recording::{Body, Header, Sensor, Short};

/// What a refusal is likely to come from, with its remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// What the columns and keys themselves show: it is told before the refusal that came of it.
    Shown(String),
    /// What would explain the refusal, and is told behind it.
    Possible(String),
}

impl Cause {
    /// A refusal's reason with this cause, and without the usual remedy with which the reason ends.
    #[must_use]
    pub fn explaining(&self, reason: &str, remedy: &str) -> String {
        let reason = reason.strip_suffix(remedy).unwrap_or(reason);
        match self {
            Self::Shown(cause) => format!("{cause}; as it stands: {reason}"),
            Self::Possible(cause) => format!("{reason}; {cause}"),
        }
    }
}

/// Times the stated noise power that no residuals are by chance or drift.
const NO_NOISE: f64 = 100.0;
/// Fewest dwells that a trial may be made with where they were too few.
const FEW: usize = 5;

/// The likely cause of a refusal of a recording whose stage stops, with its remedy.
pub fn of_stopping(of: &Question, session: &Session, refusal: &Refusal) -> Option<Cause> {
    let Question { header, body, asked } = *of;
    let proven = stuck::of_stage(header, body).or_else(|| keys::impossible(body));
    // Of a half circle that contradicts the dwells the refusal says all: columns that are mirrored would fit it.
    let is_told = matches!(refusal, Refusal::Stepwise(Stepwise::NotInHalf));
    if proven.is_some() || is_told {
        return proven.map(Cause::Shown);
    }
    let passes = |body: &Body| {
        let replay = stepwise::replay(header, body, asked, |_| {});
        replay.is_ok_and(|replay| is_answered(&replay.session))
    };
    let force = units::force_unit(body);
    if is_short(refusal) && session.dwells().len() < FEW {
        return units::of_forces(body).map(Cause::Shown);
    }
    let meant = units::tried(body, force, true, &passes);
    let warming = || {
        let is_possible = meant.as_ref().is_none_or(units::Trial::is_reversed);
        is_possible.then(|| warming::of(session, refusal, meant.is_some())).flatten()
    };
    let shown = || {
        let meant = meant.as_ref().map(|trial| trial.describe(body));
        meant
            .or_else(|| units::of_forces(body))
            .or_else(|| units::of_sigma(of))
            .or_else(|| keys::noise(of))
            .or_else(|| slip::of(session, refusal))
    };
    let possible = || keys::missing(of, refusal).or_else(|| too_much(body, refusal));
    warming()
        .map(Cause::Possible)
        .or_else(|| shown().map(Cause::Shown))
        .or_else(|| possible().map(Cause::Possible))
}

/// The cause of a level that was not found.
pub fn of_level(body: &Body) -> Option<Cause> {
    units::of_forces(body).map(Cause::Shown)
}

/// The cause of a refusal of a vehicle.
pub fn of_vehicle(of: &Question, refusal: &Refusal) -> Option<Cause> {
    vehicle::of_vehicle(of, refusal).map(Cause::Shown)
}

/// The cause of a refusal on a platform that turns all the time.
pub fn of_turning(of: &Question, refusal: &Refusal) -> Option<Cause> {
    let Question { header, body, asked } = *of;
    let Body::Rotating(rows) = body else { return None };
    let proven = stuck::of_platform(rows).or_else(|| units::of_platform_rate(rows));
    let is_noisy = matches!(refusal, Refusal::BudgetNotMet { .. });
    if proven.is_some() || is_short(refusal) && !is_noisy {
        return proven.map(Cause::Shown);
    }
    let passes = |header: &Header, body: &Body| {
        rotating::replay(header, body, asked).is_ok_and(|replay| is_answered(&replay.session))
    };
    let noise = || {
        let stated = header.gyro_n_deg_sqrt_h.filter(|_| is_scattered(refusal)).map(Short)?;
        let silent = Header { gyro_n_deg_sqrt_h: None, ..header.clone() };
        passes(&silent, body).then(|| {
            format!("key gyro_N_deg_sqrt_h says {stated} °/√h, but the turns show another noise: leave it out")
        })
    };
    let gain_is_known = header.sensor != Some(Sensor::Met);
    units::tried(body, None, gain_is_known, &|body| passes(header, body))
        .map(|trial| trial.describe(body))
        .or_else(noise)
        .map(Cause::Shown)
}

/// Whether there was too little to judge from, so that almost any other reading of it would pass.
fn is_short(refusal: &Refusal) -> bool {
    matches!(
        refusal,
        Refusal::BudgetNotMet { .. }
            | Refusal::LatitudeTooHigh { .. }
            | Refusal::Stepwise(
                Stepwise::TooFewPositions { .. }
                    | Stepwise::AzimuthUnobservable
                    | Stepwise::SignUnknown
                    | Stepwise::NotInHalf
                    | Stepwise::TrendNotSeparable
                    | Stepwise::TiltTooUncertain { .. }
            )
            | Refusal::Rotating(Rotating::TurnsTooFew { .. })
            | Refusal::Stops(
                Stops::NoStop
                    | Stops::OneStop { .. }
                    | Stops::StopTooShort { .. }
                    | Stops::DriveTooShort { .. }
            )
    )
}

/// Whether a platform's turns are too far from each other, as those of a gyro with another noise are.
fn is_scattered(refusal: &Refusal) -> bool {
    matches!(
        refusal,
        Refusal::ResidualsNotWhite { .. }
            | Refusal::BudgetNotMet { .. }
            | Refusal::Rotating(Rotating::TurnsDisturbed { .. } | Rotating::TurnsDisagree { .. })
    )
}

/// Residuals that are no noise of anything.
fn too_much(body: &Body, refusal: &Refusal) -> Option<String> {
    let Refusal::ResidualsNotWhite { ratio } = refusal else { return None };
    let stated = if matches!(body, Body::Dwells(_)) { "sigma_rad_s" } else { "gyro_N_deg_sqrt_h" };
    (*ratio > NO_NOISE).then(|| {
        format!(
            "so much is no noise: check the units of all columns, and {stated}, and whether the platform stood still"
        )
    })
}
