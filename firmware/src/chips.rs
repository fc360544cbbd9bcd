//! Implements the instrument's [`ports`](crate::ports) by the chips' drivers: converts units,
//! assigns axes, and decides which readings are valid.

use core::time::Duration;

use drivers::ads1262::Ads1262;
use drivers::ads1262::codec::Conversion;
use drivers::ads1262::scale::Scale;
use drivers::adxl355::Adxl355;
use drivers::data_ready::{DataReady, Edge};
use drivers::fault::Fault;
use drivers::lsm6dsl::Lsm6dsl;
use drivers::mt6835::Mt6835;
use drivers::tmc5160::Tmc5160;
use drivers::tmc5160::configuration::MICROSTEPS_PER_TURN;
use drivers::tmc5160::units::Velocity;
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;
use embedded_hal_async::spi::SpiDevice;
use orientation::signal::sway::CoarseSensors;
use orientation::units::{Angle, AngularRate, TURN};

use crate::ports::{
    Accelerometer, Actuator, BaseReading, BaseSensors, Code, Command, Encoder, ForceReading, Gyro,
    InStep, Motion, RateReading, Startable, clipped,
};

/// A gyro with an analogue rate output, behind its analogue-to-digital converter.
#[derive(Debug)]
pub struct AnalogueGyro<S, R, D> {
    /// The analogue-to-digital converter.
    pub converter: Ads1262<S, R, D>,
    /// The scale factor, which converts a code to an angular rate.
    pub scale: Scale,
    /// Magnitude of the rate beyond which the gyro's own output saturates, though the converter may
    /// not. Readings beyond it are reported as saturated.
    pub limit: AngularRate,
}

impl<S: SpiDevice, R: DataReady, D: DelayNs> Startable for AnalogueGyro<S, R, D> {
    fn start(&mut self) -> impl Future<Output = Result<(), Fault>> {
        self.converter.start()
    }
}

impl<S: SpiDevice, R: DataReady, D: DelayNs> Gyro for AnalogueGyro<S, R, D> {
    fn ready(&mut self) -> impl Future<Output = Result<Edge, Fault>> {
        self.converter.ready()
    }

    async fn read(&mut self) -> Result<RateReading, Fault> {
        let conversion = self.converter.read().await?;
        let rate = self.scale.rate(conversion.code);
        let is_clipped =
            conversion.is_clipped || rate.0.unsigned_abs() >= self.limit.0.unsigned_abs();
        let rate = AngularRate(clipped(rate.0, is_clipped));
        Ok(RateReading { rate, is_new: conversion.is_new })
    }
}

impl<S: SpiDevice, R: DataReady, D: DelayNs> InStep for AnalogueGyro<S, R, D> {
    fn arm(&mut self) -> impl Future<Output = Result<(), Fault>> {
        self.converter.arm()
    }

    fn begin(&mut self) -> impl Future<Output = Result<(), Fault>> {
        self.converter.begin()
    }
}

impl<S: SpiDevice, R: DataReady, D: DelayNs> Startable for Ads1262<S, R, D> {
    fn start(&mut self) -> impl Future<Output = Result<(), Fault>> {
        Ads1262::start(self)
    }
}

/// Any sensor with an analogue output behind a converter; its reading is the converter's code,
/// without a unit.
impl<S: SpiDevice, R: DataReady, D: DelayNs> Gyro<Code> for Ads1262<S, R, D> {
    fn ready(&mut self) -> impl Future<Output = Result<Edge, Fault>> {
        Ads1262::ready(self)
    }

    async fn read(&mut self) -> Result<RateReading<Code>, Fault> {
        Ads1262::read(self).await.map(RateReading::from)
    }
}

impl From<Conversion> for RateReading<Code> {
    fn from(conversion: Conversion) -> Self {
        let rate = Code(clipped(conversion.code, conversion.is_clipped));
        Self { rate, is_new: conversion.is_new }
    }
}

impl<S: SpiDevice, R: DataReady, D: DelayNs> InStep<Code> for Ads1262<S, R, D> {
    fn arm(&mut self) -> impl Future<Output = Result<(), Fault>> {
        Ads1262::arm(self)
    }

    fn begin(&mut self) -> impl Future<Output = Result<(), Fault>> {
        Ads1262::begin(self)
    }
}

impl<S: SpiDevice, D: DelayNs> Startable for Adxl355<S, D> {
    fn start(&mut self) -> impl Future<Output = Result<(), Fault>> {
        Adxl355::start(self)
    }
}

