//! The stack: what guards it, and how deep it has been.
//!
//! It grows down to the beginning of RAM (`memory.x`). Below lies the memory of the controller's own boot loader; the
//! memory protection unit forbids it, so that no frame, however large, steps over the end unseen. The start paints the
//! stack; the lowest word that has another value shows how deep it has been.

#![expect(unsafe_code, reason = "reads and guards the stack")]

use core::ptr::{read_volatile, with_exposed_provenance};

use cortex_m::asm;
use cortex_m::peripheral::MPU;
use cortex_m_rt::STACK_PAINT_VALUE;
use embassy_time::{Duration, Timer};

/// Time between two looks at the stack.
const PERIOD: Duration = Duration::from_secs(60);
/// Bytes of a piece of the stack that is looked at in one go.
const PIECE: usize = 4096;
/// Time between two pieces.
const PAUSE: Duration = Duration::from_millis(1);
/// Size of a word, bytes.
const WORD: usize = size_of::<u32>();
/// The guard: 64 KiB up to the beginning of RAM, as base address and as attributes (ARMv7-M Architecture Reference
/// Manual, B3.5): valid, region 0; no execution, no access, 2^(15 + 1) bytes, on.
const GUARD: [u32; 2] = [0x1FFF_0000 | 1 << 4, 1 << 28 | 15 << 1 | 1];
/// The 32 bytes within it that have the unique number of the controller (RM0351, 49.1): valid, region 1, which goes before
/// region 0; no execution, reads alone, 2^(4 + 1) bytes, on.
const IDENTITY: [u32; 2] = [0x1FFF_7580 | 1 << 4 | 1, 1 << 28 | 5 << 24 | 4 << 1 | 1];
/// The unit is on, with the default map for what no region has; faults themselves are handled without it.
const ON: u32 = 1 << 2 | 1;

/// Symbols of the linker's script. Only their addresses have a meaning.
mod symbols {
    // SAFETY: `memory.x` defines both, and nothing reads a value through them.
    unsafe extern "C" {
        pub safe static _stack_start: u32;
        pub safe static _stack_end: u32;
    }
}

/// Forbids the memory below the stack, but for reads of the controller's number.
pub fn guard() {
    // SAFETY: nothing uses that memory, and the rest keeps its default map.
    unsafe {
        let unit = &*MPU::PTR;
        for [base, attributes] in [GUARD, IDENTITY] {
            unit.rbar.write(base);
            unit.rasr.write(attributes);
        }
        unit.ctrl.write(ON);
    }
    asm::dsb();
    asm::isb();
}

/// Logs how deep the stack has been, once a minute where it has become deeper. It looks from the end upwards, in pieces of
/// some hundred microseconds.
#[embassy_executor::task]
pub async fn watch() -> ! {
    let [start, end] = [&symbols::_stack_start, &symbols::_stack_end]
        .map(|symbol| (&raw const *symbol).expose_provenance());
    let mut known = start;
    loop {
        Timer::after(PERIOD).await;
        let mut place = end;
        while place < known && is_painted(place) {
            place += WORD;
            if place.is_multiple_of(PIECE) {
                Timer::after(PAUSE).await;
            }
        }
        if place < known {
            known = place;
            defmt::info!("board: stack {} bytes deep, of {}", start - place, start - end);
        }
    }
}

/// Whether a word of the stack is as the start has painted it.
fn is_painted(place: usize) -> bool {
    // SAFETY: an aligned word of the stack, as the caller has it; any value will do.
    unsafe { read_volatile(with_exposed_provenance::<u32>(place)) == STACK_PAINT_VALUE }
}
