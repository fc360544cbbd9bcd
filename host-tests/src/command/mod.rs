//! The commands of the program, one file each: options in, [`Told`] out.

pub mod allan;
pub mod campaign;
pub mod driving;
pub mod emulate;
pub mod keeping;
pub mod plan;
pub mod replay;
pub mod run;
pub mod spinning;
pub mod turning;

use std::fmt;
use std::io::Write;
use std::path::Path;

use bench::report::Report;
use clap::ValueEnum;
use orientation::align::setting;
use orientation::earth::Latitude;
use serde::Serialize;

/// What came of a command, ready to print.
pub struct Told {
    /// Whether there was a result.
    pub found: bool,
    /// For standard output.
    pub output: String,
    /// Why there was none.
    pub refusal: Option<String>,
}

impl Told {
    /// The object, or the text that a writer makes.
    fn of(
        found: bool,
        as_json: bool,
        object: &impl Serialize,
        text: impl FnOnce(&mut String) -> fmt::Result,
    ) -> Result<Self, String> {
        let mut output = String::new();
        if as_json {
            output = serde_json::to_string_pretty(object).map_err(|error| error.to_string())?;
        } else {
            text(&mut output).map_err(|error| error.to_string())?;
        }
        Ok(Self { found, output, refusal: None })
    }
}

/// The half of the circle in which an azimuth lies.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Half {
    /// 0° to 180°.
    East,
    /// 180° to 360°.
    West,
}

impl From<Half> for setting::Half {
    fn from(half: Half) -> Self {
        match half {
            Half::East => Self::East,
            Half::West => Self::West,
        }
    }
}

/// A latitude in degrees.
fn latitude(text: &str) -> Result<Latitude, String> {
    let degrees: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    Latitude::from_degrees(degrees).ok_or_else(|| "outside ±90°".to_owned())
}

/// A standard deviation in degrees, as radians.
fn sigma(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if degrees > 0.0 && degrees <= 180.0 => Ok(degrees.to_radians()),
        _ => Err("not a number of degrees above 0, at most 180".to_owned()),
    }
}

impl Told {
    /// The same with a page for `--report`, where one was asked for. A page that cannot be written is a
    /// failure, but the rest is not lost with it.
    fn with_page(self, path: Option<&Path>, page: impl FnOnce() -> Report) -> Self {
        match path.map(|path| page().write(path)) {
            Some(Err(error)) => {
                Self { found: false, refusal: self.refusal.or(Some(error.to_string())), ..self }
            }
            _ => self,
        }
    }
}

/// Writes to standard output; a closed pipe is no error of ours.
pub fn print(output: &str) -> Result<(), String> {
    match writeln!(std::io::stdout(), "{output}") {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error.to_string()),
        _ => Ok(()),
    }
}
