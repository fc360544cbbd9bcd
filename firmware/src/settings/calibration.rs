//! Calibrations of the carriers: what was measured of an instrument, or stands in the test sheets of its sensors. They
//! belong to one instrument alone, and so does a record that has them.
//!
//! The defaults are those of an instrument that was not calibrated. Too small a σ makes σ of the azimuth too small: if it is
//! uncertain, take the greater one.

use core::fmt::Debug;

use orientation::alignment::rotating::Sensor;
use orientation::alignment::setup::{SetupError, check_ranges};
use orientation::alignment::stepwise::mount::TwoFrame;
use orientation::units::{
    DEGREE, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, DEGREES_PER_RADIAN, GSensitivity,
    MetresPerSecondSquared, Radians, RadiansPerRootSecond, RadiansPerSecond,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::names::{DEGREES, List, Named, PARTS, Unit};
use crate::calibration::Harmonics;
use crate::spin::configuration::{Channel, SpinConfiguration};

/// A thousandth of standard gravity, m/s².
const MILLI_G: f64 = 9.80665e-3;

/// g-sensitivities: °/h/g, to what turns an azimuth at 48° by 0.2″.
const KAPPA: Unit = Unit { places: 5, si: DEGREE_PER_HOUR };
/// Biases of accelerometers: thousandths of standard gravity, to what tilts a platform by 0.02″.
const BIAS: Unit = Unit { places: 4, si: MILLI_G };
/// Errors of an encoder and angles of frames: degrees, to 0.04″. Single precision holds that up to 90°.
const FINE: Unit = Unit { places: 5, si: DEGREE };
/// Scale factors of a spinning body's gyros: V per °/s, to a millionth of 10⁻⁶.
const RATE_SCALE: Unit = Unit { places: 12, si: DEGREES_PER_RADIAN };
/// Scale factors of its accelerometers: V per m/s², to a thousandth of 10⁻⁶.
const FORCE_SCALE: Unit = Unit { places: 9, si: 1.0 };
/// Limits of its gyros, °/s.
const RATE: Unit = Unit { places: 2, si: DEGREE };
/// Limits of its accelerometers, m/s².
const FORCE: Unit = Unit { places: 2, si: 1.0 };
/// Angle random walk, °/√h.
const WALK: Unit = Unit { places: 5, si: DEGREE_PER_SQRT_HOUR };
/// σ of a bias, °/h.
const DRIFT: Unit = Unit { places: 3, si: DEGREE_PER_HOUR };

/// Greatest g-sensitivity and σ of it, rad/s per g: 1000 °/h/g, five times the greatest in data sheets of micromachined
/// gyros.
const GREATEST_KAPPA: f64 = 1000.0 * DEGREE_PER_HOUR;
/// Greatest bias of an accelerometer, m/s²: 1 g.
const GREATEST_BIAS: f64 = 1000.0 * MILLI_G;
/// Greatest of an encoder's errors and of a frame's angles, rad: 10°. Beyond, it is another thing that is wrong.
const GREATEST_ERROR: f32 = (10.0 * DEGREE) as f32;
/// The same for what is left of them, 1σ, rad.
const GREATEST_LEFT: f64 = 10.0 * DEGREE;
/// The same for σ of an encoder's zero that was set by hand, rad.
const GREATEST_ZERO: f64 = 180.0 * DEGREE;
/// Greatest angle of an index mark, rad.
const WHOLE: f64 = 360.0 * DEGREE;
/// Least and greatest scale factor of a spinning body's sensors, V per rad/s or m/s²: from 2.5 V for what no sensor measures
/// to 2.5 V for a quarter of a percent of a unit. A [`Channel`] takes more.
const SCALES: [f64; 2] = [1e-6, 1e3];
/// Least and greatest limit of them, rad/s or m/s².
const LIMITS: [f64; 2] = [1e-2, 1e6];
/// Greatest N of a spinning body's gyro, rad/√s: 1000 °/√h, σ of its scale factor, and σ of its bias, rad/s: 10⁷ °/h.
const GREATEST_SPIN: [f64; 3] = [1e3 * DEGREE_PER_SQRT_HOUR, 1.0, 1e7 * DEGREE_PER_HOUR];

/// Calibration of the instrument on one carrier. The default is that of an instrument that was not calibrated.
pub trait Calibration:
    Clone + Debug + Default + PartialEq + Send + Serialize + DeserializeOwned + Named
{
    /// Checks that every quantity is within its range.
    ///
    /// # Errors
    /// [`SetupError::OutOfRange`], which names the first field that is not.
    fn check(&self) -> Result<(), SetupError>;

    /// What it states of a precise gyro's g-sensitivity and of accelerometers; [`None`] where it states neither.
    fn felt(&self) -> Option<Felt>;
}

/// What gravity does to the sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Felt {
    /// g-sensitivity along the gyro's axis and 90° clockwise of it: the test sheet, or a calibration with the axis up and
    /// down.
    pub g_sensitivity: [GSensitivity; 2],
    /// Standard deviation of each, 1σ.
    pub g_sensitivity_sigma: GSensitivity,
    /// Standard deviation of the accelerometer's biases, 1σ.
    pub force_bias_sigma: MetresPerSecondSquared,
}

