//! The end of a run: panics, faults of the core, exceptions that nothing handles. Each switches the motors off, writes
//! what is known into memory that outlasts the reset (`firmware::postmortem`), and resets at once.

#![expect(unsafe_code, reason = "handles faults, on a stack of its own")]

use core::arch::naked_asm;
use core::fmt::Write;
use core::ops::Range;
use core::panic::PanicInfo;
use core::ptr::{read_volatile, with_exposed_provenance};
use core::sync::atomic::AtomicU32;

use cortex_m::peripheral::SCB;
use cortex_m::register::msp;
use cortex_m_rt::exception;
use embassy_stm32::pac::gpio::vals::Moder;
use embassy_stm32::pac::{GPIOD, RCC};
use firmware::postmortem::{End, Outlasting, Record, Registers};

/// What outlasts a reset.
// SAFETY: the section is one of RAM that the start leaves alone (`memory.x`); any bits are valid for the atomics in it.
#[unsafe(link_section = ".outlasting.run")]
pub static RUN: Outlasting = Outlasting::new();

/// Where RAM begins and ends (RM0351, 2.2.2, SRAM1).
const RAM: Range<usize> = 0x2000_0000..0x2001_8000;
/// Registers that the core stacks at an exception: r0 to r3, r12, LR, PC, PSR.
const STACKED: usize = 8;

/// A stack on which a fault is handled: that of the program may have left its memory.
#[repr(align(8))]
#[expect(dead_code, reason = "only the stack pointer refers to it")]
struct FaultStack([AtomicU32; 512]);

/// That stack.
// SAFETY: as of `RUN`; nothing but the stack pointer refers to it.
#[unsafe(link_section = ".outlasting.stack")]
static STACK: FaultStack = FaultStack([const { AtomicU32::new(0) }; 512]);

/// Symbols of the linker's script. Only their addresses have a meaning.
mod symbols {
    // SAFETY: cortex-m-rt's `link.x` defines both, and nothing reads a value through them.
    unsafe extern "C" {
        pub safe static __stext: u32;
        pub safe static __etext: u32;
    }
}

/// Ends the run as this record has it: motors off, then the record, with the return addresses on the stack from an
/// address on.
fn end(stack: usize, mut record: Record) -> ! {
    cortex_m::interrupt::disable();
    switch_motors_off();
    if let Some(Record { resets, is_crystal_dead, .. }) = RUN.record() {
        (record.resets, record.is_crystal_dead) = (resets, is_crystal_dead);
    }
    for (caller, found) in record.callers.iter_mut().zip(callers(stack)) {
        *caller = found;
    }
    RUN.note(&record);
    SCB::sys_reset()
}

/// Words of the stack that may be return addresses: addresses in code, of Thumb instructions.
fn callers(stack: usize) -> impl Iterator<Item = u32> {
    let code =
        [&symbols::__stext, &symbols::__etext].map(|symbol| (&raw const *symbol).addr() as u32);
    let words = if RAM.contains(&stack) { stack.next_multiple_of(4)..RAM.end } else { 0..0 };
    // SAFETY: aligned words of RAM; the program that wrote them does not go on.
    let words = words
        .step_by(4)
        .map(|place| unsafe { read_volatile(with_exposed_provenance::<u32>(place)) });
    words.filter(move |word| word & 1 == 1 && (code[0]..code[1]).contains(word))
}

/// Takes the motors their current: `DRV_ENN` high. It stays high after the reset that follows, by the drivers' own pull-up,
/// until the next start has brought their ramps to rest.
fn switch_motors_off() {
    RCC.ahb2enr().modify(|enabled| enabled.set_gpioden(true));
    GPIOD.bsrr().write(|pins| pins.set_bs(2, true));
    GPIOD.moder().modify(|modes| modes.set_moder(2, Moder::OUTPUT));
}

#[panic_handler]
fn panic(panic: &PanicInfo) -> ! {
    // Before anything else: a second panic in the words of this one would come here again.
    cortex_m::interrupt::disable();
    switch_motors_off();
    let mut record = Record { end: End::Panic, ..Record::default() };
    if let Some(place) = panic.location() {
        let (file, line) = (place.file(), place.line());
        // It takes what fits, and never fails.
        let _ = write!(record.text, "{file}:{line}: {}", panic.message());
    }
    end(msp::read() as usize, record)
}

// The words are in the log already.
#[defmt::panic_handler]
fn panicked() -> ! {
    end(msp::read() as usize, Record { end: End::Panic, ..Record::default() })
}

/// Ends the run by a fault with these registers.
pub fn fault(registers: Registers) -> ! {
    end(registers.sp as usize, Record { end: End::Fault, registers, ..Record::default() })
}

/// Registers at a fault whose stacked ones begin at an address, where that is in RAM.
pub fn registers(stacked: usize) -> Registers {
    // SAFETY: reads of registers without side effects.
    let scb = unsafe { &*SCB::PTR };
    let is_there = stacked.is_multiple_of(4)
        && (RAM.start..=RAM.end - size_of::<[u32; STACKED]>()).contains(&stacked);
    let [_, _, _, _, _, lr, pc, psr] = if is_there {
        // SAFETY: aligned words of RAM; the program that wrote them does not go on.
        unsafe { read_volatile(with_exposed_provenance::<[u32; STACKED]>(stacked)) }
    } else {
        [0; STACKED]
    };
    Registers {
        pc,
        lr,
        psr,
        sp: stacked as u32,
        cfsr: scb.cfsr.read(),
        hfsr: scb.hfsr.read(),
        mmfar: scb.mmfar.read(),
        bfar: scb.bfar.read(),
    }
}

/// The handler of hard faults, to which all others escalate: has the rest handled on a stack of its own.
///
/// # Safety
/// The core alone enters it.
#[unsafe(naked)]
#[unsafe(no_mangle)]
unsafe extern "C" fn HardFault() -> ! {
    naked_asm!(
        "mrs r0, msp",
        "ldr r1, ={stack}",
        "add r1, r1, {bytes}",
        "msr msp, r1",
        "b {handler}",
        stack = sym STACK,
        bytes = const size_of::<FaultStack>(),
        handler = sym hard_fault,
    )
}

/// Ends the run by a hard fault.
extern "C" fn hard_fault(stacked: usize) -> ! {
    fault(registers(stacked))
}

/// Ends the run by an exception of this number that nothing handles.
pub fn unhandled(number: u32) -> ! {
    end(msp::read() as usize, Record { end: End::Unhandled, number, ..Record::default() })
}

/// An exception or an interrupt that nothing handles.
#[exception]
unsafe fn DefaultHandler(number: i16) -> ! {
    unhandled(number.unsigned_abs().into())
}
