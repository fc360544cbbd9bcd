//! The log of a board: for a probe, and, of lines that tell why something failed or what came of it, over a loss of supply.
//!
//! A line is kept as the log sends it, a number for each sentence beside its values: the words are in the image's ELF file
//! alone, by whose identity the line is known to be of that image (`meridian log` puts both together). So a line costs
//! no more flash than to be logged. It is read where a probe would: from the buffer of the real-time transfer.
//!
//! The thread writes what waits as soon as it has nothing else to do, a row of 82 µs every millisecond. Others have their way
//! meanwhile, but for the store, which may wait for the erasure of a page, 22 ms.

use embassy_time::{Duration, Instant, Timer};
use firmware::check_ins::CheckIns;
use firmware::event::Event;
use firmware::kept_lines::{IMAGE, Weight};
use firmware::log::DefmtLog;
use firmware::ports::Observer;
use firmware::postmortem::Outlasting;
use firmware::storage::CONTENT;

use crate::flash::Ring;

/// Time between two looks at what waits: lines of a device that is started again and again come every 30 ms.
const PERIOD: Duration = Duration::from_millis(20);
/// Time between two rows of a record, and between two looks at an erasure.
const STEP: Duration = Duration::from_millis(1);

/// The buffer in which the log waits for a probe. A program has it, since to read it is not safe.
#[derive(Clone, Copy, Debug)]
pub struct Buffer {
    /// Where the next byte of the log goes.
    pub end: fn() -> u32,
    /// Copies the log from a place up to its end, as far as there is room; where it goes on. Nothing may log meanwhile.
    pub copy: fn(u32, &mut [u8]) -> u32,
}

/// The observer of the instrument on a board: the log, and where the parts check in.
#[derive(Debug)]
pub struct BoardLog {
    /// What outlasts a reset.
    pub run: &'static Outlasting,
    /// The identity of the image, in the linker's note: three words and a name before it (`--build-id`).
    pub image: &'static [u32; 6],
    /// Where the log waits for a probe.
    pub buffer: Buffer,
}

impl BoardLog {
    /// Keeps what is logged meanwhile over a loss of supply, within a critical section.
    pub fn keep(&self, weight: Weight, line: impl FnOnce()) {
        critical_section::with(|_| {
            let from = (self.buffer.end)();
            line();
            self.give(weight, from);
        });
    }

    /// Writes lines as they come, for ever.
    pub async fn write(&self, mut ring: Ring) -> ! {
        let lines = &self.run.lines;
        loop {
            // At first all others begin, which use the flash without waiting for it.
            Timer::after(PERIOD).await;
            while let Some(record) = lines.first() {
                ring.begin(&record);
                while !ring.step() {
                    Timer::after(STEP).await;
                }
                lines.drop_first();
            }
            if let Some(omitted) = lines.take_omitted() {
                self.keep(Weight::Outcome, || {
                    defmt::warn!("board: {} records are not kept", omitted);
                });
            }
        }
    }

    /// Hands over the log from a place on, in as many records as it takes.
    #[inline(never)]
    fn give(&self, weight: Weight, mut from: u32) {
        let [.., image, _] = self.image;
        while from != (self.buffer.end)() {
            let mut record = [0; CONTENT];
            record[..IMAGE].copy_from_slice(&image.to_le_bytes());
            from = (self.buffer.copy)(from, &mut record[IMAGE..]);
            if !self.run.lines.give(weight, &record) {
                break;
            }
        }
    }
}

impl Observer for BoardLog {
    fn event(&self, at: Instant, event: &Event) {
        match event.weight() {
            Some(weight) => self.keep(weight, || DefmtLog.event(at, event)),
            None => DefmtLog.event(at, event),
        }
    }

    fn check_ins(&self) -> Option<&CheckIns> {
        Some(&self.run.check_ins)
    }
}
