//! Motion of the base for attitude and heading: rates and forces of the coarse sensors there, with
//! the rate about the down axis taken from the precise gyro once a mount has turned it to the
//! vertical.

use core::convert::Infallible;
use core::pin::{Pin, pin};

use drivers::data_ready::Edge;
use embassy_futures::select::{Either, select};
use embassy_time::Ticker;
use orientation::navigation::Motion;
use orientation::navigation::progress::VerticalGyro;
use orientation::signal::InertialSample;
use orientation::signal::force_offset::ForceOffset;
use orientation::timebase::Timebase;
use orientation::units::{
    Angle, AngleIncrement, AngularRate, MetresPerSecondSquared, SpecificForce,
};

use super::increments;
use crate::output_clock::Output;
use crate::pointing::Decimator;
use crate::ports::BaseReading;
use crate::shared::Shared;
use crate::sway::Compensation;

/// Quarter of a turn, in steps of an [`Angle`].
const QUARTER_TURN: u32 = 1 << 30;
/// Greatest distance of a vertical axis from the vertical, 0.1°, in steps of an [`Angle`]: its
/// response to other axes is then below 0.02 °/h of the Earth rate.
const TOLERANCE: u32 = (0.1 / 360.0 * 4_294_967_296.0) as u32;
/// Time of which a conversion of the precise gyro may be the only one, in half periods: two others may
/// be lost, and with more the rotation is unknown.
const LONGEST: u64 = 7;

/// Greatest number of samples in the comparison of the coarse gyro with the precise one: two
/// minutes at 104 Hz.
const COMPARED: u32 = 12_480;
/// Number of samples from which the comparison is used: ten seconds at 104 Hz.
const ENOUGH: u32 = 1_040;

/// Decimation of the forces on a platform with which the coarse ones are compared: twelve times a
/// second.
const FORCES_COMPARED: u32 = 8;
/// Standard deviation of the coarse accelerometers' biases after that comparison, 1σ, m/s²: 2 mg, since
/// neither the scale of the two is equal nor the platform's axis exactly that of the base.
const COMPARED_SIGMA: MetresPerSecondSquared = MetresPerSecondSquared(2e-3 * 9.80665);

/// Comparison of the coarse accelerometers with better ones that turn on a platform.
#[derive(Clone, Copy, Debug)]
struct Levelling {
    /// Decimation of the comparison.
    due: Decimator,
    /// Latest coarse force; none where it was clipped.
    latest: Option<[SpecificForce; 3]>,
    /// Comparison so far.
    comparison: ForceOffset,
    /// Offset of the coarse accelerometers, once it is known.
    offset: Option<[SpecificForce; 3]>,
}

impl Levelling {
    /// Subtracts the offset from a coarse force, where it is known.
    fn less(&self, coarse: [SpecificForce; 3]) -> [SpecificForce; 3] {
        let offset = self.offset.unwrap_or_default();
        core::array::from_fn(|axis| SpecificForce(coarse[axis].0 - offset[axis].0))
    }
}

/// Excess of the coarse gyro about the down axis over the precise one, in steps of an increment per
/// sample.
#[derive(Clone, Copy, Debug, Default)]
struct Excess {
    /// Mean excess.
    mean: f32,
    /// Number of samples compared.
    count: u32,
    /// Remainder of whole steps.
    carried: f32,
}

impl Excess {
    /// Adds a pair of increments, unless one is saturated.
    fn push(&mut self, coarse: AngleIncrement, precise: AngleIncrement) {
        if coarse.is_saturated() || precise.is_saturated() {
            return;
        }
        self.count = (self.count + 1).min(COMPARED);
        self.mean += ((coarse.0 - precise.0) as f32 - self.mean) / self.count as f32;
    }

    /// Whether enough samples were compared.
    fn is_known(&self) -> bool {
        self.count >= ENOUGH
    }

