//! The wire of a simulated board's link, and what comes over it.

use core::cell::RefCell;
use core::convert::Infallible;
use core::future::pending;

use embassy_time::{Instant, Timer};
use embedded_io_async::{ErrorType, Read, Write};

/// What comes over the link while an instrument runs.
pub trait Traffic {
    /// The next bytes, and when the last of them has come; [`None`] where nothing more comes.
    fn next(&self) -> Option<(Instant, Vec<u8>)>;
}

/// The wire of the link: it takes everything, and brings the traffic in its time.
pub(super) struct Wire<'d> {
    sent: &'d RefCell<Vec<u8>>,
    traffic: Option<&'d dyn Traffic>,
    /// What comes next.
    coming: Option<(Instant, Vec<u8>)>,
}

impl<'d> Wire<'d> {
    /// What is sent is kept in `sent`.
    pub(super) const fn new(sent: &'d RefCell<Vec<u8>>, traffic: Option<&'d dyn Traffic>) -> Self {
        Self { sent, traffic, coming: None }
    }
}

impl ErrorType for Wire<'_> {
    type Error = Infallible;
}

impl Read for Wire<'_> {
    async fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        if self.coming.is_none() {
            self.coming = self.traffic.and_then(Traffic::next);
        }
        let Some((at, coming)) = &mut self.coming else { return pending().await };
        Timer::at(*at).await;
        let count = coming.len().min(bytes.len());
        bytes[..count].copy_from_slice(&coming[..count]);
        coming.drain(..count);
        if coming.is_empty() {
            self.coming = None;
        }
        Ok(count)
    }
}

impl Write for Wire<'_> {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        self.sent.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    async fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
