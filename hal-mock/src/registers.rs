//! The register map of a chip as its data sheet lists it: what the bus may do with which bits, and what a
//! reset leaves in them.

use crate::violation::Misuse;

/// What the bus may do with a register.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Access {
    /// The bus can read it, but not write it.
    Read,
    /// The bus can write it, but not read it.
    Write,
    /// The bus can read and write it.
    Both,
    /// The bus can read it; writing a one clears the bit.
    WriteToClear,
}

/// Registers of one kind that follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Registers {
    /// Addresses of the first and the last of them.
    addresses: [u16; 2],
    /// What the bus may do with them.
    pub(crate) access: Access,
    /// Bits that may be written as one.
    pub(crate) mask: u32,
    /// Value of the bits after a reset.
    reset: u32,
}

/// Registers that can be read only, zero after a reset.
pub(crate) const fn read(first: u16, last: u16) -> Registers {
    fixed(first, last, 0)
}

/// Registers that can be read only, with what a reset leaves in them.
pub(crate) const fn fixed(first: u16, last: u16, reset: u32) -> Registers {
    Registers { addresses: [first, last], access: Access::Read, mask: 0, reset }
}

/// A register that can be written only.
pub(crate) const fn write(address: u16, mask: u32, reset: u32) -> Registers {
    Registers { addresses: [address; 2], access: Access::Write, mask, reset }
}

/// A register that can be read and written.
pub(crate) const fn both(address: u16, mask: u32, reset: u32) -> Registers {
    Registers { addresses: [address; 2], access: Access::Both, mask, reset }
}

/// A register in which a written one clears the bit.
pub(crate) const fn flags(address: u16, mask: u32, reset: u32) -> Registers {
    Registers { addresses: [address; 2], access: Access::WriteToClear, mask, reset }
}

impl Registers {
    /// These registers up to another last address.
    pub(crate) const fn to(self, last: u16) -> Self {
        Self { addresses: [self.addresses[0], last], ..self }
    }
}

/// The register at an address of a map in rising order of addresses, if there is one.
pub(crate) fn register(map: &[Registers], address: u16) -> Option<&Registers> {
    let place = map.partition_point(|registers| registers.addresses[1] < address);
    map.get(place).filter(|registers| registers.addresses[0] <= address)
}

/// The first `N` registers after a reset.
pub(crate) fn reset<const N: usize>(map: &[Registers]) -> [u32; N] {
    let value = |address| register(map, address as u16).map_or(0, |registers| registers.reset);
    core::array::from_fn(value)
}

/// The first `N` registers of one byte after a reset.
pub(crate) fn reset_bytes<const N: usize>(map: &[Registers]) -> [u8; N] {
    reset(map).map(|value| value as u8)
}

/// Why a read of an address is forbidden, or none where it is allowed.
pub(crate) fn read_refusal(map: &[Registers], address: u16) -> Option<Misuse> {
    match register(map, address) {
        None => Some(Misuse::UnknownRegister),
        Some(found) => (found.access == Access::Write).then_some(Misuse::WriteOnly),
    }
}

/// Why these ones must not be written to an address, or none where the map allows it; values that are
/// forbidden without a reserved bit are the chip's own affair.
pub(crate) fn write_refusal(map: &[Registers], address: u16, ones: u32) -> Option<Misuse> {
    match register(map, address) {
        None => Some(Misuse::UnknownRegister),
        Some(found) if found.access == Access::Read => Some(Misuse::ReadOnly),
        Some(found) => (ones & !found.mask != 0).then_some(Misuse::ReservedBits),
    }
}
