//! Transfer of datagrams: replies come one datagram late and are compared with their required
//! contents.

use embedded_hal_async::spi::{Operation, SpiDevice};

use super::codec;
use super::configuration::Configuration;
use super::registers::{Address, IOIN, spi_status};
use crate::fault::Fault;

/// A pass through a set of registers: a datagram for each, and one more, which fetches the last
/// reply.
#[derive(Debug)]
pub(super) enum Pass<'a> {
    /// Reads registers.
    Read(&'a [Address], &'a mut [u32]),
    /// Writes contents; the chip must send back the data that it received.
    Write(&'a [(Address, u32)]),
    /// Writes the settings of a configuration. Each is computed when it is due, since all of them
    /// together take much memory.
    Configure(&'a Configuration),
    /// Reads registers and compares them with these contents.
    Verify(&'a [(Address, u32)]),
}

impl Pass<'_> {
    /// The datagram for the register with this index; `None` behind the last one.
    fn datagram(&self, place: usize) -> Option<[u8; codec::DATAGRAM]> {
        match self {
            Self::Read(addresses, _) => addresses.get(place).map(|address| codec::read(*address)),
            Self::Verify(_) => self.content(place).map(|(address, _)| codec::read(address)),
            Self::Write(_) | Self::Configure(_) => {
                self.content(place).map(|(address, data)| codec::write(address, data))
            }
        }
    }

    /// The required content of the register with this index.
    fn content(&self, place: usize) -> Option<(Address, u32)> {
        match self {
            Self::Read(..) => None,
            Self::Write(contents) | Self::Verify(contents) => contents.get(place).copied(),
            Self::Configure(configuration) => codec::settings(configuration).get(place).copied(),
        }
    }

    /// Takes the reply for the register with this index; the register's address if the reply
    /// differs from the required content.
    fn take(&mut self, place: usize, data: u32) -> Option<Address> {
        if let Self::Read(_, values) = self
            && let Some(value) = values.get_mut(place)
        {
            *value = data;
        }
        let (address, expected) = self.content(place)?;
        (data != expected).then_some(address)
    }
}

/// The chip on its bus.
#[derive(Debug)]
pub(super) struct Link<S>(pub S);

impl<S: SpiDevice> Link<S> {
    /// Makes passes one after another and returns all status bits that were set in any of the
    /// datagrams. Ends after the first datagram that reports a reset, unless a reset is permitted.
    pub async fn pass(&mut self, passes: &mut [Pass<'_>], may_be_reset: bool) -> Result<u8, Fault> {
        let mut seen = 0;
        for pass in passes {
            let mut wrong = None;
            for place in 0.. {
                let datagram = pass.datagram(place);
                let mut bytes = datagram.unwrap_or(codec::read(IOIN));
                let mut operations = [Operation::TransferInPlace(&mut bytes)];
                self.0.transaction(&mut operations).await.map_err(Fault::of_transfer)?;
                let (status, data) = codec::reply(bytes);
                seen |= status;
                let differs = place.checked_sub(1).and_then(|last| pass.take(last, data));
                wrong = wrong.or(differs.map(|register| not_as_written(register, status)));
                // After a datagram that was not received correctly, nothing more is sent.
                if datagram.is_none() || wrong.is_some() && !matches!(pass, Pass::Verify(_)) {
                    break;
                }
            }
            if !may_be_reset && seen & spi_status::RESET != 0 {
                return Err(Fault::Reset);
            }
            wrong.map_or(Ok(()), Err)?;
        }
        Ok(seen)
    }
}

/// The fault of a register that does not hold its required content.
const fn not_as_written(Address(register): Address, status: u8) -> Fault {
    if status & spi_status::RESET == 0 { Fault::NotAsWritten { register } } else { Fault::Reset }
}
