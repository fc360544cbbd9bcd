//! The plant: the stage's mechanics with the instruments on it, as the chips of the board see them.
//!
//! ```text
//!  actuator ─microsteps─▶ train ─angle, rate─▶ instruments ─volts─▶ gyro's converter
//!     ▲ blocked, switches ──┘   base, sway ──▶     │  │ └──force, temperature─▶ accelerometer
//!                                disturbances ─────┘  └──shown angle + slip──▶ encoder
//! ```
//!
//! Time counts from the start of the clock and must not fall. Noise is drawn once for each reading:
//! of the gyro once a conversion, of the accelerometer once an output. A reading stands for the
//! motion at its end; within one period of the gyro's converter the stage turns too little to matter
//! except while it rotates. While the stage stands on a base at rest nothing is computed but noise,
//! warm-up and disturbances.

pub mod base;
pub mod drive;
pub mod journey;
pub(crate) mod payload;
mod ringing;
pub mod sway;
pub mod train;

use embassy_time::Instant;

use crate::accelerometer::Lever;
use crate::disturbance::Disturbance;
use crate::environment::{AnalogueInput, ForceInput, Mechanics, ShaftAngle};
use crate::instruments::{InstrumentsConfiguration, Truth};
use drive::Drive;
use journey::JourneyConfiguration;
use payload::Payload;
use sway::SwayConfiguration;
use train::StageConfiguration;

/// The unit of an accelerometer's output, m/s² (standard gravity, ISO 80000-3).
pub(crate) const STANDARD_GRAVITY_M_S2: f64 = 9.806_65;

/// One degree per second in rad/s.
pub(crate) const DEGREE_PER_SECOND: f64 = core::f64::consts::PI / 180.0;

/// Bytes of a plant: it lies in a static of a board with 96 KB.
const LARGEST: usize = 2560;

const _: () = assert!(size_of::<Plant>() <= LARGEST);

/// What goes wrong with the stage, by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StageFault {
    /// Something holds the stage from one moment until another; [`Instant::MAX`] for good.
    Block {
        /// When the stage is caught.
        from: Instant,
        /// When the stage is let go.
        until: Instant,
    },
    /// The encoder's magnet slips on its shaft.
    Slip {
        /// When the encoder slips.
        at: Instant,
        /// What the encoder shows more from then on, rad.
        by_rad: f64,
    },
    /// The encoder's magnet creeps on its shaft whenever the motor turns the stage, either way.
    Creep {
        /// From when on.
        from: Instant,
        /// What the encoder shows more for each second of turning, rad/s.
        rad_per_s: f64,
    },
}

/// A stage with its instruments, and everything that happens to them.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantConfiguration<'a> {
    /// Site, attitude, sensors. Its `rate_hz` is the conversion rate of the gyro's converter; its
    /// encoder's `step_rad` stays zero, since the chip has its own.
    pub instruments: InstrumentsConfiguration,
    /// Output rate of the accelerometer, Hz, > 0 (default 125).
    pub accelerometer_hz: f64,
    /// From the axis of the stage to the accelerometer, m, along the gyro's axis and 90° clockwise of
    /// it (default: on the axis).
    pub accelerometer_lever_m: [f64; 2],
    /// Scale factor of the gyro, V per rad/s (default 50 mV per °/s).
    pub gyro_volts_per_rad_s: f64,
    /// Rate at which the gyro's output clips, rad/s (default 40 °/s: ±2 V).
    pub gyro_full_scale_rad_s: f64,
    /// White noise of the converter, V RMS per conversion.
    pub converter_noise_v: f64,
    /// Mechanics of the stage.
    pub stage: StageConfiguration,
    /// Sway of the base.
    pub sway: SwayConfiguration,
    /// Where the base goes, if it leaves.
    pub journey: Option<JourneyConfiguration<'a>>,
    /// Bumps, nudges and overloads; their times count from the start of the clock.
    pub disturbances: &'a [Disturbance],
    /// Faults of the stage, in any order.
    pub faults: &'a [StageFault],
}

impl Default for PlantConfiguration<'_> {
    /// Perfect instruments on a perfect stage, left alone.
    fn default() -> Self {
        Self {
            instruments: InstrumentsConfiguration::default(),
            accelerometer_hz: 125.0,
            accelerometer_lever_m: [0.0; 2],
            gyro_volts_per_rad_s: 0.05 / DEGREE_PER_SECOND,
            gyro_full_scale_rad_s: 40.0 * DEGREE_PER_SECOND,
            converter_noise_v: 0.0,
            stage: StageConfiguration::default(),
            sway: SwayConfiguration::default(),
            journey: None,
            disturbances: &[],
            faults: &[],
        }
    }
}

