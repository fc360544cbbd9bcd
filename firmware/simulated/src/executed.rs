//! The worlds of the images that are executed, and the records of settings that their stores are given.
//!
//! Schedules are short: instructions are dear to execute. The boards have no calibration, as an image has none that
//! was not edited.

use firmware::settings::{
    Gyro, Settings, SpinSchedule, StageSchedule, TurntableSchedule, TwoFrameSchedule,
    VehicleSchedule,
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
    /// The settings of this board with a schedule; none where the latitude is none.
    fn settings_with<C>(&self, schedule: C) -> Option<Settings<C>> {
        Some(Settings {
            latitude: Latitude::from_degrees(self.latitude_deg)?,
            gyro: Gyro {
                volts_per_rad_per_s: scenario::VOLTS,
                limit: RadiansPerSecond(f64::from(scenario::LIMIT.0) * 1e-9),
                errors: self.precise(),
            },
            required_sigma: self.site()?.required_sigma,
            holds: true,
            schedule,
        })
    }

    /// The settings of a stage; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<StageSchedule>> {
        self.settings_with(StageSchedule {
            positions: self.positions as u8,
            dwell: Seconds(self.dwell_s),
            survey: (self.survey_s > 0.0).then_some(Seconds(self.survey_s)),
            allowed: None,
            half: self.half,
        })
    }
}

impl FramesScenario {
    /// The settings of two frames; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<TwoFrameSchedule>> {
        let Self { base, passes, .. } = self;
        let (dwell, half) = (Seconds(base.dwell_s), base.half);
        base.settings_with(TwoFrameSchedule { passes: *passes as u8, dwell, half })
    }
}

impl TurntableScenario {
    /// The settings of a turntable; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<TurntableSchedule>> {
        let speeds = self.speeds_hz.iter().filter(|speed| **speed > 0.0);
        self.base.settings_with(TurntableSchedule {
            speeds: speeds.map(|speed| RadiansPerSecond(speed * TURN)).collect(),
            turns: self.turns,
            modulated_turns: self.modulated_turns,
        })
    }
}

impl VehicleScenario {
    /// The settings of a vehicle; none where the latitude is none.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<VehicleSchedule>> {
        let (stops, stop) = (self.stops as u8, Seconds(self.stop_s));
        self.base.settings_with(VehicleSchedule { stops, stop, realigns: self.base.hold.realigns })
    }
}

impl SpinScenario {
    /// The settings of a spinning body, which uses the start of its flight alone: level, northwards.
    #[must_use]
    pub fn settings(&self) -> Option<Settings<SpinSchedule>> {
        Scenario::usual(self.seed)
            .settings_with(SpinSchedule { course: Radians(0.0), pitch: Radians(0.0) })
    }
}
