//! Which option suits which method: what a method or mount would ignore is refused, not passed over.

use bench::methods::Method;
use clap::ArgMatches;
use clap::parser::ValueSource;

/// The options that stand on the command line, by the names of their fields.
pub struct Given(Vec<String>);

impl Given {
    /// Those of a command.
    pub fn of(matches: &ArgMatches) -> Self {
        let stands =
            |id: &&clap::Id| matches.value_source(id.as_str()) == Some(ValueSource::CommandLine);
        Self(matches.ids().filter(stands).map(ToString::to_string).collect())
    }

    /// None.
    pub fn nothing() -> Self {
        Self(Vec::new())
    }

    /// Whether this one is among them.
    pub fn has(&self, option: &str) -> bool {
        self.0.iter().any(|given| given == option)
    }

    /// The first of these that is among them.
    pub fn first(&self, options: &[&'static str]) -> Option<&'static str> {
        options.iter().find(|option| self.has(option)).copied()
    }

    /// The first that is none of these.
    pub fn beside(&self, options: &[&str]) -> Option<&str> {
        let named = |given: &&String| named(RUN, given) && !options.contains(&given.as_str());
        self.0.iter().find(named).map(String::as_str)
    }
}

/// An option as it stands on the command line.
pub fn long(option: &str) -> String {
    format!("--{}", option.replace('_', "-"))
}

/// Methods and mounts, a bit each.
pub type Methods = u16;

/// An option: the methods that take it, and why no others do.
pub struct Suit(&'static str, Methods, &'static str);

/// The name under which a method is asked for.
pub struct Named(pub Methods, pub &'static str);

/// What carries the gyro of a simulated run.
pub mod carrier {
    use super::{Methods, Named};

    const STAGE_BIT: Methods = 1;
    const FRAMES_BIT: Methods = 2;
    const TURNTABLE_BIT: Methods = 4;
    const VEHICLE_BIT: Methods = 8;
    const BODY_BIT: Methods = 16;
    const PLANNED_BIT: Methods = 32;
    /// A stage, whose positions are stated.
    pub const STAGE: Named = Named(STAGE_BIT, "--method stepwise");
    /// A stage or two frames, whose positions are planned.
    pub const PLANNED: Named = Named(PLANNED_BIT, "--method positions");
    /// Two frames.
    pub const FRAMES: Named = Named(FRAMES_BIT, "--mount two-frame");
    /// A platform that turns all the time.
    pub const TURNTABLE: Named = Named(TURNTABLE_BIT, "--method rotating");
    /// A vehicle.
    pub const VEHICLE: Named = Named(VEHICLE_BIT, "--method siap");
    /// A spinning body.
    pub const BODY: Named = Named(BODY_BIT, "--method spin");

    /// What stops at positions.
    pub(super) const STOPPING: Methods = STAGE_BIT | FRAMES_BIT | PLANNED_BIT;
    /// All but a spinning body.
    pub(super) const NORTH: Methods = STOPPING | TURNTABLE_BIT | VEHICLE_BIT;
    /// All.
    pub(super) const ALL: Methods = NORTH | BODY_BIT;
    /// What stands on a base.
    pub(super) const STANDING: Methods = STOPPING | TURNTABLE_BIT;
    /// What keeps its azimuth.
    pub(super) const KEEPING: Methods = STOPPING | VEHICLE_BIT;
    /// One.
    pub(super) const LISTED: Methods = STAGE_BIT;
    /// One with a stage.
    pub(super) const RECORDED: Methods = STAGE_BIT | PLANNED_BIT;
    /// What has stated dwells.
    pub(super) const DWELLING: Methods = STAGE_BIT | FRAMES_BIT;
    /// Two frames.
    pub(super) const FRAMED: Methods = FRAMES_BIT;
    /// What turns.
    pub(super) const TURNING: Methods = TURNTABLE_BIT;
    /// What drives.
    pub(super) const DRIVING: Methods = VEHICLE_BIT;
    /// What spins.
    pub(super) const SPINNING: Methods = BODY_BIT;
}

use carrier::{
    ALL, DRIVING, DWELLING, FRAMED, KEEPING, LISTED, NORTH, RECORDED, SPINNING, STANDING, STOPPING,
    TURNING,
};

const ROLL: &str = "the roll of a spinning body does not depend on it";
const INCLINED: &str =
    "only a stage, two frames and a turntable stand as inclined as they are told";
const PLAN: &str = "only a stage and two frames stop at positions; a platform that turns all the time has \
                    --speeds and --turns, a vehicle --stops, --stop-seconds and --drive-seconds, a spinning \
                    body --flight-seconds and --turns-per-second";
const TURNS: &str = "it is one of --method rotating";
const DRIVES: &str = "it is one of --method siap";
const SPINS: &str = "it is one of --method spin";
const KEEPS: &str = "only a stage, two frames and a vehicle keep their azimuth";
const SWAYS: &str =
    "only a stage and two frames sway as they are told; a vehicle has --fault sway-at-stops";

/// The options of `run`.
pub const RUN: &[Suit] = &[
    Suit("latitude", NORTH, ROLL),
    Suit("azimuth", NORTH, ROLL),
    Suit("pitch", STANDING, INCLINED),
    Suit("roll", STANDING, INCLINED),
    Suit("gyro", NORTH, "a spinning body has gyros of its own"),
    Suit("rate", NORTH, "a spinning body is sampled at 14400 Hz"),
    Suit("seconds", STOPPING, PLAN),
    Suit("sigma", STOPPING, PLAN),
    Suit("survey", STOPPING, PLAN),
    Suit("mount", STOPPING, "what carries the gyro follows from the method"),
    Suit(
        "passes",
        FRAMED,
        "two frames have passes; a stage has --positions, unless they are planned",
    ),
    Suit("half", STOPPING, PLAN),
    Suit("positions", LISTED, "only a stage whose positions are not planned has so many"),
    Suit("dwell", DWELLING, "only stated positions of a stage or of two frames have one"),
    Suit("sensor", TURNING, TURNS),
    Suit("speeds", TURNING, TURNS),
    Suit("turns", TURNING, TURNS),
    Suit("uneven_turns", TURNING, TURNS),
    Suit("flash", TURNING, TURNS),
    Suit("date", TURNING, TURNS),
    Suit("stops", DRIVING, DRIVES),
    Suit("stop_seconds", DRIVING, DRIVES),
    Suit("drive_seconds", DRIVING, DRIVES),
    Suit("no_displacement", DRIVING, DRIVES),
    Suit("hold", KEEPING, KEEPS),
    Suit("realign", KEEPING, KEEPS),
    Suit("handover", KEEPING, KEEPS),
    Suit("flight_seconds", SPINNING, SPINS),
    Suit("turns_per_second", SPINNING, SPINS),
    Suit("sway", STOPPING, SWAYS),
    Suit("sway_hertz", STOPPING, SWAYS),
    Suit("no_base_imu", STOPPING, SWAYS),
    Suit("seed", ALL, ""),
    Suit("method", ALL, ""),
    Suit("fault", ALL, ""),
    Suit(
        "record",
        RECORDED,
        "only a stage is recorded; a recording knows no elevation of two frames",
    ),
    Suit("report", ALL, ""),
];

/// The options of `replay` that not every method takes, and why others do not.
const REPLAY: &[(&str, &str)] = &[
    ("latitude", ROLL),
    ("criterion", "only a stage that stops has another criterion than the one"),
    ("half", "only two positions of a stage leave the half of the circle open"),
    ("displacements", "only the stops of method siap have them"),
    ("attitude_out", "only method vertical keeps an attitude"),
];

/// Refuses the first option that a method of `replay` does not take.
///
/// # Errors
/// The option, the method, and why.
pub fn check_replay(given: &Given, method: &Method) -> Result<(), String> {
    let is_ignored =
        |(option, _): &&(&str, &str)| given.has(option) && !method.takes.contains(option);
    match REPLAY.iter().find(is_ignored) {
        None => Ok(()),
        Some((option, why)) => {
            Err(format!("{}: --method {} does not take it: {why}", long(option), method.name))
        }
    }
}

/// Whether a table has the option.
fn named(table: &[Suit], option: &str) -> bool {
    table.iter().any(|Suit(name, ..)| *name == option)
}

/// Refuses the first option that the method does not take.
///
/// # Errors
/// The option, the method, and why.
pub fn check(table: &[Suit], given: &Given, method: &Named) -> Result<(), String> {
    let Named(bit, name) = method;
    let ignored = |Suit(option, methods, _): &&Suit| methods & bit == 0 && given.has(option);
    match table.iter().find(ignored) {
        None => Ok(()),
        Some(Suit(option, _, why)) => {
            Err(format!("{}: {name} does not take it: {why}", long(option)))
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::Args;

    use super::RUN;
    use crate::command::run::RunOptions;

    #[test]
    fn every_option_of_a_run_is_in_the_table_and_nothing_else() {
        let command = RunOptions::augment_args(clap::Command::new("run"));
        let mut options: Vec<_> =
            command.get_arguments().map(|arg| arg.get_id().as_str()).collect();
        let mut listed: Vec<_> = RUN.iter().map(|suit| suit.0).collect();
        options.sort_unstable();
        listed.sort_unstable();
        assert_eq!(options, listed);
    }
}
