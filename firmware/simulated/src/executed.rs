//! The worlds of the images that are executed, and the records of settings that their stores are given.
//!
//! Schedules are short: instructions are dear to execute. The boards have no calibration, as an image has none that
//! was not edited.

use firmware::settings::{
    CarrierSchedule, Felt, FramesCalibration, Geometry, Gyro, Output, PlatformCalibration,
    Settings, SpinCalibration, SpinSchedule, StageSchedule, TurntableCalibration,
    TurntableSchedule, TwoFrameSchedule, VehicleCalibration, VehicleSchedule,
};
use orientation::alignment::stepwise::mount::TwoFrame;
use orientation::earth::Latitude;
use orientation::units::{Radians, RadiansPerSecond, Seconds, TURN};

use super::mount::FramesScenario;
use super::scenario::{self, Scenario};
use super::spin::SpinScenario;
use super::turntable::TurntableScenario;
use super::vehicle::{Place, VehicleScenario};

/// Non-orthogonalities of frames that were not calibrated, 1σ, rad.
const ORTHOGONALITY_SIGMA: f64 = 0.05 * orientation::units::DEGREE;

/// What all boards have in common: a coarse IMU on the base, and no calibration.
fn base(seed: u64) -> Scenario {
    Scenario { is_calibrated: false, has_base_imu: true, ..Scenario::usual(seed) }
}

/// A stage with eight positions of four seconds.
pub fn stage(seed: u64) -> Scenario {
    Scenario { positions: 8, dwell_s: 4.0, ..base(seed) }
}

/// Two frames with two passes of dwells of four seconds.
#[must_use]
pub fn two_frames(seed: u64) -> FramesScenario {
    FramesScenario {
        base: Scenario { dwell_s: 4.0, ..base(seed) },
        passes: 2,
        calibrated: TwoFrame::default(),
        orthogonality_sigma: ORTHOGONALITY_SIGMA,
        ..FramesScenario::default()
    }
}

/// A turntable with four rate-modulated turns and four each way, at 0.2 Hz.
pub fn turntable(seed: u64) -> TurntableScenario {
    let usual = TurntableScenario::usual(seed);
    TurntableScenario {
        base: base(seed),
        speeds_hz: [0.2, 0.0],
        modulated_turns: 4,
        turns: 4,
        ..usual
    }
}

/// A vehicle with two stops of a quarter of a minute and a short drive, without aiding by position.
pub fn vehicle(seed: u64) -> VehicleScenario {
    let base = Scenario { has_base_imu: false, ..base(seed) };
    VehicleScenario { base, place: Place::Unknown, ..VehicleScenario::brief(seed) }
}

/// A flight of two seconds.
#[must_use]
pub fn spin(seed: u64) -> SpinScenario {
    SpinScenario { seed, ..SpinScenario::default() }
}

impl Scenario {
    /// The settings of this board with a schedule and a calibration; none where the latitude is none.
    fn settings_with<C: CarrierSchedule>(
        &self,
        schedule: C,
        calibration: C::Calibration,
    ) -> Option<Settings<C>> {
        Some(Settings {
            output: Output::default(),
            latitude: Some(Latitude::from_degrees(self.latitude_deg)?),
            starts: true,
            gyro: Gyro {
                volts_per_rad_per_s: scenario::VOLTS,
                limit: RadiansPerSecond(f64::from(scenario::LIMIT.0) * 1e-9),
                errors: self.precise(),
            },
            required_sigma: self.site()?.required_sigma,
            holds: true,
            schedule,
            calibration,
        })
    }

    /// What was measured of gyro, accelerometer and encoder on a platform that turns them.
    fn calibration(&self) -> Option<PlatformCalibration> {
        let site = self.site()?;
        let felt = Felt {
            g_sensitivity: site.g_sensitivity,
            g_sensitivity_sigma: site.g_sensitivity_sigma,
            force_bias_sigma: site.accelerometer_bias_sigma,
        };
        let encoder = self.configuration().encoder;
        Some(PlatformCalibration { felt, encoder, encoder_sigma: site.encoder_sigma })
    }

    /// The settings of a stage; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<StageSchedule>> {
        let schedule = StageSchedule {
            positions: self.positions as u8,
            dwell: Seconds(self.dwell_s),
            survey: (self.survey_s > 0.0).then_some(Seconds(self.survey_s)),
            allowed: None,
            half: self.half,
        };
        self.settings_with(schedule, self.calibration()?)
    }
}

impl FramesScenario {
    /// The settings of two frames; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<TwoFrameSchedule>> {
        let Self { base, passes, .. } = self;
        let schedule = TwoFrameSchedule {
            passes: *passes as u8,
            dwell: Seconds(base.dwell_s),
            half: base.half,
        };
        base.settings_with(schedule, self.calibration()?)
    }

    /// What was measured of gyro, accelerometer, encoders and mount.
    fn calibration(&self) -> Option<FramesCalibration> {
        let mut platform = self.base.calibration()?;
        let inner = platform.encoder;
        platform.felt.force_bias_sigma = self.setting()?.site.accelerometer_bias_sigma;
        let stated = self.frames().ok()?.geometry();
        let geometry = Geometry {
            azimuth: stated.azimuth.0 as f32,
            pitch: stated.pitch.0 as f32,
            frames: stated.frames.0 as f32,
            gyro: stated.gyro.0 as f32,
            outer_zero: stated.outer_zero.0 as f32,
            inner_zero: stated.inner_zero.0 as f32,
        };
        let orthogonality_sigma = Radians(self.orthogonality_sigma);
        Some(FramesCalibration { platform, inner, geometry, orthogonality_sigma })
    }
}

impl TurntableScenario {
    /// The settings of a turntable; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<TurntableSchedule>> {
        let speeds = self.speeds_hz.iter().filter(|speed| **speed > 0.0);
        let schedule = TurntableSchedule {
            speeds: speeds.map(|speed| RadiansPerSecond(speed * TURN)).collect(),
            turns: self.turns,
            modulated_turns: self.modulated_turns,
        };
        let platform = self.base.calibration()?;
        let is_molecular = self.molecular.is_some();
        let calibration =
            TurntableCalibration { platform, is_molecular, ..TurntableCalibration::default() };
        self.base.settings_with(schedule, calibration)
    }
}

impl VehicleScenario {
    /// The settings of a vehicle, which has no calibration; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<VehicleSchedule>> {
        let schedule = VehicleSchedule {
            stops: self.stops as u8,
            stop: Seconds(self.stop_s),
            realigns: self.base.hold.realigns,
            aligns_known: true,
        };
        self.base.settings_with(schedule, VehicleCalibration::default())
    }
}

impl SpinScenario {
    /// The settings of a spinning body: its flight starts level, northwards, and its sensors are the usual ones.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<SpinSchedule>> {
        let schedule = SpinSchedule { course: Radians(0.0), pitch: Radians(0.0) };
        Scenario::usual(self.seed).settings_with(schedule, SpinCalibration::default())
    }
}
