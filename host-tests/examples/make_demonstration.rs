//! Writes the recording that ships with the program anew: `cargo run --example make_demonstration`.

use std::error::Error;
use std::fs::File;
use std::io::Write;
use std::path::Path;

use flate2::{Compression, GzBuilder};

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/demonstration.csv.gz");
    let mut file = GzBuilder::new().mtime(0).write(File::create(&path)?, Compression::best());
    file.write_all(bench::demonstration::text()?.as_bytes())?;
    file.finish()?;
    println!("wrote {}", path.display());
    Ok(())
}
