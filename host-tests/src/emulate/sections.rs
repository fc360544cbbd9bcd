//! Where an image's memory goes, read from its ELF file.

use object::read::elf::ElfFile32;
use object::{Object, ObjectSection, ObjectSymbol, SectionFlags, SectionKind, elf};
use serde::Serialize;

/// Where RAM begins on a Cortex-M (ARMv7-M Architecture Reference Manual, B3.1); flash lies below.
const RAM: u64 = 0x2000_0000;

/// Where `memory.x` puts the simulated chips and world.
const SIMULATION: &str = ".simulation";

/// A section that takes memory.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Section {
    /// Name of the section.
    pub name: String,
    /// Bytes of flash.
    pub flash_bytes: u64,
    /// Bytes of RAM.
    pub ram_bytes: u64,
}

/// The memory of an image.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Memory {
    /// Sections of the image, in their order.
    pub sections: Vec<Section>,
    /// Bytes of RAM that the statics leave for the stack.
    pub stack_room_bytes: u64,
}

impl Memory {
    /// Reads an image.
    ///
    /// # Errors
    /// Where it is no 32-bit ELF file, or one without cortex-m-rt's stack symbols.
    pub fn of(image: &[u8]) -> Result<Self, String> {
        let file: ElfFile32 =
            ElfFile32::parse(image).map_err(|error| format!("no image: {error}"))?;
        let symbol = |name: &str| {
            let found = file.symbols().find(|symbol| symbol.name() == Ok(name));
            found.map(|symbol| symbol.address()).ok_or_else(|| format!("no symbol {name}"))
        };
        let (start, end) = (symbol("_stack_start")?, symbol("_stack_end")?);
        Ok(Self {
            sections: file.sections().filter_map(|section| taking(&section)).collect(),
            stack_room_bytes: start.saturating_sub(end),
        })
    }

    /// Bytes of flash without the simulation, which is no part of the product.
    #[must_use]
    pub fn flash_bytes(&self) -> u64 {
        let product = self.sections.iter().filter(|section| section.name != SIMULATION);
        product.map(|section| section.flash_bytes).sum()
    }

    /// Bytes of RAM, without the stack.
    #[must_use]
    pub fn ram_bytes(&self) -> u64 {
        self.sections.iter().map(|section| section.ram_bytes).sum()
    }
}

/// A section that is loaded or reserved, and not empty.
fn taking<'d>(section: &impl ObjectSection<'d>) -> Option<Section> {
    let SectionFlags::Elf { sh_flags } = section.flags() else { return None };
    if sh_flags & u64::from(elf::SHF_ALLOC) == 0 || section.size() == 0 {
        return None;
    }
    let in_ram = section.address() >= RAM;
    // What lies in RAM and has first values has them in flash.
    let in_flash = !in_ram || section.kind() != SectionKind::UninitializedData;
    let bytes = |is_there| if is_there { section.size() } else { 0 };
    Some(Section {
        name: section.name().ok()?.to_owned(),
        flash_bytes: bytes(in_flash),
        ram_bytes: bytes(in_ram),
    })
}
