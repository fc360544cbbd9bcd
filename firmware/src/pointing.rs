//! Direction of the gyro's sensitive axis by the encoders: one angle of a stage, or the two angles
//! of a two-frame mount.
//!
//! Each encoder has a retry budget. Its harmonic errors are subtracted, and a reading that differs
//! from the one before by more than any stage can turn is discarded. For two frames, heading and
//! elevation follow from the calibrated geometry.
//!
//! The session detects a movement by changes of the heading. The heading of a two-frame mount need
//! not change while a frame moves, so while either frame moves, or the axis is not level, the
//! reported heading jumps by a quarter of a turn from sample to sample.

use embassy_time::{Duration, Instant};
use orientation::alignment::refusal::Refusal;
use orientation::alignment::stepwise::mount::{FrameAngles, TwoFrame};
use orientation::alignment::stepwise::session::procedure::STILL;
use orientation::device::Device;
use orientation::units::{Angle, DEGREE, MetresPerSecondSquared, Radians};

use crate::calibration::{Calibration, Harmonics};
use crate::configuration::{Configuration, FramesConfiguration};
use crate::guarded::Guarded;
use crate::ports::{Encoder, Frames};
use crate::retry_budget::Symptom;
use crate::shared::{LatestAngle, Shared};

/// Largest rate of any stage: a quarter of a turn per second, in steps of an [`Angle`] per
/// microsecond.
const FASTEST: u32 = (1 << 30) / 1_000_000 + 1;
/// Largest jump of an angle, in steps: one degree, for backlash, ringing and a slipping magnet.
const PLAY: u32 = u32::MAX / 360;
/// Longest interval that limits the change, µs: after it, a stage may stand anywhere.
const LONGEST: u64 = 2_000_000;

/// Delay of a reading, over a sampling period, from which the angle is put back to the end of the
/// conversion: at a turn a second, 1/16 of 2.5 ms is 0.06°.
const LATE: u32 = 16;
/// Longest time between two readings over which a rate is taken as constant.
const STEADY: Duration = Duration::from_millis(50);

/// Elevation beyond which the axis does not count as level, rad: three times the tolerance of a
/// drive.
const LEVEL: f64 = 0.1 * DEGREE;

/// Direction of the sensitive axis with one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Aim {
    /// Heading in the base's plane, clockwise from the base's forward axis.
    pub heading: Angle,
    /// Elevation above the base's plane; [`None`] on a stage, where it is zero.
    pub elevation: Option<Angle>,
}

/// The encoders as the source of the direction of the sensitive axis.
pub trait Pointing {
    /// The readings of the encoders.
    type Shown;

    /// Starts the encoders.
    ///
    /// # Errors
    /// An encoder is given up.
    async fn start(&mut self) -> Result<(), Refusal>;

    /// Restores the full retry budget of the encoders.
    fn renew(&mut self);

    /// Readings of the encoders, taken once in every `angle_divider` samples and repeated between;
    /// [`None`] if a reading was lost, whose symptoms [`Self::mend`] handles. The angle is put back by
    /// `late`, the time for which other tasks kept the conversion waiting to which the reading belongs.
    async fn read(&mut self, late: Duration) -> Option<Self::Shown>;

    /// Handles the symptoms of the latest readings, where there are any.
    ///
    /// # Errors
    /// An encoder is given up.
    async fn mend(&mut self) -> Result<(), Refusal>;

    /// The direction of the sensitive axis that belongs to readings of the encoders.
    fn aim(&mut self, shown: Self::Shown) -> Aim;

    /// Elevation of the axis at rest; [`None`] while it moves, or if it cannot leave the base's
    /// plane.
    fn elevation(&self) -> Option<Angle> {
        None
    }

    /// Standard deviation of the biases of an accelerometer that is fixed to the base, 1σ; [`None`]
    /// if it is on the platform with the gyro.
    fn force_on_base(&self) -> Option<MetresPerSecondSquared> {
        None
    }
}

/// A decimator: due at the first call, then at every `divider`-th.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decimator {
    /// The decimation, ≥ 1.
    pub(crate) divider: u32,
    /// Calls until the next one that is due.
    left: u32,
}

impl Decimator {
    /// Creates a decimator; a divider of zero counts as one.
    pub(crate) fn new(divider: u32) -> Self {
        Self { divider: divider.max(1), left: 0 }
    }

    /// Counts a call, and returns whether it is due.
    pub(crate) fn is_due(&mut self) -> bool {
        let is_due = self.left == 0;
        self.left = if is_due { self.divider } else { self.left } - 1;
        is_due
    }
}

/// A quarter of a turn in steps of an [`Angle`].
const QUARTER_TURN: u32 = 1 << 30;

