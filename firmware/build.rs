//! Hands on what the firmware may cost, as stated in `budget.toml`: as constants, and as limits that the
//! board's image must keep to link.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs, io};

/// What the images may cost.
const BUDGET: &str = "budget.toml";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={BUDGET}");
    let directory = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    let budget = fs::read_to_string(BUDGET)?;
    fs::write(directory.join("budget.rs"), constants(&budget)?)?;
    fs::write(directory.join("budget.x"), limits(&budget)?)?;
    // Cargo hands this on to whatever links this crate.
    println!("cargo::rustc-link-search={}", directory.display());
    Ok(())
}

/// The budget's keys, values and remarks.
fn entries(budget: &str) -> impl Iterator<Item = [&str; 3]> {
    budget.lines().filter_map(|line| {
        let (entry, remark) = line.split_once('#').unwrap_or((line, ""));
        let (key, value) = entry.split_once('=')?;
        Some([key, value, remark].map(str::trim))
    })
}

/// Every entry of the budget as a constant.
fn constants(budget: &str) -> io::Result<String> {
    let mut source = String::new();
    for [key, value, remark] in entries(budget) {
        let key = key.to_uppercase();
        let constant = format!("#[doc = {remark:?}]\npub const {key}: u64 = {value};");
        writeln!(source, "{constant}").map_err(io::Error::other)?;
    }
    Ok(source)
}

/// A linker script that refuses an image beyond its memory.
fn limits(budget: &str) -> io::Result<String> {
    let limit = |name: &str| {
        let entry = entries(budget).find(|[key, ..]| *key == name);
        entry
            .map(|[_, value, _]| value.replace('_', ""))
            .ok_or_else(|| io::Error::other(format!("{BUDGET}: no {name}")))
    };
    let sum = |sections: &[&str]| {
        sections.iter().map(|name| format!("SIZEOF({name})")).collect::<Vec<_>>().join(" + ")
    };
    let flash = sum(&[".vector_table", ".text", ".etalon", ".build_id", ".rodata", ".data"]);
    let ram = sum(&[".data", ".bss", ".uninit"]);
    let sram2 = sum(&[".outlasting"]);
    Ok(format!(
        "ASSERT({flash} <= {}, \"the image takes more flash than budget.toml allows\");\n\
         ASSERT({ram} <= {}, \"the statics take more of SRAM1 than budget.toml allows\");\n\
         ASSERT({sram2} <= {}, \"the statics take more of SRAM2 than budget.toml allows\");\n",
        limit("board_flash_bytes")?,
        limit("board_static_ram_bytes")?,
        limit("board_sram2_bytes")?
    ))
}
