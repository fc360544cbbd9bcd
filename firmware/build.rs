//! Links the bare-metal images by cortex-m-rt's script, which takes the memory map from `memory.x`,
//! and hands them the budget: as constants, and as limits that the board's image must keep to link.
//!
//! Cargo starts the linker in the workspace root, so `memory.x` is found there from any directory.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs, io};

/// What the images may cost.
const BUDGET: &str = "budget.toml";

/// A linker script that refuses an image without its etalon table (`memory.x`).
const ETALON: &str = "ASSERT(SIZEOF(.etalon) > 0, \"the etalon table is not in its section\");\n";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed={BUDGET}");
    println!("cargo::rerun-if-changed=../memory.x");
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none") {
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
        // defmt's own script: strings that stay on the host.
        for (feature, image) in [("EMULATOR", "emulator"), ("BOARD", "board")] {
            if env::var_os(format!("CARGO_FEATURE_{feature}")).is_some() {
                println!("cargo::rustc-link-arg-bin={image}=-Tdefmt.x");
            }
        }
    }
    let directory = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    let budget = fs::read_to_string(BUDGET)?;
    fs::write(directory.join("budget.rs"), constants(&budget)?)?;
    fs::write(directory.join("budget.x"), limits(&budget)?)?;
    fs::write(directory.join("etalon.x"), ETALON)?;
    println!("cargo::rustc-link-search={}", directory.display());
    if env::var_os("CARGO_FEATURE_EMULATOR").is_some() {
        println!("cargo::rustc-link-arg-bin=emulator=-Tetalon.x");
    }
    if env::var_os("CARGO_FEATURE_BOARD").is_some() {
        println!("cargo::rustc-link-arg-bin=board=-Tbudget.x");
    }
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
    let flash = sum(&[".vector_table", ".text", ".etalon", ".rodata", ".data"]);
    let ram = sum(&[".data", ".bss", ".uninit"]);
    Ok(format!(
        "ASSERT({flash} <= {}, \"the image takes more flash than budget.toml allows\");\n\
         ASSERT({ram} <= {}, \"the statics take more RAM than budget.toml allows\");\n",
        limit("board_flash_bytes")?,
        limit("board_static_ram_bytes")?
    ))
}
