//! What the instrument must know of its board before it begins.

use embassy_time::Duration;
use orientation::align::mount::{FrameAngles, LIMIT, MountError, Station, TwoFrame};
use orientation::keep;
use orientation::units::DEGREE;

use crate::calibration::Harmonics;
use crate::ports::Frames;

/// The stage's mechanics and how patiently it is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageConfiguration {
    /// Stage angle at which the index switch closes, rad; it stays closed below.
    pub index: f64,
    /// How far from there the encoder may stand after the stage has stopped, rad: what a wrong zero of
    /// the encoder may cost in azimuth.
    pub index_tolerance: f64,
    /// Where the stage waits for the session, rad: the first position, so that no time is lost.
    pub home: f64,
    /// Travel from lowest to highest angle, rad.
    pub travel: [f64; 2],
    /// Rate of the search for the index, rad/s.
    pub seek_rate: f64,
    /// Distance from the target that needs no correction, rad; less than the session's `arrival`.
    pub tolerance: f64,
    /// What motor and encoder may differ by, rad: backlash, the encoder's error, a step of either.
    /// Less than the azimuth's σ lets pass, more than the backlash.
    pub agreement: f64,
    /// Rest after the motor has stopped, before the encoder is believed.
    pub settle: Duration,
    /// Longest time for any single movement.
    pub longest: Duration,
}

impl Default for StageConfiguration {
    /// Index at −5°, home at 0°, travel −10°…370° (cables wrap), search at 12°/s, within 0.03° of the
    /// target, motor and encoder within 0.05°, a quarter of a second of rest, 60 s for any movement.
    fn default() -> Self {
        Self {
            index: -5.0 * DEGREE,
            index_tolerance: 0.05 * DEGREE,
            home: 0.0,
            travel: [-10.0 * DEGREE, 370.0 * DEGREE],
            seek_rate: 12.0 * DEGREE,
            tolerance: 0.03 * DEGREE,
            agreement: 0.05 * DEGREE,
            settle: Duration::from_millis(250),
            longest: Duration::from_secs(60),
        }
    }
}

/// A platform on a slip ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurntableConfiguration {
    /// What motor and encoder may differ by from one turn to the next, rad: play, what the encoder's
    /// calibration leaves, the time between two readings. Less than the azimuth's σ lets pass is out of
    /// reach here; the session finds slower and smaller slips by its turns.
    pub agreement: f64,
    /// Rest after the motor has stopped, before the encoder is believed.
    pub settle: Duration,
}

impl Default for TurntableConfiguration {
    /// Motor and encoder within 0.15°, a quarter of a second of rest.
    fn default() -> Self {
        Self { agreement: 0.15 * DEGREE, settle: Duration::from_millis(250) }
    }
}

/// The two frames of a mount: geometry, encoders, drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FramesConfiguration {
    geometry: TwoFrame,
    stations: [FrameAngles; STATIONS.len()],
    /// What the encoders show beyond the true angles.
    pub encoders: Frames<Harmonics>,
    /// The drives; where they wait and how far they turn is the geometry's.
    pub drives: Frames<StageConfiguration>,
    /// For how long neither frame may have moved before samples count. Unlike a stage, the frames turn
    /// the gyro about its own axis, so it feels how they ring long after the encoders do.
    pub rest: Duration,
}

/// Where a mount stands.
const STATIONS: [Station; 5] =
    [Station::Forward, Station::Right, Station::Backward, Station::Left, Station::Storage];

/// The default rest: frames that ring at 15 Hz, damped by 0.08, then turn by less than 0.02 °/h.
const FRAMES_REST: Duration = Duration::from_millis(1500);

/// True angle at which a frame's index switch closes, rad; it stays closed below.
const FRAME_INDEX: f64 = -95.0 * DEGREE;

impl FramesConfiguration {
    /// The default drives with encoders and a geometry as they are calibrated: index at −95°, travel
    /// as [`LIMIT`] has it.
    ///
    /// # Errors
    /// A geometry that does not let the axis stand where it must.
    pub fn new(geometry: TwoFrame, encoders: Frames<Harmonics>) -> Result<Self, MountError> {
        let drive = |zero| StageConfiguration {
            index: FRAME_INDEX + zero,
            travel: [-LIMIT, LIMIT],
            ..StageConfiguration::default()
        };
        let mut stations = [FrameAngles::default(); STATIONS.len()];
        for (angles, station) in stations.iter_mut().zip(STATIONS) {
            *angles = geometry.angles(station)?;
        }
        let zeros = Frames { outer: geometry.outer_zero, inner: geometry.inner_zero };
        Ok(Self { geometry, stations, encoders, drives: zeros.map(drive), rest: FRAMES_REST })
    }

