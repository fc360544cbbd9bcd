//! Builds the table of the ziggurat (`noise::Generator::gaussian`) with libm, as exact bits.
//!
//! 256 layers of one area V cover the right half of exp(−x²/2). Layer 0 is the strip under f(r)
//! together with the tail beyond r; layer i ≥ 1 reaches from x = 0 to edge i. Method: G. Marsaglia,
//! W. W. Tsang, "The Ziggurat Method for Generating Random Variables", Journal of Statistical
//! Software 5(8), 2000. The base r is solved for here rather than copied from the paper.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

/// Number of layers; a byte of the random word chooses one.
const LAYERS: usize = 256;

/// exp(−x²/2).
fn density(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

/// Area of each layer when the base strip ends at `r`: r·f(r) and the tail.
fn area(r: f64) -> f64 {
    let tail =
        libm::sqrt(core::f64::consts::FRAC_PI_2) * libm::erfc(r * core::f64::consts::FRAC_1_SQRT_2);
    r * density(r) + tail
}

/// Edges for base `r` and the height at which the last layer closes (1 when r is right; NaN when
/// the layers overshoot the top).
fn stack(r: f64) -> ([f64; LAYERS + 1], f64) {
    let mut edges = [0.0; LAYERS + 1];
    let mut height = density(r);
    (edges[0], edges[1]) = (area(r) / height, r);
    for layer in 2..LAYERS {
        height += area(r) / edges[layer - 1];
        edges[layer] = libm::sqrt(-2.0 * libm::log(height));
    }
    (edges, height + area(r) / edges[LAYERS - 1])
}

/// The edges of the ziggurat that closes at height 1, found by bisection of r.
fn solve() -> [f64; LAYERS + 1] {
    let (mut low, mut high) = (3.5, 3.8);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if stack(middle).1 < 1.0 { high = middle } else { low = middle }
    }
    stack(high).0
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    let edges = solve();
    // Bit patterns are exact; their digits are not for reading.
    let mut text = String::from("#[allow(clippy::unreadable_literal)]\n");
    writeln!(text, "static EDGES: [f64; {}] = [", edges.len())?;
    for edge in edges {
        writeln!(text, "    f64::from_bits({:#018x}), // {edge:?}", edge.to_bits())?;
    }
    text.push_str("];\n");
    let folder = env::var_os("OUT_DIR").ok_or("cargo sets OUT_DIR for a build script")?;
    fs::write(Path::new(&folder).join("ziggurat.rs"), text)?;
    Ok(())
}
