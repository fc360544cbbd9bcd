//! One chip on a bus of its own in a motion that the test sets.

use std::cell::RefCell;

use drivers::lsm6dsl::registers::ADDRESS_LOW;
use drivers::lsm6dsl::{BUS_HERTZ, Configuration, Lsm6dsl};
use embassy_time::{Delay, Instant};
use embedded_hal_async::i2c::I2c;
use hal_mock::chip::Single;
use hal_mock::environment::{ForceInput, MotionInput};
use hal_mock::i2c::{I2cChip, I2cPort};
use hal_mock::lsm6dsl::Lsm6dsl as Chip;
use hal_mock::violation::Misuse;

/// A constant motion.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// g.
    pub force: [f64; 3],
    /// °/s.
    pub rate: [f64; 3],
    /// °C.
    pub temperature: f64,
}

impl ForceInput for Table {
    fn force_g(&mut self, _: Instant) -> [f64; 3] {
        self.force
    }

    fn temperature_c(&mut self, _: Instant) -> f64 {
        self.temperature
    }
}

impl MotionInput for Table {
    fn rate_rad_s(&mut self, _: Instant) -> [f64; 3] {
        self.rate.map(f64::to_radians)
    }
}

pub type Rig = RefCell<Single<Chip, Table>>;
pub type Imu<'a> = Lsm6dsl<I2cPort<'a, Chip, Table>, Delay>;

pub fn rig_with(force: [f64; 3], rate: [f64; 3]) -> Rig {
    let environment = Table { force, rate, temperature: 25.0 };
    RefCell::new(Single { chip: Chip::new(Instant::from_ticks(0), 0x6A, 1.0), environment })
}

pub fn level() -> Rig {
    rig_with([0.0, 0.0, -1.0], [0.0; 3])
}

pub use crate::support::rig::run;

pub fn port(rig: &Rig) -> I2cPort<'_, Chip, Table> {
    I2cPort::new(rig, BUS_HERTZ)
}

pub fn imu(rig: &Rig, configuration: Configuration) -> Imu<'_> {
    Lsm6dsl::new(port(rig), Delay, ADDRESS_LOW, configuration)
}

pub async fn started(rig: &Rig, configuration: Configuration) -> Imu<'_> {
    let mut imu = imu(rig, configuration);
    imu.start().await.expect("the chip is well");
    imu
}

pub fn violations(rig: &Rig) -> Vec<Misuse> {
    let rig = rig.borrow();
    let violations = I2cChip::<Table>::violations(&rig.chip);
    violations.first.iter().map(|violation| violation.misuse).collect()
}

/// One row of a transcript: a read of registers, or a write of some.
#[derive(Clone, Copy, Debug)]
pub enum Row<'a> {
    /// From this register these bytes come.
    Read(u8, &'a [u8]),
    /// Register and values.
    Write(&'a [u8]),
}

pub async fn transcript(rig: &Rig, rows: &[Row<'_>]) {
    for row in rows {
        match row {
            Row::Read(register, expected) => {
                let mut bytes = vec![0; expected.len()];
                port(rig).write_read(0x6A, &[*register], &mut bytes).await.expect("it answers");
                assert_eq!(bytes, *expected, "{register:#x}");
            }
            Row::Write(bytes) => port(rig).write(0x6A, bytes).await.expect("it answers"),
        }
    }
}
