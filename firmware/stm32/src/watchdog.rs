//! Independent watchdog, and the reason of the last reset: a part that hangs is reset, and the
//! reset is reported. The registers are those of an STM32L4; other families have them elsewhere.

use embassy_stm32::pac::iwdg::vals::{Key, Pr};
use embassy_stm32::pac::{DBGMCU, IWDG, RCC};
use embassy_time::{Duration, Timer};
use firmware::postmortem::Outlasting;

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

/// Refreshes the watchdog as long as every part that is expected has checked in since the last time. It is a task of the
/// lowest priority, so that one that never returns has it wait too. Who had not checked in, and who ran, outlasts the
/// reset.
#[embassy_executor::task]
pub async fn feed(run: &'static Outlasting) -> ! {
    loop {
        if run.check_ins.renew() {
            IWDG.kr().write(|key| key.set_key(Key::RESET));
        }
        Timer::after(PERIOD).await;
        run.pass_second();
    }
}

/// Reason of the last reset of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
pub enum Reason {
    /// The watchdog expired: the program hung.
    Watchdog,
    /// The supply was switched on, or was too low: the flag is that of both.
    Supply,
    /// Software or a debugger requested it; a panic or a fault does.
    Software,
    /// The reset button or the reset pin.
    Pin,
    /// Option bytes were loaded.
    OptionBytes,
    /// A low-power mode was entered that is forbidden.
    LowPower,
    /// The firewall was violated.
    Firewall,
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
        () if flags.oblrstf() => Reason::OptionBytes,
        () if flags.sftrstf() => Reason::Software,
        () if flags.fwrstf() => Reason::Firewall,
        () if flags.lpwrrstf() => Reason::LowPower,
        () => Reason::Pin,
    }
}
