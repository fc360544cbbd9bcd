//! An I²C bus on which no device answers for some time.

use embassy_time::Instant;
use embedded_hal_async::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};

use super::When;

/// A bus whose device is lost at some time.
#[derive(Debug)]
pub struct FaultyI2c<B> {
    /// The bus that is wrapped.
    bus: B,
    /// Whether the loss has shown, for one that shows once.
    lost: Option<When>,
    /// Whether the loss has shown.
    has_shown: bool,
}

impl<B> FaultyI2c<B> {
    /// A bus with a device that is lost then, if ever.
    pub const fn new(bus: B, lost: Option<When>) -> Self {
        Self { bus, lost, has_shown: false }
    }
}

impl<B> ErrorType for FaultyI2c<B> {
    type Error = ErrorKind;
}

impl<B: I2c<Error = ErrorKind>> I2c for FaultyI2c<B> {
    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        if self.lost.is_some_and(|when| when.shows(Instant::now(), &mut self.has_shown)) {
            return Err(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address));
        }
        self.bus.transaction(address, operations).await
    }
}
