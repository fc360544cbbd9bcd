//! The observer that logs: every event once, by defmt, as a sentence that the host puts together.

use embassy_time::Instant;

use crate::event::Event;
use crate::ports::Observer;

/// Logs events at level info. The time is that of the log's own stamp, which the image defines.
#[derive(Clone, Copy, Debug, Default)]
pub struct DefmtLog;

impl Observer for DefmtLog {
    // In one place: every part tells, and all sentences would be there again.
    #[inline(never)]
    fn event(&self, _: Instant, event: &Event) {
        defmt::info!("{}", event);
    }
}
