//! One simulated alignment on a two-frame mount: what is true, what the board is given, the wiring.
//!
//! Site, attitude, gyro and dwells are those of a [`Scenario`]; the mechanism, its calibration and the
//! accelerometer on the base are its own. What a calibration leaves is drawn from the seed.

use drivers::tmc5160::configuration::Configuration as Motor;
use hal_mock::chip::Select;
use hal_mock::gimbal::board::GimbalBoard;
use hal_mock::gimbal::{FrameConfiguration, Gimbal, GimbalConfiguration, Misalignment};
use hal_mock::noise::Generator;
use hal_mock::plant::journey::JourneyConfiguration;
use hal_mock::plant::train::StageConfiguration;
use hal_mock::plant::{PlantConfiguration, StageFault};
use orientation::alignment::site::Site;
use orientation::alignment::stepwise::mount::{
    ARRIVAL, MountError, TWO_FRAMES, TwoFrame, azimuth_sigma,
};
use orientation::alignment::stepwise::session::Prepared;
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::schedule::{Position, Schedule};
use orientation::alignment::stepwise::setting::Setting;
use orientation::planner::POSITIONS;
use orientation::planner::Rotation;
use orientation::planner::order::Order;
use orientation::units::{DEGREE, MetresPerSecondSquared, Radians, RadiansPerSecond, Seconds};

use super::fault::{Injection, PortWrapper};
use super::scenario::{self, Scenario, Turning};
use super::{OSCILLATOR, SimulatedEncoder, SimulatedMotor, SimulatedSensors, Wires};
use firmware::configuration::FramesConfiguration;
use firmware::ports::{Frames, Sensors};

/// 1σ of the accelerometers on the base, m/s²: their biases are tilt, so they are calibrated, to
/// 0.1 mg; as delivered, an ADXL355 would cost 0.5° at 48°.
const FORCE_BIAS_SIGMA: MetresPerSecondSquared = MetresPerSecondSquared(1e-4 * 9.80665);

/// How long the frames take: the stage's ramp, each on its own way; they stand 1.5 s before they are
/// believed.
const ROTATION: Rotation = Rotation {
    rest: Seconds(scenario::ROTATION.rest.0 + 1.5),
    speed: RadiansPerSecond(0.35),
    wraps: true,
};

/// What a movement of the frames takes, s, more than a usual one of a stage: half a turn is the longest.
const FRAMES_SECONDS: f64 = 7.0;

/// The headings of a pass in their order, °: opposite ones follow each other, so that drift cancels.
const PASS: [f64; 4] = [0.0, 180.0, 90.0, 270.0];

/// A stream of random numbers that no source of noise has.
const STREAM: u64 = 1000;

/// A simulated alignment on a two-frame mount.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FramesScenario {
    /// Site, attitude, gyro, sample rate and dwell; its positions and start angle are not looked at.
    pub base: Scenario,
    /// How often the four headings are visited, 1…16.
    pub passes: usize,
    /// What the calibration found.
    pub calibrated: TwoFrame,
    /// 1σ of each non-orthogonality that it leaves, rad.
    pub orthogonality_sigma: f64,
    /// Whether the board is given it; else it takes the mount for perfect.
    pub is_calibrated: bool,
    /// Frame angles at power-on, °.
    pub start_deg: Frames<f64>,
}

impl Default for FramesScenario {
    /// Six passes of four dwells of 10 s on a mount with non-orthogonalities of some tenths of a degree,
    /// calibrated to 5″.
    fn default() -> Self {
        Self {
            base: Scenario::default(),
            passes: 6,
            calibrated: TwoFrame {
                azimuth: Radians::from_degrees(0.05),
                pitch: Radians::from_degrees(-0.08),
                frames: Radians::from_degrees(0.15),
                gyro: Radians::from_degrees(-0.12),
                outer_zero: Radians::from_degrees(0.1),
                inner_zero: Radians::from_degrees(-0.2),
            },
            orthogonality_sigma: 5.0 / 3600.0 * DEGREE,
            is_calibrated: true,
            start_deg: Frames { outer: 12.0, inner: -35.0 },
        }
    }
}

impl FramesScenario {
    /// A pass of short dwells at 2400 Hz: what a sample costs at the highest rate.
    #[must_use]
    pub fn brief(seed: u64) -> Self {
        Self { base: Scenario::brief(seed), passes: 1, ..Self::default() }
    }

    /// What its session needs; none where the latitude is none or the schedule impossible.
    #[must_use]
    pub fn prepared(&self) -> Option<Prepared> {
        Prepared::new(self.setting()?, self.procedure()).ok()
    }

    /// What the board is given about place and instrument; none where the latitude is none.
    #[must_use]
    pub fn setting(&self) -> Option<Setting> {
        let site = self.base.site()?;
        let encoder_sigma =
            azimuth_sigma(Radians(self.orthogonality_sigma), site.encoder_sigma, site.latitude);
        let site = Site { accelerometer_bias_sigma: FORCE_BIAS_SIGMA, encoder_sigma, ..site };
        Some(Setting { mount: TWO_FRAMES, half: self.base.half, ..Setting::new(site) })
    }

