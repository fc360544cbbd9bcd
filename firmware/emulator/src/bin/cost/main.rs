//! Counts the instructions of the pure cores on an emulated Cortex-M4F and holds them to budgets.
//!
//! `cargo cost` builds this image at the board's own addresses and runs it in QEMU, where the core's
//! timer counts executed instructions. **Instructions are not cycles**: on the board a load or a taken
//! branch takes more than one, flash has wait states, and a count here is a lower bound there. The
//! figures repeat exactly, so that a change in them is a change of the code.
//!
//! The exit status is 0 only if the counter is right and all budgets are kept.
#![no_std]
#![no_main]

mod conclusion;
mod keep;
mod matching;
mod memory;
mod noise;
mod planning;
mod report;
mod samples;
mod scale;
mod stops;
mod turning;
mod yardsticks;

use core::panic::PanicInfo;

use cortex_m::asm::wfi;
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hprintln};
use measure::counter::Counter;
use measure::stack;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::etalon::series::SeriesError;
use orientation::alignment::{self, rotating, stepwise};
use orientation::attitude::Keeper;
use orientation::filter::DesignError;
use orientation::noise::allan::Allan;
use orientation::roll::Spin;

use report::{Report, figure, heading};

/// Reason for which nothing was measured.
#[derive(Debug)]
#[expect(dead_code, reason = "the content is printed")]
enum Failure {
    /// The core's peripherals were taken before.
    NoTimer,
    /// A filter could not be designed.
    Filter(DesignError),
    /// A series could not be matched.
    Series(SeriesError),
}

#[entry]
fn main() -> ! {
    let mut report = Report::default();
    if let Err(failure) = measure(&mut report) {
        hprintln!("{failure:?}");
        report.require("everything was measured", false);
    }
    report.end()
}

/// Measures all cases, in the order of the data path.
fn measure(report: &mut Report) -> Result<(), Failure> {
    let peripherals = cortex_m::Peripherals::take().ok_or(Failure::NoTimer)?;
    let counter = Counter::start(peripherals.SYST);
    check_scale(&counter, report);
    heading("INSTRUCTIONS (not cycles) on a Cortex-M4F");
    samples::report(&counter, report).map_err(Failure::Filter)?;
    turning::report(&counter, report);
    stops::report(&counter, report);
    keep::report(&counter, report);
    matching::report(&counter, report).map_err(Failure::Series)?;
    yardsticks::regression(&counter, report);
    conclusion::report(&counter, report).map_err(Failure::Filter)?;
    noise::report(&counter, report);
    planning::report(&counter, report);
    heading("bytes");
    sizes()
}

/// Shows that the counter counts instructions, also beyond its 24 bits.
fn check_scale(counter: &Counter, report: &mut Report) {
    heading("checks, instructions");
    let mut check = |name, work: fn(), known| {
        report.check(name, counter.measure(work).0.instructions(), known);
    };
    check("a thousand instructions in a row", scale::thousand, scale::THOUSAND);
    check("a loop of ten million", scale::long_loop, scale::LONG_LOOP);
}

/// Stack, static sizes and flash.
fn sizes() -> Result<(), Failure> {
    matching::report_stack().map_err(Failure::Series)?;
    let stack_of_conclusion = conclusion::stack().map_err(Failure::Filter)?;
    for (name, bytes) in [
        ("stack of a conclusion of 60 dwells", stack_of_conclusion),
        ("stack of a noise fit of the full grid", noise::stack()),
        ("stack of a plan", planning::stack()),
        ("stack of a conclusion of two stops", stops::stack()),
        ("stack of this image at its deepest", stack::greatest_stack()),
        ("a Session", size_of::<stepwise::Session>()),
        ("a Session on a turning platform", size_of::<rotating::Session>()),
        ("a Session from stops", size_of::<alignment::stops::Session>()),
        ("a Keeper", size_of::<Keeper>()),
        ("a Spin", size_of::<Spin>()),
        ("a Conclusion", size_of::<Conclusion>()),
        ("an Allan variance", size_of::<Allan>()),
        ("static memory of this image", memory::statics()),
        ("flash of this image, its measuring and the etalon table included", memory::flash()),
    ] {
        figure(name, bytes as u64);
    }
    Ok(())
}

/// Prints the panic and ends the emulator with an error.
#[panic_handler]
fn panic(information: &PanicInfo) -> ! {
    hprintln!("{information}");
    debug::exit(debug::EXIT_FAILURE);
    loop {
        wfi();
    }
}