    /// Subtracts the excess, where it is known.
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

/// Rotation of the precise gyro since the latest coarse reading.
#[derive(Clone, Copy, Debug)]
struct Precise {
    /// Nominal time between two conversions, ns.
    period: u32,
    /// End of the latest conversion that was read.
    latest: Option<Edge>,
    /// Sense of the axis: +1 down, −1 up, 0 neither.
    sense: i32,
    /// Rotation in steps of an increment, and remainder of whole steps.
    turned: i64,
    carried: i64,
    /// Whether the axis was vertical all the time, and whether no conversion is missing or
    /// saturated.
    is_vertical: bool,
    is_whole: bool,
}

impl Precise {
    /// Time for which a conversion stands that ended so, ns: since the previous one that was read, by the
    /// better clock; `None` where too many are missing.
    fn lasted(&mut self, end: Edge, clocks: Timebase) -> Option<u64> {
        let latest = self.latest.replace(end)?;
        let elapsed = clocks.instant(end.at).0.saturating_sub(clocks.instant(latest.at).0);
        let is_known = 2 * 1000 * elapsed <= LONGEST * u64::from(self.period);
        let elapsed = u32::try_from(elapsed).ok().filter(|_| is_known)?;
        Some(clocks.integrated(end.count.wrapping_sub(latest.count), self.period, elapsed))
    }
}

/// Samples of the base's motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coarse {
    /// Remainders of whole steps.
    carried: [i64; 3],
    /// Rotation of the precise gyro.
    precise: Precise,
    /// Latest force of the better accelerometer on the base; none without a new one.
    force: Option<[SpecificForce; 3]>,
    /// Whether there is a better accelerometer on the base.
    is_felt: bool,
    /// Comparison of the coarse accelerometers with those on a platform.
    levelling: Levelling,
    /// Source of the rate about the down axis.
    down: VerticalGyro,
    /// Comparison of the coarse gyro with the precise one.
    excess: Excess,
}

impl Coarse {
    /// Motion before the first reading, for precise samples with a period in ns.
    pub(super) fn new(precise: u32) -> Self {
        Self {
            carried: [0; 3],
            precise: Precise {
                period: precise,
                latest: None,
                sense: 0,
                turned: 0,
                carried: 0,
                is_vertical: false,
                is_whole: true,
            },
            force: None,
            is_felt: false,
            levelling: Levelling {
                due: Decimator::new(FORCES_COMPARED),
                latest: None,
                comparison: ForceOffset::default(),
                offset: None,
            },
            down: VerticalGyro::Coarse,
            excess: Excess::default(),
        }
    }

    /// Takes a conversion of the precise gyro that ended so; none where it was lost.
    pub(super) fn turn(&mut self, end: Edge, rate: Option<AngularRate>, clocks: Timebase) {
        let precise = &mut self.precise;
        let Some(rate) = rate.filter(|_| precise.sense != 0) else {
            return;
        };
        let lasted = precise.lasted(end, clocks);
        let time = lasted.unwrap_or(precise.period.into());
        let turned = AngleIncrement::of_rate_over(rate, time, &mut precise.carried);
        precise.is_whole &= lasted.is_some() && !turned.is_saturated();
        precise.turned += i64::from(turned.0) * i64::from(precise.sense);
    }

    /// Sets the direction of the precise gyro's axis: its elevation, where it stands and can leave
    /// the base plane at all.
    pub(super) fn point(&mut self, elevation: Option<Angle>) {
        let sense = elevation.map_or(0, sense);
        if sense != self.precise.sense {
            self.precise.sense = sense;
            self.precise.is_vertical = false;
            self.precise.latest = None;
        }
    }

    /// Takes a force of the better accelerometer on the base, whose biases have this 1σ.
    pub(super) fn feel(
        &mut self,
        force: [SpecificForce; 3],
        bias_sigma: MetresPerSecondSquared,
        shared: &Shared<'_>,
    ) {
        if !core::mem::replace(&mut self.is_felt, true) {
            shared.move_on(Motion::ForcesExchanged(bias_sigma));
        }
        self.force = Some(force);
    }