    /// How the board goes about it.
    pub fn procedure(&self) -> Procedure {
        let seconds = Seconds(self.base.dwell_s);
        let pass = PASS.map(|heading| Position { angle: Radians::from_degrees(heading), seconds });
        let positions = core::iter::repeat_n(pass, self.passes).flatten().take(POSITIONS).collect();
        let turning = Turning {
            rotation: ROTATION,
            orders: &Order::QUARTERS,
            usual: Schedule::Listed(positions),
        };
        Procedure { arrival: ARRIVAL, ..self.base.procedure_on(&turning) }
    }

    /// What the board is given about the frames.
    ///
    /// # Errors
    /// A calibration that lets the axis not stand where it must.
    pub fn frames(&self) -> Result<FramesConfiguration, MountError> {
        let stated = if self.is_calibrated { self.calibrated } else { self.zeros() };
        let harmonics = self.base.configuration().encoder;
        FramesConfiguration::new(
            stated,
            Frames { outer: harmonics, inner: harmonics },
            FORCE_BIAS_SIGMA,
        )
    }

    /// A perfect mount with the same zeros of its encoders, without which nothing homes.
    fn zeros(&self) -> TwoFrame {
        let TwoFrame { outer_zero, inner_zero, .. } = self.calibrated;
        TwoFrame { outer_zero, inner_zero, ..TwoFrame::default() }
    }

    /// What is true of everything that the chips feel and move, on a base that goes along a journey where
    /// there is one.
    #[must_use]
    pub fn gimbal<'a>(
        &self,
        journey: Option<JourneyConfiguration<'a>>,
        injection: &'a Injection,
    ) -> GimbalConfiguration<'a> {
        let mut chance = Generator::stream(self.base.seed, STREAM);
        let mut left = |sigma: f64| sigma * chance.gaussian();
        let stated = &self.calibrated;
        let misalignment = Misalignment {
            azimuth_rad: stated.azimuth.0,
            pitch_rad: stated.pitch.0,
            frames_rad: stated.frames.0 + left(self.orthogonality_sigma),
            gyro_rad: stated.gyro.0 + left(self.orthogonality_sigma),
        };
        let disturbances = &injection.disturbances;
        let mut plant = PlantConfiguration { journey, disturbances, ..self.base.plant() };
        plant.instruments.accelerometer.bias_sigma_m_s2 = FORCE_BIAS_SIGMA.0;
        let sigma = scenario::G_SENSITIVITY_SIGMA;
        for part in &mut plant.instruments.gyro.g_sensitivity_deg_h_g {
            *part += left(sigma);
        }
        let third_g_sensitivity_deg_h_g = left(sigma);
        let Injection { axes, caught, .. } = injection;
        let start = self.start_deg;
        GimbalConfiguration {
            outer: frame(&plant, &axes.outer, caught.outer, stated.outer_zero.0, start.outer),
            inner: frame(&plant, &axes.inner, caught.inner, stated.inner_zero.0, start.inner),
            plant,
            misalignment,
            third_g_sensitivity_deg_h_g,
        }
    }

    /// The simulated board on such a base.
    pub fn board<'a>(
        &self,
        journey: Option<JourneyConfiguration<'a>>,
        injection: &'a Injection,
    ) -> GimbalBoard<'a> {
        let gimbal = Gimbal::new(&self.gimbal(journey, injection), self.base.seed);
        let mut board = GimbalBoard::new(gimbal, OSCILLATOR);
        board.blackouts = &injection.blackouts;
        board
    }

    /// How long an alignment takes, s.
    #[must_use]
    pub fn alignment_seconds(&self) -> f64 {
        self.base.seconds_of(&self.procedure(), ROTATION.rest.0 + FRAMES_SECONDS)
    }
}

/// A frame with the gear and the encoder of the single-axis stage, whose cable may be caught at an angle, rad.
fn frame<'a>(
    plant: &PlantConfiguration<'_>,
    faults: &'a [StageFault],
    caught: Option<f64>,
    zero_rad: f64,
    start_deg: f64,
) -> FrameConfiguration<'a> {
    let perfect = FrameConfiguration::default();
    let [low, high] = perfect.stage.travel_rad;
    let stage = StageConfiguration {
        start_rad: start_deg * DEGREE,
        travel_rad: [low, caught.unwrap_or(high)],
        switches_rad: perfect.stage.switches_rad,
        ..plant.stage
    };
    FrameConfiguration { stage, encoder: plant.instruments.encoder, zero_rad, faults }
}

impl<'a, A: PortWrapper> Wires<'a, '_, A> {
    /// The sensors of a two-frame mount, beside those of its base.
    #[must_use]
    pub fn frame_sensors<B>(
        &self,
        scenario: &FramesScenario,
        base: B,
    ) -> SimulatedSensors<'a, A, Frames<SimulatedEncoder<'a, A>>, B> {
        let Sensors { gyro, accelerometer, encoder: outer, base } =
            self.sensors(&scenario.base, scenario::FORCE, base);
        let inner = self.encoder(Select::InnerEncoder);
        Sensors { gyro, accelerometer, encoder: Frames { outer, inner }, base }
    }

    /// The motors of a two-frame mount.
    #[must_use]
    pub fn actuators(&self) -> Frames<SimulatedMotor<'a, A>> {
        Frames { outer: Select::Actuator, inner: Select::InnerActuator }
            .map(|select| self.motor(select, Motor::default()))
    }
}