/// The plant at work.
#[derive(Clone, Debug, PartialEq)]
pub struct Plant<'a> {
    /// Instruments on the stage, and the motion of the base.
    payload: Payload<'a>,
    /// Motor, gear and stage, with their faults.
    pub(crate) drive: Drive<'a>,
    /// Moment of the latest pose on a swaying base.
    swayed_at: Option<Instant>,
    /// Where the accelerometer sits.
    lever: Lever,
}

impl<'a> Plant<'a> {
    /// A plant at the start of the clock; the seed fixes everything random in it.
    ///
    /// Not inlined, so that a size report of an image counts it with the simulation and not with the
    /// caller.
    #[must_use]
    #[inline(never)]
    pub fn new(configuration: &PlantConfiguration<'a>, seed: u64) -> Self {
        Self {
            payload: Payload::new(configuration, seed),
            drive: Drive::new(&configuration.stage, configuration.faults),
            swayed_at: None,
            lever: Lever::new(configuration.accelerometer_lever_m),
        }
    }

    /// Moves the stage on to `now`, so that switches and stall are those of that moment.
    #[inline]
    pub fn advance(&mut self, now: Instant) {
        self.drive.advance(now);
    }

    /// What the sensors cannot know: attitude of the base at rest, drawn biases and scale; stage as
    /// of the latest moment, rate as of the latest reading.
    pub fn truth(&self) -> Truth {
        Truth { stage: self.drive.state(), ..self.payload.instruments.truth() }
    }

    /// Brings the instruments to where the stage is at `now`.
    #[inline]
    fn look(&mut self, now: Instant) {
        self.advance(now);
        let stage = self.drive.state();
        let Payload { instruments, sway, .. } = &mut self.payload;
        match sway {
            None => instruments.turn(stage),
            Some(sway) if self.swayed_at != Some(now) => {
                instruments.turn_on(stage, &sway.at(seconds(now)));
                self.swayed_at = Some(now);
            }
            Some(_) => {}
        }
    }

    /// Brings the instruments to what they feel in a reading at `now`: of the gyro's converter with
    /// `chip` 0, of the accelerometer with 1.
    #[inline]
    fn feel(&mut self, chip: usize, now: Instant) {
        self.look(now);
        if let Some(means) = self.payload.ridden(chip, now) {
            self.payload.instruments.ride(self.drive.state(), &means);
        }
    }
}

/// Seconds since the start of the clock.
pub(crate) fn seconds(now: Instant) -> f64 {
    now.as_micros() as f64 * 1e-6
}

impl AnalogueInput for Plant<'_> {
    fn volts(&mut self, now: Instant) -> f64 {
        self.feel(0, now);
        self.payload.volts(now)
    }
}

/// The accelerometer's axes are those of the platform: x along the gyro's axis, z down.
impl ForceInput for Plant<'_> {
    fn force_g(&mut self, now: Instant) -> [f64; 3] {
        self.feel(1, now);
        let mut effect = self.payload.effect(now);
        self.lever.add(&mut effect, seconds(now), self.drive.state().rate_rad_s);
        self.payload.force_g(&effect)
    }

    fn temperature_c(&mut self, now: Instant) -> f64 {
        self.payload.instruments.temperature(seconds(now))
    }
}

impl ShaftAngle for Plant<'_> {
    fn shaft_turns(&mut self, now: Instant) -> f64 {
        self.look(now);
        (self.payload.instruments.shown_rad() + self.drive.slip_rad(now)) / core::f64::consts::TAU
    }
}

impl Mechanics for Plant<'_> {
    fn drive(&mut self, now: Instant, microsteps: f64, microsteps_per_s: f64) {
        self.drive.drive(now, microsteps, microsteps_per_s);
        // The pose of this moment may have been another.
        self.swayed_at = None;
    }

    fn is_blocked(&self) -> bool {
        self.drive.is_blocked()
    }

    fn reference_switches(&self) -> [bool; 2] {
        self.drive.reference_switches()
    }

    fn beyond_edge(&self) -> f64 {
        self.drive.beyond_edge()
    }
}
