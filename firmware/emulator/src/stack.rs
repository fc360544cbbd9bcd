//! Measures the stack that a piece of work uses: paints the unused stack with a pattern, runs the
//! work, and looks for the lowest word that has changed.

#![expect(unsafe_code, reason = "reads the linker's symbols and the stack's unused memory")]

use core::ptr::{
    read_volatile, with_exposed_provenance, with_exposed_provenance_mut, write_volatile,
};
use core::sync::atomic::{AtomicUsize, Ordering};

use cortex_m::register::msp;

/// The pattern that marks unused stack.
const PAINT: u32 = 0xC0DE_FACE;
/// Size of a word, bytes.
const WORD: usize = size_of::<u32>();

/// Distance from the stack pointer below which the stack is not painted, bytes: the painting
/// function itself may save registers there after it has read the pointer. A smaller use of stack
/// is reported as this value.
const MARGIN: usize = 128;

/// Lowest address of the stack in use so far.
static LOWEST: AtomicUsize = AtomicUsize::new(usize::MAX);

/// Symbols of cortex-m-rt's `link.x`. Only their addresses have a meaning.
mod symbols {
    // SAFETY: the script defines every one of them, and nothing reads a value through them.
    unsafe extern "C" {
        pub safe static _stack_start: u32;
        pub safe static _stack_end: u32;
    }
}

/// The address of a symbol.
#[must_use]
pub fn address(symbol: &'static u32) -> usize {
    (&raw const *symbol).expose_provenance()
}

/// Runs the work and returns the bytes of stack below the caller that it used, and its result.
#[inline(never)]
pub fn stack_of<T>(work: impl FnOnce() -> T) -> (usize, T) {
    paint();
    let top = msp::read() as usize;
    let result = work();
    (top - lowest(), result)
}

/// Bytes of stack at the deepest point that any [`stack_of`] has seen, counted from the stack's
/// start.
#[must_use]
pub fn greatest_stack() -> usize {
    address(&symbols::_stack_start) - LOWEST.load(Ordering::Relaxed)
}

/// Fills the unused stack below this call with the pattern.
#[inline(never)]
fn paint() {
    let top = msp::read() as usize - MARGIN;
    for place in (address(&symbols::_stack_end)..top).step_by(WORD) {
        // SAFETY: an aligned word of RAM above the statics and below all frames, this function's
        // included (`MARGIN`): no variable lies there. An exception may use it meanwhile, but needs
        // nothing there once it has returned.
        unsafe { write_volatile(with_exposed_provenance_mut(place), PAINT) }
    }
}

/// The lowest address whose pattern has changed.
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
