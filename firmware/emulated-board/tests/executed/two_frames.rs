//! Two frames, whose base is said to have driven on although it stands.
//!
//! Until the base counts as still, the keeper has the forces of the LSM6DSL; from there on those of the ADXL355 on the
//! base. The image takes the offset of the first for 2 mg, as after a calibration; by the data sheet it is 20 mg (1σ),
//! and nothing calibrates it. So gravity seems to change its direction by a degree, which the keeper takes for an
//! acceleration; after 5 s of that the body counts as having set off. The host's runs have no keeper where nothing is
//! held, and a calibrated IMU where something is, so they never showed it.

use emulated_board::run::Order;
use embassy_time::Instant;
use firmware::platform::Platform;
use hal_mock::chip::Single;
use hal_mock::lsm6dsl::Lsm6dsl;
use hal_mock::plant::base::{Base, CoarseConfiguration};
use hal_mock::plant::sway::SwayConfiguration;

use super::support::bench::Bench;
use super::support::defect::hold;
use super::support::executed::executed;
use super::support::worlds::usual;

/// Address of the LSM6DSL on the board, whose pin SA0 is low (data sheet, 6.1.1).
const ADDRESS: u8 = 0x6A;

#[test]
#[should_panic(expected = "between 6 and 7 s after its forces come from another accelerometer a base at rest counts as under way")]
fn two_frames_on_a_base_at_rest_are_aligned() {
    let shown = executed(Platform::TwoFrame, 1);
    let Some(refused) = shown.lines("no azimuth: the vehicle drove on before it was aligned").next() else { return };
    let after = refused.seconds - shown.line("base: still within").seconds;
    let words = "s after its forces come from another accelerometer a base at rest counts as under way";
    hold(after, 0.0..=0.0, 6.0..=7.0, words);
}

#[test]
fn two_frames_home_on_a_base_whose_coarse_accelerometers_are_calibrated() {
    let scenario = simulated::executed::two_frames(1).base;
    let coarse = CoarseConfiguration {
        rate_hz: 208.0,
        rate_noise_mdps_sqrt_hz: 4.0,
        rate_bias_sigma_deg_s: 3.0,
        force_noise_ug_sqrt_hz: 90.0,
        force_bias_sigma_mg: 2.0,
        scale_sigma: 0.005,
        lever_m: [0.1, 0.0, -0.4],
    };
    let sway = SwayConfiguration::default();
    let environment = Base::new(&scenario.instruments(), &sway, &coarse, None, scenario.seed);
    let base = Single { chip: Lsm6dsl::new(Instant::MIN, ADDRESS, 1.0), environment };
    let world = usual(Platform::TwoFrame).with_base(base);
    let mut bench = Bench::new(&Order::usual(Platform::TwoFrame, 1), world);
    bench.run_until("outer frame: stands at", 60.0);
    bench.log.iter().for_each(|entry| assert!(!entry.words.contains("no azimuth"), "{}", entry.words));
}
