//! Checks of a Cortex-M4F: what exceptions, faults and the memory protection unit do, told by one line a step.
//!
//! The lines hold a model of the core to another, which executes the same code. Each step pends, masks or breaks
//! something; handlers tell on its line when they begin (`>15`) and end (`<15`), by the number of their exception,
//! and do what the step has set for them. Numbers are hexadecimal.
#![no_std]
#![expect(unsafe_code, reason = "handlers, assembly, registers of the core")]

mod assembly;
mod faults;
mod floats;
mod handlers;
mod interrupts;
mod line;
mod protection;
mod returns;
mod stacks;
mod waits;

/// Does all steps and hands over the line of each. The last one locks the core up.
pub fn run(mut show: impl FnMut(&str)) -> ! {
    let steps = [
        interrupts::STEPS,
        floats::STEPS,
        stacks::STEPS,
        waits::STEPS,
        faults::STEPS,
        protection::STEPS,
        returns::STEPS,
    ];
    for (name, step) in steps.into_iter().flatten() {
        line::begin(name);
        step();
        handlers::forget();
        show(line::text());
    }
    show("end");
    faults::lock_up()
}

/// A step: its name, and what it does.
type Step = (&'static str, fn());
