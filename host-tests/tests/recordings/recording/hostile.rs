//! No bytes whatever make the reader panic, hang, or hold more than one line too many.

use std::cell::Cell;
use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use flate2::{Compression, write::GzEncoder};
use host::recording::{MAX_LINE_BYTES, MAX_ROWS, read, read_from};
use proptest::prelude::*;

use crate::support::files::Scratch;

use super::{DWELLS, ROTATING, STAGE, changed, gzip, message, parse};

/// Gives a text, then repeats another without end, and counts what is taken.
struct Endless<'a> {
    text: &'a [u8],
    repeated: &'a [u8],
    at: usize,
    taken: &'a Cell<u64>,
}

impl Read for Endless<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        for byte in buffer.iter_mut() {
            let past = self.at.checked_sub(self.text.len());
            *byte =
                past.map_or_else(|| self.text[self.at], |i| self.repeated[i % self.repeated.len()]);
            self.at += 1;
        }
        self.taken.set(self.taken.get() + buffer.len() as u64);
        Ok(buffer.len())
    }
}

/// The message for a text that never ends, and how many bytes of it were taken.
fn endless(text: &str, repeated: &str) -> (String, u64) {
    let taken = Cell::new(0);
    let [text, repeated] = [text, repeated].map(str::as_bytes);
    let reader = Endless { text, repeated, at: 0, taken: &taken };
    let error = read_from("walk.csv", reader).expect_err("never ends");
    (error.to_string(), taken.get())
}

#[test]
fn a_line_that_never_ends_is_refused_after_little_of_it() {
    for start in ["", "# kind: stage\n# remark ", STAGE] {
        let line = start.lines().count().max(1) + usize::from(start.ends_with('\n'));
        let (message, taken) = endless(start, "1");
        assert_eq!(
            message,
            format!(
                "walk.csv: line {line}: is longer than {MAX_LINE_BYTES} bytes; is this a recording \
                 in CSV?"
            )
        );
        assert!(taken <= start.len() as u64 + 128 * 1024, "{taken} bytes were taken");
    }
}

#[test]
fn a_line_of_ten_megabytes_is_refused_at_once() {
    let text = changed(STAGE, "0.04", &"7".repeat(10_000_000));
    let expected = "walk.csv: line 7: is longer than 65536 bytes; is this a recording in CSV?";
    assert_eq!(message(text), expected);
}

#[test]
fn the_longest_line_is_read_and_one_byte_more_is_not() {
    let remark = |length: usize| format!("#{}\n{STAGE}", "x".repeat(length - 1));
    assert!(parse(remark(65_536)).is_ok());
    assert!(message(remark(65_537)).contains("line 1: is longer"));
}

#[test]
fn blank_lines_or_remarks_without_end_are_refused() {
    for repeated in ["\n", "#\n"] {
        let (message, _) = endless(STAGE, repeated);
        let expected = "walk.csv: line 9000001: more than 9000000 lines; split the recording";
        assert_eq!(message, expected);
    }
}

#[test]
fn truth_keys_without_number_are_refused() {
    let keys = (0..1001).map(|i| format!("# truth_{i}: 1")).collect::<Vec<_>>().join("\n");
    let expected = "walk.csv: line 1001: more than 1000 truth_ keys; split the recording";
    assert_eq!(message(keys), expected);
}

/// Gives a row for every turn of the clock, without end.
struct Rows(u64, Vec<u8>);

impl Read for Rows {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.1.is_empty() {
            self.1 = format!("{},0,0,0,0,0\n", self.0).into_bytes();
            self.0 += 1;
        }
        let length = buffer.len().min(self.1.len());
        buffer[..length].copy_from_slice(&self.1[..length]);
        self.1.drain(..length);
        Ok(length)
    }
}

#[test]
fn rows_without_end_are_refused() {
    let head = changed(&STAGE[..STAGE.find("0.00").unwrap_or(0)], "# rate_hz: 50\n", "");
    let error = read_from("walk.csv", head.as_bytes().chain(Rows(0, Vec::new())));
    let line = MAX_ROWS + 4;
    assert_eq!(
        error.expect_err("never ends").to_string(),
        format!("walk.csv: line {line}: more than 8000000 rows; split the recording")
    );
}

/// A gzip stream of some hundred kilobytes that holds 200 MB.
fn bomb(start: &str, byte: u8) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(start.as_bytes()).expect("writes to memory");
    for _ in 0..200 {
        encoder.write_all(&vec![byte; 1_000_000]).expect("writes to memory");
    }
    encoder.finish().expect("writes to memory")
}

