//! Options that several platforms share.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use clap::Args;
use drivers::ads1262::configuration::DataRate;
use host::angle::Quantity;
use host::instrument::recorder::{self, Recorded, Samples};
use host::interrupt;
use host::new_file::NewFile;
use host::packed::Packed;
use host::recording::inputs::{self, Given, Writer};
use orientation::earth::Latitude;
use simulated::hold::Hold;
use simulated::scenario::{GyroClass, RATES, Scenario};

use crate::command::faults::{self, FaultChoice};
use crate::command::{OUTPUT, angle, named, seed};

/// Headings of the options, in the help.
pub const PLACE: &str = "Place";
/// As the board stands.
pub const ATTITUDE: &str = "Attitude";
/// What measures.
pub const SENSOR: &str = "Sensor";
/// What the board and its carrier do.
pub const COURSE: &str = "Course";
/// What is done after an alignment.
pub const KEEPING: &str = "Keeping";
/// What is drawn, what sways, and what goes wrong.
pub const CHANCE: &str = "Chance, disturbances and faults";

/// What writes the inputs of a run, where they are recorded.
pub type Inputs = Option<Writer<Packed>>;

/// What every platform takes.
#[derive(Args, Clone, Debug)]
pub struct Common {
    /// What fixes everything random.
    #[arg(long, default_value_t = 1, value_parser = seed, help_heading = CHANCE)]
    pub seed: u64,
    /// What goes wrong; `list` names the faults of the platform.
    #[arg(long, value_name = "NAME", value_parser = faults::parse, help_heading = CHANCE)]
    pub fault: Option<FaultChoice>,
    /// Writes a recording for `replay`: FILE.csv holds the samples of the alignment, FILE.jsonl all that the board's
    /// software took, keeping included; each also compressed, with .gz behind it. Of a flight FILE.csv alone.
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub record: Option<PathBuf>,
    /// Writes figures and tables as a page for a browser.
    #[arg(long, value_name = "FILE.html", help_heading = OUTPUT)]
    pub report: Option<PathBuf>,
}

impl Common {
    /// The file of the recording, where it is to hold inputs.
    pub fn inputs_file(&self) -> Option<&Path> {
        self.record.as_deref().filter(|path| inputs::is_named(path))
    }

    /// A place for the samples of a session, and for all inputs of its instrument, which is given this.
    ///
    /// # Errors
    /// The recording cannot be written; the words say why.
    pub fn wanted<S>(
        &self,
        place: Option<&NewFile>,
        given: Option<Given>,
    ) -> Result<(Samples<S>, Inputs), String> {
        let begin = |(place, given): (&NewFile, Given)| {
            let file = Packed::create(place.path());
            let begun = file.and_then(|file| Writer::new(file, self.seed, given));
            begun.map_err(|error| place.unwritten(&error))
        };
        let place = place.filter(|_| self.inputs_file().is_some());
        let inputs = place.zip(given).map(begin).transpose()?;
        let is_idle = self.record.is_none() || inputs.is_some();
        Ok((Samples { taken: Vec::new(), is_idle }, inputs))
    }

    /// Writes the recording of a run, where one is asked for; that of inputs has no end where the run was interrupted.
    ///
    /// # Errors
    /// The recording cannot be written; the words say why.
    pub fn write<C: Recorded>(
        place: Option<&NewFile>,
        carrier: &C,
        run: &C::Run,
        (samples, inputs): (&[C::Sample], Inputs),
    ) -> Result<(), String> {
        let (kept, truth) = carrier.end_of(run);
        let end = |inputs: Writer<Packed>| match interrupt::ended() {
            Some(_) => inputs.stop().and_then(Packed::finish),
            None => inputs.finish(kept, &truth).and_then(Packed::finish),
        };
        place.map_or(Ok(()), |place| {
            inputs
                .map_or_else(|| recorder::write(place.path(), carrier, run, samples), end)
                .map_err(|error| place.unwritten(&error))
        })
    }
}

