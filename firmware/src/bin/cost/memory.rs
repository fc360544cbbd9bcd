//! How much flash and static memory this image takes, as its linker says.

#![expect(unsafe_code, reason = "reads the linker's symbols")]

/// Places that cortex-m-rt's `link.x` names; only their addresses mean something.
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

/// The address of a symbol.
fn address(symbol: &'static u32) -> usize {
    (&raw const *symbol).expose_provenance()
}

/// Bytes of flash: vectors, code, constants, and the first values of variables.
pub fn flash() -> usize {
    let variables = address(&symbols::__edata) - address(&symbols::__sdata);
    address(&symbols::__sidata) - address(&symbols::__vector_table) + variables
}

/// Bytes of static memory.
pub fn statics() -> usize {
    address(&symbols::__ebss) - address(&symbols::__sdata)
}