#[test]
fn a_compressed_bomb_meets_the_same_limits() {
    let line = message(bomb(STAGE, b'1'));
    assert_eq!(line, "walk.csv: line 9: is longer than 65536 bytes; is this a recording in CSV?");
    let lines = message(bomb(STAGE, b'\n'));
    assert_eq!(lines, "walk.csv: line 9000001: more than 9000000 lines; split the recording");
}

#[test]
fn compressed_data_cut_short_or_damaged_are_refused() {
    let mut bytes = gzip(STAGE.as_bytes());
    let cut = message(&bytes[..bytes.len() - 20]);
    assert!(cut.contains("the compressed data are damaged or cut short ("), "{cut}");
    let middle = bytes.len() - 6;
    bytes[middle] ^= 0xff;
    let damaged = message(&bytes);
    assert!(damaged.contains("the compressed data are damaged or cut short ("), "{damaged}");
}

#[test]
fn text_that_is_not_utf_8_is_refused_with_its_line() {
    let mut bytes = STAGE.as_bytes().to_vec();
    let at = STAGE.find("0.02").unwrap_or(0);
    bytes[at] = 0xe9;
    let refusal = "is not UTF-8 text; save the file as UTF-8";
    assert_eq!(message(&bytes), format!("walk.csv: line 6: {refusal}"));
    let utf_16: Vec<u8> = STAGE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let marked = [&[0xff, 0xfe], utf_16.as_slice()].concat();
    assert_eq!(message(marked), format!("walk.csv: line 1: {refusal}"));
}

#[test]
fn a_file_that_is_not_there_or_is_a_directory_is_refused() {
    let message = |path: &Path| read(path).expect_err("no recording").to_string();
    assert_eq!(message(Path::new("no/such.csv")), "no/such.csv: there is no such file");
    assert_eq!(message(Path::new(".")), ".: is a directory; name a file in it");
}

#[test]
#[cfg(unix)]
fn a_file_that_may_not_be_read_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let scratch = Scratch::new("unreadable");
    let path = PathBuf::from(scratch.with("unreadable.csv", STAGE));
    fs::set_permissions(&path, fs::Permissions::from_mode(0o000)).expect("the file is ours");
    let may_read_all = fs::read(&path).is_ok();
    let result = read(&path).map_err(|error| error.to_string());
    let expected = format!("{}: may not be read; change its permissions", path.display());
    assert!(may_read_all || result == Err(expected));
}

/// Reads and asserts what holds for any bytes: rows, or a message of one line.
fn reads_or_says_why(bytes: &[u8]) -> Result<(), TestCaseError> {
    match parse(bytes) {
        Ok(recording) => {
            let holds_nan = format!("{:?}", recording.body).contains("NaN");
            prop_assert!(!holds_nan);
        }
        Err(message) => {
            prop_assert!(message.starts_with("walk.csv: "));
            prop_assert!(!message.chars().any(char::is_control), "{message:?}");
            prop_assert!(message.len() < 1000, "{message}");
        }
    }
    Ok(())
}

/// Pieces that a recording's reader takes for something.
const PIECES: [&str; 16] = [
    "\n",
    "\r",
    ",",
    "#",
    ":",
    "nan",
    "inf",
    "-",
    "1e308",
    "1e400",
    "truth_",
    "# kind: dwells\n",
    "\0",
    "é",
    "\u{feff}",
    "0.00",
];

proptest! {
    #[test]
    fn any_bytes_read_or_give_one_line(bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
        reads_or_says_why(&bytes)?;
        reads_or_says_why(&[b"\x1f\x8b".as_slice(), &bytes].concat())?;
        reads_or_says_why(&[b"# kind: stage\n".as_slice(), &bytes].concat())?;
    }

    #[test]
    fn any_change_of_bytes_reads_or_gives_one_line(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        cut in any::<prop::sample::Index>(),
    ) {
        let plain = [STAGE, DWELLS, ROTATING].map(|text| text.as_bytes().to_vec());
        for mut bytes in plain.into_iter().chain([gzip(STAGE.as_bytes())]) {
            for (index, byte) in &changes {
                let at = index.index(bytes.len());
                bytes[at] = *byte;
            }
            reads_or_says_why(&bytes)?;
            reads_or_says_why(&bytes[..cut.index(bytes.len())])?;
        }
    }

    #[test]
    fn any_piece_put_anywhere_reads_or_gives_one_line(
        pieces in prop::collection::vec((any::<prop::sample::Index>(), 0..PIECES.len()), 1..4),
    ) {
        for good in [STAGE, DWELLS, ROTATING] {
            let mut bytes = good.as_bytes().to_vec();
            for (index, piece) in &pieces {
                let at = index.index(bytes.len());
                bytes.splice(at..at, PIECES[*piece].bytes());
            }
            reads_or_says_why(&bytes)?;
        }
    }
}