    /// How the mount is calibrated.
    #[must_use]
    pub fn geometry(&self) -> TwoFrame {
        self.geometry
    }

    /// The angles of a station.
    #[must_use]
    pub fn angles(&self, station: Station) -> FrameAngles {
        self.stations[station as usize]
    }
}

/// The instrument's configuration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Samples of the precise gyro a second, Hz.
    pub sample_rate: f64,
    /// The accelerometer is read with every so-manieth sample, ≥ 1.
    pub force_divider: u32,
    /// The encoder is read with every so-manieth sample, ≥ 1.
    pub angle_divider: u32,
    /// What the encoder shows beyond the true angle.
    pub encoder: Harmonics,
    /// The stage.
    pub stage: StageConfiguration,
}

/// Rate at which the accelerometer is read, Hz; its mean is all that an alignment needs.
const FORCE_RATE: f64 = 100.0;
/// Rate at which the encoder is read, Hz: the stage turns 0.1° between two readings.
const ANGLE_RATE: f64 = 200.0;

impl Configuration {
    /// The default board with a gyro of so many samples a second.
    #[must_use]
    pub fn at(sample_rate: f64) -> Self {
        let divider = |rate: f64| (libm::round(sample_rate / rate) as u32).max(1);
        Self {
            sample_rate,
            force_divider: divider(FORCE_RATE),
            angle_divider: divider(ANGLE_RATE),
            encoder: Harmonics::default(),
            stage: StageConfiguration::default(),
        }
    }

    /// The sample period, µs, to nearest.
    #[must_use]
    pub fn period(&self) -> u32 {
        libm::round(1e6 / self.sample_rate) as u32
    }
}

/// An instrument that is fixed to a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleConfiguration {
    /// Samples of each gyro a second, Hz.
    pub sample_rate: f64,
    /// The accelerometer is read with every so-manieth sample, ≥ 1.
    pub force_divider: u32,
    /// So many of its readings make the mean that the session gets, ≥ 1.
    pub forces: u32,
}

/// Greatest rate at which the accelerometer of a vehicle is read, Hz: what it feels turns with the vehicle,
/// so its filter may delay it by milliseconds only, and must not be too narrow.
const VEHICLE_FORCE_RATE: f64 = 400.0;
/// Rate at which the session gets their means, Hz, no more often than it carries the attitude on.
const MEAN_FORCE_RATE: f64 = 100.0;

impl VehicleConfiguration {
    /// The default board with gyros of so many samples a second.
    #[must_use]
    pub fn at(sample_rate: f64) -> Self {
        let ratio = |rate: f64, to: f64| (libm::round(rate / to) as u32).max(1);
        let force_divider = ratio(sample_rate, VEHICLE_FORCE_RATE);
        let forces = ratio(sample_rate / f64::from(force_divider), MEAN_FORCE_RATE);
        Self { sample_rate, force_divider, forces }
    }

    /// The sample period, µs, to nearest.
    #[must_use]
    pub fn period(&self) -> u32 {
        libm::round(1e6 / self.sample_rate) as u32
    }
}

/// What is done about the azimuth once it is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Realignment {
    /// It ages until somebody hands another over.
    Never,
    /// On a stage or two frames: wherever the vehicle has stood for so long, it is aligned anew.
    AtStops {
        /// How long.
        after: Duration,
    },
    /// In a vehicle: the stop that ended one session begins the next.
    BetweenStops,
}

/// Whether north is looked for where the azimuth is known already: handed over, or recalled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Alignment {
    /// It is; what is found is compared with what is known.
    Always,
    /// It is not.
    UnlessKnown,
}

/// How the instrument goes on after its alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeepConfiguration {
    /// For how long; zero for not at all, [`Duration::MAX`] for ever.
    pub hold: Duration,
    /// What is done at stops.
    pub realignment: Realignment,
    /// Whether the session itself knows when the vehicle stands, as that from stop to stop does. Any other
    /// one is of no use where the vehicle drives on before it is over.
    pub knows_stops: bool,
    /// What is done where the azimuth is known from elsewhere.
    pub alignment: Alignment,
    /// The gyro about the down axis beside the two others.
    pub beside: keep::Gyro,
    /// The precise gyro, which shows the down axis once a mount has turned it to the vertical.
    pub precise: keep::Gyro,
}
