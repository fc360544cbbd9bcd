//! Writes the etalon table: a quarter of the cosine on a 10″ grid, as chords and what is above them, and the CRC-32 of its
//! entries.
//!
//! The table is computed with `libm` on the host, so every build of one `libm` version gives the
//! same entries whatever the platform's own cosine does.

use std::path::PathBuf;
use std::{env, fs, io};

/// Steps of 10″ in a quarter of a turn.
const QUARTER: u32 = 32_400;

/// The value of cos 0 in table units.
const ONE: f64 = 2_147_483_648.0;

/// Steps that a chord of the table spans: so many that what is above it fits a byte.
const SPAN: u32 = 16;

/// Entry `k` of the table: 2³¹ cos(k · 10″), rounded to nearest.
fn entry(k: u32) -> u32 {
    let angle = f64::from(k) * (core::f64::consts::FRAC_PI_2 / f64::from(QUARTER));
    libm::round(ONE * libm::cos(angle)) as u32
}

/// CRC-32 (IEEE 802.3, reflected) of the entries as little-endian bytes.
fn crc32(entries: &[u32]) -> u32 {
    let mut crc = u32::MAX;
    for byte in entries.iter().flat_map(|entry| entry.to_le_bytes()) {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xEDB8_8320 & (crc & 1).wrapping_neg());
        }
    }
    !crc
}

/// A literal that keeps the digit groups clippy asks for.
fn literal(value: u32) -> String {
    format!("0x{:04X}_{:04X}", value >> 16, value & 0xFFFF)
}

/// How far entry `k` is above its chord, as the table's `entry` computes the latter.
fn above(k: u32) -> Option<u8> {
    let [from, to] = [k / SPAN, k / SPAN + 1].map(chord);
    let below = (from - to) * (k % SPAN) / SPAN + 1;
    u8::try_from(entry(k) + below - from).ok()
}

/// Where chord `number` begins. One that ends beyond the quarter is needed for its begin alone.
fn chord(number: u32) -> u32 {
    if number * SPAN <= QUARTER { entry(number * SPAN) } else { 0 }
}

/// Literals of an array, in rows.
fn rows(literals: impl Iterator<Item = String>) -> String {
    let literals: Vec<String> = literals.collect();
    let rows: Vec<String> = literals.chunks(8).map(|row| row.join(", ")).collect();
    rows.join(",\n        ")
}

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let above: Option<Vec<u8>> = (0..=QUARTER).map(above).collect();
    let above = above.ok_or_else(|| io::Error::other("what is above a chord fits no byte"))?;
    let chords = rows((0..=QUARTER / SPAN + 1).map(|number| literal(chord(number))));
    let above = rows(above.iter().map(u8::to_string));
    let source = format!("Quarter {{ chords: [{chords}], above: [{above}] }}");
    let entries: Vec<u32> = (0..=QUARTER).map(entry).collect();
    let directory = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    fs::write(directory.join("quarter_cosine.rs"), source)?;
    fs::write(directory.join("quarter_cosine_crc.rs"), literal(crc32(&entries)))
}
