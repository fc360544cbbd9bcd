//! The campaign of spinning bodies as `ACCURACY.md` prints it: the paper's second, and flights with noise.

use host::campaign::spin::cases::{self, Row, Spot};
use host::campaign::spin::paper;
use host::campaign::statistics::Spread;

use crate::support::campaign::{Extent, assert_in_accuracy, campaigns};

/// Flights in each row.
const RUNS: usize = 200;

#[test]
fn the_papers_second_gives_its_figures() {
    let paper = paper::paper();
    // Ω δk t: 36° of 100 turns; a quarter of a turn between corrections, its first sample corrected.
    assert!((paper.uncorrected_deg - 0.36 * paper::TURNS_PER_S).abs() < 0.01, "{paper:?}");
    assert!((paper.growth_deg - 0.09).abs() < 0.005, "{paper:?}");
    assert!((paper.corrections_per_turn - 4.0).abs() < 0.05, "{paper:?}");
    let [extrema, interpolated, locked] = [0, 1, 2].map(|index: usize| paper.methods[index].1);
    assert!(extrema < 1.1 && interpolated < 0.06 && locked < 0.002, "{paper:?}");
    assert!(paper.scale_miss.abs() < 1e-7, "{paper:?}");
    assert_in_accuracy(&[format!(
        "36.1° after a second without correction, {extrema:.2}° RMS with corrections at bare extrema, {interpolated:.3}° \
         interpolated, {locked:.5}° by phase lock"
    )]);
}

/// RMS error, limit and coverage at a moment.
fn figures(spot: &Spot) -> String {
    let Spot { spread: Spread { rms_deg, coverage_percent: [one, two, three], .. }, limit_deg } =
        spot;
    format!("{rms_deg:.4}° | {limit_deg:.4}° | {one:.1}, {two:.1}, {three:.1} % |")
}

/// The row of flights, and of what they held without lift.
fn text(row: &Row) -> Vec<String> {
    let [extrema, interpolated, locked] = row.rms_deg;
    let methods =
        format!("{extrema:.1}° | {interpolated:.1}° | {locked:.3}° | {:.3}°", row.limit_deg);
    let whole = format!("| {} | {methods} | {}", row.case, figures(&row.end));
    let held = row.held.as_ref();
    let held = held.map(|held| format!("| before the lift comes back | | | | | {}", figures(held)));
    [whole].into_iter().chain(held).collect()
}

campaigns! { noise_a_weak_gyro_and_a_missing_lift_stay_within_sigma_and_lose_no_turn; }

fn noise_a_weak_gyro_and_a_missing_lift_stay_within_sigma_and_lose_no_turn(extent: Extent) {
    let runs = extent.of(RUNS);
    let rows: Vec<_> = (0..cases::COUNT).map(|case| cases::row(case, runs, &|| {})).collect();
    // Of all, eight points fewer, and none far beyond.
    let [of_one, of_three] = [(8.3, 68.3), (1.7, 99.7)]
        .map(|(whole, normal)| normal - extent.share(whole, normal, runs));
    for row in &rows {
        assert_eq!((row.lost, row.miscounted), (0, 0), "{row:?}");
        for spot in [Some(&row.end), row.held.as_ref()].into_iter().flatten() {
            let [one, _, three] = spot.spread.coverage_percent;
            assert!(one > of_one && three > of_three, "{row:?}");
        }
    }
    for row in &rows[1..] {
        let [extrema, interpolated, locked] = row.rms_deg;
        assert!(extrema > 90.0 && interpolated > 90.0 && locked < 0.25, "{row:?}");
    }
    extent.assert_in_accuracy(&rows.iter().flat_map(text).collect::<Vec<_>>());
}
