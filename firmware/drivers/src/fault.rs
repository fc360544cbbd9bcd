//! The reasons why a chip gives no valid reading, with the remedy for each.

use embedded_hal_async::spi::{Error, ErrorKind};
use orientation::words;

/// A failed exchange with a chip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The bus reported an error: repeat the transfer.
    Bus,
    /// The bus did not end a transfer within its time, and was started again: repeat the transfer.
    Hung,
    /// A checksum was wrong: repeat the transfer.
    Checksum,
    /// The chip has restarted and lost its configuration: start it again.
    Reset,
    /// Another chip answers, or none: check the wiring.
    Identity {
        /// Content of the identity register.
        found: u32,
    },
    /// The chip's self-test failed: start it again, then replace it.
    SelfTest,
    /// A register does not hold the value that was written to it: start the chip again.
    NotAsWritten {
        /// Address of the register.
        register: u8,
    },
    /// The chip did not become ready within its time limit: start it again.
    NotReady,
    /// The chip reports a bad supply, reference or magnet: its readings are invalid.
    Alarm {
        /// The status bits of the chip.
        status: u8,
    },
}

words! { Fault:
    Self::Bus => "bus error";
    Self::Hung => "its bus hangs";
    Self::Checksum => "wrong checksum";
    Self::Reset => "it has restarted";
    Self::Identity { found } => "wrong identity {:#x}", found;
    Self::SelfTest => "self-test failed";
    Self::NotAsWritten { register } => "register {:#x} does not hold what was written", register;
    Self::NotReady => "not ready in time";
    Self::Alarm { status } => "alarm, status {:#x}", status;
}

impl Fault {
    /// The fault of a transfer on a serial bus. A bus tells a transfer that it has not ended within its time by an
    /// error of another than the usual kinds.
    #[expect(clippy::needless_pass_by_value, reason = "it is what an error is mapped by")]
    pub(crate) fn of_transfer(error: impl Error) -> Self {
        if error.kind() == ErrorKind::Other { Self::Hung } else { Self::Bus }
    }
}

/// Compares registers, as read back from the address `first` on, with what was written to them.
///
/// # Errors
/// [`Fault::NotAsWritten`] with the first register that differs.
pub(crate) fn compare(first: u8, found: &[u8], written: &[u8]) -> Result<(), Fault> {
    for (register, (found, written)) in (first..).zip(found.iter().zip(written)) {
        if found != written {
            return Err(Fault::NotAsWritten { register });
        }
    }
    Ok(())
}