/// Distance of two angles on the circle, in steps.
fn distance(a: Angle, b: Angle) -> u32 {
    (a - b).0.cast_signed().unsigned_abs()
}

/// Largest change of an angle in an interval, in steps of an [`Angle`].
fn greatest_step(time: Duration) -> u32 {
    PLAY.saturating_add(time.as_micros().min(LONGEST) as u32 * FASTEST)
}

/// An angle as it was some time before it was read, by the rate since the reading before; unchanged
/// where that is too long ago.
fn put_back(
    (angle, read): (Angle, Instant),
    (before, read_before): (Angle, Instant),
    late: Duration,
) -> Angle {
    let since = read - read_before;
    if since > STEADY || since.as_ticks() == 0 {
        return angle;
    }
    let turned = (angle - before).0.cast_signed() as f32;
    // Both are short, and the core converts 32 bits by an instruction.
    let share = late.min(STEADY).as_ticks() as u32 as f32 / since.as_ticks() as u32 as f32;
    angle - Angle(((turned * share) as i32).cast_unsigned())
}

/// The encoder of one axis: retry budget, calibration and check of its jumps.
pub struct Shaft<'a, E> {
    /// The encoder with its retry budget.
    encoder: Guarded<'a, E>,
    /// Correction of its harmonic errors.
    calibration: Calibration,
    /// Decimation of the readings.
    due: Decimator,
    /// The angle of the latest reading; [`None`] if it was lost.
    angle: Option<Angle>,
    /// The cell for the latest valid angle, read by the motor's control.
    latest: &'a LatestAngle,
    /// Symptom with which the latest reading was lost, until it is handled.
    symptom: Option<Symptom>,
    /// Whether the latest reading was discarded as a jump.
    has_jumped: bool,
    shared: &'a Shared<'a>,
}

impl<'a, E: Encoder> Shaft<'a, E> {
    /// Takes an encoder with its name in the log; nothing is started yet. Valid angles are written
    /// to `latest`.
    pub fn new(
        encoder: &'a mut E,
        name: Device,
        harmonics: Harmonics,
        configuration: &Configuration,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a>,
    ) -> Self {
        Self {
            encoder: Guarded::new(encoder, name),
            calibration: Calibration::new(harmonics),
            due: Decimator::new(configuration.angle_divider),
            angle: None,
            latest,
            symptom: None,
            has_jumped: false,
            shared,
        }
    }

    /// Accepts an angle that was read now, unless it differs from the one before by more than the
    /// axis can turn: such a reading is discarded and counted. The next one is accepted in any
    /// case, for the axis may really have moved.
    fn is_in_line(&mut self, angle: Angle, now: Instant) -> bool {
        let (last, read) = self.latest.get();
        let is_far = distance(angle, last) > greatest_step(now - read);
        self.has_jumped = is_far && !self.has_jumped && read > Instant::MIN;
        if self.has_jumped {
            self.shared.lose(self.encoder.name, Symptom::Jumped);
            return false;
        }
        self.latest.set((angle, now));
        self.shared.sensing.signal(());
        true
    }
}

/// The one axis of a stage: the sensitive axis lies in the stage's plane, and its angle is the
/// heading.
impl<E: Encoder> Pointing for Shaft<'_, E> {
    type Shown = Angle;

    async fn start(&mut self) -> Result<(), Refusal> {
        self.encoder.start(self.shared).await
    }

    fn renew(&mut self) {
        self.encoder.renew();
    }

    async fn read(&mut self, late: Duration) -> Option<Angle> {
        if self.due.is_due() || self.angle.is_none() {
            let outcome = self.encoder.device.read().await;
            let now = Instant::now();
            let outcome = self.encoder.checked(outcome);
            self.symptom = outcome.err();
            self.angle = outcome.ok().map(|shown| self.calibration.correct(shown));
            let before = self.latest.get();
            self.angle = self.angle.filter(|angle| self.is_in_line(*angle, now));
            if late > self.shared.period.get() / LATE {
                self.angle = self.angle.map(|angle| put_back((angle, now), before, late));
            }
        }
        self.angle
    }

    async fn mend(&mut self) -> Result<(), Refusal> {
        let Some(symptom) = self.symptom.take() else { return Ok(()) };
        self.encoder.mend(symptom, self.shared).await.map(|_| ())
    }

    fn aim(&mut self, heading: Angle) -> Aim {
        Aim { heading, elevation: None }
    }
}

