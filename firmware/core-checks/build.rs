//! Links the images by cortex-m-rt's script, which takes the memory map from `memory.x`. Cargo starts the
//! linker in the workspace root, so that file is found there from any directory.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../../memory.x");
    println!("cargo::rustc-link-arg-bins=-Tlink.x");
    // defmt's own script: strings that stay on the host.
    println!("cargo::rustc-link-arg-bin=core-checks-probe=-Tdefmt.x");
}
