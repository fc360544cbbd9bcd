//! Clocks: 80 MHz from the internal oscillator, which follows the 32.768 kHz crystal.

use embassy_stm32::rcc::{LsConfig, MSIRange, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk};
use embassy_stm32::{Config, Peripherals};

/// Core and both peripheral buses, Hz. Trimmed by the crystal the oscillator makes 122 · 32 768 Hz
/// of its 4 MHz: all times are then 0.06 % too short, always the same. Without the crystal it is
/// good to about 1 %.
pub const SYSTEM: u32 = 80_000_000;

/// Starts the clocks, trimmed by the crystal X2 (UM2153, section 7.6) where `has_crystal`; else
/// this would wait for it for ever.
pub fn start(has_crystal: bool) -> Peripherals {
    let mut configuration = Config::default();
    let rcc = &mut configuration.rcc;
    rcc.msi = Some(MSIRange::RANGE4M);
    rcc.ls = if has_crystal { LsConfig::default_lse() } else { LsConfig::off() };
    rcc.pll = Some(Pll {
        source: PllSource::MSI,
        prediv: PllPreDiv::DIV1,
        mul: PllMul::MUL40,
        divp: None,
        divq: None,
        divr: Some(PllRDiv::DIV2),
    });
    rcc.sys = Sysclk::PLL1_R;
    embassy_stm32::init(configuration)
}
