//! Datagrams on the bus: reads that come one late, writes that are compared with their echo.

use embedded_hal_async::spi::SpiDevice;

use super::codec;
use super::registers::{Address, IOIN, spi_status};
use crate::fault::Fault;

/// What came back, and all status bits that were set in any datagram on the way.
pub(super) type Seen<T> = Result<(T, u8), Fault>;

/// The bus with the chip on it.
#[derive(Debug)]
pub(super) struct Link<S>(pub S);

impl<S: SpiDevice> Link<S> {
    async fn exchange(&mut self, mut bytes: [u8; codec::DATAGRAM]) -> Result<(u8, u32), Fault> {
        self.0.transfer_in_place(&mut bytes).await.map_err(|_| Fault::Bus)?;
        Ok(codec::reply(bytes))
    }

    /// Reads registers, one datagram each and one more.
    pub async fn read<const N: usize>(&mut self, addresses: [Address; N]) -> Seen<[u32; N]> {
        let mut values = [0; N];
        let mut seen = 0;
        let mut asked: Option<&mut u32> = None;
        for (address, value) in addresses.into_iter().zip(&mut values) {
            let (status, data) = self.exchange(codec::read(address)).await?;
            seen |= status;
            if let Some(place) = asked.replace(value) {
                *place = data;
            }
        }
        let (status, data) = self.exchange(codec::read(IOIN)).await?;
        if let Some(place) = asked {
            *place = data;
        }
        Ok((values, seen | status))
    }

    /// Writes registers, one datagram each and one more, and compares what the chip received.
    pub async fn write(&mut self, values: &[(Address, u32)]) -> Seen<()> {
        let mut seen = 0;
        let mut sent: Option<(Address, u32)> = None;
        for &(address, data) in values {
            seen |= self.echo(codec::write(address, data), sent).await?;
            sent = Some((address, data));
        }
        seen |= self.echo(codec::read(IOIN), sent).await?;
        Ok(((), seen))
    }

    /// Sends a datagram whose reply must be what was sent before it; the status byte.
    async fn echo(
        &mut self,
        bytes: [u8; codec::DATAGRAM],
        sent: Option<(Address, u32)>,
    ) -> Result<u8, Fault> {
        let (status, received) = self.exchange(bytes).await?;
        match sent {
            Some((_, data)) if received != data && status & spi_status::RESET != 0 => {
                Err(Fault::Reset)
            }
            Some((Address(register), data)) if received != data => {
                Err(Fault::NotAsWritten { register })
            }
            _ => Ok(status),
        }
    }
}
