//! The checks for QEMU: lines go to the host by semihosting.
#![no_std]
#![no_main]

use core::panic::PanicInfo;

use cortex_m_rt::entry;
use cortex_m_semihosting::hprintln;

#[entry]
fn main() -> ! {
    core_checks::run(|line| hprintln!("{line}"))
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    hprintln!("{info}");
    cortex_m::asm::udf()
}
