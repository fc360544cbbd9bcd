//! Datagrams on the bus: replies that come one late, and what they must hold.

use embedded_hal_async::spi::{Operation, SpiDevice};

use super::codec;
use super::configuration::Configuration;
use super::registers::{Address, IOIN, spi_status};
use crate::fault::Fault;

/// One way through some registers: a datagram for each and one more, which fetches the last reply.
#[derive(Debug)]
pub(super) enum Pass<'a> {
    /// Reads registers into these places.
    Read(&'a [Address], &'a mut [u32]),
    /// Writes contents; the chip must tell that it received them.
    Write(&'a [(Address, u32)]),
    /// Writes the settings of a configuration, each made when it is due: all take much room.
    Configure(&'a Configuration),
    /// Reads registers, which must hold these contents.
    Verify(&'a [(Address, u32)]),
}

impl Pass<'_> {
    /// The datagram for the register in a place; none behind the last one.
    fn datagram(&self, place: usize) -> Option<[u8; codec::DATAGRAM]> {
        match self {
            Self::Read(addresses, _) => addresses.get(place).map(|address| codec::read(*address)),
            Self::Verify(_) => self.content(place).map(|(address, _)| codec::read(address)),
            Self::Write(_) | Self::Configure(_) => {
                self.content(place).map(|(address, data)| codec::write(address, data))
            }
        }
    }

    /// What the register in a place is to hold.
    fn content(&self, place: usize) -> Option<(Address, u32)> {
        match self {
            Self::Read(..) => None,
            Self::Write(contents) | Self::Verify(contents) => contents.get(place).copied(),
            Self::Configure(configuration) => codec::settings(configuration).get(place).copied(),
        }
    }

    /// Takes what came for the register in a place; its address where that is not what it ought to be.
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

/// The bus with the chip on it.
#[derive(Debug)]
pub(super) struct Link<S>(pub S);

impl<S: SpiDevice> Link<S> {
    /// Makes passes one after another; all status bits that were set in any datagram on the way.
    /// Ends after the first that tells of a reset, unless that may be.
    pub async fn pass(&mut self, passes: &mut [Pass<'_>], may_be_reset: bool) -> Result<u8, Fault> {
        let mut seen = 0;
        for pass in passes {
            let mut wrong = None;
            for place in 0.. {
                let datagram = pass.datagram(place);
                let mut bytes = datagram.unwrap_or(codec::read(IOIN));
                let mut operations = [Operation::TransferInPlace(&mut bytes)];
                self.0.transaction(&mut operations).await.map_err(|_| Fault::Bus)?;
                let (status, data) = codec::reply(bytes);
                seen |= status;
                let differs = place.checked_sub(1).and_then(|last| pass.take(last, data));
                wrong = wrong.or(differs.map(|register| not_as_written(register, status)));
                // What was not received as it was sent is no ground to send more on.
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

/// Why a register does not hold what it ought to.
const fn not_as_written(Address(register): Address, status: u8) -> Fault {
    if status & spi_status::RESET == 0 { Fault::NotAsWritten { register } } else { Fault::Reset }
}
