//! The independent watchdog, and why the controller has started: whatever hangs is reset and told.

use embassy_stm32::pac::iwdg::vals::{Key, Pr};
use embassy_stm32::pac::{DBGMCU, IWDG, RCC};
use embassy_time::{Duration, Timer};

/// Time between two feedings. The executor may be busy in between for the fit at the end, some
/// seconds; the watchdog bites after 8 s.
const PERIOD: Duration = Duration::from_secs(1);

/// Arms the watchdog: 4096 ticks of 32 kHz/64, 8.2 s (7.7 s to 8.9 s by the oscillator's limits).
/// It rests while a debugger halts the core. Nothing but a reset stops it (RM0351, IWDG).
pub fn arm() {
    DBGMCU.apb1fzr1().modify(|freeze| freeze.set_iwdg(true));
    IWDG.kr().write(|key| key.set_key(Key::START));
    IWDG.kr().write(|key| key.set_key(Key::ENABLE));
    IWDG.pr().write(|prescaler| prescaler.set_pr(Pr::DIVIDE_BY64));
}

/// Feeds the watchdog as long as the executor comes round.
#[embassy_executor::task]
pub async fn feed() -> ! {
    loop {
        IWDG.kr().write(|key| key.set_key(Key::RESET));
        Timer::after(PERIOD).await;
    }
}

/// Why the controller has started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Reason {
    /// Something hung or panicked: the watchdog bit.
    Watchdog,
    /// The supply was switched on, or broke down.
    Supply,
    /// Software or a debugger asked for it.
    Software,
    /// The reset button, or the pin.
    Pin,
    /// Option bytes, firewall or a low-power mode.
    Other,
}

/// The reason, which is then forgotten (RM0351, `RCC_CSR`). Every reset pulls the pin, so that the
/// pin's flag tells something only when it is alone.
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

/// Whether the last start hung waiting for the 32.768 kHz crystal: it was switched on, and in all
/// the watchdog's time did not get ready. The backup domain remembers it over the reset.
pub fn crystal_failed(reason: Reason) -> bool {
    let crystal = RCC.bdcr().read();
    reason == Reason::Watchdog && crystal.lseon() && !crystal.lserdy()
}
