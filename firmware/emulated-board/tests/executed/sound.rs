//! What holds today.

use emulated_board::run::Order;
use execution::built::root;
use execution::report::{FlashUse, Report};
use firmware::budget;
use firmware::platform::Platform;

use super::support::angles::distance;
use super::support::executed::{Executed, execute_anew, executed, executed_by};
use super::support::sentences::states;

/// Carriers whose alignment ends with an azimuth.
const ALIGNED: [Platform; 3] = [Platform::Stage, Platform::Turntable, Platform::Vehicle];

/// The azimuth and its 1σ, °.
pub(super) fn azimuth(report: &Report) -> (f64, f64) {
    let [azimuth, sigma, _] = report.azimuth_deg.unwrap_or_else(|| panic!("{}", report.outcome));
    (azimuth, sigma)
}

#[test]
fn every_carrier_starts_with_its_record_and_its_chips_pass_their_self_tests() {
    let axis = ["stage", "base", "accelerometer", "encoder", "gyro"];
    let frames = [
        "outer frame",
        "inner frame",
        "base",
        "accelerometer",
        "outer encoder",
        "inner encoder",
        "gyro",
    ];
    let triad = ["accelerometer", "forward gyro", "right gyro", "down gyro"];
    let spin = ["forward gyro", "up gyro", "right gyro", "up accelerometer", "right accelerometer"];
    let chips: [&[&str]; 5] = [&axis, &frames, &axis, &triad, &spin];
    for (carrier, chips) in Platform::ALL.into_iter().zip(chips) {
        let shown = executed(carrier, 1);
        let first = |count| {
            shown.log.iter().map(|entry| entry.words.clone()).take(count).collect::<Vec<_>>()
        };
        let begin = [
            "board: started by Supply, clock follows its crystal: true".to_owned(),
            format!("board: carrier {carrier}, latitude 47.58°, settings of a record in flash"),
        ];
        assert_eq!(first(2), begin);
        let passed: Vec<_> = shown.lines("identity and self-test passed, configured").collect();
        let passed = passed.iter().map(|entry| entry.words.split(": ").next().unwrap_or_default());
        assert_eq!(passed.collect::<Vec<_>>(), chips, "{carrier}");
    }
}

#[test]
fn no_chip_and_no_bus_is_used_as_its_data_sheet_forbids() {
    for carrier in Platform::ALL {
        assert_eq!(executed(carrier, 1).report.violations, [""; 0], "{carrier}");
    }
}

#[test]
fn azimuths_are_within_three_sigma_of_the_truth() {
    for (carrier, seed) in ALIGNED.into_iter().flat_map(|carrier| [(carrier, 1), (carrier, 2)]) {
        let report = &executed(carrier, seed).report;
        let (azimuth, sigma) = azimuth(report);
        let error = distance(azimuth, report.truth_deg);
        assert!(error <= 3.0 * sigma, "{carrier}, seed {seed}: {error}° at a σ of {sigma}°");
    }
}

#[test]
fn an_azimuth_hardly_depends_on_the_cycles_of_an_instruction() {
    for carrier in [Platform::Stage, Platform::Vehicle] {
        let usual = Order::usual(carrier, 1);
        let quick = executed_by(&Order { cycles: 0.5 * usual.cycles, ..usual });
        let ((azimuth, sigma), (quick, _)) =
            (azimuth(&executed_by(&usual).report), azimuth(&quick.report));
        let change = distance(azimuth, quick);
        // A dwell or a stop that begins some samples earlier has other noise.
        assert!(change <= 0.5 * sigma, "{carrier}: {change}° at a σ of {sigma}°");
    }
}

#[test]
fn an_order_that_is_executed_twice_shows_the_same() {
    let text = |shown: &Executed| {
        let report = serde_json::to_string(&shown.report).expect("a report is written as JSON");
        (report, shown.text(), shown.link.clone())
    };
    let order = Order::usual(Platform::TwoFrame, 1);
    assert_eq!(text(&executed_by(&order)), text(&execute_anew(&order)));
}

