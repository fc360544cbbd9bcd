//! Links the bare-metal images by cortex-m-rt's script, which takes the memory map from `memory.x`,
//! and hands them the budget.
//!
//! Cargo starts the linker in the workspace root, so `memory.x` is found there from any directory.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::{env, fs, io};

/// What the images may cost.
const BUDGET: &str = "budget.toml";

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
    fs::write(directory.join("budget.rs"), constants(&fs::read_to_string(BUDGET)?)?)
}

/// Every `key = value` of the budget as a constant.
fn constants(budget: &str) -> io::Result<String> {
    let mut source = String::new();
    for line in budget.lines() {
        let Some((key, value)) = line.split('#').next().and_then(|line| line.split_once('='))
        else {
            continue;
        };
        let (key, value) = (key.trim().to_uppercase(), value.trim());
        writeln!(source, "pub const {key}: u64 = {value};").map_err(io::Error::other)?;
    }
    Ok(source)
}
