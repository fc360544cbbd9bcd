//! Samples of three gyros and two accelerometers on a body in fast rotation.
//!
//! All five are analogue sensors behind synchronised converters, so that forces and rates belong to
//! one moment: a conversion is a mean, and belongs to its middle. From middle to middle a gyro has
//! turned by half of either conversion. A lost conversion shows in the next sample's time.
//!
//! The forces show the roll, so a sample has their time. Converters are begun one after the other, and
//! the accelerometers last: the median of all ends is earlier than theirs. A gyro that converts earlier
//! has turned by as much of the later conversion more, and of the earlier one less: a spin that changes
//! would else be shown too late.

use core::convert::Infallible;

use embassy_time::Duration;
use orientation::alignment::refusal::Refusal;
use orientation::device::Device;
use orientation::signal::SpinSample;
use orientation::units::{AngleIncrement, Instant, SpinForce};

use super::Source;
use super::in_step::Group;
use super::outlet::Outlet;
use crate::configuration::period;
use crate::pointing::Decimator;
use crate::ports::{Code, InStep, Quantity, SpinSensors, Together};
use crate::shared::Channels;
use crate::spin::configuration::{CHANNELS, GYROS, SpinConfiguration};

/// Names of the sensors in the log.
const NAMES: [Device; CHANNELS] = [
    Device::ForwardGyro,
    Device::UpGyro,
    Device::RightGyro,
    Device::UpAccelerometer,
    Device::RightAccelerometer,
];

/// Places of the accelerometers among them.
const ACCELEROMETERS: [usize; 2] = [GYROS, GYROS + 1];

/// Conversions of which one shows how far apart the sensors convert, and the part of what it shows that is followed.
const LOOKED_APART: u32 = 16;
const FOLLOWED: f32 = 0.125;

/// Conversions for which there is always room, where others wait until the queue has some.
const SPARE: usize = 8;
/// Time between two looks whether the queue has room.
const LOOK: Duration = Duration::from_micros(200);

/// Acquisition of the sensors of a spinning body.
pub struct SpinAcquisition<'a, C, R> {
    /// Converters of all sensors.
    converters: Group<'a, C, &'a mut R, CHANNELS, Code>,
    /// Scale factors and rates.
    configuration: &'a SpinConfiguration,
    /// Length of a conversion, µs, rounded up.
    length: u64,
    /// Conversions in a microsecond.
    rate: f32,
    /// By how much each gyro converts earlier than the accelerometers, in half conversions, and when that is looked at.
    earlier: [f32; GYROS],
    due: Decimator,
    /// Outlet of samples.
    outlet: Outlet<'a, SpinSample>,
    /// Rotation of the gyros in the previous conversion, in steps of an increment.
    before: Option<[i32; GYROS]>,
    /// Remaining half steps.
    carried: [i64; GYROS],
}

impl<'a, C: InStep<Code>, R: Together<C, Code, CHANNELS>> SpinAcquisition<'a, C, R> {
    /// Takes the sensors; nothing is started yet.
    pub fn new(
        SpinSensors { converters, reader }: &'a mut SpinSensors<C, R>,
        configuration: &'a SpinConfiguration,
        channels: &'a Channels<'a, SpinSample>,
    ) -> Self {
        let rate = configuration.sample_rate;
        let period = period(rate);
        Self {
            converters: Group::new((converters, reader), NAMES, rate, period, &channels.shared),
            configuration,
            length: libm::ceil(1e6 / rate) as u64,
            rate: (1e-6 * rate) as f32,
            earlier: [0.0; GYROS],
            due: Decimator::new(LOOKED_APART),
            outlet: Outlet::new(period, period, channels),
            before: None,
            carried: [0; GYROS],
        }
    }

