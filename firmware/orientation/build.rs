//! Writes the etalon table: a quarter of the cosine on a 10″ grid, and its CRC-32.
//!
//! The table is computed with `libm` on the host, so every build of one `libm` version gives the
//! same entries whatever the platform's own cosine does.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs, io};

/// Steps of 10″ in a quarter of a turn.
const QUARTER: u32 = 32_400;

/// The value of cos 0 in table units.
const ONE: f64 = 2_147_483_648.0;

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

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let entries: Vec<u32> = (0..=QUARTER).map(entry).collect();
    let mut source = String::from("[\n");
    for row in entries.chunks(8) {
        let row: Vec<String> = row.iter().copied().map(literal).collect();
        writeln!(source, "    {},", row.join(", ")).map_err(io::Error::other)?;
    }
    source.push(']');
    let directory = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    fs::write(directory.join("quarter_cosine.rs"), source)?;
    fs::write(directory.join("quarter_cosine_crc.rs"), literal(crc32(&entries)))
}
