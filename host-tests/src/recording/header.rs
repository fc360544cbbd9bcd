//! The header of a recording: `# key: value` lines above the column names.
//!
//! What a solver may know becomes a [`Header`]; `truth_*` keys go to [`Truth`] while the lines are
//! read, so no other type ever holds them. Unknown keys, and comments without a colon, are skipped.

use super::checksum::Checksum;
use super::error::Fault;
use super::number::{angle, number, pair};
use super::problem::Problem;
use super::range::Range;
use super::resemblance::resembled;
use super::warning::{self, About, Warning};
use crate::angle::Quantity;

/// What the header says about the site and the instrument. A key that is absent is `None`: a noise
/// coefficient is then estimated, an uncertainty taken as zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Header {
    /// Latitude, °, north positive, [−90, 90].
    pub latitude_deg: Option<f64>,
    /// Sample rate, Hz, (0, 10⁶].
    pub rate_hz: Option<f64>,
    /// Angle random walk N, °/√h, ≥ 0.
    pub gyro_n_deg_sqrt_h: Option<f64>,
    /// Bias instability B, °/h, ≥ 0.
    pub gyro_b_deg_h: Option<f64>,
    /// Rate random walk K, °/h/√h, ≥ 0.
    pub gyro_k_deg_h_sqrt_h: Option<f64>,
    /// Rate ramp R, °/h², ≥ 0.
    pub gyro_r_deg_h2: Option<f64>,
    /// 1σ of the gyro's bias from start to start, °/h, ≥ 0.
    pub gyro_bias_deg_h: Option<f64>,
    /// 1σ of the gyro's relative scale error, [0, 1].
    pub gyro_scale_sigma: Option<f64>,
    /// 1σ of the accelerometer's bias from start to start, m/s², ≥ 0.
    pub accelerometer_bias_m_s2: Option<f64>,
    /// g-sensitivity along the sensitive axis and across it (`k_s`, `k_o`), °/h/g.
    pub g_sensitivity_deg_h_g: Option<[f64; 2]>,
    /// 1σ of each of the two, °/h/g, ≥ 0.
    pub g_sensitivity_sigma_deg_h_g: Option<f64>,
    /// 1σ of the stage encoder's zero, as it turns the azimuth, °, ≥ 0.
    pub encoder_zero_sigma_deg: Option<f64>,
    /// The principle of the sensor.
    pub sensor: Option<Sensor>,
    /// When the vehicle stood, from … to, s, one after the other; at least one.
    pub stops_s: Option<Vec<[f64; 2]>>,
    /// How far each stop lies from the first, north and east, m; as many as the stops where both are there.
    pub displacements_m: Option<Vec<[f64; 2]>>,
    /// What the session of a run was given, as [`super::Given`] reads it.
    pub session: Option<String>,
}

/// The principle of the rate sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// A gyroscope.
    Gyro,
    /// A molecular-electronic rate sensor.
    Met,
}

/// What a simulator or a reference instrument knows, for checking a result only: a solver must
/// never be given this.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Truth {
    /// `truth_azimuth_deg`: azimuth of body x at the end, °; `None` when absent or `nan`.
    pub azimuth_deg: Option<f64>,
    /// `truth_start_azimuth_deg`: the same at the beginning.
    pub start_azimuth_deg: Option<f64>,
    /// `truth_roll_rad`: the roll of a spinning body at each row, whole turns counted, rad; not a number where
    /// it is not known, empty where the recording has no such column.
    pub roll_rad: Vec<f64>,
    /// `truth_qw`, `truth_qx`, `truth_qy`, `truth_qz`: the attitude at each row of kind `imu`, forward, right,
    /// down to north, east, down up to a constant heading; none where it is not known or where `moving` is 0,
    /// empty where the recording has no such columns.
    pub attitude: Vec<Option<[f64; 4]>>,
    /// The other `truth_*` keys and their text, in the order of the file.
    pub others: Vec<(String, String)>,
}

/// Most `truth_*` keys: they are the only ones kept without being known.
const MAX_TRUTH_KEYS: usize = 1000;

/// The key of a vehicle's stops.
pub(super) const STOPS: &str = "stops_s";
/// The key of their displacements.
pub(super) const DISPLACEMENTS: &str = "displacements_north_east_m";
/// Keys whose value is not one number.
const WORDS: [&str; 7] = ["kind", LATITUDE, PAIR, "sensor", STOPS, DISPLACEMENTS, SESSION];
/// The key of the latitude, which may stand in degrees, minutes and seconds.
const LATITUDE: &str = "latitude_deg";
pub(super) const SESSION: &str = "session";
const PAIR: &str = "g_sensitivity_deg_h_g";
/// Keys of the truth that are looked at.
const TRUTHS: [&str; 2] = ["truth_azimuth_deg", "truth_start_azimuth_deg"];