    /// Rotation of the gyros since the middle of the accelerometers' previous conversion; for the first one as
    /// much as in a whole conversion.
    fn turned(&mut self, codes: &[Code; CHANNELS]) -> [AngleIncrement; GYROS] {
        let gyros = &self.configuration.gyros;
        let steps = core::array::from_fn(|axis| gyros[axis].steps(codes[axis]));
        if self.due.is_due() {
            self.look_apart();
        }
        let before = self.before.replace(steps).unwrap_or(steps);
        let Self { earlier, carried, .. } = self;
        core::array::from_fn(|axis| {
            between([before[axis], steps[axis]], earlier[axis], &mut carried[axis])
        })
    }

    /// Follows by how much the gyros convert earlier than the accelerometers: it changes only where the converters
    /// are begun anew, and stamps are rounded.
    #[inline(never)]
    fn look_apart(&mut self) {
        let part = if self.before.is_none() { 1.0 } else { FOLLOWED };
        for (axis, earlier) in self.earlier.iter_mut().enumerate() {
            let after = |index| {
                let [gyro, force] = [axis, index].map(|index| self.converters.end(index).at.0);
                force.wrapping_sub(gyro).cast_signed() as i32
            };
            let [up, right] = ACCELEROMETERS.map(after);
            *earlier += part * ((up + right) as f32 * self.rate - *earlier);
        }
    }

    /// Specific forces up and right; [`None`] if one is saturated.
    fn force(&self, codes: &[Code; CHANNELS]) -> Option<[SpinForce; 2]> {
        let [_, _, _, up, right] = *codes;
        let [of_up, of_right] = &self.configuration.accelerometers;
        let force = [SpinForce(of_up.steps(up)), SpinForce(of_right.steps(right))];
        (!force.iter().any(|force| force.is_saturated())).then_some(force)
    }

    /// Middle of the accelerometers' latest conversions, rounded to the nearest microsecond. The sum of
    /// two ends is whole, so that a length that is rounded up costs nothing.
    fn middle(&self) -> Instant {
        let [up, right] =
            ACCELEROMETERS.map(|index| self.outlet.time(self.converters.end(index)).0);
        Instant((up + right + 1).saturating_sub(self.length) / 2)
    }

    /// Takes the next sample; [`None`] where a reading was lost.
    ///
    /// # Errors
    /// A sensor is given up.
    async fn sample(&mut self) -> Result<Option<SpinSample>, Refusal> {
        let Some((end, Some(codes))) = self.converters.next().await? else { return Ok(None) };
        self.outlet.judge(end);
        let (time, force) = (self.middle(), self.force(&codes));
        Ok(Some(SpinSample { time, turned: self.turned(&codes), force }))
    }
}

impl<'a, C: InStep<Code>, R: Together<C, Code, CHANNELS>> Source<'a> for SpinAcquisition<'a, C, R> {
    type Sample = SpinSample;

    fn outlet(&mut self) -> &mut Outlet<'a, SpinSample> {
        &mut self.outlet
    }

    fn start(&mut self) -> impl Future<Output = Result<(), Refusal>> {
        self.converters.start()
    }

    async fn run(&mut self) -> Result<Infallible, Refusal> {
        loop {
            // The evaluation of a turn takes the aligner longer than the queue lasts now and then.
            while self.outlet.is_full() && self.converters.room() > SPARE {
                self.converters.rest_for(LOOK).await;
            }
            if let Some(sample) = self.sample().await? {
                self.outlet.hand_over(sample);
            }
        }
    }

    fn renew(&mut self) {
        self.converters.renew();
    }
}

/// Half of the sum of two increments, with so many half parts more of the later one and less of the one before;
/// saturated where one of them is.
fn between(increments: [i32; 2], later: f32, carried: &mut i64) -> AngleIncrement {
    if let Some(steps) = increments.into_iter().find(|steps| Code(*steps).is_saturated()) {
        return AngleIncrement(steps);
    }
    let [before, now] = increments;
    let moved = (now.wrapping_sub(before) as f32 * later) as i32;
    let whole = i64::from(before) + i64::from(now) + i64::from(moved) + *carried;
    *carried = whole & 1;
    AngleIncrement((whole >> 1) as i32)
}
