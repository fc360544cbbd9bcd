//! Clocks of the board: 80 MHz from the internal oscillator, locked to the 32.768 kHz crystal.

use embassy_stm32::rcc::{LsConfig, MSIRange, Pll, PllMul, PllPreDiv, PllRDiv, PllSource, Sysclk};
use embassy_stm32::{Config, Peripherals};

/// Clock of the core and of both peripheral buses, Hz. Trimmed by the crystal, the oscillator runs
/// at 122 · 32 768 Hz instead of 4 MHz: all times are then 0.06 % too short, with a constant ratio.
/// Without the crystal it is accurate to about 1 %.
pub const SYSTEM: u32 = 80_000_000;

/// Starts the clocks, trimmed by the crystal X2 (UM2153, section 7.6) where `has_crystal`; without
/// a crystal the start would wait for it for ever.
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
