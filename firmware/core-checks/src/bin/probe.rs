//! The checks for the board and its model: a probe takes the lines out of RAM.
#![no_std]
#![no_main]

use core::panic::PanicInfo;

use cortex_m_rt::entry;
use defmt_rtt as _;

#[entry]
fn main() -> ! {
    core_checks::run(|line| defmt::println!("{=str}", line))
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    defmt::println!("panicked: {}", defmt::Display2Format(info));
    cortex_m::asm::udf()
}