/// Larger than any gyro that could find north, small enough that squares stay finite.
const LARGEST: f64 = 1e6;
const SIGNED: Range = Range::symmetric(LARGEST, " °/h/g");
const AZIMUTHS: Range = Range::symmetric(360.0, "°");
const LATITUDES: Range = Range::symmetric(90.0, "°");

/// A key whose value is one number: its name, its range, and where it goes.
type NumberKey = (&'static str, Range, fn(&mut Header) -> &mut Option<f64>);

static NUMBERS: [NumberKey; 10] = [
    ("rate_hz", Range::above_zero(1e6, " Hz"), |h| &mut h.rate_hz),
    ("gyro_N_deg_sqrt_h", Range::from_zero(LARGEST, " °/√h"), |h| &mut h.gyro_n_deg_sqrt_h),
    ("gyro_B_deg_h", Range::from_zero(LARGEST, " °/h"), |h| &mut h.gyro_b_deg_h),
    ("gyro_K_deg_h_sqrt_h", Range::from_zero(LARGEST, " °/h/√h"), |h| {
        &mut h.gyro_k_deg_h_sqrt_h
    }),
    ("gyro_R_deg_h2", Range::from_zero(LARGEST, " °/h²"), |h| &mut h.gyro_r_deg_h2),
    ("gyro_bias_deg_h", Range::from_zero(LARGEST, " °/h"), |h| &mut h.gyro_bias_deg_h),
    ("gyro_scale_sigma", Range::from_zero(1.0, ""), |h| &mut h.gyro_scale_sigma),
    ("accelerometer_bias_m_s2", Range::from_zero(2147.0, " m/s²"), |h| {
        &mut h.accelerometer_bias_m_s2
    }),
    ("g_sensitivity_sigma_deg_h_g", Range::from_zero(LARGEST, " °/h/g"), |h| {
        &mut h.g_sensitivity_sigma_deg_h_g
    }),
    ("encoder_zero_sigma_deg", Range::from_zero(180.0, "°"), |h| &mut h.encoder_zero_sigma_deg),
];

/// One header line.
#[derive(Debug)]
struct Entry {
    line: u64,
    key: String,
    value: String,
}

/// The header lines that matter, while they are collected.
#[derive(Debug, Default)]
pub(super) struct Collector {
    known: Vec<Entry>,
    truth: Vec<Entry>,
    /// Unknown keys, each with its line and the known one that it resembles.
    resembling: Vec<(u64, String, &'static str)>,
}

/// The key and value of a comment line, without its `#`; `None` for a plain remark.
pub(super) fn key_and_value(comment: &str) -> Option<(&str, &str)> {
    let (key, value) = comment.trim_start_matches('#').split_once(':')?;
    Some((key.trim_ascii(), value.trim_ascii()))
}

/// Whether the key bears on how a recording is read.
fn is_known(key: &str) -> bool {
    WORDS.contains(&key) || NUMBERS.iter().any(|(name, ..)| *name == key)
}

/// Checksum of a run's header with what its session was given: over all keys that bear on how the recording is read.
pub(super) fn checksum<'a>(
    keys: impl Iterator<Item = (&'a str, &'a str)>,
    session: &'a str,
) -> String {
    let mut sum = Checksum::default();
    let keys = keys.filter(|(key, _)| is_known(key) && *key != SESSION);
    keys.chain([(SESSION, session)]).for_each(|(key, value)| sum.add(&format!("{key}:{value}")));
    sum.digits()
}

/// The names of all keys that are looked at.
fn names() -> impl Iterator<Item = &'static str> + Clone {
    WORDS.into_iter().chain(TRUTHS).chain(NUMBERS.iter().map(|(name, ..)| *name))
}

/// Refuses a comment below the column names that says what only the header may say: skipping it
/// would lose, say, the noise of a recording without a word. Other comments there are skipped.
pub(super) fn check_late(line: u64, comment: &str) -> Result<(), Fault> {
    match key_and_value(comment) {
        Some((key, _)) if is_known(key) => Err(Fault::key(line, key, Problem::Late)),
        _ => Ok(()),
    }
}

