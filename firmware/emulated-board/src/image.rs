//! The image that is flashed: its bytes, its symbols and its lines, as its ELF file has them.

use std::path::Path;

use addr2line::Loader;
use object::read::elf::ElfFile32;
use object::{Object, ObjectSection, ObjectSegment, ObjectSymbol, SymbolKind};

/// An image for the microcontroller.
pub struct Image {
    /// Bytes of the flash from its beginning.
    pub flash: Vec<u8>,
    /// Lowest address of the stack.
    pub stack_end: u32,
    /// First address above the stack, which grows down from it.
    pub stack_start: u32,
    /// Address of the control block of the real-time transfer, in which the log waits for a probe.
    pub log: u32,
    /// Bytes of RAM that the statics take.
    pub static_bytes: u32,
    /// The ELF file itself, of which the log's strings are read.
    pub elf: Vec<u8>,
    /// Functions and lines of the sources by address.
    sources: Loader,
}

impl Image {
    /// Reads an ELF file.
    ///
    /// # Errors
    /// The file, and why it is no image of this controller: no ELF file, without a segment in flash, or without the
    /// symbols of cortex-m-rt's stack and of the log's buffer.
    pub fn read(path: &Path) -> Result<Self, String> {
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let elf = std::fs::read(path).map_err(|error| named(&error))?;
        let sources = Loader::new(path).map_err(|error| named(&error))?;
        Self::of(elf, sources).map_err(|error| named(&error))
    }

    /// The image in an ELF file, beside the places of its sources.
    fn of(elf: Vec<u8>, sources: Loader) -> Result<Self, String> {
        let file: ElfFile32 =
            ElfFile32::parse(&*elf).map_err(|error| format!("no image: {error}"))?;
        let symbol = |name: &str| {
            let found = file.symbols().find(|symbol| symbol.name() == Ok(name));
            found.map(|symbol| symbol.address() as u32).ok_or_else(|| format!("no symbol {name}"))
        };
        let (stack_start, stack_end) = (symbol("_stack_start")?, symbol("_stack_end")?);
        let in_ram = |section: &object::read::elf::ElfSection32| section.address() >= 0x2000_0000;
        let takes = |section: &object::read::elf::ElfSection32| matches!(section.flags(), object::SectionFlags::Elf { sh_flags } if sh_flags & 2 != 0);
        let statics = file.sections().filter(|section| in_ram(section) && takes(section));
        Ok(Self {
            flash: flash(&file)?,
            stack_start,
            stack_end,
            log: symbol("_SEGGER_RTT")?,
            static_bytes: statics.map(|section| section.size() as u32).sum(),
            elf,
            sources,
        })
    }

    /// The function at an address, and the file and line where its code comes from: of functions that were put into each
    /// other the innermost one that is not of Rust's own library.
    #[must_use]
    pub fn place(&self, address: u32) -> String {
        let function = self.function(address).unwrap_or_else(|| "no function".to_owned());
        let mut line = None;
        if let Ok(mut frames) = self.sources.find_frames(address.into()) {
            while line.is_none()
                && let Ok(Some(frame)) = frames.next()
            {
                let place = frame.location.and_then(|line| Some((line.file?, line.line?)));
                line = place.filter(|(file, _)| !file.starts_with("/rustc/"));
            }
        }
        match line {
            Some((file, line)) => format!("{function} ({file}:{line})"),
            None => format!("{function} ({address:#010x})"),
        }
    }

    /// The files of the sources from which the instruction at an address comes: that of the innermost function, then
    /// those of the functions that it was put into.
    #[must_use]
    pub fn files(&self, address: u32) -> Vec<String> {
        let mut files = Vec::new();
        if let Ok(mut frames) = self.sources.find_frames(address.into()) {
            while let Ok(Some(frame)) = frames.next() {
                files.extend(frame.location.and_then(|line| line.file).map(str::to_owned));
            }
        }
        files
    }

    /// The address of a function whose name in the source contains this.
    #[must_use]
    pub fn address_of(&self, part: &str) -> Option<u32> {
        let file: ElfFile32 = ElfFile32::parse(&*self.elf).ok()?;
        let named = |symbol: &object::read::elf::ElfSymbol32| {
            let name = symbol.name().unwrap_or_default();
            addr2line::demangle_auto(name.into(), None).contains(part)
        };
        let found =
            file.symbols().find(|symbol| symbol.kind() == SymbolKind::Text && named(symbol));
        found.map(|symbol| symbol.address() as u32 & !1)
    }

    /// The function at an address, by its name in the source.
    #[must_use]
    pub fn function(&self, address: u32) -> Option<String> {
        let name = self.sources.find_symbol(address.into())?;
        Some(addr2line::demangle_auto(name.into(), None).into_owned())
    }
}

/// What a programmer writes into the flash.
fn flash(file: &ElfFile32) -> Result<Vec<u8>, String> {
    let mut flash = Vec::new();
    for segment in file.segments() {
        let bytes = segment.data().map_err(|error| format!("a segment: {error}"))?;
        let load = segment.elf_program_header().p_paddr.get(file.endian());
        let Some(start) = load.checked_sub(crate::FLASH).filter(|_| !bytes.is_empty()) else {
            continue;
        };
        let start = start as usize;
        let end = start + bytes.len();
        if end > crate::FLASH_BYTES {
            return Err(format!("the image ends {end} bytes behind the beginning of the flash"));
        }
        flash.resize(flash.len().max(end), 0xFF);
        flash[start..end].copy_from_slice(bytes);
    }
    if flash.is_empty() {
        Err("no segment of the image lies in flash".to_owned())
    } else {
        Ok(flash)
    }
}