/// The accelerometer on the platform: x along the gyro's sensitive axis, y 90° clockwise of it, z
/// down. On a two-frame mount the accelerometer is fixed to the base, and in a vehicle without a
/// stage to the body: x forward, y right, z down.
impl<S: SpiDevice, D: DelayNs> Accelerometer for Adxl355<S, D> {
    async fn read(&mut self) -> Result<ForceReading, Fault> {
        let reading = Adxl355::read(self).await?;
        Ok(ForceReading {
            force: reading.force,
            temperature: reading.temperature,
            is_new: reading.is_fresh,
            is_clipped: reading.is_clipped,
        })
    }
}

/// Rates of which at least one is saturated.
const CLIPPED: [AngularRate; 3] = [AngularRate(i32::MAX); 3];

/// The coarse inertial measurement unit on the base, mounted with x forward, y right, z down.
#[derive(Debug)]
pub struct BaseImu<I, D> {
    /// The driver of the chip.
    pub chip: Lsm6dsl<I, D>,
    /// The stated noise and biases of its sensors.
    pub sensors: CoarseSensors,
    /// Decimation: the unit is read once in this many samples of the precise gyro, ≥ 1, at least 1.5 times as
    /// often as it has a new output.
    pub divider: u32,
}

impl<I: I2c, D: DelayNs> Startable for BaseImu<I, D> {
    fn start(&mut self) -> impl Future<Output = Result<(), Fault>> {
        self.chip.start()
    }
}

impl<I: I2c, D: DelayNs> BaseSensors for BaseImu<I, D> {
    async fn read(&mut self) -> Result<Option<BaseReading>, Fault> {
        let reading = self.chip.read().await?;
        Ok(reading.map(|reading| BaseReading {
            // The chip does not report which axis saturates.
            rate: if reading.is_rate_clipped { CLIPPED } else { reading.rate },
            force: reading.force,
            is_clipped: reading.is_rate_clipped || reading.is_force_clipped,
        }))
    }

    fn sensors(&self) -> CoarseSensors {
        self.sensors
    }

    fn divider(&self) -> u32 {
        self.divider
    }

    fn output_period(&self) -> Duration {
        self.chip.output_period()
    }
}

impl<S: SpiDevice, D: DelayNs> Startable for Mt6835<S, D> {
    fn start(&mut self) -> impl Future<Output = Result<(), Fault>> {
        Mt6835::start(self)
    }
}

/// The encoder on the axis of the stage; the angle grows clockwise as seen from above.
impl<S: SpiDevice, D: DelayNs> Encoder for Mt6835<S, D> {
    fn read(&mut self) -> impl Future<Output = Result<Angle, Fault>> {
        Mt6835::read(self)
    }
}

/// Converts an angle of the stage, rad, to microsteps, rounded to nearest; saturates at the range
/// of 32 bits. The same factor converts a rate, rad/s, to microsteps/s.
fn microsteps(angle: f64) -> i32 {
    libm::round(angle / TURN * f64::from(MICROSTEPS_PER_TURN)) as i32
}

/// Converts microsteps to an angle of the stage, rad.
fn angle(microsteps: i64) -> f64 {
    microsteps as f64 / f64::from(MICROSTEPS_PER_TURN) * TURN
}

impl<S: SpiDevice, D: DelayNs> Startable for Tmc5160<S, D> {
    fn start(&mut self) -> impl Future<Output = Result<(), Fault>> {
        Tmc5160::start(self)
    }
}

/// The stepper motor of the stage behind its gear; positive is clockwise as seen from above.
impl<S: SpiDevice, D: DelayNs> Actuator for Tmc5160<S, D> {
    async fn execute(&mut self, request: Command) -> Result<Option<Motion>, Fault> {
        match request {
            Command::Rest => self.rest().await?,
            Command::GoTo(angle) => self.go_to(microsteps(angle)).await?,
            Command::Seek(rate) => self.run(Velocity(microsteps(rate))).await?,
            Command::SetAngle(angle) => self.set_position(microsteps(angle)).await?,
            Command::Release => {
                self.stop().await?;
                // To clear it holds the motor at the velocity that it has.
                if self.status().await?.stalled {
                    self.clear_stall().await?;
                }
            }
            Command::Look => {
                let status = self.status().await?;
                let counted = self.counted(status.position);
                let mark = self.take_mark(&status).await?;
                return Ok(Some(Motion {
                    angle: angle(counted),
                    mark: mark.map(|edge| angle(self.beside(edge))),
                    is_standing: status.standing,
                    has_reached: status.reached,
                    is_stalled: status.stalled,
                    at_index: status.left_switch,
                }));
            }
        }
        Ok(None)
    }
}
