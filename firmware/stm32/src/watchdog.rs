//! Independent watchdog, and the reason of the last reset: a program that hangs is reset, and the
//! reset is reported. The registers are those of an STM32L4; other families have them elsewhere.

use embassy_stm32::pac::iwdg::vals::{Key, Pr};
use embassy_stm32::pac::{DBGMCU, IWDG, RCC};
use embassy_time::{Duration, Timer};

/// Time between two refreshes. The executor may be busy in between with the final fit for some
/// seconds; the watchdog resets after 8 s.
const PERIOD: Duration = Duration::from_secs(1);

/// Arms the watchdog: 4096 ticks of 32 kHz/64, 8.2 s (7.7 s to 8.9 s by the oscillator's limits).
/// It pauses while a debugger halts the core. Only a reset stops it (RM0351, IWDG).
pub fn arm() {
    DBGMCU.apb1fzr1().modify(|freeze| freeze.set_iwdg(true));
    IWDG.kr().write(|key| key.set_key(Key::START));
    IWDG.kr().write(|key| key.set_key(Key::ENABLE));
    IWDG.pr().write(|prescaler| prescaler.set_pr(Pr::DIVIDE_BY64));
}

/// Refreshes the watchdog as long as the executor runs.
#[embassy_executor::task]
pub async fn feed() -> ! {
    loop {
        IWDG.kr().write(|key| key.set_key(Key::RESET));
        Timer::after(PERIOD).await;
    }
}

/// Reason of the last reset of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Reason {
    /// The watchdog expired: the program hung or panicked.
    Watchdog,
    /// The supply was switched on, or failed.
    Supply,
    /// Software or a debugger requested it.
    Software,
    /// The reset button or the reset pin.
    Pin,
    /// Option bytes, firewall or a low-power mode.
    Other,
}

/// Reads the reason and clears it (RM0351, `RCC_CSR`). Every reset pulls the pin, so the pin's flag
/// is meaningful only when it is alone.
#[must_use]
pub fn reason() -> Reason {
    let flags = RCC.csr().read();
    RCC.csr().modify(|status| status.set_rmvf(true));
    match () {
        () if flags.iwdgrstf() || flags.wwdgrstf() => Reason::Watchdog,
        () if flags.borrstf() => Reason::Supply,
        () if flags.sftrstf() => Reason::Software,
        () if flags.oblrstf() || flags.fwrstf() || flags.lpwrrstf() => Reason::Other,
        () => Reason::Pin,
    }
}

/// Whether the last start hung waiting for the 32.768 kHz crystal: it was switched on, and did not
/// become ready within the watchdog's time. The backup domain keeps these flags over the reset.
#[must_use]
pub fn crystal_failed(reason: Reason) -> bool {
    let crystal = RCC.bdcr().read();
    reason == Reason::Watchdog && crystal.lseon() && !crystal.lserdy()
}
