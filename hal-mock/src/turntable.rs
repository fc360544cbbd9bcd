//! A platform that turns all the time, sample by sample, as a recording of kind `rotating`: thousands
//! of runs without a chip.
//!
//! A list of segments says how the motor turns; the gear's unevenness makes the stage of it, and the
//! instruments are those of a board ([`crate::instruments`]). Angles and rates have closed forms, so
//! that an hour is as exact as a second.

use crate::accelerometer::Lever;
use crate::disturbance::{self, Disturbance};
use crate::instruments::{BaseMotion, Instruments, InstrumentsConfiguration};
use crate::stage::{StageState, Unevenness, first_sample};

/// A stretch of time under one rate law of the motor: a ramp from the rate it had to
/// `rate_rad_s`, then `rate_rad_s`·(1 + depth·sin 2πft) from the end of the ramp on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Segment {
    /// Mean rate, rad/s, clockwise positive; zero stands still.
    pub rate_rad_s: f64,
    /// Depth of a deliberate unevenness, relative to the mean rate, 1; zero for none.
    pub depth: f64,
    /// Frequency f of that unevenness, Hz, > 0 where there is a depth.
    pub frequency_hz: f64,
    /// Time of the ramp, s, ≥ 0, within `seconds`; zero changes the rate at once.
    pub ramp_s: f64,
    /// Duration, s, ≥ 0, the ramp included.
    pub seconds: f64,
}

impl Segment {
    /// A steady rate in rad/s for `seconds`, entered at once.
    #[must_use]
    pub const fn steady(rate_rad_s: f64, seconds: f64) -> Self {
        Self { rate_rad_s, depth: 0.0, frequency_hz: 0.0, ramp_s: 0.0, seconds }
    }

    /// This segment with its rate modulated: by `depth` relative to the mean rate, 1, at `frequency_hz`,
    /// > 0.
    #[must_use]
    pub const fn modulated(self, depth: f64, frequency_hz: f64) -> Self {
        Self { depth, frequency_hz, ..self }
    }

    /// This segment entered by a ramp of `ramp_s` seconds, ≥ 0, by which it lasts longer.
    #[must_use]
    pub const fn after(self, ramp_s: f64) -> Self {
        Self { ramp_s, seconds: self.seconds + ramp_s, ..self }
    }

    /// How far the motor has turned, rad, and its rate, rad/s, `elapsed_s` seconds after the beginning of
    /// the segment, where it had the rate `before_rad_s`.
    fn at(&self, before_rad_s: f64, elapsed_s: f64) -> StageState {
        let gain_rad_s = self.rate_rad_s - before_rad_s;
        if elapsed_s < self.ramp_s {
            let part = elapsed_s / self.ramp_s;
            return StageState {
                angle_rad: (before_rad_s + 0.5 * gain_rad_s * part) * elapsed_s,
                rate_rad_s: before_rad_s + gain_rad_s * part,
            };
        }
        let lost_rad = 0.5 * gain_rad_s * self.ramp_s;
        let even = StageState {
            angle_rad: self.rate_rad_s * elapsed_s - lost_rad,
            rate_rad_s: self.rate_rad_s,
        };
        if self.depth == 0.0 { even } else { self.modulate(even, elapsed_s - self.ramp_s) }
    }

    /// An even motion with the unevenness of the `elapsed_s` seconds since the ramp ended.
    fn modulate(&self, even: StageState, elapsed_s: f64) -> StageState {
        let angular = core::f64::consts::TAU * self.frequency_hz;
        let (sine, cosine) = libm::sincos(angular * elapsed_s);
        let change_rad_s = self.rate_rad_s * self.depth;
        StageState {
            angle_rad: even.angle_rad + change_rad_s / angular * (1.0 - cosine),
            rate_rad_s: even.rate_rad_s + change_rad_s * sine,
        }
    }
}

/// An encoder whose magnet slips once and creeps from then on; the default does neither.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EncoderSlip {
    /// When the magnet slips, s from the first sample.
    pub from_s: f64,
    /// What the encoder shows more from then on, rad.
    pub by_rad: f64,
    /// What it shows more for each further second of turning, rad/s.
    pub rad_per_s: f64,
}

/// A run: the instruments, how the platform turns, what goes wrong; by default perfect instruments on a level
/// platform at the equator, with nowhere to turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TurntableConfiguration<'a> {
    /// Site, attitude, sensors, sample rate.
    pub instruments: InstrumentsConfiguration,
    /// Unevenness of the gear.
    pub unevenness: Unevenness,
    /// Angle of the gear at the first sample, rad.
    pub start_rad: f64,
    /// From the axis to the accelerometer, m, along the gyro's axis and 90° clockwise of it.
    pub accelerometer_lever_m: [f64; 2],
    /// What goes wrong with the encoder.
    pub slip: EncoderSlip,
    /// How the motor turns, in order; the run ends with the last of them.
    pub segments: &'a [Segment],
    /// Events, in any order.
    pub disturbances: &'a [Disturbance],
}

/// One reading of a turning platform, as a recording of kind `rotating` has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TurningSample {
    /// Time from the first sample, s.
    pub time_s: f64,
    /// What the encoder shows, rad, not wrapped.
    pub stage_rad: f64,
    /// True rate of the stage, rad/s.
    pub stage_rate_rad_s: f64,
    /// What the gyro shows, rad/s.
    pub rate_rad_s: f64,
    /// What the accelerometer shows, m/s²: x along the sensitive axis (the recording's `a_m_s2`), y 90°
    /// clockwise, z down.
    pub force_m_s2: [f64; 3],
}

