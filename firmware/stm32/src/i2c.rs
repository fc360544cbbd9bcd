//! The bus of the IMU on the base, started anew after each transfer that has failed.
//!
//! embassy ends a transfer that hangs after its time limit, but leaves the interface as it is, and before the next
//! one polls for as long until the bus is free: meanwhile no other sensor would be read.

use embassy_embedded_hal::SetConfig;
use embassy_stm32::i2c::{Error, I2c, Master};
use embassy_stm32::mode::Async;
use embassy_stm32::time::Hertz;
use embedded_hal_async::i2c::{self, ErrorType, Operation};

/// The bus of the IMU on the base.
pub struct BaseBus {
    bus: I2c<'static, Async, Master>,
    frequency: Hertz,
}

impl BaseBus {
    /// A bus that is clocked with this frequency.
    #[must_use]
    pub const fn new(bus: I2c<'static, Async, Master>, frequency: Hertz) -> Self {
        Self { bus, frequency }
    }

    /// Passes an outcome on. To write the frequency disables the interface for a moment, which resets it and
    /// releases the bus (RM0351, 39.4.6).
    fn renewed<T>(&mut self, outcome: Result<T, Error>) -> Result<T, Error> {
        if outcome.is_err() {
            // It has no error.
            let _ = self.bus.set_config(&self.frequency);
        }
        outcome
    }
}

impl ErrorType for BaseBus {
    type Error = Error;
}

impl i2c::I2c for BaseBus {
    async fn write(&mut self, address: u8, sent: &[u8]) -> Result<(), Error> {
        let outcome = self.bus.write(address, sent).await;
        self.renewed(outcome)
    }

    async fn write_read(
        &mut self,
        address: u8,
        sent: &[u8],
        received: &mut [u8],
    ) -> Result<(), Error> {
        let outcome = self.bus.write_read(address, sent, received).await;
        self.renewed(outcome)
    }

    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Error> {
        let outcome = self.bus.transaction(address, operations).await;
        self.renewed(outcome)
    }
}
