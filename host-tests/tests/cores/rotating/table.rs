//! Cosine and sine of any angle from the stored quarter, against the standard library's.

use orientation::math::reference_table::Table;
use orientation::units::Angle;
use proptest::prelude::*;

/// 2³⁰.
const ONE: f64 = 1_073_741_824.0;

fn assert_at(angle: u32) {
    // A step of an angle is 2⁻³² of a turn: exact in f64.
    let radians = f64::from(angle) * (std::f64::consts::TAU / 4_294_967_296.0);
    let found = Table::built_in().at(Angle(angle));
    let exact = [radians.cos(), radians.sin()].map(|value| value * ONE);
    for (found, exact) in found.iter().zip(exact) {
        let off = f64::from(*found) - exact;
        // A cosine of exactly 2³⁰ must not be cut off.
        assert!(off.abs() <= BOUND, "{found} is not {exact} at {angle:#x}");
    }
}

/// As [`Table::at`] states it.
const BOUND: f64 = 2.0;

proptest! {
    #[test]
    fn cosine_and_sine_of_any_angle_are_within_the_stated_bound(angle in any::<u32>()) {
        assert_at(angle);
    }
}

#[test]
fn they_are_on_a_dense_grid_and_beside_every_quadrant() {
    let dense = (0..2_000_000_u64).map(|number| (number * 4_294_967_291 / 2_000_000) as u32);
    dense.for_each(assert_at);
    for quadrant in 0..4_u32 {
        for beside in 0..4000_u32 {
            assert_at((quadrant << 30).wrapping_add(beside));
            assert_at((quadrant << 30).wrapping_sub(beside * 37));
        }
    }
}
