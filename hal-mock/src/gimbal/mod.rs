//! The plant of a two-frame mount: two trains, a gyro in the inner frame, an accelerometer on the base.
//!
//! ```text
//!  outer actuator ─▶ train ─▶ outer frame, about body x ─▶ shown angle ─▶ outer encoder
//!  inner actuator ─▶ train ─▶ inner frame, across it ────▶ shown angle ─▶ inner encoder
//!                               └─▶ gyro ─volts─▶ its converter     base ─force─▶ accelerometer
//! ```
//!
//! With both frames at zero the inner axis lies along body y and the gyro's sensitive axis points down.
//! Own reading of the mechanism, by products of full rotation matrices. Time and noise as in
//! [`crate::plant`].

pub mod board;

use embassy_time::Instant;

use crate::earth::{Matrix, about_x, about_y, about_z, multiply};
use crate::environment::{AnalogueInput, ForceInput, ShaftAngle};
use crate::gyro::DEGREE_PER_HOUR;
use crate::instruments::{BaseMotion, Felt, Instruments};
use crate::plant::drive::Drive;
use crate::plant::payload::Payload;
use crate::plant::train::StageConfiguration;
use crate::plant::{PlantConfiguration, StageFault, seconds};
use crate::stage::{EncoderConfiguration, StageState};

/// How the mechanism differs from a perfect one, rad; right-handed about the named axis with both
/// frames at zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Misalignment {
    /// Turn of the outer axis from body x about body z, down.
    pub azimuth_rad: f64,
    /// Turn of the outer axis about body y, right, after that about z.
    pub pitch_rad: f64,
    /// Turn of the inner axis about z from the perpendicular to the outer axis.
    pub frames_rad: f64,
    /// Turn of the sensitive axis from the perpendicular to the inner axis, towards its right end.
    pub gyro_rad: f64,
}

/// One frame: mechanics, encoder, faults.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameConfiguration<'a> {
    /// The drive of the frame; angles are true ones.
    pub stage: StageConfiguration,
    /// Errors of the encoder; the chip adds the steps of its own.
    pub encoder: EncoderConfiguration,
    /// What the encoder shows where the frame stands at zero, rad.
    pub zero_rad: f64,
    /// What goes wrong with the frame, in any order.
    pub faults: &'a [StageFault],
}

impl Default for FrameConfiguration<'_> {
    /// Perfect, standing at zero, between hard ends at ±100° with switches at ±95°.
    fn default() -> Self {
        Self {
            stage: StageConfiguration {
                travel_rad: [-100.0, 100.0].map(f64::to_radians),
                switches_rad: [-95.0, 95.0].map(f64::to_radians),
                ..StageConfiguration::default()
            },
            encoder: EncoderConfiguration::default(),
            zero_rad: 0.0,
            faults: &[],
        }
    }
}

/// A two-frame mount with its instruments, and everything that happens to them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GimbalConfiguration<'a> {
    /// Site, attitude, sensors, converter, sway and disturbances. Stage, its faults, encoder and the
    /// gyro's elevation are those of a single-axis stage and not looked at.
    pub plant: PlantConfiguration<'a>,
    /// The outer frame.
    pub outer: FrameConfiguration<'a>,
    /// The inner frame.
    pub inner: FrameConfiguration<'a>,
    /// How the mechanism is misaligned.
    pub misalignment: Misalignment,
    /// The gyro's g-sensitivity across both its sensitive axis and the inner axis, forward where the
    /// frames stand at zero, °/h/g; the other two stand with the gyro, the second one along the inner
    /// axis.
    pub third_g_sensitivity_deg_h_g: f64,
}

/// A frame at work: what its encoder sees, and its motor driver by the drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame<'a> {
    /// The train that moves it, with its faults.
    pub drive: Drive<'a>,
    /// Errors of its encoder.
    encoder: EncoderConfiguration,
    /// What the encoder shows at zero, rad.
    zero_rad: f64,
}

impl<'a> Frame<'a> {
    /// A frame at the start of the clock.
    fn new(configuration: &FrameConfiguration<'a>) -> Self {
        Self {
            drive: Drive::new(&configuration.stage, configuration.faults),
            encoder: configuration.encoder,
            zero_rad: configuration.zero_rad,
        }
    }
}

impl ShaftAngle for Frame<'_> {
    fn shaft_turns(&mut self, now: Instant) -> f64 {
        self.drive.advance(now);
        let angle_rad = self.encoder.read(self.drive.state().angle_rad);
        (angle_rad + self.zero_rad + self.drive.slip_rad(now)) / core::f64::consts::TAU
    }
}

/// The mount at work.
#[derive(Clone, Debug, PartialEq)]
pub struct Gimbal<'a> {
    /// The outer frame.
    pub outer: Frame<'a>,
    /// The inner frame.
    pub inner: Frame<'a>,
    /// How the mechanism is misaligned.
    misalignment: Misalignment,
    /// The g-sensitivity along the third axis, rad/s per g.
    third_rad_s: f64,
    /// Instruments in the inner frame and on the base, and the motion of the base.
    payload: Payload<'a>,
    /// What was felt last, on a base at rest, with the frames that it belongs to.
    felt: Option<([StageState; 2], Felt)>,
}