impl Felt {
    /// No g-sensitivity, known to 0.1 °/h/g, and biases of an accelerometer with this σ, thousandths of g.
    fn uncalibrated(milli_g: f64) -> Self {
        Self {
            g_sensitivity: [GSensitivity(0.0); 2],
            g_sensitivity_sigma: GSensitivity::from_degrees_per_hour(0.1),
            force_bias_sigma: MetresPerSecondSquared(milli_g * MILLI_G),
        }
    }

    fn check(&self) -> Result<(), SetupError> {
        let [along, across] = self.g_sensitivity.map(|part| part.0);
        let either = [-GREATEST_KAPPA, GREATEST_KAPPA];
        check_ranges(&[
            ("g_sensitivity", along, either),
            ("g_sensitivity", across, either),
            ("g_sensitivity_sigma", self.g_sensitivity_sigma.0, [0.0, GREATEST_KAPPA]),
            ("force_bias_sigma", self.force_bias_sigma.0, [0.0, GREATEST_BIAS]),
        ])
    }
}

impl Named for Felt {
    fn list(&mut self, list: &mut List<'_>) {
        let [along, across] = &mut self.g_sensitivity;
        list.number("g_along", KAPPA, &mut along.0);
        list.number("g_across", KAPPA, &mut across.0);
        list.number("g_sigma", KAPPA, &mut self.g_sensitivity_sigma.0);
        list.number("force_sigma", BIAS, &mut self.force_bias_sigma.0);
    }
}

/// Refuses an error of an encoder out of its range.
fn check_harmonics(encoder: &Harmonics) -> Result<(), SetupError> {
    let mut parts = encoder.first.iter().chain(&encoder.second);
    parts.try_for_each(|part| {
        check_ranges(&[(
            "encoder",
            (*part).into(),
            [-GREATEST_ERROR, GREATEST_ERROR].map(f64::from),
        )])
    })
}

/// Lists the amplitudes of an encoder's error by their names.
fn list_harmonics(list: &mut List<'_>, names: [&'static str; 4], encoder: &mut Harmonics) {
    let parts = encoder.first.iter_mut().chain(&mut encoder.second);
    names.iter().zip(parts).for_each(|(name, part)| list.single(name, FINE, part));
}

/// Calibration of a stage, and part of others.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlatformCalibration {
    /// What gravity does to gyro and accelerometer.
    pub felt: Felt,
    /// Error of the encoder; on two frames of the outer one.
    pub encoder: Harmonics,
    /// Standard deviation of the remaining error as it enters the azimuth, 1σ.
    pub encoder_sigma: Radians,
}

