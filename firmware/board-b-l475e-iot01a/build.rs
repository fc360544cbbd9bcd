//! Links the image by the scripts of cortex-m-rt, which takes the memory map from `memory.x`, of defmt, whose
//! strings stay on the host, and of the budget, which an image must keep to. A symbol that takes no memory states the
//! carrier: who executes an image can look.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../../memory.x");
    // Functions of the same code are one.
    println!("cargo::rustc-link-arg-bins=--icf=all");
    // By its identity in a note, the lines that an image has kept in flash find the ELF file with their words.
    println!("cargo::rustc-link-arg-bins=--build-id=fast");
    for script in ["link.x", "defmt.x", "budget.x"] {
        println!("cargo::rustc-link-arg-bins=-T{script}");
    }
    for (feature, _) in env::vars() {
        if let Some(carrier) = feature.strip_prefix("CARGO_FEATURE_") {
            println!("cargo::rustc-link-arg-bins=--defsym=_carrier_{}=0", carrier.to_lowercase());
        }
    }
}
