//! Sentences that an instrument has sent over its link, whose checksums are computed here once more.
#![allow(dead_code, reason = "every binary uses a part of it")]

/// The fields of the sentences of an address among lines, in the order in which they were sent.
///
/// # Panics
/// Where a line is no sentence: without its frame, with another checksum, or too long.
#[track_caller]
pub fn sentences<'l>(lines: impl IntoIterator<Item = &'l str>, address: &str) -> Vec<Vec<&'l str>> {
    let all = lines.into_iter().map(fields);
    all.filter(|fields| fields[0] == address).map(|fields| fields[1..].to_vec()).collect()
}

/// The fields of a sentence, its address first. The beginning of one that a reset has cut off may stand before it, from which
/// receivers begin anew.
#[track_caller]
fn fields(line: &str) -> Vec<&str> {
    let (cut, line) = line.split_at(line.rfind('$').unwrap_or(0));
    // At most its checksum and the first half of the end of its line stand behind its content.
    let is_one = cut.split_once('*').is_none_or(|(_, rest)| "*00\r".len() > rest.len());
    assert!(cut.is_empty() || (cut.starts_with('$') && is_one), "{cut:?} before {line:?}");
    let content = line.strip_prefix('$').and_then(|rest| rest.rsplit_once('*'));
    let (content, sum) = content.unwrap_or_else(|| panic!("no sentence: {line:?}"));
    let right = content.bytes().fold(0, |sum, byte| sum ^ byte);
    assert_eq!(sum, format!("{right:02X}"), "{line}");
    assert!(line.len() <= 80, "with the end of its line it has more than 82 characters: {line}");
    content.split(',').collect()
}

/// The words for people among lines, one text after the other.
#[track_caller]
pub fn words<'l>(lines: impl IntoIterator<Item = &'l str>) -> Vec<String> {
    let mut texts: Vec<String> = Vec::new();
    for part in sentences(lines, "HETXT") {
        match (part[1], texts.last_mut()) {
            ("01", _) | (_, None) => texts.push(part[3].to_owned()),
            (_, Some(text)) => text.push_str(part[3]),
        }
    }
    texts
}

/// The instrument's states among lines: state, σ of azimuth, pitch and roll, faults, seconds since the alignment, what is
/// done of what is planned, and why an azimuth is to be used with care.
#[track_caller]
pub fn states<'l>(lines: impl IntoIterator<Item = &'l str>) -> Vec<[&'l str; 9]> {
    let all = sentences(lines, "PMRDS").into_iter();
    all.map(|fields| fields.try_into().expect("nine fields")).collect()
}