/// Axes of the mechanism in the base's frame, unit vectors forward, right, down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes {
    /// The outer frame's axis.
    pub outer: [f64; 3],
    /// The inner frame's axis.
    pub inner: [f64; 3],
    /// The gyro's sensitive axis.
    pub sensitive: [f64; 3],
    /// Across the inner and the sensitive axis: forward where the frames stand at zero.
    pub third: [f64; 3],
}

impl Misalignment {
    /// The axes with the frames at these true angles, rad: the outer one positive right side down, the
    /// inner one where it takes the sensitive axis from down to forward.
    #[must_use]
    pub fn axes(&self, outer_rad: f64, inner_rad: f64) -> Axes {
        let case = multiply(&about_z(self.azimuth_rad), &about_y(self.pitch_rad));
        let bearing = multiply(&multiply(&case, &about_x(outer_rad)), &about_z(self.frames_rad));
        let frame = multiply(&bearing, &about_y(inner_rad));
        let gyro = multiply(&frame, &about_x(-self.gyro_rad));
        Axes {
            outer: column(&case, 0),
            inner: column(&bearing, 1),
            sensitive: column(&gyro, 2),
            third: column(&frame, 0),
        }
    }
}

impl<'a> Gimbal<'a> {
    /// A mount at the start of the clock; the seed fixes everything random in it.
    #[must_use]
    pub fn new(configuration: &GimbalConfiguration<'a>, seed: u64) -> Self {
        Self {
            outer: Frame::new(&configuration.outer),
            inner: Frame::new(&configuration.inner),
            misalignment: configuration.misalignment,
            third_rad_s: configuration.third_g_sensitivity_deg_h_g * DEGREE_PER_HOUR,
            payload: Payload::new(&configuration.plant, seed),
            felt: None,
        }
    }

    /// Moves both frames on to `now`.
    pub fn advance(&mut self, now: Instant) {
        self.outer.drive.advance(now);
        self.inner.drive.advance(now);
    }

    /// True angles and rates of the outer and the inner frame at the latest moment.
    pub fn frames(&self) -> [StageState; 2] {
        [&self.outer, &self.inner].map(|frame| frame.drive.state())
    }

    /// Brings the instruments to what the gyro's converter, 0, or the accelerometer, 1, feels.
    fn feel(&mut self, chip: usize, now: Instant) {
        self.advance(now);
        let frames = self.frames();
        let felt = match (self.payload.ridden(chip, now), &self.payload.sway, self.felt) {
            (Some(means), ..) => self.felt_of(means.rate_rad_s, means.force_m_s2, frames),
            (None, Some(sway), _) => self.felt_on(&sway.at(seconds(now)), frames),
            (None, None, Some((known, felt))) if known == frames => felt,
            (None, None, _) => {
                let felt = self.felt_on(&BaseMotion::default(), frames);
                self.felt = Some((frames, felt));
                felt
            }
        };
        self.payload.instruments.pose.felt = felt;
    }

    /// What is felt on a base that moves.
    fn felt_on(&self, motion: &BaseMotion, frames: [StageState; 2]) -> Felt {
        let Instruments { attitude, site, .. } = &self.payload.instruments;
        let attitude = motion.moved(attitude);
        let base = site.with_attitude(&attitude).on_platform(0.0);
        let own = motion.body_rad_s(&attitude);
        let rate_rad_s = core::array::from_fn(|i| base.rate_rad_s[i] + own[i]);
        self.felt_of(rate_rad_s, base.force_m_s2, frames)
    }

    /// What is felt where the base turns and feels a force like this, on its axes.
    fn felt_of(&self, turn: [f64; 3], force_m_s2: [f64; 3], frames: [StageState; 2]) -> Felt {
        let [outer, inner] = frames;
        let axes = self.misalignment.axes(outer.angle_rad, inner.angle_rad);
        let rate: [f64; 3] = core::array::from_fn(|i| {
            turn[i] + outer.rate_rad_s * axes.outer[i] + inner.rate_rad_s * axes.inner[i]
        });
        let Instruments { gyro, site, .. } = &self.payload.instruments;
        let gravity = site.gravity_m_s2;
        let [along, inner_g, third_g] =
            [axes.sensitive, axes.inner, axes.third].map(|axis| dot(axis, force_m_s2) / gravity);
        let (axis_rad_s, force_g) = (dot(axes.sensitive, rate), [along, inner_g]);
        let steady_rad_s = gyro.steady(axis_rad_s, force_g) + third_g * self.third_rad_s;
        Felt { axis_rad_s, steady_rad_s, force_m_s2, force_g }
    }
}

/// A column of a matrix: where it takes a unit vector.
fn column(matrix: &Matrix, index: usize) -> [f64; 3] {
    [0, 1, 2].map(|row| matrix[row][index])
}

/// The scalar product a · b.
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl AnalogueInput for Gimbal<'_> {
    fn volts(&mut self, now: Instant) -> f64 {
        self.feel(0, now);
        self.payload.volts(now)
    }
}

/// The accelerometer's axes are those of the base: forward, right, down.
impl ForceInput for Gimbal<'_> {
    fn force_g(&mut self, now: Instant) -> [f64; 3] {
        self.feel(1, now);
        let effect = self.payload.effect(now);
        self.payload.force_g(&effect)
    }

    fn temperature_c(&mut self, now: Instant) -> f64 {
        self.payload.instruments.temperature(seconds(now))
    }
}
