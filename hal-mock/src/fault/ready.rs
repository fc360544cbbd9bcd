//! A data-ready line that may lose edges, or fall late.

use embassy_time::{Duration, Instant, Timer};
use embedded_hal::digital::ErrorType;
use embedded_hal_async::digital::Wait;

use super::When;

/// By how much a converter that is out of step comes late.
const LATE: Duration = Duration::from_millis(4);

/// A data-ready line that may lose edges: what waited for a lost edge, or for the level that it
/// brought, waits for the next edge. It may also fall late.
#[derive(Debug)]
pub struct FaultyReady<W> {
    /// The line that is wrapped.
    line: W,
    /// Whether an edge was lost, for a fault that shows once.
    when: Option<When>,
    /// Whether an edge was shown.
    shown: bool,
    /// Since when edges come late, if they do.
    late: Option<Instant>,
}

impl<W> FaultyReady<W> {
    /// The line with a time when it loses edges, and one since when they come 4 ms late; without either it is
    /// healthy and passes all on.
    #[must_use]
    pub const fn new(line: W, when: Option<When>, late: Option<Instant>) -> Self {
        Self { line, when, shown: false, late }
    }

    /// Whether what has just happened on the line is lost.
    fn loses(&mut self) -> bool {
        self.when.is_some_and(|when| when.shows(Instant::now(), &mut self.shown))
    }
}

impl<W: Wait> FaultyReady<W> {
    /// Waits for what is wanted first, and where that is lost for the next edge, until one is not lost.
    async fn wait(
        &mut self,
        wanted: impl AsyncFnOnce(&mut W) -> Result<(), W::Error>,
        next: impl AsyncFn(&mut W) -> Result<(), W::Error>,
    ) -> Result<(), W::Error> {
        wanted(&mut self.line).await?;
        while self.loses() {
            next(&mut self.line).await?;
        }
        if self.late.is_some_and(|since| Instant::now() >= since) {
            Timer::after(LATE).await;
        }
        Ok(())
    }
}

impl<W: ErrorType> ErrorType for FaultyReady<W> {
    type Error = W::Error;
}

impl<W: Wait> Wait for FaultyReady<W> {
    async fn wait_for_high(&mut self) -> Result<(), W::Error> {
        self.wait(W::wait_for_high, W::wait_for_rising_edge).await
    }

    async fn wait_for_low(&mut self) -> Result<(), W::Error> {
        self.wait(W::wait_for_low, W::wait_for_falling_edge).await
    }

    async fn wait_for_rising_edge(&mut self) -> Result<(), W::Error> {
        self.wait(W::wait_for_rising_edge, W::wait_for_rising_edge).await
    }

    async fn wait_for_falling_edge(&mut self) -> Result<(), W::Error> {
        self.wait(W::wait_for_falling_edge, W::wait_for_falling_edge).await
    }

    async fn wait_for_any_edge(&mut self) -> Result<(), W::Error> {
        self.wait(W::wait_for_any_edge, W::wait_for_any_edge).await
    }
}
