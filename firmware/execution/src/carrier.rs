//! The carrier of an image, which states it by a symbol of the linker (`build.rs` of the board): it takes no memory.

use firmware::platform::Platform;
use object::read::elf::ElfFile32;
use object::{Object, ObjectSymbol};

/// How the symbol begins; the name of the carrier follows, with `_` where it has a hyphen. Other features have such a
/// symbol, too.
const SYMBOL: &str = "_carrier_";

/// The carrier that an image was built for; none where it states none.
///
/// # Errors
/// Where this is no 32-bit ELF file.
pub fn stated(elf: &[u8]) -> Result<Option<Platform>, String> {
    let file: ElfFile32 = ElfFile32::parse(elf).map_err(|error| format!("no image: {error}"))?;
    let mut features = file.symbols().filter_map(|symbol| symbol.name().ok()?.strip_prefix(SYMBOL));
    Ok(features.find_map(|feature| {
        let name = feature.replace('_', "-");
        Platform::ALL.into_iter().find(|carrier| name == carrier.name())
    }))
}

/// Makes sure that an image was built for a carrier.
///
/// # Errors
/// Which carrier it was built for instead, or that it states none.
pub fn require(elf: &[u8], carrier: Platform) -> Result<(), String> {
    match stated(elf)? {
        Some(stated) if stated == carrier => Ok(()),
        Some(stated) => {
            Err(format!("the image was built for the carrier {stated}, not for {carrier}"))
        }
        None => Err(format!("no image of a board for the carrier {carrier}: it states no carrier")),
    }
}
