//! The observer that logs each event once by defmt. The image contains only an index and the
//! values; the host composes the sentence.

use embassy_time::Instant;

use crate::event::Event;
use crate::ports::Observer;

/// Logs events at level info. The time in the log is that of defmt's own stamp, which the image
/// defines.
#[derive(Clone, Copy, Debug, Default)]
pub struct DefmtLog;

impl Observer for DefmtLog {
    // Kept in one place: inlined, all sentences would be in the image once for each part that
    // reports.
    #[inline(never)]
    fn event(&self, _: Instant, event: &Event) {
        defmt::info!("{}", event);
    }
}