/// The encoders of the two frames of a mount.
pub struct FrameShafts<'a, E> {
    /// Encoders of the outer and the inner frame.
    shafts: Frames<Shaft<'a, E>>,
    /// Calibrated geometry of the mount.
    geometry: TwoFrame,
    /// Standard deviation of the accelerometers' biases, 1σ.
    force_bias_sigma: MetresPerSecondSquared,
    /// Time without movement after which the frames count as at rest.
    rest: Duration,
    /// Largest change of an angle that counts as rest, in steps of an [`Angle`].
    still: u32,
    /// Largest elevation that counts as level, in steps of an [`Angle`].
    level: u32,
    /// Offset of the reported heading while the axis does not stand level: zero or a quarter of a
    /// turn in alternation, in steps, so that consecutive samples never show the same angle.
    jump: u32,
    /// Angles from which neither frame has moved.
    anchor: Frames<Angle>,
    /// Since when neither frame has moved from there.
    since: Instant,
    /// Angles to which [`Self::aim`] belongs; the trigonometry is repeated only if they have
    /// changed.
    seen: Option<Frames<Angle>>,
    /// Direction of the axis at these angles.
    aim: Aim,
}

impl<'a, E: Encoder> FrameShafts<'a, E> {
    /// Takes the encoders of both frames; nothing is started yet.
    pub fn new(
        encoders: &'a mut Frames<E>,
        configuration: &Configuration,
        frames: &FramesConfiguration,
        shared: &'a Shared<'a>,
    ) -> Self {
        let Frames { outer, inner } = encoders;
        let latest = &shared.angles;
        let Frames { outer: outer_error, inner: inner_error } = frames.encoders;
        let shaft = |encoder, name, harmonics, latest| {
            Shaft::new(encoder, name, harmonics, configuration, latest, shared)
        };
        Self {
            shafts: Frames {
                outer: shaft(outer, Device::OuterEncoder, outer_error, &latest.outer),
                inner: shaft(inner, Device::InnerEncoder, inner_error, &latest.inner),
            },
            geometry: frames.geometry(),
            force_bias_sigma: frames.force_bias_sigma,
            rest: frames.rest,
            still: Angle::from_rad(STILL.0).0,
            level: Angle::from_rad(LEVEL).0,
            jump: 0,
            anchor: Frames::default(),
            since: Instant::MIN,
            seen: None,
            aim: Aim { heading: Angle(0), elevation: None },
        }
    }

    /// Whether both frames have been at rest for long enough.
    fn has_rested(&mut self, angles: Frames<Angle>) -> bool {
        let has_moved = |now, then| distance(now, then) > self.still;
        if has_moved(angles.outer, self.anchor.outer) || has_moved(angles.inner, self.anchor.inner)
        {
            self.anchor = angles;
            self.since = Instant::now();
        }
        self.since.elapsed() >= self.rest
    }

    /// Computes the direction of the axis at these frame angles.
    fn point(&mut self, angles: Frames<Angle>) {
        if self.seen.replace(angles) == Some(angles) {
            return;
        }
        let Frames { outer, inner } = angles.map(|angle| Radians(angle.signed_rad()));
        let pointing = self.geometry.pointing(FrameAngles { outer, inner });
        self.aim.heading = Angle::from_rad(pointing.heading.0);
        self.aim.elevation = Some(Angle::from_rad(pointing.elevation.0));
    }
}

impl<E: Encoder> Pointing for FrameShafts<'_, E> {
    type Shown = Frames<Angle>;

    async fn start(&mut self) -> Result<(), Refusal> {
        self.shafts.outer.start().await?;
        self.shafts.inner.start().await
    }

    fn renew(&mut self) {
        self.shafts.outer.renew();
        self.shafts.inner.renew();
    }

    async fn read(&mut self, late: Duration) -> Option<Frames<Angle>> {
        let outer = self.shafts.outer.read(late).await;
        let inner = self.shafts.inner.read(late).await;
        outer.zip(inner).map(|(outer, inner)| Frames { outer, inner })
    }

    async fn mend(&mut self) -> Result<(), Refusal> {
        self.shafts.outer.mend().await?;
        self.shafts.inner.mend().await
    }

    fn aim(&mut self, angles: Frames<Angle>) -> Aim {
        if self.has_rested(angles) {
            // Only an axis at rest and level has a valid heading.
            self.point(angles);
            if self.aim.elevation.is_some_and(|up| distance(up, Angle(0)) <= self.level) {
                return self.aim;
            }
        }
        self.jump ^= QUARTER_TURN;
        Aim { heading: Angle(self.aim.heading.0.wrapping_add(self.jump)), ..self.aim }
    }

    fn elevation(&self) -> Option<Angle> {
        self.aim.elevation.filter(|_| self.since.elapsed() >= self.rest)
    }

    fn force_on_base(&self) -> Option<MetresPerSecondSquared> {
        Some(self.force_bias_sigma)
    }
}
