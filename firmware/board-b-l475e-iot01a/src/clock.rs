//! Clocks of the board: 64 MHz from the internal oscillator, locked to the 32.768 kHz crystal once that oscillates.

use embassy_stm32::pac::rcc::vals::Lsedrv;
use embassy_stm32::pac::{PWR, RCC};
use embassy_stm32::rcc::{
    LsConfig, LseConfig, LseDrive, LseMode, MSIRange, Pll, PllMul, PllPreDiv, PllRDiv, PllSource,
    RtcClockSource, Sysclk,
};
use embassy_stm32::time::Hertz;
use embassy_stm32::{Config, Peripherals};
use embassy_time::{Duration, Instant, Timer};

/// Clock of the core and of both peripheral buses, Hz: a power of two divides it to the 8 MHz that the converters allow
/// their serial bus, where the greatest clock, 80 MHz, would leave 5. Trimmed by the crystal, the oscillator runs
/// at 122 · 32 768 Hz instead of 4 MHz: all times are then 0.06 % too short, with a constant ratio.
/// Without the crystal it is accurate to about 1 %.
pub const SYSTEM: u32 = 64_000_000;

/// Longest start of the crystal X2 (UM2153, section 7.6): typically 2 s (DS10969, LSE oscillator characteristics).
const LONGEST: Duration = Duration::from_millis(2500);
/// Time between two looks whether it oscillates.
const LOOK: Duration = Duration::from_millis(10);

/// The crystal, unless it is off.
const CRYSTAL: LsConfig = LsConfig {
    rtc: RtcClockSource::DISABLE,
    lsi: false,
    lse: Some(LseConfig {
        frequency: Hertz(32_768),
        mode: LseMode::Oscillator(LseDrive::MediumHigh),
    }),
};

/// Starts the clocks, without waiting for the crystal: embassy would with interrupts off, for two seconds or, without a
/// crystal, for ever. One that oscillates still, as after a reset, is used at once.
pub fn start() -> Peripherals {
    let mut configuration = Config::default();
    let rcc = &mut configuration.rcc;
    rcc.msi = Some(MSIRange::RANGE4M);
    rcc.ls = if oscillates() { CRYSTAL } else { LsConfig::off() };
    rcc.pll = Some(Pll {
        source: PllSource::MSI,
        prediv: PllPreDiv::DIV1,
        mul: PllMul::MUL32,
        divp: None,
        divq: None,
        divr: Some(PllRDiv::DIV2),
    });
    rcc.sys = Sysclk::PLL1_R;
    embassy_stm32::init(configuration)
}

/// Whether the crystal oscillates.
fn oscillates() -> bool {
    let crystal = RCC.bdcr().read();
    crystal.lseon() && crystal.lserdy()
}

/// Switches the crystal on, and has the oscillator follow it as soon as it oscillates; whether it does in time. Where it
/// was dead before this reset, it is not waited for.
pub async fn follow_crystal(is_dead: bool) -> bool {
    if !oscillates() {
        PWR.cr1().modify(|control| control.set_dbp(true));
        RCC.bdcr().modify(|crystal| {
            crystal.set_lsedrv(Lsedrv::MEDIUM_HIGH);
            crystal.set_lseon(true);
        });
        let begun = Instant::now();
        while !is_dead && !oscillates() && begun.elapsed() < LONGEST {
            Timer::after(LOOK).await;
        }
    }
    let follows = oscillates();
    // Only where the crystal oscillates (RM0351, 6.4.1, MSIPLLEN).
    RCC.cr().modify(|control| control.set_msipllen(follows));
    follows
}
