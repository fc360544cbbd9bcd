//! The data-ready line of a simulated converter, which tells when it fell.

use core::cell::RefCell;

use drivers::data_ready::{DataReady, Edge};
use drivers::fault::Fault;
use embassy_time::Instant;
use embedded_hal_async::digital::Wait;
use hal_mock::chip::{Rig, Select};
use orientation::units;

/// A data-ready line as the simulated pin shows it, with what may be wrong with it, and the chip that knows when it
/// fell.
pub struct ObservedLine<'a, W> {
    /// The chips of the board.
    rig: &'a RefCell<dyn Rig + 'a>,
    /// Whose line it is.
    select: Select,
    /// The line as it is seen.
    line: W,
}

impl<'a, W> ObservedLine<'a, W> {
    /// The line of the chip at `select`, which is seen through `line`.
    #[must_use]
    pub const fn new(rig: &'a RefCell<dyn Rig + 'a>, select: Select, line: W) -> Self {
        Self { rig, select, line }
    }
}

impl<W: Wait> DataReady for ObservedLine<'_, W> {
    /// A line that is seen to be low without a wait fell when its chip says; any other falls now, late where the line
    /// shows it late.
    async fn edge(&mut self) -> Result<Edge, Fault> {
        let asked = Instant::now();
        self.line.wait_for_low().await.map_err(|_| Fault::Bus)?;
        let now = Instant::now();
        // The wait has had the chips do all that they do until now.
        let line = self.rig.borrow_mut().latest_line(self.select);
        let at = line.latest.filter(|_| now == asked).unwrap_or(now);
        Ok(Edge { at: units::Instant(at.as_micros()), count: line.count })
    }
}
