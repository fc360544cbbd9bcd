//! Does nothing: it is here for a feature of a build dependency, which `Cargo.toml` explains.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
}
