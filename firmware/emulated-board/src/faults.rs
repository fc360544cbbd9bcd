//! Faults of the core: which there are, what they tell, what becomes of one that cannot be taken (ARMv7-M
//! Architecture Reference Manual, B1.5.14, B3.2.15).

use crate::exceptions::{BUS_FAULT, HARD_FAULT, MEMORY_FAULT, USAGE_FAULT};

/// A fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Number of its exception.
    pub number: u32,
    /// Its bits in `CFSR`.
    pub status: u32,
    /// The address that was accessed, where the fault tells it.
    pub address: Option<u32>,
}

impl Fault {
    /// A breakpoint that no debugger takes: a hard fault by its own bit of `HFSR`.
    pub const BREAKPOINT: Self = Self { number: HARD_FAULT, status: 0, address: None };
    /// An instruction that there is not.
    pub const UNDEFINED: Self = Self::usage(16);
    /// An instruction while the state is not that of Thumb (`INVSTATE`).
    pub const NO_THUMB: Self = Self::usage(17);
    /// A return from an exception that fails an integrity check (`INVPC`).
    pub const INVALID_RETURN: Self = Self::usage(18);
    /// An instruction for the floating-point unit while it is off (`NOCP`).
    pub const NO_COPROCESSOR: Self = Self::usage(19);
    /// An access that is not aligned where it must be.
    pub const UNALIGNED: Self = Self::usage(24);

    const fn usage(bit: u32) -> Self {
        Self { number: USAGE_FAULT, status: 1 << bit, address: None }
    }

    /// Data where there is nothing.
    pub const fn bus(address: u32) -> Self {
        Self { number: BUS_FAULT, status: 0x8200, address: Some(address) }
    }

    /// Data that are protected.
    pub const fn protected(address: u32) -> Self {
        Self { number: MEMORY_FAULT, status: 0x82, address: Some(address) }
    }

    /// An instruction where there is nothing, or where the default map has no code (B3.1, table B3-1).
    pub const fn fetch(address: u32) -> Self {
        match address >> 28 {
            0x4 | 0x5 | 0xA.. => Self::PROTECTED_CODE,
            _ => Self { number: BUS_FAULT, status: 0x100, address: None },
        }
    }

    /// An instruction that is protected.
    pub const PROTECTED_CODE: Self = Self { number: MEMORY_FAULT, status: 1, address: None };

    /// The stacking of registers failed, by protection or by the bus.
    pub const fn stacking(is_protected: bool) -> Self {
        Self::of_stack(is_protected, 4)
    }

    /// The unstacking of registers failed, by protection or by the bus.
    pub const fn unstacking(is_protected: bool) -> Self {
        Self::of_stack(is_protected, 3)
    }

    const fn of_stack(is_protected: bool, bit: u32) -> Self {
        if is_protected {
            Self { number: MEMORY_FAULT, status: 1 << bit, address: None }
        } else {
            Self { number: BUS_FAULT, status: 1 << (bit + 8), address: None }
        }
    }
}
