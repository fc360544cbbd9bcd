//! Flash and static memory of this image, from its linker symbols.

#![expect(unsafe_code, reason = "reads the linker's symbols")]

use measure::stack::address;

/// Symbols of cortex-m-rt's `link.x`, of which only the addresses are meaningful.
mod symbols {
    // SAFETY: the script defines every one of them, and nothing reads a value through them.
    unsafe extern "C" {
        pub safe static __sidata: u32;
        pub safe static __sdata: u32;
        pub safe static __edata: u32;
        pub safe static __ebss: u32;
        pub safe static __vector_table: u32;
    }
}

/// Size of the flash contents, bytes: vectors, code, constants, and initial values of variables.
pub fn flash() -> usize {
    let variables = address(&symbols::__edata) - address(&symbols::__sdata);
    address(&symbols::__sidata) - address(&symbols::__vector_table) + variables
}

/// Size of the static memory, bytes.
pub fn statics() -> usize {
    address(&symbols::__ebss) - address(&symbols::__sdata)
}
