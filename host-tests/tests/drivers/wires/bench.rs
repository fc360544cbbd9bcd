//! A world that any chip can be put into, and a port whose transactions go over the wires.

use std::cell::RefCell;

use embassy_time::{Duration, Instant, Timer};
use embedded_hal::spi::Mode;
use embedded_hal_async::spi::{ErrorKind, ErrorType, Operation, SpiDevice};
use hal_mock::chip::{Rig, Select};
use hal_mock::environment::{AnalogueInput, ForceInput, Mechanics, MotionInput, ShaftAngle};
use hal_mock::wires::{Clock, SpiWires};

/// A world in which all that a chip feels depends on time alone, and a motor with a left switch at zero.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bench {
    pub microsteps: f64,
    pub microsteps_per_s: f64,
}

fn wave(now: Instant, hertz: f64) -> f64 {
    (now.as_micros() as f64 * 1e-6 * hertz * std::f64::consts::TAU).sin()
}

impl AnalogueInput for Bench {
    fn volts(&mut self, now: Instant) -> f64 {
        1.5 * wave(now, 3.0)
    }
}

impl ForceInput for Bench {
    fn force_g(&mut self, now: Instant) -> [f64; 3] {
        [0.1, 0.2, 1.0].map(|scale| scale * wave(now, 5.0))
    }

    fn temperature_c(&mut self, now: Instant) -> f64 {
        25.0 + 10.0 * wave(now, 0.1)
    }
}

impl MotionInput for Bench {
    fn rate_rad_s(&mut self, now: Instant) -> [f64; 3] {
        [0.1, 0.2, 0.3].map(|scale| scale * wave(now, 2.0))
    }
}

impl ShaftAngle for Bench {
    fn shaft_turns(&mut self, now: Instant) -> f64 {
        wave(now, 0.7)
    }
}

impl Mechanics for Bench {
    fn drive(&mut self, _: Instant, microsteps: f64, microsteps_per_s: f64) {
        *self = Self { microsteps, microsteps_per_s };
    }

    fn is_blocked(&self) -> bool {
        false
    }

    fn reference_switches(&self) -> [bool; 2] {
        [self.microsteps < 0.0, false]
    }
}

/// Time of a byte at a bus clock, ns, rounded up.
pub fn byte_ns(hertz: u32) -> u64 {
    8_000_000_000_u64.div_ceil(u64::from(hertz))
}

/// One chip of a rig behind its select line, each of its transactions a run of bytes over the wires. Waits
/// between select and clock are those of a controller of 64 MHz that takes 16 clocks.
pub struct WirePort<'a, R> {
    pub rig: &'a RefCell<R>,
    pub wires: &'a RefCell<SpiWires>,
    pub select: Select,
    pub mode: Mode,
    pub hertz: u32,
}

/// What the controller takes between select and clock, ns.
const WAIT: u64 = 250;

impl<R> ErrorType for WirePort<'_, R> {
    type Error = ErrorKind;
}

impl<R: Rig> SpiDevice for WirePort<'_, R> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        let began = Instant::now().as_micros() * 1000;
        let ended = self.transact(operations, began);
        Timer::after(Duration::from_micros((ended - began).div_ceil(1000))).await;
        Ok(())
    }
}

impl<R: Rig> WirePort<'_, R> {
    /// Has the chip answer; when select rises, ns.
    fn transact(&mut self, operations: &mut [Operation<'_, u8>], began: u64) -> u64 {
        let (mut rig, mut wires) = (self.rig.borrow_mut(), self.wires.borrow_mut());
        let clock = Clock { mode: self.mode, hertz: self.hertz };
        wires.set_select(&mut *rig, self.select, true, began);
        let mut at = began + WAIT;
        let mut byte = |sent| {
            let reply = wires.exchange(&mut *rig, sent, clock, at);
            at += byte_ns(clock.hertz);
            reply
        };
        for operation in operations {
            match operation {
                Operation::Write(sent) => {
                    for sent in *sent {
                        byte(*sent);
                    }
                }
                Operation::Read(reply) => reply.iter_mut().for_each(|reply| *reply = byte(0)),
                Operation::TransferInPlace(both) => both.iter_mut().for_each(|b| *b = byte(*b)),
                Operation::Transfer(reply, sent) => {
                    reply.iter_mut().zip(*sent).for_each(|(reply, sent)| *reply = byte(*sent));
                }
                Operation::DelayNs(_) => panic!("no driver waits within a transaction"),
            }
        }
        at += WAIT;
        wires.set_select(&mut *rig, self.select, false, at);
        at
    }
}
