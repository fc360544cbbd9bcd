//! Full sets of the chain, as acquisition takes them.

use core::future::poll_fn;
use core::sync::atomic::Ordering;
use core::task::Poll;

use drivers::ads1262::codec;
use drivers::data_ready::Edge;
use drivers::fault::Fault;
use embassy_stm32::pac::spi::regs::Cr1;
use firmware::ports::{Code, RateReading, Together};
use firmware::spin::configuration::CHANNELS;

use super::set::Set;
use super::{CHAIN, SETS, Wires};

/// Full sets that are kept: one is being filled, one may wait for that, and one is being taken.
const KEPT: usize = SETS - 3;

/// Reads the converters of the chain together. Where no set becomes full, since a converter is silent or a transfer hangs,
/// a converter is started anew, which stops the chain; it begins again with the next conversions.
pub struct ChainReader {
    /// Settings of the bus.
    control: Cr1,
    /// Number of sets that were taken, lost ones included.
    taken: u32,
    /// The latest of them.
    set: &'static Set,
}

impl ChainReader {
    /// A reader whose bus has these settings.
    pub(crate) fn new(control: Cr1) -> Self {
        Self { control, taken: 0, set: &CHAIN.sets[0] }
    }

    /// Takes the next set, where one is full; where acquisition was so late that the next is overwritten, the latest.
    fn take(&mut self) -> Option<()> {
        let filled = CHAIN.filled.load(Ordering::Acquire);
        let waiting = filled.wrapping_sub(self.taken);
        if waiting == 0 {
            return None;
        }
        self.taken = if waiting as usize > KEPT { filled } else { self.taken.wrapping_add(1) };
        self.set = CHAIN.set(self.taken.wrapping_sub(1));
        Some(())
    }
}

impl<C> Together<C, Code, CHANNELS> for ChainReader {
    async fn next(&mut self, _: [&mut C; CHANNELS], _: u64) -> Result<(), Fault> {
        if !CHAIN.runs() {
            self.taken = CHAIN.filled.load(Ordering::Acquire);
            CHAIN.begin(self.control);
        }
        poll_fn(|context| {
            if self.take().is_some() {
                return Poll::Ready(Ok(()));
            }
            CHAIN.waiting.register(context.waker());
            // One that was filled meanwhile has woken no task.
            self.take().map_or(Poll::Pending, |()| Poll::Ready(Ok(())))
        })
        .await
    }

    fn end(&self, index: usize) -> Edge {
        self.set.end(index)
    }

    fn reading(&self, index: usize) -> Result<RateReading<Code>, Fault> {
        codec::decode(self.set.frame(index)).map(RateReading::from)
    }

    fn room(&self) -> usize {
        let waiting = CHAIN.filled.load(Ordering::Acquire).wrapping_sub(self.taken);
        KEPT.saturating_sub(waiting as usize)
    }

    /// The first whose edge the chain waits for; where it waits for none, the first of all.
    fn awaited(&self) -> usize {
        let awaited = CHAIN.awaited.load(Ordering::Relaxed);
        let is_awaited = |wires: &Wires| awaited & wires.bit() != 0;
        CHAIN.wires().iter().position(is_awaited).unwrap_or_default()
    }
}