impl Collector {
    /// Takes one comment line of the header.
    pub fn add(&mut self, line: u64, comment: &str) -> Result<(), Fault> {
        let Some((key, value)) = key_and_value(comment) else { return Ok(()) };
        if !is_known(key) && self.resembling.len() < warning::MOST {
            let resembled = resembled(key, names());
            self.resembling.extend(resembled.map(|known| (line, key.to_owned(), known)));
        }
        let entries = match key {
            _ if is_known(key) => &mut self.known,
            _ if key.starts_with("truth_") => &mut self.truth,
            _ => return Ok(()),
        };
        match entries.iter().find(|entry| entry.key == key) {
            Some(before) if before.value == value => return Ok(()),
            Some(before) => return Err(contradiction(line, before, value)),
            None if entries.len() < MAX_TRUTH_KEYS => {}
            None => {
                let most = Problem::TooMany(MAX_TRUTH_KEYS as u64, "truth_ keys");
                return Err(Fault::line(line, most));
            }
        }
        entries.push(Entry { line, key: key.to_owned(), value: value.to_owned() });
        Ok(())
    }

    /// The line and text of a known key.
    pub fn get(&self, key: &str) -> Option<(u64, &str)> {
        self.known.iter().find(|entry| entry.key == key).map(|e| (e.line, e.value.as_str()))
    }

    /// The line of a known key; that of the file's beginning where it is absent.
    pub fn line(&self, key: &str) -> u64 {
        self.get(key).map_or(1, |(line, _)| line)
    }

    /// The unknown key that resembles this one, and its line.
    pub fn resembling(&self, known: &str) -> Option<(u64, &str)> {
        let found = self.resembling.iter().find(|(.., resembled)| *resembled == known);
        found.map(|(line, key, _)| (*line, key.as_str()))
    }

    /// What is to be said of unknown keys.
    pub fn warnings(&self) -> Vec<Warning> {
        let warning = |(line, key, known): &(u64, String, &'static str)| Warning {
            line: *line,
            about: About::Key(key.clone(), known),
        };
        self.resembling.iter().map(warning).collect()
    }

    /// What a solver may know.
    pub fn header(&self) -> Result<Header, Fault> {
        let mut header = Header::default();
        for (name, range, slot) in &NUMBERS {
            *slot(&mut header) = self.parse(name, |text| number(text, range))?;
        }
        header.latitude_deg =
            self.parse(LATITUDE, |text| angle(text, Quantity::Latitude, &LATITUDES))?;
        header.g_sensitivity_deg_h_g =
            self.parse(PAIR, |text| pair(text, &SIGNED, Problem::NotAPair))?;
        header.sensor = self.parse("sensor", sensor)?;
        header.session = self.parse(SESSION, |text| self.unchanged(text))?;
        Ok(header)
    }

    /// What a session was given, behind the checksum that the run wrote.
    fn unchanged(&self, text: &str) -> Result<String, Problem> {
        let keys = self.known.iter().map(|entry| (entry.key.as_str(), entry.value.as_str()));
        let (sum, session) = text.split_once(' ').unwrap_or_default();
        let is_unchanged = sum == checksum(keys, session);
        is_unchanged.then(|| session.to_owned()).ok_or(Problem::Changed)
    }

    /// What only a check may know.
    pub fn truth(self) -> Result<Truth, Fault> {
        let mut truth = Truth::default();
        for Entry { line, key, value } in self.truth {
            let slot = match key.as_str() {
                "truth_azimuth_deg" => &mut truth.azimuth_deg,
                "truth_start_azimuth_deg" => &mut truth.start_azimuth_deg,
                _ => {
                    truth.others.push((key, value));
                    continue;
                }
            };
            *slot = azimuth(&value).map_err(|problem| Fault::key(line, &key, problem))?;
        }
        Ok(truth)
    }

    /// Parses a known key's value; `None` when the key is absent.
    pub fn parse<T>(
        &self,
        key: &str,
        parse: impl Fn(&str) -> Result<T, Problem>,
    ) -> Result<Option<T>, Fault> {
        let Some((line, text)) = self.get(key) else { return Ok(None) };
        parse(text).map(Some).map_err(|problem| Fault::key(line, key, problem))
    }
}

/// The key has another value further up.
fn contradiction(line: u64, before: &Entry, value: &str) -> Fault {
    let problem = Problem::Contradiction(value.to_owned(), before.value.clone(), before.line);
    Fault::key(line, &before.key, problem)
}

/// The sensor's name.
fn sensor(text: &str) -> Result<Sensor, Problem> {
    match text {
        "gyro" => Ok(Sensor::Gyro),
        "met" => Ok(Sensor::Met),
        other => Err(Problem::UnknownSensor(other.to_owned())),
    }
}

/// The true azimuth; a truth may be `nan`, which says that it is not known.
fn azimuth(text: &str) -> Result<Option<f64>, Problem> {
    match angle(text, Quantity::Azimuth, &AZIMUTHS) {
        Ok(value) => Ok(Some(value)),
        Err(Problem::Nan(_)) => Ok(None),
        Err(problem) => Err(problem),
    }
}
