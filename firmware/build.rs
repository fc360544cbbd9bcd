//! Links the bare-metal images by cortex-m-rt's script, which takes the memory map from `memory.x`.
//!
//! Cargo starts the linker in the workspace root, so `memory.x` is found there from any directory.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../memory.x");
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none") {
        println!("cargo::rustc-link-arg-bins=-Tlink.x");
    }
}
