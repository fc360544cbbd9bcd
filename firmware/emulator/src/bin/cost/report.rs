//! Printed table, with the check of every budget.

use core::fmt::Display;

use cortex_m::asm::wfi;
use cortex_m_semihosting::{debug, hprintln};

use measure::counter::Cost;

/// Divisor of the tolerance of a check: one per cent.
const CHECK_PARTS: u64 = 100;

/// Begins a table of a quantity.
pub fn heading(quantity: &str) {
    hprintln!("");
    hprintln!("{:>10} {:>10} {:5} {quantity}", "count", "budget", "");
}

/// Prints a figure without a budget.
#[inline(never)]
pub fn figure(name: impl Display, count: u64) {
    hprintln!("{count:>10} {:>10} {:5} {name}", "-", "");
}

/// Mean and greatest number of instructions of equal pieces of work, each of which returns its cost.
pub fn mean_and_greatest(count: u64, mut piece: impl FnMut(u64) -> Cost) -> [u64; 2] {
    let (mut total, mut worst) = (Cost::default(), Cost::default());
    for index in 0..count {
        let cost = piece(index);
        total += cost;
        worst = worst.max(cost);
    }
    [total.mean(count), worst.instructions()]
}

/// Result of all checks so far.
#[derive(Debug, Default)]
pub struct Report {
    /// Whether a check failed.
    failed: bool,
}

impl Report {
    /// Prints a figure that must not exceed its budget.
    #[inline(never)]
    pub fn budget(&mut self, name: impl Display, count: u64, budget: u64) {
        let verdict = if count <= budget { "ok" } else { "OVER" };
        self.failed |= count > budget;
        hprintln!("{count:>10} {budget:>10} {verdict:5} {name}");
    }

    /// Prints a figure with a known value, which must agree within one per cent.
    pub fn check(&mut self, name: impl Display, count: u64, known: u64) {
        let agrees = count.abs_diff(known) * CHECK_PARTS <= known;
        self.failed |= !agrees;
        let verdict = if agrees { "ok" } else { "WRONG" };
        hprintln!("{count:>10} {known:>10} {verdict:5} {name}");
    }

    /// Requires a condition without which the figures are not valid.
    pub fn require(&mut self, what: &str, is_true: bool) {
        if !is_true {
            self.failed = true;
            hprintln!("NOT TRUE: {what}");
        }
    }

    /// Ends the emulator, successfully only if nothing failed.
    pub fn end(self) -> ! {
        hprintln!("");
        hprintln!("{}", if self.failed { "FAILED" } else { "all within budget" });
        debug::exit(if self.failed { debug::EXIT_FAILURE } else { debug::EXIT_SUCCESS });
        loop {
            wfi();
        }
    }
}