impl PlatformCalibration {
    /// A true encoder, known to 0.05°, and an accelerometer of this σ, thousandths of g.
    fn uncalibrated(milli_g: f64) -> Self {
        let encoder_sigma = Radians::from_degrees(0.05);
        Self { felt: Felt::uncalibrated(milli_g), encoder: Harmonics::default(), encoder_sigma }
    }
}

impl Default for PlatformCalibration {
    /// The ADXL355 as it is delivered: its offset is at most 25 mg (data sheet rev. C, table 1), 3σ.
    fn default() -> Self {
        Self::uncalibrated(8.3)
    }
}

impl Calibration for PlatformCalibration {
    fn check(&self) -> Result<(), SetupError> {
        self.felt.check()?;
        check_harmonics(&self.encoder)?;
        check_ranges(&[("encoder_sigma", self.encoder_sigma.0, [0.0, GREATEST_LEFT])])
    }

    fn felt(&self) -> Option<Felt> {
        Some(self.felt)
    }
}

impl Named for PlatformCalibration {
    fn list(&mut self, list: &mut List<'_>) {
        self.felt.list(list);
        let names = ["encoder_sin_1", "encoder_cos_1", "encoder_sin_2", "encoder_cos_2"];
        list_harmonics(list, names, &mut self.encoder);
        list.number("encoder_sigma", FINE, &mut self.encoder_sigma.0);
    }
}

/// Angles of a [`TwoFrame`], rad, in single precision: up to 10° that is 0.0002″.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// Rotation of the outer axis to the right.
    pub azimuth: f32,
    /// Rotation of the outer axis, its front up.
    pub pitch: f32,
    /// Non-orthogonality of the frames.
    pub frames: f32,
    /// Non-orthogonality of the gyro.
    pub gyro: f32,
    /// Reading of the outer encoder at zero.
    pub outer_zero: f32,
    /// Reading of the inner encoder at zero.
    pub inner_zero: f32,
}

impl From<Geometry> for TwoFrame {
    fn from(geometry: Geometry) -> Self {
        let angle = |angle: f32| Radians(angle.into());
        Self {
            azimuth: angle(geometry.azimuth),
            pitch: angle(geometry.pitch),
            frames: angle(geometry.frames),
            gyro: angle(geometry.gyro),
            outer_zero: angle(geometry.outer_zero),
            inner_zero: angle(geometry.inner_zero),
        }
    }
}

/// Calibration of two frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FramesCalibration {
    /// Gyro, accelerometer on the base, and outer encoder.
    pub platform: PlatformCalibration,
    /// Error of the inner encoder.
    pub inner: Harmonics,
    /// Angles of the mount.
    pub geometry: Geometry,
    /// Standard deviation of each non-orthogonality that the calibration leaves, 1σ.
    pub orthogonality_sigma: Radians,
}

impl Default for FramesCalibration {
    /// A perfect mount, known to 0.05°, and a calibrated accelerometer, whose biases act as tilt: to 0.1 mg.
    fn default() -> Self {
        Self {
            platform: PlatformCalibration::uncalibrated(0.1),
            inner: Harmonics::default(),
            geometry: Geometry::default(),
            orthogonality_sigma: Radians::from_degrees(0.05),
        }
    }
}

impl Calibration for FramesCalibration {
    fn check(&self) -> Result<(), SetupError> {
        self.platform.check()?;
        check_harmonics(&self.inner)?;
        let Geometry { azimuth, pitch, frames, gyro, outer_zero, inner_zero } = self.geometry;
        let either = [-GREATEST_ERROR, GREATEST_ERROR].map(f64::from);
        check_ranges(&[
            ("azimuth", azimuth.into(), either),
            ("pitch", pitch.into(), either),
            ("frames", frames.into(), either),
            ("gyro", gyro.into(), either),
            ("outer_zero", outer_zero.into(), either),
            ("inner_zero", inner_zero.into(), either),
            ("orthogonality_sigma", self.orthogonality_sigma.0, [0.0, GREATEST_LEFT]),
        ])
    }

    fn felt(&self) -> Option<Felt> {
        self.platform.felt()
    }
}

