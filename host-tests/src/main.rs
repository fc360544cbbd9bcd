//! The `meridian` command line.
fn main() {}
