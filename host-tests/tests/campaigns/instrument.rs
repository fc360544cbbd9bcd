//! Whole instruments on simulated chips: many healthy boards, as `ACCURACY.md` prints them, and every fault of every chip.

use host::campaign::faults::{self, WRONG_SIGMAS};
use host::campaign::instrument::{self, Runs};
use host::campaign::statistics::{NORMAL_COVERAGE, Precision};

use simulated::fault::Platform;

use crate::support::campaign::{Extent, campaigns};

/// Boards.
const RUNS: usize = 500;

campaigns! {
    north_is_found_as_well_as_the_limit_allows_over_sites_attitudes_and_tilts;
    every_fault_of_every_chip_is_survived_or_refused_for_its_reason_and_nothing_hangs;
    on_no_platform_a_fault_gives_a_wrong_north_or_roll_comes_to_no_end_or_goes_unnoticed;
}

fn on_no_platform_a_fault_gives_a_wrong_north_or_roll_comes_to_no_end_or_goes_unnoticed(
    extent: Extent,
) {
    // `cargo test` draws the quickest platform.
    let (platforms, seeds) = match extent {
        Extent::Tenth => (&[Platform::Spin][..], 1),
        Extent::Whole => (&Platform::ALL[..], 2),
    };
    let rows = faults::rows(platforms, 1..=seeds, &|| ());
    assert_eq!(rows.len(), seeds as usize * faults::count(platforms));
    for platform in platforms {
        assert!(rows.iter().any(|row| row.platform == platform.name() && row.outcome == "ok"));
    }
    let bad: Vec<_> = rows.iter().filter(|row| row.is_bad()).collect();
    assert!(bad.is_empty(), "{bad:#?}");
}

fn north_is_found_as_well_as_the_limit_allows_over_sites_attitudes_and_tilts(extent: Extent) {
    let wanted = extent.of(RUNS);
    let Runs { precision: found, violations, .. } =
        &instrument::precision(wanted, &|| ()).expect("all are possible");
    let Precision { runs, refused, ratio, coverage_percent, .. } = found;
    assert_eq!((runs, refused, violations), (&wanted, &0, &0), "{found:?}");
    assert!(*ratio <= 1.0 + extent.rms(0.06, wanted), "{found:?}");
    for (found, normal) in coverage_percent.iter().zip(NORMAL_COVERAGE) {
        let chance = extent.share(2.5, normal, wanted);
        assert!((found - normal).abs() <= chance, "{found} % instead of {normal} %");
    }
    let [one, two, three] = coverage_percent;
    let row = format!(
        "| 24 positions of 15°, the first once more | {:.4}° | {:.4}° | {ratio:.3} | {one:.1}, {two:.1}, {three:.1} % |",
        found.rms_deg, found.limit_deg
    );
    extent.assert_in_accuracy(&[row]);
}

/// What a fault must come to: an azimuth, or a refusal whose reason says this.
fn expected(fault: &str) -> Option<&'static str> {
    const NOT_THERE: &str = "another chip answers, or none";
    let (device, chip_fault) = fault.split_once('-').expect("device and its fault");
    let [is_gyro, is_stage] = ["gyro", "stage"].map(|name| device == name);
    let is_force = device == "accelerometer";
    match chip_fault {
        "identity" => Some(NOT_THERE),
        "silent" => Some("gives no more data"),
        // Without a checksum a broken reply shows in identity or read-back, after a while.
        "checksum-always" | "stuck" if is_stage => Some("stage: "),
        "checksum-always" if is_force => Some("accelerometer: "),
        "checksum-always" => Some("fail their checksum"),
        "stuck" if device == "encoder" => Some("encoder: "),
        "stuck" => Some("the same reading for ever"),
        "bus-always" => Some("its bus fails"),
        "hang-always" if is_gyro => Some("its bus hangs"),
        "blocked" => Some("it is blocked at 75"),
        "limit" => Some("it is blocked at 200"),
        "slip" | "slip-at-start" | "creep" => Some("motor and encoder disagree"),
        "always" => Some("at the limit of its range"),
        _ => None,
    }
}

fn every_fault_of_every_chip_is_survived_or_refused_for_its_reason_and_nothing_hangs(
    extent: Extent,
) {
    let seeds = match extent {
        Extent::Tenth => 1,
        Extent::Whole => 2,
    };
    let rows = faults::rows(&[Platform::Stage], 1..=seeds, &|| ());
    assert_eq!(
        rows.len(),
        seeds as usize * (4 * 10 + 3 + 15),
        "every chip with all its faults, and the rest"
    );
    for row in rows.iter().filter(|row| !row.fault.starts_with("coarse-imu")) {
        // The default session takes 276 s; what was lost is measured again, retry budget has its limits.
        assert!(row.seconds < 400.0, "{row:?} takes too long");
        match (expected(&row.fault), &row.reason) {
            (None, None) => {
                let sigmas = row.error_sigmas.expect("an azimuth");
                assert!(sigmas.abs() <= WRONG_SIGMAS, "{row:?}: a wrong north");
            }
            (Some(part), Some(reason)) => assert!(reason.contains(part), "{row:?}: not {part}"),
            _ => panic!("{row:?}"),
        }
    }
    what_is_survived_is_noticed(&rows);
}

/// What the board must have noticed of faults that it survives.
fn what_is_survived_is_noticed(rows: &[faults::Row]) {
    for (fault, part) in [
        ("gyro-checksum-once", "gyro: reading lost: wrong checksum"),
        ("encoder-checksum-once", "encoder: reading lost: wrong checksum"),
        ("gyro-silent-once", "1 sample(s) missing"),
        ("encoder-silent-once", "encoder: reading lost: too far from the one before"),
        ("gyro-bus-once", "gyro: reading lost: bus error"),
        ("accelerometer-reset", "accelerometer: it has restarted: starting it again"),
        ("encoder-reset", "encoder: it has restarted: starting it again"),
        ("stage-reset", "stage: it has restarted: starting it again"),
        ("gyro-hang", "gyro: reading lost: its bus hangs"),
        ("stage-blocked-once", "stage: blocked, trying again"),
        ("saturation-once", "gyro: at the limit of its range"),
        ("overflow-once", "the queue was full"),
        ("door-slam", "is measured again"),
        ("base-nudge", "is measured again"),
    ] {
        let row = rows.iter().find(|row| row.fault == fault).expect(fault);
        let noticed = row.noticed.as_deref().unwrap_or("nothing");
        assert!(noticed.contains(part), "{fault}: {noticed}");
    }
}