    /// Takes a force of the better accelerometer on a platform, with the heading of its axis.
    pub(super) fn compare(
        &mut self,
        force: [SpecificForce; 3],
        heading: Angle,
        shared: &Shared<'_>,
    ) {
        let Levelling { due, latest, comparison, offset } = &mut self.levelling;
        if offset.is_some() || !due.is_due() {
            return;
        }
        if let Some(coarse) = *latest {
            comparison.push(coarse, force, heading);
            *offset = comparison.offset();
        }
        if offset.is_some() {
            shared.move_on(Motion::ForcesExchanged(COMPARED_SIGMA));
        }
    }

    /// Passes a coarse reading on to attitude and heading, where there is a new one.
    pub(super) fn pass_on(&mut self, base: Option<&Compensation>, shared: &Shared<'_>) {
        if let Some((output, reading)) = base.and_then(Compensation::reading) {
            self.convert(output, &reading, shared);
        }
    }

    /// Awaits what keeps acquisition from samples, as the restart of a device, and passes coarse readings on
    /// meanwhile. Where nothing is to be waited for, none is asked for.
    pub(super) async fn beside<T>(
        &mut self,
        awaited: Pin<&mut impl Future<Output = T>>,
        base: Option<&Compensation>,
        shared: &Shared<'_>,
    ) -> T {
        match select(awaited, pin!(self.go_on_alone(base, shared))).await {
            Either::First(outcome) => outcome,
            Either::Second(never) => match never {},
        }
    }

    /// Asks for coarse readings at the sampling period and passes them on, without end and without the precise
    /// gyro, whose rotation and direction are not known.
    async fn go_on_alone(
        &mut self,
        base: Option<&Compensation>,
        shared: &Shared<'_>,
    ) -> Infallible {
        self.point(None);
        let mut ticker = Ticker::every(shared.period.get());
        loop {
            ticker.next().await;
            if let Some(base) = base
                && (base.asks(false, shared) || base.asks(true, shared))
            {
                base.answered().await;
            }
            self.pass_on(base, shared);
        }
    }

    /// Converts a coarse output to a sample and passes it on. Saturation is kept as such; missing outputs show in
    /// the times, and attitude and heading bridge them.
    fn convert(&mut self, output: Output, reading: &BaseReading, shared: &Shared<'_>) {
        let Output { time, period, periods } = output;
        let mut turned = increments(reading.rate, period.into(), &mut self.carried);
        turned[2] = match self.take_precise(periods, shared) {
            Some(precise) => {
                self.excess.push(turned[2], precise);
                precise
            }
            None => self.excess.less(turned[2]),
        };
        self.levelling.latest = (!reading.is_clipped).then_some(reading.force);
        let coarse = self.levelling.latest.filter(|_| !self.is_felt);
        let coarse = coarse.map(|force| self.levelling.less(force));
        let force = self.force.take().or(coarse);
        shared.move_on(Motion::Moved(InertialSample { time, turned, force }));
    }

    /// Rotation of the precise gyro about down in the time for which an output stands, as its part of that in so
    /// many periods since the output before; `None` where the axis was not vertical.
    fn take_precise(&mut self, periods: u32, shared: &Shared<'_>) -> Option<AngleIncrement> {
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
        let steps = i32::try_from(turned / i64::from(periods.max(1)))
            .ok()
            .filter(|_| is_whole)
            .unwrap_or(i32::MAX);
        (down == VerticalGyro::Precise).then_some(AngleIncrement(steps))
    }
}

/// Sense of an axis with this elevation: +1 down, −1 up, 0 neither.
fn sense(elevation: Angle) -> i32 {
    let is_near =
        |quarter: u32| (elevation - Angle(quarter)).0.cast_signed().unsigned_abs() <= TOLERANCE;
    i32::from(is_near(QUARTER_TURN.wrapping_neg())) - i32::from(is_near(QUARTER_TURN))
}
