//! Registers of the core: what is written there and not modelled ends the execution.

use emulated_board::controller::Refused;
use emulated_board::controller::system::System;
use emulated_board::exceptions::Exceptions;

/// What becomes of a word that is written at a distance from 0xE000 E000.
fn write(offset: u32, value: u32) -> Result<(), Refused> {
    System::new().write(offset, value, 4, &mut Exceptions::default())
}

#[test]
fn what_the_model_does_not_have_is_refused_and_what_it_has_is_taken() {
    // Register; a value that is taken, and values that are not: one function each.
    let table: [(&str, u32, u32, &[u32]); 10] = [
        ("VTOR", 0xD08, 0x0800_0400, &[0x400, 0x4000_0000]),
        ("AIRCR", 0xD0C, 0x05FA_0004, &[0x05FA_0001, 0x05FA_0002, 0x05FA_0500, 4]),
        ("SCR", 0xD10, 1 << 4, &[1 << 1, 1 << 2]),
        ("CCR", 0xD14, 0x201, &[0x202, 0x208, 0x210, 0x300, 0]),
        ("SHCSR", 0xD24, 7 << 16, &[1 << 0, 1 << 7, 1 << 15]),
        ("CPACR", 0xD88, 0xF << 20, &[0, 5 << 20]),
        ("DEMCR", 0xDFC, 1 << 24, &[1 << 16, 1 << 10]),
        ("FPCCR", 0xF34, 0x8000_0000, &[0x4000_0000, 0xC000_0001]),
        ("FPDSCR", 0xF3C, 0, &[1 << 24]),
        ("SYST_CSR", 0x010, 0, &[1]),
    ];
    for (name, offset, taken, refused) in table {
        assert_eq!(write(offset, taken), Ok(()), "{name} {taken:#x}");
        for value in refused {
            assert!(write(offset, *value).is_err(), "{name} {value:#x}");
        }
    }
    // Where floating-point registers would be stacked later, of which none is; the cycle counter is elsewhere.
    assert!(write(0xF38, 0).is_err());
}