#[test]
fn flash_and_static_ram_of_every_image_are_within_the_budget() {
    for carrier in Platform::ALL {
        let Report { flash_bytes, static_bytes, .. } = executed(carrier, 1).report;
        assert!(
            u64::from(flash_bytes) <= budget::BOARD_FLASH_BYTES,
            "{carrier}: {flash_bytes} bytes of flash"
        );
        assert!(
            u64::from(static_bytes) <= budget::BOARD_STATIC_RAM_BYTES,
            "{carrier}: {static_bytes} bytes of RAM"
        );
    }
}

#[test]
fn conversions_that_are_read_and_lost_are_those_that_the_converters_make() {
    let converters = [
        (Platform::Stage, 1.0, 400.0),
        (Platform::Turntable, 1.0, 400.0),
        (Platform::TwoFrame, 1.0, 400.0),
        (Platform::Vehicle, 3.0, 400.0),
        (Platform::Spin, 5.0, 14_400.0),
    ];
    for (carrier, converters, hertz) in converters {
        let shown = executed(carrier, 1);
        let afterwards =
            if carrier == Platform::Spin { 0.0 } else { Order::usual(carrier, 1).afterwards };
        // The board's own time begins with its clocks.
        let first = shown.line("board: started by").seconds;
        let end = shown.report.seconds + afterwards - (shown.report.start_seconds - first);
        // They are counted from when the last chip is configured.
        let last = shown.lines("identity and self-test passed, configured").last();
        let begin = last.expect("chips are configured").seconds;
        let made = (end - begin) * hertz * converters;
        let counted: u64 =
            shown.report.service.iter().map(|service| service.read + service.lost).sum();
        let off = (counted as f64 / made - 1.0).abs();
        assert!(off <= 0.01, "{carrier}: {counted} conversions, of {made} that are made");
    }
}

#[test]
fn instructions_and_sleep_together_are_the_time_of_the_measurement() {
    for carrier in ALIGNED {
        let Report { samples, instructions_per_sample, cycles_per_instruction, idle, .. } =
            executed(carrier, 1).report;
        let instructions_per_sample = instructions_per_sample.expect("it has measured");
        let parts: f64 = executed(carrier, 1).report.instructions_by_origin.values().sum();
        assert!(
            (parts / instructions_per_sample - 1.0).abs() < 1e-9,
            "{carrier}: {parts} in parts"
        );
        // 122 periods of the crystal where there were 4 MHz, times 16.
        let hertz = 16.0 * 122.0 * 32_768.0;
        let busy = instructions_per_sample * cycles_per_instruction / hertz * 400.0;
        assert!(
            ((busy + idle) - 1.0).abs() < 0.01,
            "{carrier}: {busy} busy, {idle} asleep, {samples} samples"
        );
    }
}

#[test]
fn a_heading_in_flash_takes_twelve_rows_and_one_that_declares_it_void() {
    for carrier in [Platform::Stage, Platform::Vehicle] {
        let FlashUse { rows, pages, .. } = executed(carrier, 1).report.flash_use;
        let is_whole = rows > 0 && matches!(rows % 13, 0 | 12);
        assert!(is_whole && pages == 0, "{carrier}: {rows} rows, {pages} pages");
    }
}

#[test]
fn a_vehicle_loses_nothing_from_when_its_converters_are_configured_until_its_conclusion() {
    let shown = executed(Platform::Vehicle, 1);
    assert_eq!(shown.report.service[0].lost, 0);
    let states = states(shown.link.iter().map(String::as_str));
    let until = states.iter().take_while(|state| state[1].is_empty());
    assert!(until.clone().count() > 90, "the link says something every second");
    until.for_each(|state| assert_eq!([state[0], state[4]], ["aligning", "0"], "{state:?}"));
}

#[test]
fn every_key_of_a_report_is_described() {
    let page = std::fs::read_to_string(root().join("firmware/emulated-board/README.md"))
        .expect("the page can be read");
    let report = serde_json::to_value(&executed(Platform::Stage, 1).report).expect("an object");
    let keys = report.as_object().expect("an object").keys();
    let missing: Vec<_> = keys.filter(|key| !page.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "{missing:?}");
}
