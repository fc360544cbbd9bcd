//! The buffer in which defmt-rtt has the log wait for a probe, read as a probe does.

use core::ptr::{read_volatile, with_exposed_provenance};
use core::sync::atomic::{AtomicU32, Ordering};

use stm32::log::Buffer;

/// The buffer.
pub const BUFFER: Buffer = Buffer { end, copy };

/// Symbols of the linker.
mod symbols {
    use super::AtomicU32;

    #[expect(unsafe_code, reason = "what another crate defines is declared")]
    // SAFETY: defmt-rtt defines it; it is words alone, in the form that probes expect (SEGGER, "RTT control block"): mark,
    // numbers of channels, then of the first its name, buffer, size, and where the target writes and the host reads next.
    unsafe extern "C" {
        pub(super) safe static _SEGGER_RTT: [AtomicU32; 11];
    }
}

/// Where the next byte of the log goes.
fn end() -> u32 {
    let [.., write, _] = &symbols::_SEGGER_RTT;
    write.load(Ordering::Relaxed)
}

/// Copies the log from a place up to its end, as far as there is room; where it goes on.
fn copy(mut from: u32, to: &mut [u8]) -> u32 {
    let [.., buffer, size, _, _] = &symbols::_SEGGER_RTT;
    let [buffer, size] = [buffer, size].map(|word| word.load(Ordering::Relaxed));
    for byte in to {
        if from == end() {
            break;
        }
        #[expect(unsafe_code, reason = "the buffer is reached by its address alone")]
        // SAFETY: a byte of the buffer, which is a static.
        let read = unsafe { read_volatile(with_exposed_provenance((buffer + from) as usize)) };
        *byte = read;
        from = if from + 1 < size { from + 1 } else { 0 };
    }
    from
}
