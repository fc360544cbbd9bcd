//! How much stack a piece of work uses.

#![expect(unsafe_code, reason = "reads the linker's symbols and the stack's unused memory")]

use core::ptr::{
    read_volatile, with_exposed_provenance, with_exposed_provenance_mut, write_volatile,
};
use core::sync::atomic::{AtomicUsize, Ordering};

use cortex_m::register::msp;

/// What unused stack holds.
const PAINT: u32 = 0xC0DE_FACE;
/// Bytes of a word.
const WORD: usize = size_of::<u32>();

/// Bytes next to the stack pointer that are not painted: the painter itself may save registers
/// there after it has read the pointer. Uses of stack smaller than this show as this.
const MARGIN: usize = 128;

/// Lowest address of the stack that was in use so far.
static LOWEST: AtomicUsize = AtomicUsize::new(usize::MAX);

/// Places that cortex-m-rt's `link.x` names; only their addresses mean something.
mod symbols {
    // SAFETY: the script defines every one of them, and nothing reads a value through them.
    unsafe extern "C" {
        pub safe static _stack_start: u32;
        pub safe static _stack_end: u32;
    }
}

/// The address of a symbol.
fn address(symbol: &'static u32) -> usize {
    (&raw const *symbol).expose_provenance()
}

/// Does the work and tells how many bytes of stack it took below its caller.
#[inline(never)]
pub fn stack_of<T>(work: impl FnOnce() -> T) -> (usize, T) {
    paint();
    let top = msp::read() as usize;
    let result = work();
    (top - lowest(), result)
}

/// Bytes of stack at the deepest so far, as far as [`stack_of`] saw.
pub fn greatest_stack() -> usize {
    address(&symbols::_stack_start) - LOWEST.load(Ordering::Relaxed)
}

/// Fills the stack below this call.
#[inline(never)]
fn paint() {
    let top = msp::read() as usize - MARGIN;
    for place in (address(&symbols::_stack_end)..top).step_by(WORD) {
        // SAFETY: an aligned word of RAM above the statics and below all frames, this function's
        // included (`MARGIN`): nobody's variable. An exception may use it meanwhile, but needs
        // nothing there once it has returned.
        unsafe { write_volatile(with_exposed_provenance_mut(place), PAINT) }
    }
}

/// The lowest address that lost its paint.
#[inline(never)]
fn lowest() -> usize {
    let mut place = address(&symbols::_stack_end);
    // SAFETY: as in `paint`, and the walk ends at the first word in use, below the stack's start.
    while unsafe { read_volatile(with_exposed_provenance::<u32>(place)) } == PAINT {
        place += WORD;
    }
    LOWEST.fetch_min(place, Ordering::Relaxed);
    place
}