impl Named for FramesCalibration {
    fn list(&mut self, list: &mut List<'_>) {
        self.platform.list(list);
        let names =
            ["encoder_in_sin_1", "encoder_in_cos_1", "encoder_in_sin_2", "encoder_in_cos_2"];
        list_harmonics(list, names, &mut self.inner);
        list.single("frame_azimuth", FINE, &mut self.geometry.azimuth);
        list.single("frame_pitch", FINE, &mut self.geometry.pitch);
        list.single("frame_square", FINE, &mut self.geometry.frames);
        list.single("frame_gyro", FINE, &mut self.geometry.gyro);
        list.single("frame_outer_zero", FINE, &mut self.geometry.outer_zero);
        list.single("frame_inner_zero", FINE, &mut self.geometry.inner_zero);
        list.number("frame_sigma", FINE, &mut self.orthogonality_sigma.0);
    }
}

/// Calibration of a platform that turns all the time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TurntableCalibration {
    /// Gyro, accelerometer and encoder.
    pub platform: PlatformCalibration,
    /// Standard deviation of the encoder's zero as it enters the azimuth, 1σ: without an index no rotation shows it.
    pub encoder_zero_sigma: Radians,
    /// Angles at which the index mark begins to close its switch as the platform turns clockwise and counter-clockwise,
    /// rad, within a turn.
    pub index: [Radians; 2],
    /// Whether the sensor is a molecular-electronic one.
    pub is_molecular: bool,
}

impl TurntableCalibration {
    /// Kind of sensor.
    #[must_use]
    pub const fn sensor(&self) -> Sensor {
        if self.is_molecular { Sensor::MOLECULAR } else { Sensor::GYRO }
    }
}

impl Default for TurntableCalibration {
    /// A gyro, a zero that was set by hand to 0.15°, a mark from 30° to 40°.
    fn default() -> Self {
        Self {
            platform: PlatformCalibration::default(),
            encoder_zero_sigma: Radians::from_degrees(0.15),
            index: [30.0, 40.0].map(Radians::from_degrees),
            is_molecular: false,
        }
    }
}

impl Calibration for TurntableCalibration {
    fn check(&self) -> Result<(), SetupError> {
        self.platform.check()?;
        let [clockwise, counter] = self.index;
        check_ranges(&[
            ("encoder_zero_sigma", self.encoder_zero_sigma.0, [0.0, GREATEST_ZERO]),
            ("index", clockwise.0, [0.0, WHOLE]),
            ("index", counter.0, [0.0, WHOLE]),
        ])
    }

    fn felt(&self) -> Option<Felt> {
        self.platform.felt()
    }
}

impl Named for TurntableCalibration {
    fn list(&mut self, list: &mut List<'_>) {
        self.platform.list(list);
        let [clockwise, counter] = &mut self.index;
        list.number("encoder_0_sigma", FINE, &mut self.encoder_zero_sigma.0);
        list.number("index_cw", DEGREES, &mut clockwise.0);
        list.number("index_ccw", DEGREES, &mut counter.0);
        let is_molecular = &mut self.is_molecular;
        let index = usize::from(*is_molecular);
        list.choice("sensor", &["gyro", "molecular"], index, &mut |index| {
            *is_molecular = index == 1;
        });
    }
}

/// Calibration of a vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VehicleCalibration(pub Felt);

impl Default for VehicleCalibration {
    /// Calibrated accelerometers, whose biases act as tilt: to 0.1 mg.
    fn default() -> Self {
        Self(Felt::uncalibrated(0.1))
    }
}

impl Calibration for VehicleCalibration {
    fn check(&self) -> Result<(), SetupError> {
        self.0.check()
    }

    fn felt(&self) -> Option<Felt> {
        Some(self.0)
    }
}

impl Named for VehicleCalibration {
    fn list(&mut self, list: &mut List<'_>) {
        self.0.list(list);
    }
}