/// Where a platform that finds north is, and with which gyro.
#[derive(Args, Clone, Debug)]
pub struct Place {
    /// Latitude, north positive: 47.58, 47°35′, 47:34:48, or 47°35′N.
    #[arg(long, value_name = "DEGREES", default_value = "47.58", value_parser = latitude, help_heading = PLACE)]
    latitude: f64,
    /// True azimuth of body x, clockwise from north, in degrees or 213°42′; the board is not given it.
    #[arg(long, value_name = "DEGREES", default_value = "213.7", value_parser = azimuth, help_heading = ATTITUDE)]
    azimuth: f64,
    /// The gyro (fog).
    #[arg(long, value_parser = named(&GYROS), help_heading = SENSOR)]
    pub gyro: Option<GyroClass>,
    /// Samples of the gyro a second: a data rate of its converter (400; of a vehicle 100).
    #[arg(long, value_name = "HERTZ", value_parser = rate, help_heading = SENSOR)]
    pub rate: Option<f64>,
}

impl Place {
    /// How a run goes on there: where the latitude has no north it ends with the refusal, for no azimuth is ever found that
    /// could be kept, unless one is given from outside.
    pub fn going_on(&self, hold: Hold) -> Hold {
        let has_north = Latitude::from_degrees(self.latitude).is_none_or(Latitude::has_north);
        let seconds = if has_north || hold.handover.is_some() { hold.seconds } else { 0.0 };
        Hold { seconds, ..hold }
    }

    /// A scenario there, everything else as usual.
    pub fn scenario(&self, seed: u64) -> Scenario {
        let usual = Scenario::usual(seed);
        Scenario {
            latitude_deg: self.latitude,
            azimuth_deg: self.azimuth.rem_euclid(360.0),
            gyro: self.gyro.unwrap_or(usual.gyro),
            sample_rate_hz: self.rate.unwrap_or(usual.sample_rate_hz),
            ..usual
        }
    }
}

/// How a base that stands is inclined.
#[derive(Args, Clone, Debug)]
pub struct Inclination {
    /// True pitch of the base in degrees, nose up positive.
    #[arg(long, value_name = "DEGREES", default_value = "0.6", value_parser = inclination::<90>, help_heading = ATTITUDE)]
    pub pitch: f64,
    /// True roll of the base in degrees, right side down positive.
    #[arg(long, value_name = "DEGREES", default_value = "-0.4", value_parser = inclination::<180>, help_heading = ATTITUDE)]
    pub roll: f64,
}

/// The classes of gyros.
static GYROS: [(GyroClass, [&str; 2]); 4] = [
    (GyroClass::FIBRE_OPTIC, ["fog", "Fibre-optic: N 0.001 °/√h, B 0.007 °/h"]),
    (
        GyroClass::FIBRE_OPTIC_COARSE,
        ["fog-coarse", "Fibre-optic, lower grade: N 0.02 °/√h, B 0.1 °/h"],
    ),
    (
        GyroClass::MICROMECHANICAL_FINE,
        ["mems-fine", "The best micromechanical: N 0.036 °/√h, B 0.3 °/h"],
    ),
    (
        GyroClass::MICROMECHANICAL,
        ["mems", "Micromechanical, tactical grade: N 0.15 °/√h, B 0.5 °/h"],
    ),
];

fn latitude(text: &str) -> Result<f64, String> {
    within(90.0, angle(text, Quantity::Latitude)?)
}

/// An azimuth in degrees, east of north, or west of it with a minus.
pub fn azimuth(text: &str) -> Result<f64, String> {
    within(360.0, angle(text, Quantity::Azimuth)?)
}

fn inclination<const LIMIT: u16>(text: &str) -> Result<f64, String> {
    within(f64::from(LIMIT), angle(text, Quantity::Other)?)
}

fn within(limit: f64, angle: f64) -> Result<f64, String> {
    if angle.abs() <= limit { Ok(angle) } else { Err(format!("outside ±{limit}°")) }
}

fn rate(text: &str) -> Result<f64, String> {
    let rates = RATES.map(DataRate::hertz);
    let known = rates.map(|rate| rate.to_string()).join(", ");
    let rate = text.parse::<f64>().ok().filter(|rate| rates.contains(rate));
    rate.ok_or_else(|| format!("not one of the converter's rates: {known}"))
}

/// A parser of a number in a range, of what the words name.
pub fn number(
    range: RangeInclusive<f64>,
    what: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.parse::<f64>() {
        Ok(number) if range.contains(&number) => Ok(number),
        _ => Err(format!("not {what} from {} to {}", range.start(), range.end())),
    }
}

/// A parser of a time in a range, s.
pub fn seconds(range: RangeInclusive<f64>) -> impl Fn(&str) -> Result<f64, String> + Clone {
    number(range, "a number of seconds")
}
