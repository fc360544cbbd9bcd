//! Where peripherals are: their addresses, what gives them their clock, their requests for direct memory access, their
//! interrupts (RM0351, tables 1, 44, 45 and 57).

use super::dma::CHANNELS;

/// The peripherals, by where their registers begin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Peripheral {
    /// A serial peripheral interface, SPI1 being 0.
    Spi(usize),
    /// The unique number of the device.
    Identity,
    /// The interface I2C2.
    I2c,
    /// Power control.
    Power,
    /// The independent watchdog.
    Watchdog,
    /// Registers of the core.
    System,
    /// The system configuration.
    Configuration,
    /// Interrupts by edges.
    Exti,
    /// The serial port USART1.
    Usart,
    /// The timer TIM15.
    Timer,
    /// Direct memory access, DMA1 being 0.
    Dma(usize),
    /// Reset and clocks.
    Rcc,
    /// The flash.
    Flash,
    /// A port of pins, A being 0.
    Gpio(usize),
    /// The debug unit.
    Debug,
}

impl Peripheral {
    /// Whether it takes a write of so many bytes at an address: of a word. Registers of the core take bytes, that of the
    /// data of a serial peripheral interface, too, and those on the peripherals' buses that have sixteen bits take those.
    pub fn takes(self, address: u32, size: u32) -> bool {
        match self {
            Self::System => true,
            Self::Spi(_) => address.is_multiple_of(4),
            Self::Timer => address.is_multiple_of(4) && size >= 2,
            _ => size == 4,
        }
    }
}

/// The peripheral at an address, and what gives it its clock: offset of a register of [`Rcc`] and bit.
pub const fn peripheral(address: u32) -> Option<(Peripheral, Option<(u32, u32)>)> {
    Some(match address & !0x3FF {
        0x1FFF_7400 => (Peripheral::Identity, None),
        0x4000_3000 => (Peripheral::Watchdog, None),
        0x4000_3800 => (Peripheral::Spi(1), Some((0x58, 14))),
        0x4000_5800 => (Peripheral::I2c, Some((0x58, 22))),
        0x4000_7000 => (Peripheral::Power, Some((0x58, 28))),
        0x4001_0000 => (Peripheral::Configuration, Some((0x60, 0))),
        0x4001_0400 => (Peripheral::Exti, None),
        0x4001_3000 => (Peripheral::Spi(0), Some((0x60, 12))),
        0x4001_3800 => (Peripheral::Usart, Some((0x60, 14))),
        0x4001_4000 => (Peripheral::Timer, Some((0x60, 16))),
        0x4002_0000 => (Peripheral::Dma(0), Some((0x48, 0))),
        0x4002_0400 => (Peripheral::Dma(1), Some((0x48, 1))),
        0x4002_1000 => (Peripheral::Rcc, None),
        0x4002_2000 => (Peripheral::Flash, None),
        base @ 0x4800_0000..0x4800_2000 => {
            let port = (base - 0x4800_0000) / 0x400;
            (Peripheral::Gpio(port as usize), Some((0x4C, port)))
        }
        0xE000_E000..0xE000_F000 => (Peripheral::System, None),
        0xE004_2000 => (Peripheral::Debug, None),
        _ => return None,
    })
}

/// Requests of peripherals for direct memory access: controller, channel from zero, selection (tables 44, 45).
pub const REQUESTS: [(usize, usize, u32, Request); 12] = [
    (0, 1, 1, Request::FromSpi(0)),
    (0, 2, 1, Request::ToSpi(0)),
    (0, 3, 1, Request::FromSpi(1)),
    (0, 4, 1, Request::ToSpi(1)),
    (0, 3, 3, Request::ToI2c),
    (0, 4, 3, Request::FromI2c),
    (0, 3, 2, Request::ToUsart),
    (0, 4, 2, Request::FromUsart),
    (1, 2, 4, Request::FromSpi(0)),
    (1, 3, 4, Request::ToSpi(0)),
    (1, 5, 2, Request::ToUsart),
    (1, 6, 2, Request::FromUsart),
];

/// Who asks for direct memory access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Request {
    /// A serial peripheral interface has a byte.
    FromSpi(usize),
    /// A serial peripheral interface wants a byte.
    ToSpi(usize),
    /// The two-wire interface has a byte.
    FromI2c,
    /// The two-wire interface wants a byte.
    ToI2c,
    /// The serial port has a byte.
    FromUsart,
    /// The serial port wants a byte.
    ToUsart,
}

/// Interrupts of the channels of both DMA controllers.
pub const DMA_INTERRUPTS: [[u32; CHANNELS]; 2] =
    [[11, 12, 13, 14, 15, 16, 17], [56, 57, 58, 59, 60, 68, 69]];
