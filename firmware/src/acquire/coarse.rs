//! Motion of the base for whoever keeps attitude and azimuth: rates and forces of the coarse sensors there,
//! about the down axis those of the precise gyro once a mount has turned it to the vertical.

use embassy_time::Instant;
use orientation::signal::InertialSample;
use orientation::units::{Angle, AngleIncrement, AngularRate, SpecificForce};

use crate::keep::{Motion, VerticalGyro};
use crate::ports::{BaseReading, Observer};
use crate::shared::Shared;

/// A quarter of a turn, and how far from it an axis is as good as vertical, 0.1°, in steps of an
/// [`Angle`]: what it feels of other axes is below 0.02 °/h of the Earth's rate.
const QUARTER_TURN: u32 = 1 << 30;
const TOLERANCE: u32 = (0.1 / 360.0 * 4_294_967_296.0) as u32;
/// Periods that a reading may stand for: where more are missing, nobody knows what was turned.
const LONGEST: u64 = 3;

/// Samples over which the coarse gyro is compared with the precise one, and as many as tell enough: two
/// minutes and ten seconds at 200 Hz.
const COMPARED: u32 = 24_000;
const ENOUGH: u32 = 2_000;

/// What the coarse gyro about the down axis shows more than the precise one, in steps a sample.
#[derive(Clone, Copy, Debug, Default)]
struct Excess {
    mean: f32,
    count: u32,
    /// What was left over of whole steps.
    carried: f32,
}

impl Excess {
    fn push(&mut self, coarse: AngleIncrement, precise: AngleIncrement) {
        if coarse.is_saturated() || precise.is_saturated() {
            return;
        }
        self.count = (self.count + 1).min(COMPARED);
        self.mean += ((coarse.0 - precise.0) as f32 - self.mean) / self.count as f32;
    }

    /// Whether it is known.
    fn is_known(&self) -> bool {
        self.count >= ENOUGH
    }

    /// Takes it off, where it is known.
    fn less(&mut self, coarse: AngleIncrement) -> AngleIncrement {
        if !self.is_known() || coarse.is_saturated() {
            return coarse;
        }
        let whole = self.mean + self.carried;
        let steps = whole as i32;
        self.carried = whole - steps as f32;
        AngleIncrement(coarse.0.saturating_sub(steps))
    }
}

/// One sensor's time, and rounding that is carried on.
#[derive(Clone, Copy, Debug)]
struct Timing {
    /// Nominal time between two readings, µs.
    period: u32,
    latest: Option<Instant>,
}

impl Timing {
    /// How long a reading of this time has lasted, µs: since the one before; a period where that is not
    /// known. And whether nothing is missing.
    fn lasted(&mut self, at: Instant) -> (u32, bool) {
        let since = self.latest.replace(at).map(|latest| (at - latest).as_micros());
        match since {
            Some(since) if since <= LONGEST * u64::from(self.period) => (since as u32, true),
            _ => (self.period, false),
        }
    }
}

/// The precise gyro's turn since the latest coarse reading.
#[derive(Clone, Copy, Debug)]
struct Precise {
    pace: Timing,
    /// Sense of the axis: +1 down, −1 up, 0 neither.
    sense: i32,
    /// What it has turned, in steps of an increment, and what was left over of whole steps.
    turned: i64,
    carried: i64,
    /// Whether it was vertical all the time, whether nothing of it is missing, and none clipped.
    is_vertical: bool,
    is_whole: bool,
}

/// Samples from the base.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coarse {
    pace: Timing,
    carried: [i64; 3],
    precise: Precise,
    /// A force of a better accelerometer on the base; none where there was no new one.
    force: Option<[SpecificForce; 3]>,
    /// Whether there is such an accelerometer.
    is_felt: bool,
    down: VerticalGyro,
    excess: Excess,
}

impl Coarse {
    /// Coarse readings and samples of the precise gyro with periods in µs.
    pub(super) fn new(coarse: u32, precise: u32) -> Self {
        let pace = |period| Timing { period, latest: None };
        Self {
            pace: pace(coarse),
            carried: [0; 3],
            precise: Precise {
                pace: pace(precise),
                sense: 0,
                turned: 0,
                carried: 0,
                is_vertical: false,
                is_whole: true,
            },
            force: None,
            is_felt: false,
            down: VerticalGyro::Coarse,
            excess: Excess::default(),
        }
    }

