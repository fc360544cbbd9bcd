//! The simulated platform of the campaign, whose north the independent solution finds.

use std::f64::consts::TAU;

use host::campaign::rotating::world::{LATITUDE_DEG, World};
use host::methods::rotating::part::Part;
use host::output::azimuth_error;

use super::oracle::{self, Known};

#[test]
fn an_independent_solution_finds_the_simulated_north() {
    for seed in 1..=4 {
        let world = World {
            n_deg_sqrt_h: 0.000_2,
            g_sensitivity_deg_h_g: [8.0, -5.0],
            ..World::drawn(seed, &[0.137], 200.0)
        };
        let rows = world.rows(seed);
        let modulated = 12.0 / 0.137;
        let whole = (27.0 - 1e-3) / 0.137;
        let part =
            |from: f64, seconds: f64| Part::between(&rows, from + 0.02, from + seconds, true).rows;
        let misalignment = oracle::misalignment(part(0.0, modulated));
        let known = Known {
            latitude: LATITUDE_DEG.to_radians(),
            gravity: hal_mock::earth::normal_gravity_m_s2(LATITUDE_DEG.to_radians()),
            g_sensitivity: [8.0, -5.0].map(|part| part * TAU / 360.0 / 3600.0),
        };
        let turns = [part(modulated, whole), part(modulated + 200.0, whole)];
        let found = oracle::azimuth(turns, misalignment, &known).to_degrees();
        let error = azimuth_error(found, world.azimuth_deg);
        assert!((-misalignment.asin().to_degrees() - 0.8).abs() < 1e-4);
        assert!(error.abs() < 0.025, "{error}");
    }
}
