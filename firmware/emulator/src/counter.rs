//! Counts executed instructions with the system timer of the processor core.
//!
//! QEMU with `-icount shift=5` advances the virtual time by 32 ns for every instruction, whatever
//! the instruction does, and `SysTick` of the emulated netduinoplus2 runs at 168 MHz: one
//! instruction is 5.376 ticks. The timer is 24 bits wide. An exception counts its wraps, one in 3.1
//! million instructions, and adds about ten instructions to the work that it interrupts, 3·10⁻⁶ of
//! it.

use core::hint::black_box;
use core::ops::{Add, AddAssign, Div, Sub};
use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::exception;

/// Reload value of the timer, which counts down from it to zero: the full 24 bits.
const RELOAD: u32 = 0xFF_FFFF;
/// Numerator of the ratio of ticks to instructions: 672 ticks are 125 instructions.
const TICKS: u64 = 672;
/// Denominator of the ratio: 672/125 = 5.376 = 168 MHz · 32 ns.
const INSTRUCTIONS: u64 = 125;
/// Number of empty measurements whose mean is the cost of a measurement itself.
const CALIBRATIONS: u64 = 1000;

/// Number of times that the timer has passed zero.
static WRAPS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    WRAPS.store(WRAPS.load(Ordering::Relaxed).wrapping_add(1), Ordering::Relaxed);
}

/// The cost of a piece of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Cost {
    /// Ticks of the timer; 5.376 for each instruction.
    ticks: u64,
}

impl Cost {
    /// The number of instructions, rounded to nearest.
    #[must_use]
    pub fn instructions(self) -> u64 {
        self.mean(1)
    }

    /// The mean number of instructions of one of `count` equal pieces, rounded to nearest. `count`
    /// must not be zero.
    #[must_use]
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

/// The difference of two costs, at least zero.
impl Sub for Cost {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { ticks: self.ticks.saturating_sub(other.ticks) }
    }
}

/// The cost of one of `count` equal pieces, rounded to nearest ticks.
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
    /// Ticks of a measurement of no work, subtracted from every measurement.
    own: u64,
}

impl Counter {
    /// Starts the timer and measures the cost of a measurement itself.
    #[must_use]
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

    /// Runs the work and returns its cost and its result. The work must be a call that is not
    /// inlined, or the compiler may move parts of it out of the measurement.
    #[inline(never)]
    pub fn measure<T>(&self, work: impl FnOnce() -> T) -> (Cost, T) {
        let before = now();
        let result = black_box(work());
        let after = now();
        (Cost { ticks: (after - before).saturating_sub(self.own) }, result)
    }
}

/// Ticks since the start. Reads again if the timer wrapped between the two reads.
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
