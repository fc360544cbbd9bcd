//! Where the gyro's sensitive axis points, by the encoders: of a stage's one axis, or of two frames.
//!
//! Decimator encoder is guarded, its harmonics are taken off, and a reading further from the one before
//! than anything can turn is lost. Two frames give heading and elevation by their calibrated geometry.
//! The session takes the axis to stand where its heading does; of two frames the heading does not tell,
//! so while either moves, or the axis is not level, it is made to jump from sample to sample.

use core::cell::Cell;

use embassy_time::{Duration, Instant};
use orientation::align::mount::{FrameAngles, TwoFrame};
use orientation::device::Device;
use orientation::error::Refusal;
use orientation::session::procedure::STILL;
use orientation::units::{Angle, DEGREE};

use crate::calibration::{Calibration, Harmonics};
use crate::configuration::{Configuration, FramesConfiguration};
use crate::guarded::Guarded;
use crate::ports::{Encoder, Frames, Observer};
use crate::retry_budget::Symptom;
use crate::shared::{LatestAngle, Shared};

/// Faster than any stage: a quarter of a turn a second, in steps of an [`Angle`] in a microsecond.
const FASTEST: u32 = (1 << 30) / 1_000_000 + 1;
/// What a stage may jump by, in steps: a degree of play, ringing, a slipping magnet.
const PLAY: u32 = u32::MAX / 360;
/// The longest time that counts, µs: after it a stage may stand anywhere.
const LONGEST: u64 = 2_000_000;

/// Elevation beyond which the axis is not where the frames were sent, rad: three times what a drive
/// tolerates.
const LEVEL: f64 = 0.1 * DEGREE;

/// Where the axis points with one sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Aim {
    /// Heading in the base plane.
    pub heading: Angle,
    /// Elevation above it, where there can be one.
    pub elevation: Option<Angle>,
}

/// What knows where the axis points.
#[expect(async_fn_in_trait, reason = "one executor polls all of it: no future needs to be Send")]
pub trait Pointing {
    /// What the encoders show.
    type Shown;

    /// Whether the accelerometer sits on the base, and not beside the gyro.
    const FORCE_ON_BASE: bool;

    /// Starts the encoders.
    async fn start(&mut self) -> Result<(), Refusal>;

    /// Has all retry budget with them again.
    fn renew(&mut self);

    /// What the encoders show, read anew with every so-manieth sample; none where a reading was lost.
    async fn read(&mut self) -> Result<Option<Self::Shown>, Refusal>;

    /// Where the axis points when the encoders show this.
    fn aim(&mut self, shown: Self::Shown) -> Aim;

    /// Elevation of an axis that stands, where it can leave the base's plane.
    fn elevation(&self) -> Option<Angle> {
        None
    }
}

/// Says yes at first, then every so-manieth time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decimator {
    /// How many.
    pub(crate) divider: u32,
    left: u32,
}

impl Decimator {
    pub(crate) fn new(divider: u32) -> Self {
        Self { divider: divider.max(1), left: 0 }
    }

    pub(crate) fn is_due(&mut self) -> bool {
        let is_due = self.left == 0;
        self.left = if is_due { self.divider } else { self.left } - 1;
        is_due
    }
}

/// A quarter of a turn in steps of an [`Angle`].
const QUARTER_TURN: u32 = 1 << 30;

/// How far apart two angles are, in steps.
fn distance(a: Angle, b: Angle) -> u32 {
    (a - b).0.cast_signed().unsigned_abs()
}

/// How far an axis can turn in a time, in steps of an [`Angle`].
fn greatest_step(time: Duration) -> u32 {
    PLAY.saturating_add(time.as_micros().min(LONGEST) as u32 * FASTEST)
}

/// The encoder of one axis at work.
pub struct Shaft<'a, E, O> {
    encoder: Guarded<'a, E>,
    name: Device,
    calibration: Calibration,
    due: Decimator,
    /// The angle of the latest reading; none where it was lost.
    angle: Option<Angle>,
    latest: &'a LatestAngle,
    has_jumped: bool,
    shared: &'a Shared<'a, O>,
}

impl<'a, E: Encoder, O: Observer> Shaft<'a, E, O> {
    /// Takes an encoder by its name in the log; nothing is started yet. Good angles go to `latest`.
    pub fn new(
        encoder: &'a mut E,
        name: Device,
        harmonics: Harmonics,
        configuration: &Configuration,
        latest: &'a LatestAngle,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        Self {
            encoder: Guarded::new(encoder, name),
            name,
            calibration: Calibration::new(harmonics),
            due: Decimator::new(configuration.angle_divider),
            angle: None,
            latest,
            has_jumped: false,
            shared,
        }
    }

    /// Takes an angle that was read now, unless it is further from the one before than the axis can turn: such a one is
    /// lost, but the next is believed.
    fn is_in_line(&mut self, angle: Angle, now: Instant) -> bool {
        let (last, read) = self.latest.get();
        let is_far = distance(angle, last) > greatest_step(now - read);
        self.has_jumped = is_far && !self.has_jumped && read > Instant::MIN;
        if self.has_jumped {
            self.shared.lose(self.name, Symptom::Jumped);
            return false;
        }
        self.latest.set((angle, now));
        self.shared.sensing.signal(());
        true
    }
}