    /// Takes a conversion of the precise gyro, if it was not lost.
    pub(super) fn turn(&mut self, at: Instant, rate: Option<AngularRate>) {
        let precise = &mut self.precise;
        let Some(rate) = rate.filter(|_| precise.sense != 0) else {
            return;
        };
        let (lasted, is_whole) = precise.pace.lasted(at);
        let turned = AngleIncrement::of_rate(rate, lasted, &mut precise.carried);
        precise.is_whole &= is_whole && !turned.is_saturated();
        precise.turned += i64::from(turned.0) * i64::from(precise.sense);
    }

    /// Where the precise gyro's axis points from now on: its elevation, if it stands and can leave the
    /// base's plane at all.
    pub(super) fn point(&mut self, elevation: Option<Angle>) {
        let sense = elevation.map_or(0, sense);
        if sense != self.precise.sense {
            self.precise.sense = sense;
            self.precise.is_vertical = false;
            self.precise.pace.latest = None;
        }
    }

    /// The precise gyro is given up.
    pub(super) fn lose_precise(&mut self) {
        self.precise.sense = 0;
        self.precise.is_vertical = false;
    }

    /// Takes a force of the better accelerometer, if there is a new one.
    pub(super) fn feel(&mut self, force: Option<[SpecificForce; 3]>) {
        self.is_felt |= force.is_some();
        self.force = force.or(self.force);
    }

    /// Makes a sample of a coarse reading and passes it on. What stood at a limit shows there; what is
    /// missing shows in the times.
    pub(super) fn pass_on<O: Observer>(
        &mut self,
        at: Instant,
        reading: &BaseReading,
        shared: &Shared<'_, O>,
    ) {
        let (lasted, _) = self.pace.lasted(at);
        let [forward, right, down] = &mut self.carried;
        let [about_forward, about_right, about_down] = reading.rate;
        let mut turned = [
            AngleIncrement::of_rate(about_forward, lasted, forward),
            AngleIncrement::of_rate(about_right, lasted, right),
            AngleIncrement::of_rate(about_down, lasted, down),
        ];
        turned[2] = match self.take_precise(shared) {
            Some(precise) => {
                self.excess.push(turned[2], precise);
                precise
            }
            None => self.excess.less(turned[2]),
        };
        let coarse = (!reading.is_clipped && !self.is_felt).then_some(reading.force);
        let time = orientation::units::Instant(at.as_micros());
        let force = self.force.take().or(coarse);
        shared.move_on(Motion::Moved(InertialSample { time, turned, force }));
    }

    /// What the precise gyro has turned about down since the latest reading, where it was vertical.
    fn take_precise<O: Observer>(&mut self, shared: &Shared<'_, O>) -> Option<AngleIncrement> {
        let precise = &mut self.precise;
        let down = match (precise.is_vertical, self.excess.is_known()) {
            (true, _) => VerticalGyro::Precise,
            (false, true) => VerticalGyro::Calibrated,
            (false, false) => VerticalGyro::Coarse,
        };
        let (turned, is_whole) = (precise.turned, precise.is_whole);
        precise.is_vertical = precise.sense != 0;
        (precise.turned, precise.is_whole) = (0, true);
        if core::mem::replace(&mut self.down, down) != down {
            shared.move_on(Motion::Exchanged(down));
        }
        let steps = i32::try_from(turned).ok().filter(|_| is_whole).unwrap_or(i32::MAX);
        (down == VerticalGyro::Precise).then_some(AngleIncrement(steps))
    }
}

/// Sense of an axis of this elevation: +1 down, −1 up, 0 neither.
fn sense(elevation: Angle) -> i32 {
    let is_near =
        |quarter: u32| (elevation - Angle(quarter)).0.cast_signed().unsigned_abs() <= TOLERANCE;
    i32::from(is_near(QUARTER_TURN.wrapping_neg())) - i32::from(is_near(QUARTER_TURN))
}
