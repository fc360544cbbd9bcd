//! Records of the log that came in parts, put together.

use std::collections::BTreeMap;

use firmware::storage::CONTENT;

use super::conversation::Part;

/// A record: its number and its content.
pub type Record = (u32, [u8; CONTENT]);

/// The whole records of these parts by their numbers, and the numbers of those that lack something.
#[must_use]
pub fn whole(parts: &[Part]) -> (Vec<Record>, Vec<u32>) {
    let mut by_record: BTreeMap<u32, BTreeMap<u32, &[u8]>> = BTreeMap::new();
    for part in parts {
        by_record.entry(part.record).or_default().insert(part.number, &part.bytes);
    }
    let (mut whole, mut lacking) = (Vec::new(), Vec::new());
    for (record, parts) in by_record {
        match content(&parts) {
            Some(content) => whole.push((record, content)),
            None => lacking.push(record),
        }
    }
    (whole, lacking)
}

/// The content of a record, where none of its parts is missing.
fn content(parts: &BTreeMap<u32, &[u8]>) -> Option<[u8; CONTENT]> {
    let are_all = parts.keys().copied().eq(0..parts.len() as u32);
    let bytes: Vec<u8> = parts.values().flat_map(|bytes| bytes.iter().copied()).collect();
    bytes.try_into().ok().filter(|_| are_all)
}
