//! A 32-bit ELF file written byte by byte, after the System V ABI and its ARM supplement.

/// Bits and pieces of the format: section types and flags.
pub const PROGBITS: u32 = 1;
const SYMTAB: u32 = 2;
const STRTAB: u32 = 3;
pub const NOBITS: u32 = 8;
pub const WRITE: u32 = 1;
pub const ALLOC: u32 = 2;
pub const EXECUTE: u32 = 4;

const HEADER: usize = 52;

/// A section as the file shall hold it.
#[derive(Clone, Debug)]
pub struct Section {
    pub name: &'static str,
    pub kind: u32,
    pub flags: u32,
    pub address: u32,
    pub content: Vec<u8>,
    /// Index of the section that it refers to, and its entries' size.
    link: [u32; 2],
}

impl Section {
    pub fn new(name: &'static str, kind: u32, flags: u32, address: u32, size: usize) -> Self {
        Self { name, kind, flags, address, content: vec![0; size], link: [0; 2] }
    }
}

/// A symbol: name, address, index of its section from one (0xFFF1: absolute).
pub type Symbol = (&'static str, u32, u16);
pub const ABSOLUTE: u16 = 0xFFF1;

/// The file.
pub fn elf(sections: &[Section], symbols: &[Symbol]) -> Vec<u8> {
    let mut sections = sections.to_vec();
    let (table, names) = symbol_table(symbols);
    let strings = sections.len() as u32 + 2;
    let mut add = |name, kind, content, link| {
        sections.push(Section { content, link, ..Section::new(name, kind, 0, 0, 0) });
    };
    add(".symtab", SYMTAB, table, [strings, 16]);
    add(".strtab", STRTAB, names, [0; 2]);
    add(".shstrtab", STRTAB, Vec::new(), [0; 2]);
    let mut titles = vec![0];
    let places: Vec<u32> =
        sections.iter().map(|section| append(&mut titles, section.name)).collect();
    if let Some(last) = sections.last_mut() {
        last.content = titles;
    }
    assemble(&sections, &places)
}

/// Puts a text at the end of a string table; where it begins.
fn append(table: &mut Vec<u8>, text: &str) -> u32 {
    let place = table.len() as u32;
    table.extend_from_slice(text.as_bytes());
    table.push(0);
    place
}

fn symbol_table(symbols: &[Symbol]) -> (Vec<u8>, Vec<u8>) {
    let (mut table, mut names) = (vec![0; 16], vec![0]);
    for (name, address, section) in symbols {
        words(&mut table, &[append(&mut names, name), *address, 0]);
        // Global, without type.
        table.extend_from_slice(&[0x10, 0]);
        table.extend_from_slice(&section.to_le_bytes());
    }
    (table, names)
}

fn words(bytes: &mut Vec<u8>, words: &[u32]) {
    for word in words {
        bytes.extend_from_slice(&word.to_le_bytes());
    }
}

fn halves(bytes: &mut Vec<u8>, halves: &[u16]) {
    for half in halves {
        bytes.extend_from_slice(&half.to_le_bytes());
    }
}

fn assemble(sections: &[Section], titles: &[u32]) -> Vec<u8> {
    let (mut body, mut headers) = (vec![0; HEADER], vec![0; 40]);
    for (section, title) in sections.iter().zip(titles) {
        let Section { kind, flags, address, content, link: [link, entry], .. } = section;
        let (offset, size) = (body.len() as u32, content.len() as u32);
        // The first symbol that is not local is number one.
        let information = u32::from(*kind == SYMTAB);
        words(&mut headers, &[*title, *kind, *flags, *address, offset, size]);
        words(&mut headers, &[*link, information, 4, *entry]);
        if *kind != NOBITS {
            body.extend_from_slice(content);
            body.resize(body.len().next_multiple_of(4), 0);
        }
    }
    let (offset, count) = (body.len() as u32, sections.len() as u16 + 1);
    body[..HEADER].copy_from_slice(&header(offset, count));
    body.extend_from_slice(&headers);
    body
}

fn header(section_headers: u32, count: u16) -> Vec<u8> {
    let mut bytes = vec![0x7F, b'E', b'L', b'F', 1, 1, 1];
    bytes.resize(16, 0);
    // An executable for ARM.
    halves(&mut bytes, &[2, 40]);
    words(&mut bytes, &[1, 0, 0, section_headers, 0x0500_0400]);
    halves(&mut bytes, &[HEADER as u16, 32, 0, 40, count, count - 1]);
    bytes
}
