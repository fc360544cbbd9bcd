//! Worlds of the tests beside the usual ones.

use std::sync::Arc;

use embassy_time::Instant;
use emulated_board::run::Order;
use emulated_board::wiring::board::BaseImu;
use emulated_board::world::{SERIAL, World, stored};
use firmware::platform::Platform;
use firmware::ports::Store as _;
use firmware::settings::{CarrierSchedule, FASTEST, Format, ITEMS, Output, Settings, save};
use firmware::storage::HEADING;
use hal_mock::chip::Single;
use hal_mock::lsm6dsl::Lsm6dsl;
use hal_mock::plant::base::{Base, CoarseConfiguration};
use hal_mock::plant::sway::SwayConfiguration;
use simulated::scenario::Scenario;

use super::executed::{Executed, execute_in, once};

/// Address of the LSM6DSL on the board, whose pin SA0 is low (data sheet, 6.1.1).
pub const ADDRESS: u8 = 0x6A;
/// An LSM6DSL of its data sheet, whose accelerometers are calibrated to 2 mg.
const CALIBRATED: CoarseConfiguration = CoarseConfiguration {
    rate_hz: 208.0,
    rate_noise_mdps_sqrt_hz: 4.0,
    rate_bias_sigma_deg_s: 3.0,
    force_noise_ug_sqrt_hz: 90.0,
    force_bias_sigma_mg: 2.0,
    scale_sigma: 0.005,
    lever_m: [0.1, 0.0, -0.4],
};

/// Headings that fill the page of the store that has the settings.
pub const FULL: usize = 17;
/// Bytes of a heading in the store: a version, eight numbers, a checksum.
const HEADING_BYTES: usize = 72;

/// The usual world of a carrier.
pub fn usual(carrier: Platform) -> World {
    World::new(carrier, 1).expect("the usual world can be made")
}

/// A stage with three positions of so many seconds.
pub fn stage_of_dwells(seconds: f64) -> World {
    let usual_stage = simulated::executed::stage(1);
    let settings = Scenario { positions: 3, dwell_s: seconds, ..usual_stage }.settings();
    let settings = settings.expect("the scenario has a latitude");
    usual(Platform::Stage).with_store(worn_store(&settings, 0))
}

/// A stage with three positions of two seconds, which holds its result or does not, and in whose store a void heading
/// was written so many times.
pub fn short_stage(holds: bool, headings: usize) -> World {
    let scenario = Scenario { positions: 3, dwell_s: 2.0, ..simulated::executed::stage(1) };
    let mut settings = scenario.settings().expect("the scenario has a latitude");
    settings.holds = holds;
    usual(Platform::Stage).with_store(worn_store(&settings, headings))
}

/// A store with these settings, in which a void heading was written so many times.
pub fn worn_store<C: CarrierSchedule>(settings: &Settings<C>, headings: usize) -> Vec<u8> {
    let store = stored(async |store| {
        save(store, settings, &SERIAL).await.map_err(|error| error.to_string())?;
        for _ in 0..headings {
            store.save(HEADING, &[0; HEADING_BYTES]).await.map_err(|fault| format!("{fault:?}"))?;
        }
        Ok(())
    });
    store.expect("a store takes settings and headings")
}

/// The usual world of a carrier, whose settings have its link send all of a format at each look.
pub fn at_full_load(carrier: Platform, format: Format) -> World {
    let store = match carrier {
        Platform::Stage => full(simulated::executed::stage(1).settings(), format),
        Platform::Turntable => full(simulated::executed::turntable(1).settings(), format),
        Platform::TwoFrame => full(simulated::executed::two_frames(1).settings(), format),
        Platform::Vehicle => full(simulated::executed::vehicle(1).settings(), format),
        Platform::Spin => full(simulated::executed::spin(1).settings(), format),
    };
    usual(carrier).with_store(store)
}

/// A store with these settings, by which the link sends all of a format at each look.
fn full<C: CarrierSchedule>(settings: Option<Settings<C>>, format: Format) -> Vec<u8> {
    let mut settings = settings.expect("the usual settings are some");
    settings.output = Output { format, rates: [FASTEST; ITEMS], ..settings.output };
    settings.check().expect("the link carries all that it may send");
    worn_store(&settings, 0)
}

/// Two frames on a base whose IMU has accelerometers as calibrated as their image states, until the result.
pub fn calibrated_two_frames() -> Arc<Executed> {
    once("calibrated two frames".to_owned(), || {
        let order = Order { afterwards: 0.0, ..Order::usual(Platform::TwoFrame, 1) };
        execute_in(
            &order,
            usual(Platform::TwoFrame)
                .with_base(calibrated(&simulated::executed::two_frames(1).base)),
        )
    })
}

/// The calibrated IMU on the base of a scenario.
fn calibrated(scenario: &Scenario) -> BaseImu {
    let sway = SwayConfiguration::default();
    let environment = Base::new(&scenario.instruments(), &sway, &CALIBRATED, None, scenario.seed);
    Single { chip: Lsm6dsl::new(Instant::MIN, ADDRESS, 1.0), environment }
}
