//! The configuration of the instrument: mechanics and sampling rates.
//!
//! All values are read once at the start. Angles are in rad, rates in rad/s, unless a line says
//! otherwise.

use embassy_time::Duration;
use orientation::alignment::stepwise::mount::{FrameAngles, LIMIT, MountError, Station, TwoFrame};
use orientation::units::{DEGREE, MetresPerSecondSquared, Radians};

use crate::calibration::Harmonics;
use crate::ports::Frames;

/// Mechanics of the stage, and tolerances and time limits of its movements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageConfiguration {
    /// Stage angle at which the index switch closes, rad; the switch stays closed below this angle.
    pub index: f64,
    /// Largest difference between this angle and the encoder after homing, rad. It limits the error
    /// of the encoder's zero, which goes into the azimuth in full.
    pub index_tolerance: f64,
    /// Angle at which the stage waits for the session, rad: the first position, so that the session
    /// begins without a movement.
    pub home: f64,
    /// Lowest and highest permitted angle, rad.
    pub travel: [f64; 2],
    /// Rate of the search for the index, rad/s.
    pub seek_rate: f64,
    /// Distance from the target that is not corrected, rad; must be less than the session's
    /// `arrival`.
    pub tolerance: f64,
    /// Largest permitted difference between motor and encoder, rad: backlash, error of the encoder
    /// and one step of either. It must exceed the backlash and stay below what the azimuth's σ
    /// permits.
    pub agreement: f64,
    /// Time for vibrations to decay after the motor has stopped, before the encoder's angle is
    /// used.
    pub settle: Duration,
    /// Time limit of any single movement; the stage is given up beyond it.
    pub longest: Duration,
}

impl Default for StageConfiguration {
    /// Index at −5°, home at 0°, travel from −10° to 370° (the cables are wound up by at most about
    /// one turn), search at 12°/s, target reached within 0.03°, motor and encoder within 0.05°,
    /// 0.25 s of settling, 60 s for any movement.
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

/// Tolerances of a turntable, a platform that turns continuously on a slip ring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurntableConfiguration {
    /// Platform angles at which the index mark begins to close its switch as the platform turns
    /// clockwise and counter-clockwise, rad, as the encoder showed them when its zero was set.
    /// They are the only angles that do not come from the encoder, so they alone can show that it has
    /// slipped while the board was off.
    pub index: [f64; 2],
    /// Largest permitted change of the difference between motor and encoder from one turn to the
    /// next, and of encoder and index, rad: backlash, the residual of the encoder's calibration, and
    /// the time between the two readings. This check finds coarse slips only; slips as small as the azimuth's σ
    /// are found by the session from the turns themselves.
    pub agreement: f64,
    /// Time for vibrations to decay after the motor has stopped, before the encoder's angle is
    /// used.
    pub settle: Duration,
}

impl Default for TurntableConfiguration {
    /// Index from 30° to 40°, motor and encoder within 0.15°, 0.25 s of settling.
    fn default() -> Self {
        let index = [30.0 * DEGREE, 40.0 * DEGREE];
        Self { index, agreement: 0.15 * DEGREE, settle: Duration::from_millis(250) }
    }
}

/// The two frames of a two-frame mount: geometry, encoders, drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FramesConfiguration {
    /// Calibrated geometry of the mount.
    geometry: TwoFrame,
    /// Frame angles of each entry of [`STATIONS`], rad, computed once at the start.
    stations: [FrameAngles; STATIONS.len()],
    /// Harmonic errors of the two encoders.
    pub encoders: Frames<Harmonics>,
    /// Standard deviation of the biases of the accelerometer on the base, 1σ.
    pub force_bias_sigma: MetresPerSecondSquared,
    /// The two drives. The waiting position and the travel follow from the geometry.
    pub drives: Frames<StageConfiguration>,
    /// Time for which neither frame may have moved before samples are used. The frames turn the
    /// gyro about its own sensitive axis, unlike a stage, so the gyro senses their ringing long
    /// after the encoders resolve it.
    pub rest: Duration,
}

/// The orientations of the mount: four headings with a horizontal sensitive axis, and the vertical
/// one in which the azimuth is stored.
const STATIONS: [Station; 5] =
    [Station::Forward, Station::Right, Station::Backward, Station::Left, Station::Storage];

/// The default settling time: frames that ring at 15 Hz with a damping ratio of 0.08 then turn by
/// less than 0.02 °/h.
const FRAMES_REST: Duration = Duration::from_millis(1500);

