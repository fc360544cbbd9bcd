//! What is measured of an image while it is executed.

use std::collections::HashMap;

use execution::report::Origin;

use crate::image::Image;
use crate::processor::blocks::Blocks;

/// Parts of paths of sources, with what they belong to; the first that is found holds.
const PATHS: [(&str, Origin); 26] = [
    ("/firmware/orientation/", Origin::Methods),
    ("/firmware/drivers/", Origin::Drivers),
    ("/firmware/stm32/src/edges.rs", Origin::Peripherals),
    ("/firmware/stm32/src/i2c.rs", Origin::Peripherals),
    ("/firmware/stm32/src/spi.rs", Origin::Peripherals),
    ("/firmware/", Origin::Instrument),
    ("firmware/", Origin::Instrument),
    ("time_driver", Origin::Time),
    ("embassy-time", Origin::Time),
    ("embassy-stm32", Origin::Peripherals),
    ("stm32-metapac", Origin::Peripherals),
    ("embassy-embedded-hal", Origin::Peripherals),
    ("embedded-hal", Origin::Peripherals),
    ("embassy-hal-internal", Origin::Peripherals),
    ("embassy-", Origin::Channels),
    ("critical-section", Origin::Channels),
    ("cortex-m", Origin::Channels),
    ("portable-atomic", Origin::Channels),
    ("futures", Origin::Channels),
    ("compiler-builtins/src/mem", Origin::Memory),
    ("compiler-builtins", Origin::Arithmetic),
    ("libm", Origin::Arithmetic),
    ("micromath", Origin::Arithmetic),
    ("sequential-storage", Origin::Store),
    ("defmt", Origin::Log),
    ("heapless", Origin::Channels),
];

/// The origin of a source.
fn origin(path: &str) -> Option<Origin> {
    PATHS.iter().find(|(part, _)| path.contains(part)).map(|(_, origin)| *origin)
}

/// Executions of each block at a moment.
#[derive(Clone, Debug, Default)]
pub struct Snapshot(Vec<u64>);

impl Snapshot {
    /// The executions until now.
    pub fn of(blocks: &Blocks) -> Self {
        Self(blocks.all.iter().map(|block| block.count).collect())
    }

    /// Instructions of all blocks since an earlier moment, by where they go.
    pub fn since(
        &self,
        earlier: &Self,
        blocks: &Blocks,
        origins: &mut Origins,
    ) -> HashMap<Origin, u64> {
        let mut sums = HashMap::new();
        for (place, (block, count)) in blocks.all.iter().zip(&self.0).enumerate() {
            let executed = count - earlier.0.get(place).copied().unwrap_or(0);
            if executed == 0 {
                continue;
            }
            for offset in &block.offsets {
                *sums.entry(origins.of(block.address + u32::from(*offset))).or_insert(0) +=
                    executed;
            }
        }
        sums
    }
}

/// The origin of each instruction, looked up once.
pub struct Origins<'i> {
    image: &'i Image,
    known: HashMap<u32, Origin>,
}

impl<'i> Origins<'i> {
    /// Those of an image.
    pub fn new(image: &'i Image) -> Self {
        Self { image, known: HashMap::new() }
    }

    /// The origin of an instruction: the innermost function that is not one of Rust's own library.
    fn of(&mut self, address: u32) -> Origin {
        let image = self.image;
        *self.known.entry(address).or_insert_with(|| {
            image.files(address).iter().find_map(|file| origin(file)).unwrap_or(Origin::Other)
        })
    }
}
