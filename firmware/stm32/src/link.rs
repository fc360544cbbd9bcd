//! The serial port of the link.

use core::future::poll_fn;
use core::task::{Context, Poll};

use embassy_stm32::dma::ReadableRingBuffer;
use embassy_stm32::mode::Async;
use embassy_stm32::usart::{Error, UartTx};
use embedded_io_async::{ErrorType, Read, Write};

/// Bytes that the link receives before the first of them is written over: 115 200 baud bring 11.5 a millisecond at most
/// (ten bits each), so that they last 22 ms, and 11 once half of them have woken who reads.
pub const RECEIVED: usize = 256;

/// The serial port, both ways.
///
/// Direct memory access fills the ring buffer without end, whatever the core does. Who reads is woken by every half of it;
/// what is less waits until the reader comes by itself, as it does ten times a second. No error of a byte stops the
/// reception: embassy's own receiver would stop it, and start it again without the number of its items, which the
/// controller does not support (RM0351, 11.4.3).
pub struct Link {
    receiver: ReadableRingBuffer<'static, u8>,
    sender: UartTx<'static, Async>,
}

impl Link {
    /// The port, whose ring of [`RECEIVED`] bytes is being filled.
    #[must_use]
    pub const fn new(
        receiver: ReadableRingBuffer<'static, u8>,
        sender: UartTx<'static, Async>,
    ) -> Self {
        Self { receiver, sender }
    }

    /// Takes bytes that were received; pending where there are none.
    ///
    /// # Errors
    /// [`Error::Overrun`]: it was looked at too late, and what was written over is lost.
    fn poll_read(&mut self, bytes: &mut [u8], context: &Context<'_>) -> Poll<Result<usize, Error>> {
        self.receiver.set_waker(context.waker());
        match self.receiver.read(bytes) {
            Ok((0, _)) => Poll::Pending,
            Ok((count, _)) => Poll::Ready(Ok(count)),
            Err(_) => {
                self.receiver.clear();
                Poll::Ready(Err(Error::Overrun))
            }
        }
    }
}

impl ErrorType for Link {
    type Error = Error;
}

impl Read for Link {
    async fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Error> {
        poll_fn(|context| self.poll_read(bytes, context)).await
    }
}

impl Write for Link {
    async fn write(&mut self, bytes: &[u8]) -> Result<usize, Error> {
        Write::write(&mut self.sender, bytes).await
    }

    async fn flush(&mut self) -> Result<(), Error> {
        // What was written has been handed to the port; its own end of sending may be missed.
        Ok(())
    }
}