/// True angle at which a frame's index switch closes, rad; the switch stays closed below it.
const FRAME_INDEX: f64 = -95.0 * DEGREE;

impl FramesConfiguration {
    /// Default drives with a calibrated geometry, calibrated encoders and a calibrated accelerometer:
    /// index at −95°, travel of ±[`LIMIT`].
    ///
    /// # Errors
    /// A geometry with which the sensitive axis cannot be brought to one of the orientations.
    pub fn new(
        geometry: TwoFrame,
        encoders: Frames<Harmonics>,
        force_bias_sigma: MetresPerSecondSquared,
    ) -> Result<Self, MountError> {
        let drive = |zero: Radians| StageConfiguration {
            index: FRAME_INDEX + zero.0,
            travel: [-LIMIT.0, LIMIT.0],
            ..StageConfiguration::default()
        };
        let mut stations = [FrameAngles::default(); STATIONS.len()];
        for (angles, station) in stations.iter_mut().zip(STATIONS) {
            *angles = geometry.angles(station)?;
        }
        let zeros = Frames { outer: geometry.outer_zero, inner: geometry.inner_zero };
        let drives = zeros.map(drive);
        Ok(Self { geometry, stations, encoders, force_bias_sigma, drives, rest: FRAMES_REST })
    }

    /// The calibrated geometry of the mount.
    #[must_use]
    pub fn geometry(&self) -> TwoFrame {
        self.geometry
    }

    /// The frame angles of an orientation, rad.
    #[must_use]
    pub fn angles(&self, station: Station) -> FrameAngles {
        self.stations[station as usize]
    }
}

/// The configuration of an instrument on a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Sampling rate of the precise gyro, Hz.
    pub sample_rate: f64,
    /// Decimation of the accelerometer: one reading in this many samples of the gyro, ≥ 1.
    pub force_divider: u32,
    /// Decimation of the encoder: one reading in this many samples of the gyro, ≥ 1.
    pub angle_divider: u32,
    /// Harmonic error of the encoder.
    pub encoder: Harmonics,
    /// Mechanics of the stage.
    pub stage: StageConfiguration,
}

/// Rate at which the accelerometer is read, Hz. An alignment uses only the mean over a dwell.
const FORCE_RATE: f64 = 100.0;
/// Rate at which the encoder is read, Hz. At 20 °/s the stage turns 0.1° between two readings.
const ANGLE_RATE: f64 = 200.0;

impl Configuration {
    /// The default board with a gyro of `sample_rate` samples per second, Hz.
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
}

/// The sampling period at a sampling rate, Hz: in µs, rounded to nearest.
#[must_use]
pub fn period(sample_rate: f64) -> u32 {
    libm::round(1e6 / sample_rate) as u32
}

/// The sampling period at a sampling rate, Hz, at least one: in ns, rounded to nearest.
#[must_use]
pub fn nanoseconds(sample_rate: f64) -> u32 {
    libm::round(1e9 / sample_rate) as u32
}

/// The configuration of a strapdown instrument in a vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VehicleConfiguration {
    /// Sampling rate of each gyro, Hz.
    pub sample_rate: f64,
    /// Decimation of the accelerometer: one reading in this many samples of the gyros, ≥ 1.
    pub force_divider: u32,
    /// Number of accelerometer readings that are averaged before the session gets them, ≥ 1.
    pub forces: u32,
}

/// Highest rate at which the accelerometer of a vehicle is read, Hz. Its measurement turns with the
/// vehicle, so its filter may delay it by milliseconds only and its bandwidth must not be narrow.
const VEHICLE_FORCE_RATE: f64 = 400.0;
/// Rate at which the session gets averaged specific forces, Hz; not higher than the rate at which
/// it integrates the attitude.
const MEAN_FORCE_RATE: f64 = 100.0;

impl VehicleConfiguration {
    /// The default board with gyros of `sample_rate` samples per second, Hz.
    #[must_use]
    pub fn at(sample_rate: f64) -> Self {
        let ratio = |rate: f64, to: f64| (libm::round(rate / to) as u32).max(1);
        let force_divider = ratio(sample_rate, VEHICLE_FORCE_RATE);
        let forces = ratio(sample_rate / f64::from(force_divider), MEAN_FORCE_RATE);
        Self { sample_rate, force_divider, forces }
    }
}
