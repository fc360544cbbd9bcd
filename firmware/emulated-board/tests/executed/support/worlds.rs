//! Worlds of the tests beside the usual ones.

use emulated_board::world::{World, stored};
use firmware::platform::Platform;
use firmware::ports::Store as _;
use firmware::settings::save;
use firmware::storage::HEADING;
use simulated::scenario::Scenario;

/// Bytes of a heading in the store: a version, eight numbers, a checksum.
const HEADING_BYTES: usize = 72;

/// The usual world of a carrier.
pub fn usual(carrier: Platform) -> World {
    World::new(carrier, 1).expect("the usual world can be made")
}

/// A stage with three positions of two seconds, which holds its result or does not, and in whose store a void heading
/// was written so many times.
pub fn short_stage(holds: bool, headings: usize) -> World {
    let scenario = Scenario { positions: 3, dwell_s: 2.0, ..simulated::executed::stage(1) };
    let mut settings = scenario.settings().expect("the scenario has a latitude");
    settings.holds = holds;
    let store = stored(async |store| {
        save(store, &settings).await.map_err(|error| error.to_string())?;
        for _ in 0..headings {
            store.save(HEADING, &[0; HEADING_BYTES]).await.map_err(|fault| format!("{fault:?}"))?;
        }
        Ok(())
    });
    usual(Platform::Stage).with_store(store.expect("a store takes settings and headings"))
}
