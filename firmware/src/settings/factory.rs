//! Factory settings, which hold until a record takes their place.
//!
//! There is no latitude among them: nothing begins until one is stated, but on a spinning body, which needs none. The gyro is
//! one of the OIUS-1000 class. Calibrations are those of an instrument that was not calibrated.

use orientation::alignment::rotating::session::Procedure as Turning;
use orientation::attitude;
use orientation::noise::model::GyroNoise;
use orientation::units::{DEGREE, Radians, RadiansPerSecond, Seconds, TURN};

use super::{
    CarrierSchedule, Gyro, Output, Settings, SpinSchedule, StageSchedule, TurntableSchedule,
    TwoFrameSchedule, VehicleSchedule,
};

/// Scale factor of the gyro at the converter's input, V per °/s.
const GYRO_SCALE: f64 = 0.05;
/// Rate beyond which its own output may saturate, °/s: 97 % of its range.
const GYRO_LIMIT: f64 = 0.97 * 40.0;
/// Its angle random walk N, °/√h, bias instability B, °/h, rate random walk K, °/h/√h.
const GYRO_NOISE: [f64; 3] = [0.001, 0.007, 0.0];
/// Standard deviation of its scale factor, 1σ, relative.
const GYRO_SCALE_SIGMA: f64 = 5e-4;
/// Standard deviation of its bias from switch-on to switch-on, 1σ, °/h.
const GYRO_BIAS_SIGMA: f64 = 0.5;
/// Greatest 1σ of the azimuth that is accepted, °: any that is worth its name.
const ACCURACY: f64 = 10.0;
/// Positions of a stage on the full circle; the first is repeated at the end.
const POSITIONS: u8 = 24;
/// Time at each position of a stage, and at each heading of two frames.
const DWELL: Seconds = Seconds(10.0);
/// Number of times that the four headings of two frames are taken.
const PASSES: u8 = 6;
/// Speed of a turning platform, turns per second.
const SPEED: f64 = 0.137;
/// Number of stops of a vehicle: three with different headings make the gyros' biases observable.
const STOPS: u8 = 3;
/// Time for which a vehicle is to stand at each stop.
const STOP: Seconds = Seconds(60.0);

impl Default for Gyro {
    fn default() -> Self {
        let [n, b, k] = GYRO_NOISE;
        let errors = attitude::Gyro {
            noise: GyroNoise::from_field_units(n, b, k, 0.0),
            bias_sigma: RadiansPerSecond::from_degrees_per_hour(GYRO_BIAS_SIGMA),
            scale_sigma: GYRO_SCALE_SIGMA,
        };
        let limit = RadiansPerSecond(GYRO_LIMIT * DEGREE);
        Self { volts_per_rad_per_s: GYRO_SCALE / DEGREE, limit, errors }
    }
}

impl<C: CarrierSchedule> Default for Settings<C> {
    /// It begins at power-on, and holds what it finds.
    fn default() -> Self {
        Self {
            output: Output::default(),
            latitude: None,
            starts: true,
            gyro: Gyro::default(),
            required_sigma: Radians::from_degrees(ACCURACY),
            holds: true,
            schedule: C::default(),
            calibration: C::Calibration::default(),
        }
    }
}

impl Default for StageSchedule {
    /// It ends with its positions.
    fn default() -> Self {
        let (survey, allowed, half) = (None, None, None);
        Self { positions: POSITIONS, dwell: DWELL, survey, allowed, half }
    }
}

impl Default for TwoFrameSchedule {
    fn default() -> Self {
        Self { passes: PASSES, dwell: DWELL, half: None }
    }
}

impl Default for TurntableSchedule {
    /// One speed, as a gyro needs it, with the usual number of turns of either kind.
    fn default() -> Self {
        let speeds = [RadiansPerSecond(SPEED * TURN)];
        // The turns do not depend on the sample period.
        let Turning { speeds, turns, modulated_turns, .. } = Turning::new(&speeds, Seconds(1.0));
        Self { speeds, turns, modulated_turns }
    }
}

impl Default for VehicleSchedule {
    fn default() -> Self {
        Self { stops: STOPS, stop: STOP, realigns: true, aligns_known: true }
    }
}

impl Default for SpinSchedule {
    /// Level and northwards.
    fn default() -> Self {
        Self { course: Radians(0.0), pitch: Radians(0.0) }
    }
}