/// An analogue sensor behind a converter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Analogue {
    /// Scale factor, V per rad/s or per m/s², negative where its axis is reversed.
    pub scale: f64,
    /// Magnitude beyond which its own output may saturate, rad/s or m/s².
    pub limit: f64,
}

/// Calibration of a spinning body, by the test sheets of its sensors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpinCalibration {
    /// Gyros about x, y and z.
    pub gyros: [Analogue; 3],
    /// Accelerometers along y and z.
    pub forces: [Analogue; 2],
    /// Angle random walk N of the gyro about x.
    pub angle_random_walk: RadiansPerRootSecond,
    /// Standard deviation of its scale factor, 1σ, relative.
    pub scale_sigma: f64,
    /// Standard deviation of its bias, 1σ.
    pub bias_sigma: RadiansPerSecond,
}

impl Default for SpinCalibration {
    /// 2 V for 700 rad/s about x, 20 rad/s about y and z, and 10 000 m/s²; all clip at 97 % of that. Micromechanical gyros
    /// of 0.5 °/√h.
    fn default() -> Self {
        let across = Analogue { scale: 0.1, limit: 19.0 };
        Self {
            gyros: [Analogue { scale: 2.0 / 700.0, limit: 680.0 }, across, across],
            forces: [Analogue { scale: 2e-4, limit: 9700.0 }; 2],
            angle_random_walk: RadiansPerRootSecond(0.5 * DEGREE_PER_SQRT_HOUR),
            scale_sigma: 1e-3,
            bias_sigma: RadiansPerSecond::from_degrees_per_hour(200.0),
        }
    }
}

impl SpinCalibration {
    /// Configuration of the sensors at a sample rate, Hz; [`None`] where a scale factor is zero.
    #[must_use]
    pub fn configuration(&self, sample_rate: f64) -> Option<SpinConfiguration> {
        let [x, y, z] =
            self.gyros.map(|Analogue { scale, limit }| Channel::gyro(scale, limit, sample_rate));
        let [up, right] =
            self.forces.map(|Analogue { scale, limit }| Channel::accelerometer(scale, limit));
        Some(SpinConfiguration { sample_rate, gyros: [x?, y?, z?], accelerometers: [up?, right?] })
    }
}

impl Calibration for SpinCalibration {
    fn check(&self) -> Result<(), SetupError> {
        let mut sensors = self.gyros.iter().chain(&self.forces);
        sensors.try_for_each(|Analogue { scale, limit }| {
            check_ranges(&[("magnitude of scale", scale.abs(), SCALES), ("limit", *limit, LIMITS)])
        })?;
        let [walk, scale, bias] = GREATEST_SPIN;
        check_ranges(&[
            ("angle_random_walk", self.angle_random_walk.0, [0.0, walk]),
            ("scale_sigma", self.scale_sigma, [0.0, scale]),
            ("bias_sigma", self.bias_sigma.0, [0.0, bias]),
        ])
    }

    fn felt(&self) -> Option<Felt> {
        None
    }
}

impl Named for SpinCalibration {
    fn list(&mut self, list: &mut List<'_>) {
        let names = [
            ["spin_x_scale", "spin_x_limit"],
            ["spin_y_scale", "spin_y_limit"],
            ["spin_z_scale", "spin_z_limit"],
            ["spin_fy_scale", "spin_fy_limit"],
            ["spin_fz_scale", "spin_fz_limit"],
        ];
        let units = [[RATE_SCALE, RATE]; 3].into_iter().chain([[FORCE_SCALE, FORCE]; 2]);
        let sensors = self.gyros.iter_mut().chain(&mut self.forces);
        for (sensor, (names, units)) in sensors.zip(names.into_iter().zip(units)) {
            list.number(names[0], units[0], &mut sensor.scale);
            list.number(names[1], units[1], &mut sensor.limit);
        }
        list.number("spin_n", WALK, &mut self.angle_random_walk.0);
        list.number("spin_scale_sigma", PARTS, &mut self.scale_sigma);
        list.number("spin_bias_sigma", DRIFT, &mut self.bias_sigma.0);
    }
}
