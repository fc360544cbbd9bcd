//! The registry of methods: what `replay` can do with a recording, under which name, of which kinds.
//!
//! A further method is an entry here; its replay and its outcome stand in a folder of their own, what its refusals come from in `cause`.

pub mod asked;
pub mod error;
mod limits;
pub mod rotating;
pub mod spin;
pub mod stepwise;
pub mod stops;
pub mod vertical;

use orientation::alignment;
use orientation::alignment::stepwise::session::Session;
use simulated::fault::Platform;

use self::asked::Asked;
use self::error::ReplayError;
use crate::outcome::Finished;
use crate::recording::{Body, Header, Kind, Recording};
use crate::report::Stretch;

/// What is called at each step of a replay: the session so far.
pub type Watch<'a> = &'a dyn Fn(&Session);

/// Replays a recording.
type Replays = fn(&Header, &Body, &Asked, Watch<'_>) -> Result<Box<dyn Finished>, ReplayError>;

/// A method of `replay`.
pub struct Method {
    /// Name of the method on the command line.
    pub name: &'static str,
    /// What the method does, for the help.
    pub meaning: &'static str,
    /// Options of `replay`, by their names without dashes, that it takes beside those that every method takes.
    pub takes: &'static [&'static str],
    /// Platform of `run` that finds an azimuth or a roll by it.
    pub platform: Option<Platform>,
    /// Whether a recording for which no method was asked is one of its, where none before it takes the recording.
    pub suits: fn(&Header, &Body) -> bool,
    /// Replays a recording.
    pub replay: Replays,
}

/// The methods, in the order of the help.
pub static METHODS: [Method; 7] = [
    Method {
        name: stepwise::STEPWISE,
        meaning: "Stepwise gyrocompassing",
        takes: &["latitude", "criterion", "half"],
        platform: Some(Platform::Stage),
        suits: |_, body| matches!(body.kind(), Kind::Stage | Kind::Dwells),
        replay: |header, body, asked, watch| boxed(stepwise::replay(header, body, asked, watch)),
    },
    Method {
        name: stepwise::POSITIONS,
        meaning: "Autocompensated positions, in passes",
        takes: &["latitude", "criterion", "half"],
        platform: Some(Platform::TwoFrame),
        suits: |_, _| false,
        replay: |header, body, asked, watch| boxed(stepwise::replay(header, body, asked, watch)),
    },
    Method {
        name: "rotating",
        meaning: "A platform that turns all the time",
        takes: &["latitude"],
        platform: Some(Platform::Turntable),
        suits: |_, body| body.kind() == Kind::Rotating,
        replay: |header, body, asked, _| boxed(rotating::replay(header, body, asked)),
    },
    Method {
        name: stops::SIAP,
        meaning: "A vehicle: the azimuth from two stops and more",
        takes: &["latitude", "displacements"],
        platform: Some(Platform::Vehicle),
        suits: |header, body| stops::usual_method(header, body) == Some(stops::SIAP),
        replay: |header, body, asked, _| boxed(stops::replay(header, body, asked)),
    },
    Method {
        name: stops::STATIC,
        meaning: "A vehicle at rest all the time, sway allowed",
        takes: &["latitude"],
        platform: None,
        suits: |_, body| stops::samples::rows(body).is_some(),
        replay: |header, body, asked, _| boxed(stops::replay(header, body, asked)),
    },
    Method {
        name: "vertical",
        meaning: "Pitch and roll, and the turn about the vertical, kept from the beginning to the end",
        takes: &["latitude", "attitude_out"],
        platform: None,
        suits: |_, _| false,
        replay: |header, body, asked, _| boxed(vertical::replay(header, body, asked)),
    },
    Method {
        name: "spin",
        meaning: "The roll of a body in fast rotation, from the extrema of its accelerometers and by phase lock",
        takes: &[],
        platform: Some(Platform::Spin),
        suits: |_, body| body.kind() == Kind::Spin,
        replay: |header, body, asked, _| boxed(spin::replay(header, body, asked)),
    },
];

/// The method of a name.
#[must_use]
pub fn named(name: &str) -> Option<&'static Method> {
    METHODS.iter().find(|method| method.name == name)
}

/// The method for a recording for which none was asked: the first that suits it, or else the first, which says why it
/// does not.
#[must_use]
pub fn usual(Recording { header, body, .. }: &Recording) -> &'static Method {
    METHODS.iter().find(|method| (method.suits)(header, body)).unwrap_or(&METHODS[0])
}

/// An alignment whose course a timeline shows.
pub(crate) trait Course {
    /// What it did when, from power-on: dwells, turns, or stops and drives.
    fn stretches(&self) -> Vec<Stretch>;
}

/// Whether an alignment found an azimuth.
pub(crate) fn is_answered<S>(session: &impl alignment::Method<S>) -> bool {
    matches!(session.verdict(), Some(Ok(_)))
}

fn boxed<F: Finished + 'static>(
    replay: Result<F, ReplayError>,
) -> Result<Box<dyn Finished>, ReplayError> {
    replay.map(|finished| Box::new(finished) as Box<dyn Finished>)
}
