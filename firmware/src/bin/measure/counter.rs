//! Counts executed instructions with the core's own timer.
//!
//! QEMU with `-icount shift=5` gives every instruction 32 ns of virtual time, whatever it does, and
//! `SysTick` of its netduinoplus2 runs at 168 MHz: one instruction is 5.376 ticks. The timer is 24
//! bits wide; its exception counts the wraps, one in 3.1 million instructions, and adds about ten
//! instructions to what it interrupts.

use core::hint::black_box;
use core::ops::{Add, AddAssign, Div, Sub};
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

/// Highest value of the timer, which counts down from it to zero.
const RELOAD: u32 = 0xFF_FFFF;
/// Ticks of so many instructions …
const TICKS: u64 = 672;
/// … as these: 672/125 = 168 MHz · 32 ns.
const INSTRUCTIONS: u64 = 125;
/// How often nothing is measured to learn what measuring costs.
const CALIBRATIONS: u64 = 1000;

/// How often the timer has passed zero.
static WRAPS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    WRAPS.store(WRAPS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// What a piece of work took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cost {
    ticks: u64,
}

impl Cost {
    /// In instructions, rounded to nearest.
    pub fn instructions(self) -> u64 {
        self.mean(1)
    }

    /// Instructions of one of `count` equal pieces, rounded to nearest.
    pub fn mean(self, count: u64) -> u64 {
        let unit = TICKS * count;
        (self.ticks * INSTRUCTIONS + unit / 2) / unit
    }
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { ticks: self.ticks + other.ticks }
    }
}

/// What is left; nothing where more is taken away than there is.
impl Sub for Cost {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { ticks: self.ticks.saturating_sub(other.ticks) }
    }
}

/// One of so many equal pieces, rounded to nearest.
impl Div<u64> for Cost {
    type Output = Self;

    fn div(self, count: u64) -> Self {
        Self { ticks: (self.ticks + count / 2) / count }
    }
}

impl AddAssign for Cost {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// The running timer.
pub struct Counter {
    /// Ticks that a measurement of nothing shows.
    own: u64,
}

impl Counter {
    /// Starts the timer and learns what a measurement costs.
    pub fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.clear_current();
        timer.enable_interrupt();
        timer.enable_counter();
        let mut counter = Self { own: 0 };
        let empty: u64 = (0..CALIBRATIONS).map(|_| counter.measure(|| ()).0.ticks).sum();
        counter.own = (empty + CALIBRATIONS / 2) / CALIBRATIONS;
        counter
    }

    /// Does the work, which must be a call that is not inlined, and tells what it took.
    #[inline(never)]
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (Cost, T) {
        let before = now();
        let result = black_box(work());
        let after = now();
        (Cost { ticks: (after - before).saturating_sub(self.own) }, result)
    }
}

/// Ticks since the start.
#[inline(never)]
fn now() -> u64 {
    loop {
        let wraps = WRAPS.load(Ordering::Relaxed);
        let left = SYST::get_current();
        if wraps == WRAPS.load(Ordering::Relaxed) {
            return (u64::from(wraps) << 24) + u64::from(RELOAD - left);
        }
    }
}