/// The one axis of a stage: the sensitive axis lies in its plane, and its angle is the heading.
impl<E: Encoder, O: Observer> Pointing for Shaft<'_, E, O> {
    type Shown = Angle;

    const FORCE_ON_BASE: bool = false;

    async fn start(&mut self) -> Result<(), Refusal> {
        self.encoder.start(self.shared).await
    }

    fn renew(&mut self) {
        self.encoder.renew();
    }

    async fn read(&mut self) -> Result<Option<Angle>, Refusal> {
        if self.due.is_due() || self.angle.is_none() {
            let begun = Instant::now();
            let outcome = self.encoder.device.read().await;
            let now = Instant::now();
            self.angle = match self.encoder.checked_at(now, begun, outcome) {
                Ok(shown) => Some(self.calibration.correct(shown)),
                Err(symptom) => self.encoder.mend(symptom, self.shared).await.map(|()| None)?,
            };
            self.angle = self.angle.filter(|angle| self.is_in_line(*angle, now));
        }
        Ok(self.angle)
    }

    fn aim(&mut self, heading: Angle) -> Aim {
        Aim { heading, elevation: None }
    }
}

/// The two frames of a mount.
pub struct FrameShafts<'a, E, O> {
    shafts: Frames<Shaft<'a, E, O>>,
    geometry: TwoFrame,
    rest: Duration,
    /// Change of an angle that still counts as rest, and elevation that counts as level, in steps of an
    /// [`Angle`].
    still: u32,
    level: u32,
    /// What the heading of an axis that does not stand is off by: nothing or a quarter of a turn, in
    /// turns, so that no two samples show one angle.
    jump: u32,
    /// Angles from which neither frame has moved, and since when.
    anchor: Frames<Angle>,
    since: Instant,
    /// Angles that [`Self::aim`] is for: trigonometry is done only where they have changed.
    seen: Option<Frames<Angle>>,
    aim: Aim,
}

impl<'a, E: Encoder, O: Observer> FrameShafts<'a, E, O> {
    /// Takes both encoders; nothing is started yet.
    pub fn new(
        encoders: &'a mut Frames<E>,
        configuration: &Configuration,
        frames: &FramesConfiguration,
        latest: &'a Frames<LatestAngle>,
        shared: &'a Shared<'a, O>,
    ) -> Self {
        let Frames { outer, inner } = encoders;
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
            rest: frames.rest,
            still: Angle::from_rad(STILL).0,
            level: Angle::from_rad(LEVEL).0,
            jump: 0,
            anchor: Frames::default(),
            since: Instant::MIN,
            seen: None,
            aim: Aim { heading: Angle(0), elevation: None },
        }
    }

    /// Whether both frames have rested.
    fn has_rested(&mut self, angles: Frames<Angle>) -> bool {
        let has_moved = |now, then| distance(now, then) > self.still;
        if has_moved(angles.outer, self.anchor.outer) || has_moved(angles.inner, self.anchor.inner)
        {
            self.anchor = angles;
            self.since = Instant::now();
        }
        self.since.elapsed() >= self.rest
    }

    /// The direction of the axis at these angles.
    fn point(&mut self, angles: Frames<Angle>) {
        if self.seen.replace(angles) == Some(angles) {
            return;
        }
        let Frames { outer, inner } = angles.map(Angle::signed_rad);
        let pointing = self.geometry.pointing(FrameAngles { outer, inner });
        self.aim.heading = Angle::from_rad(pointing.heading);
        self.aim.elevation = Some(Angle::from_rad(pointing.elevation));
    }
}

impl<E: Encoder, O: Observer> Pointing for FrameShafts<'_, E, O> {
    type Shown = Frames<Angle>;

    const FORCE_ON_BASE: bool = true;

    async fn start(&mut self) -> Result<(), Refusal> {
        self.shafts.outer.start().await?;
        self.shafts.inner.start().await
    }

    fn renew(&mut self) {
        self.shafts.outer.renew();
        self.shafts.inner.renew();
    }

    async fn read(&mut self) -> Result<Option<Frames<Angle>>, Refusal> {
        let outer = self.shafts.outer.read().await?;
        let inner = self.shafts.inner.read().await?;
        Ok(outer.zip(inner).map(|(outer, inner)| Frames { outer, inner }))
    }

    fn aim(&mut self, angles: Frames<Angle>) -> Aim {
        if self.has_rested(angles) {
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
}

/// Latest angles of both frames that nobody has read yet.
impl Frames<LatestAngle> {
    /// Nothing was read.
    #[must_use]
    pub const fn unread() -> Self {
        Self {
            outer: Cell::new((Angle(0), Instant::MIN)),
            inner: Cell::new((Angle(0), Instant::MIN)),
        }
    }
}
