//! Lines of its log that a board has kept in flash, by a dump of those pages and the ELF file of its image, which has the
//! words.

use std::fmt;

use defmt_decoder::Table;
use firmware::kept_lines::IMAGE;
use firmware::storage::{CONTENT, records};
use object::read::elf::ElfFile32;
use object::{Object, ObjectSection};
use serde::Serialize;

/// A line that was kept.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Line {
    /// Number of its last record, of all that the board has ever written.
    pub record: u32,
    /// Time since its start, s, as the board states it.
    pub seconds: String,
    /// Level; none where there is no line.
    pub level: Option<&'static str>,
    /// Words of the line, or why there are none.
    pub words: String,
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { seconds, level, words, .. } = self;
        write!(f, "{seconds:>12} {:<5} {words}", level.unwrap_or("-"))
    }
}

/// What one record after the other has of a line.
struct Piece {
    /// Number of its last record.
    record: u32,
    /// Identity of its image.
    image: [u8; IMAGE],
    /// What the log has sent, without the zero at its end.
    bytes: Vec<u8>,
    /// Whether that zero was there.
    is_whole: bool,
}

/// The lines in pages that were read from a board's flash, in the order of time, by the words of an image.
///
/// # Errors
/// Where the file is no image of a board with a log.
pub fn lines(elf: &[u8], pages: &[u8]) -> Result<Vec<Line>, String> {
    lines_of(elf, records(pages).map(|(record, content)| (record, *content)).collect())
}

/// The lines in records with their numbers, in the order of time, by the words of an image.
///
/// # Errors
/// As [`lines`].
pub fn lines_of(elf: &[u8], records: Vec<(u32, [u8; CONTENT])>) -> Result<Vec<Line>, String> {
    let table = match Table::parse(elf) {
        Ok(Some(table)) => table,
        Ok(None) => return Err("the image has no strings of a log".to_owned()),
        Err(error) => return Err(format!("the image's strings cannot be read: {error:#}")),
    };
    let image = identity(elf)?;
    Ok(pieces(records).iter().map(|piece| read(piece, image, &table)).collect())
}

/// The identity of an image: the first bytes of the hash in the linker's note (`--build-id`).
fn identity(elf: &[u8]) -> Result<[u8; IMAGE], String> {
    let file: ElfFile32 = ElfFile32::parse(elf).map_err(|error| format!("no image: {error}"))?;
    let note = file.section_by_name(".build_id").and_then(|section| section.data().ok());
    let hash = note.and_then(|note| note.get(16..)?.first_chunk().copied());
    hash.ok_or_else(|| "no image of a board: it states no identity".to_owned())
}

/// What these records have, put together in the order of their numbers.
fn pieces(mut found: Vec<(u32, [u8; CONTENT])>) -> Vec<Piece> {
    found.sort_by_key(|(record, _)| *record);
    let mut pieces: Vec<Piece> = Vec::new();
    for (record, content) in found {
        let Some((&image, sent)) = content.split_first_chunk() else { continue };
        let begun = pieces
            .pop_if(|piece| !piece.is_whole && piece.image == image && piece.record + 1 == record);
        let mut bytes = begun.map_or_else(Vec::new, |piece| piece.bytes);
        // The very first line has a zero before it, too.
        let is_first = bytes.is_empty();
        bytes.extend(sent.iter().skip_while(|byte| is_first && **byte == 0));
        let end = bytes.iter().position(|byte| *byte == 0);
        bytes.truncate(end.unwrap_or(bytes.len()));
        pieces.push(Piece { record, image, bytes, is_whole: end.is_some() });
    }
    pieces
}

/// The line of a piece.
#[expect(clippy::redundant_closure_for_method_calls, reason = "the method's type has no name here")]
fn read(piece: &Piece, image: [u8; IMAGE], table: &Table) -> Line {
    let without = |words: &str| Line {
        record: piece.record,
        seconds: String::new(),
        level: None,
        words: words.to_owned(),
    };
    if piece.image != image {
        return without("(a line of another image)");
    }
    let mut decoder = table.new_stream_decoder();
    decoder.received(&piece.bytes);
    decoder.received(&[0]);
    match decoder.decode() {
        Ok(frame) if piece.is_whole => Line {
            seconds: frame.display_timestamp().map(|time| time.to_string()).unwrap_or_default(),
            level: frame.level().map(|level| level.as_str()),
            ..without(&frame.display_message().to_string())
        },
        _ => without("(a part of a line)"),
    }
}