/// The motor's way through its segments.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Motor<'a> {
    /// The segments that are left, the current one first.
    segments: &'a [Segment],
    /// Samples per second, Hz.
    rate_hz: f64,
    /// When the current segment began, s from the first sample.
    since_s: f64,
    /// Angle and rate of the motor at that time.
    then: StageState,
    /// First sample after it.
    end: u64,
}

impl<'a> Motor<'a> {
    /// A motor at rest at an angle in rad, before its first segment.
    fn new(segments: &'a [Segment], start_rad: f64, rate_hz: f64) -> Self {
        let then = StageState { angle_rad: start_rad, rate_rad_s: 0.0 };
        let seconds = segments.first().map_or(0.0, |segment| segment.seconds);
        Self { segments, rate_hz, since_s: 0.0, then, end: first_sample(seconds, rate_hz) }
    }

    /// State at sample number `sample`; ask in rising order. None after the last segment.
    #[inline]
    fn state(&mut self, sample: u64) -> Option<StageState> {
        while sample >= self.end {
            self.change()?;
        }
        let elapsed_s = sample as f64 / self.rate_hz - self.since_s;
        Some(self.after(self.segments.first()?, elapsed_s))
    }

    /// State `elapsed_s` seconds into a segment.
    fn after(&self, segment: &Segment, elapsed_s: f64) -> StageState {
        let turned = segment.at(self.then.rate_rad_s, elapsed_s);
        StageState { angle_rad: self.then.angle_rad + turned.angle_rad, ..turned }
    }

    /// Goes over to the next segment, if there is one.
    #[cold]
    fn change(&mut self) -> Option<()> {
        let (over, left) = self.segments.split_first()?;
        let next = left.first()?;
        self.then = self.after(over, over.seconds);
        self.since_s += over.seconds;
        self.segments = left;
        self.end = first_sample(self.since_s + next.seconds, self.rate_hz);
        Some(())
    }
}

/// A turning platform at work: an iterator of samples that starts at t = 0 and ends after the last segment.
/// Sample k is taken at k/`rate_hz`.
#[derive(Clone, Debug, PartialEq)]
pub struct Turntable<'a> {
    /// The motor's way.
    motor: Motor<'a>,
    /// Unevenness of the gear.
    unevenness: Unevenness,
    /// What is mounted on the platform.
    instruments: Instruments,
    /// Where the accelerometer sits.
    lever: Lever,
    /// What goes wrong with the encoder.
    slip: EncoderSlip,
    /// How far the encoder has crept, rad.
    crept_rad: f64,
    /// What disturbs the sensors, in any order.
    disturbances: &'a [Disturbance],
    /// Number of the next sample.
    next: u64,
}

impl<'a> Turntable<'a> {
    /// The platform of a configuration; the seed fixes everything random in it.
    #[must_use]
    pub fn new(configuration: &TurntableConfiguration<'a>, seed: u64) -> Self {
        let c = configuration;
        Self {
            motor: Motor::new(c.segments, c.start_rad, c.instruments.rate_hz),
            unevenness: c.unevenness,
            instruments: Instruments::new(&c.instruments, seed),
            lever: Lever::new(c.accelerometer_lever_m),
            slip: c.slip,
            crept_rad: 0.0,
            disturbances: c.disturbances,
            next: 0,
        }
    }

    /// The next sample on a base that may move, with a drift of the gyro, rad/s: both at a time, s, and a true
    /// stage angle, rad.
    #[inline]
    pub fn next_on(
        &mut self,
        befalls: impl FnOnce(f64, f64) -> (Option<BaseMotion>, f64),
    ) -> Option<TurningSample> {
        let stage = self.unevenness.stage(self.motor.state(self.next)?);
        let time_s = self.next as f64 / self.motor.rate_hz;
        self.next += 1;
        let (motion, drift_rad_s) = befalls(time_s, stage.angle_rad);
        match motion {
            Some(motion) => self.instruments.turn_on(stage, &motion),
            None => self.instruments.turn(stage),
        }
        let mut effect = disturbance::total(self.disturbances, time_s);
        effect.rate_rad_s += drift_rad_s;
        let rate_rad_s = self.instruments.rate(time_s, &effect);
        self.lever.add(&mut effect, time_s, stage.rate_rad_s);
        let force_m_s2 = self.instruments.force(&effect);
        let stage_rad = self.instruments.shown_rad() + self.slipped_rad(time_s, stage.rate_rad_s);
        let stage_rate_rad_s = stage.rate_rad_s;
        Some(TurningSample { time_s, stage_rad, stage_rate_rad_s, rate_rad_s, force_m_s2 })
    }

    /// How far the encoder has slipped and crept, rad.
    fn slipped_rad(&mut self, time_s: f64, rate_rad_s: f64) -> f64 {
        if time_s < self.slip.from_s {
            return 0.0;
        }
        let slipped_rad = self.slip.by_rad + self.crept_rad;
        if rate_rad_s != 0.0 {
            self.crept_rad += self.slip.rad_per_s / self.motor.rate_hz;
        }
        slipped_rad
    }
}

impl Iterator for Turntable<'_> {
    type Item = TurningSample;

    #[inline]
    fn next(&mut self) -> Option<TurningSample> {
        self.next_on(|_, _| (None, 0.0))
    }
}
