//! A device on a serial bus that may fail.

use embassy_time::{Duration, Instant, Timer};
use embedded_hal_async::spi::{Error, ErrorKind, ErrorType, Operation, SpiDevice};
use heapless::Vec;

use super::When;
use crate::noise::Generator;
use crate::spi::{length, received, sent};

/// Time that a missing chip takes for a byte: a bus of 1 MHz. Without it a driver that polls would
/// stop the clock.
const BYTE: Duration = Duration::from_micros(8);

/// How long a transfer hangs until its bus gives it up.
const HANG: Duration = Duration::from_millis(1);

/// Kinds of transactions whose latest reply is remembered, and the longest reply.
const KINDS: usize = 4;
/// Bytes of the longest reply that is remembered.
const LONGEST: usize = 32;

/// What is wrong with a bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusFault {
    /// The controller reports an overrun. The chip has heard it all; the reply is lost and reads zero.
    Error,
    /// One bit of the reply is wrong, each time another. Transactions without a reply stay whole.
    FlippedBit {
        /// Chooses byte and bit.
        seed: u64,
    },
    /// The reply of the latest healthy transaction with the same first byte and length comes again,
    /// while the chip goes on. Replies are remembered for the four latest kinds of transactions of up
    /// to 32 bytes; others stay true.
    Stuck,
    /// The chip is not there: no byte reaches it, and all bits of a reply have one level.
    Missing {
        /// 0xff or 0x00, where a line floats or is shorted.
        level: u8,
    },
    /// The transfer does not begin, and is given up by its bus after a millisecond.
    Hang,
}

/// A fault of a bus and its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultPlan {
    /// What is wrong with the bus.
    pub fault: BusFault,
    /// When the fault shows.
    pub when: When,
}

/// A device on a bus that may fail.
#[derive(Debug)]
pub struct FaultySpi<S> {
    /// The device that is wrapped.
    device: S,
    /// What goes wrong, and when.
    plan: Option<FaultPlan>,
    /// Whether the fault has shown, for one that shows once.
    shown: bool,
    /// Chooses what is flipped.
    chance: Generator,
    /// Replies that come again where the bus sticks.
    memory: Memory,
}

impl<S> FaultySpi<S> {
    /// The device with a plan of its fault, or a healthy one.
    #[must_use]
    pub fn new(device: S, plan: Option<FaultPlan>) -> Self {
        let seed = match plan {
            Some(FaultPlan { fault: BusFault::FlippedBit { seed }, .. }) => seed,
            _ => 0,
        };
        let chance = Generator::new(seed);
        Self { device, plan, shown: false, chance, memory: Memory::default() }
    }

    /// The fault that shows in a transaction that begins now.
    fn fault(&mut self, operations: &mut [Operation<'_, u8>]) -> Option<BusFault> {
        let FaultPlan { fault, when } = self.plan?;
        // What has no reply cannot have a wrong one.
        let flips = matches!(fault, BusFault::FlippedBit { .. });
        let shows_here = !flips || replies(operations).next().is_some();
        (shows_here && when.shows(Instant::now(), &mut self.shown)).then_some(fault)
    }

    /// Whether replies must be remembered.
    fn may_stick(&self) -> bool {
        self.plan.is_some_and(|plan| plan.fault == BusFault::Stuck)
    }

    /// Flips one bit of the reply.
    fn flip(&mut self, operations: &mut [Operation<'_, u8>]) {
        let bytes = replies(operations).count();
        let chosen = self.chance.next_u64() % (8 * bytes.max(1) as u64);
        if let Some(byte) = replies(operations).nth((chosen / 8) as usize) {
            *byte ^= 1 << (chosen % 8);
        }
    }
}

impl<S: SpiDevice> FaultySpi<S> {
    /// Passes a transaction on.
    async fn pass(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        self.device.transaction(operations).await.map_err(|error| error.kind())
    }

    /// Passes a transaction on and remembers or repeats its reply.
    async fn pass_stuck(
        &mut self,
        operations: &mut [Operation<'_, u8>],
        stuck: bool,
    ) -> Result<(), ErrorKind> {
        // A reply may take the place of what was sent.
        let kind = Kind::of(operations);
        self.pass(operations).await?;
        if stuck {
            self.memory.repeat(kind, operations);
        } else {
            self.memory.remember(kind, operations);
        }
        Ok(())
    }
}

impl<S> ErrorType for FaultySpi<S> {
    type Error = ErrorKind;
}

impl<S: SpiDevice> SpiDevice for FaultySpi<S> {
    async fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
        match self.fault(operations) {
            None if self.may_stick() => self.pass_stuck(operations, false).await,
            None => self.pass(operations).await,
            Some(BusFault::Error) => {
                self.pass(operations).await?;
                replies(operations).for_each(|byte| *byte = 0);
                Err(ErrorKind::Overrun)
            }
            Some(BusFault::FlippedBit { .. }) => {
                self.pass(operations).await?;
                self.flip(operations);
                Ok(())
            }
            Some(BusFault::Stuck) => self.pass_stuck(operations, true).await,
            Some(BusFault::Missing { level }) => {
                let bytes: usize = operations.iter().map(length).sum();
                Timer::after(BYTE * bytes as u32).await;
                replies(operations).for_each(|byte| *byte = level);
                Ok(())
            }
            Some(BusFault::Hang) => {
                Timer::after(HANG).await;
                Err(ErrorKind::Other)
            }
        }
    }
}

/// The bytes that the controller reads, in order.
fn replies<'b>(operations: &'b mut [Operation<'_, u8>]) -> impl Iterator<Item = &'b mut u8> {
    operations.iter_mut().flat_map(received)
}

/// What transactions of one kind have in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Kind {
    /// The first byte that is sent.
    first: u8,
    /// Bytes on the wire.
    length: usize,
}

impl Kind {
    /// The kind of a transaction that has not been passed on yet; a read sends zeros.
    fn of(operations: &[Operation<'_, u8>]) -> Self {
        let first = operations.iter().find(|operation| length(operation) > 0);
        let first = first.and_then(|operation| sent(operation).first());
        Self { first: first.copied().unwrap_or(0), length: operations.iter().map(length).sum() }
    }
}

/// The latest reply of each of the latest kinds, in the order in which they came.
#[derive(Debug, Default)]
struct Memory {
    /// Kinds with their replies, oldest first.
    replies: Vec<(Kind, Vec<u8, LONGEST>), KINDS>,
}

impl Memory {
    /// Keeps the reply of a transaction in place of the last of its kind, or of the oldest.
    fn remember(&mut self, kind: Kind, operations: &mut [Operation<'_, u8>]) {
        if replies(operations).count() > LONGEST {
            return;
        }
        let known = self.replies.iter().position(|(other, _)| *other == kind);
        if let Some(index) = known.or(self.replies.is_full().then_some(0)) {
            self.replies.remove(index);
        }
        // There is room now.
        let _ = self.replies.push((kind, replies(operations).map(|byte| *byte).collect()));
    }

    /// Replaces a reply by the one that is remembered.
    fn repeat(&self, kind: Kind, operations: &mut [Operation<'_, u8>]) {
        if let Some((_, reply)) = self.replies.iter().find(|(other, _)| *other == kind) {
            replies(operations).zip(reply).for_each(|(byte, old)| *byte = *old);
        }
    }
}
