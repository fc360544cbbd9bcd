//! `campaign burov`: its entry in the registry, and its report: the paper's Figs. 5 and 6, its tables, and schedules under drift.

use serde_json::json;

use super::devices::{Device, ROTATION, SECONDS, curve};
use super::drift::Comparison;
use super::{LATITUDE_DEG, classes, devices, drift};
use crate::campaign::columns::{Columns, normal};
use crate::campaign::{Asked, Campaign, Done, Tick, one_by_one, tenth, unless};
use crate::report::{Figure, Part, Report, Series, Style};

/// The paper's example and devices, schedules under drift, the five classes.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "burov",
    meaning: "Burov's optimisation, his devices and classes, and schedules under drift",
    runs: 5000,
    steps: "alignments",
    count: |asked| 2 * drift::GYROS.len() * asked.runs + classes::COUNT * tenth(asked.runs),
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where every row of the classes is met.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let drift = one_by_one(drift::GYROS, tick, |gyro| drift::compare(gyro, asked.runs, tick));
    let drift: Vec<_> = drift.into_iter().flatten().collect();
    let classes = classes::rows(tenth(asked.runs), tick);
    let (curve, devices) = (curve(8..=14), devices::devices());
    let reason =
        "a class does not meet its row; with few runs (a tenth of --runs) that may be chance";
    Done {
        report: report(&devices, &drift, &classes),
        refusal: unless(classes.iter().all(|row| row.is_met), reason),
        object: json!({
            "devices": devices, "rate_error_deg_h": curve, "drift": drift, "classes": classes,
        }),
    }
}

/// Positions that the figures show.
const POSITIONS: std::ops::RangeInclusive<u32> = 5..=25;
/// Positions of the table around the optimum.
const NEAR: std::ops::RangeInclusive<u32> = 8..=14;

/// The page for a campaign.
fn report(devices: &[Device], drift: &[Comparison], classes: &[classes::Row]) -> Report {
    let errors = curve(POSITIONS);
    let points = errors.iter().map(|(n, error)| (f64::from(*n), *error)).collect();
    let fig_5 = "Fig. 5: change of the rate error with n";
    let fig_6 = "Fig. 6: rate error after autocompensation";
    let parts = [
        over_positions(fig_5, "change a position", change(&errors)),
        over_positions(fig_6, "rate error, 1σ", points),
        of_curve(&errors),
        of_devices(devices),
        of_drift(drift),
        of_classes(classes),
    ];
    Report::new("Burov: autocompensation, devices and classes", parts).below([
        &format!("{SECONDS} s in all, {ROTATION} s a rotation, {LATITUDE_DEG}° of latitude"),
        "angles times the secant of the latitude; a full azimuth takes √2 of one axis",
        &normal(),
    ])
}

fn over_positions(title: &str, label: &str, curve: Vec<(f64, f64)>) -> Part {
    let series = Series::new("autocompensation", Style::LineAndPoints, curve);
    Figure::new(title, ["number of positions n", ""], [label, "°/h"], [series]).into()
}

/// The slope of Δω over n by differences, between the positions.
fn change(errors: &[(u32, f64)]) -> Vec<(f64, f64)> {
    errors.windows(2).map(|pair| (f64::from(pair[0].0) + 0.5, pair[1].1 - pair[0].1)).collect()
}

fn of_curve(errors: &[(u32, f64)]) -> Part {
    let near: Vec<_> = errors.iter().filter(|(n, _)| NEAR.contains(n)).collect();
    Columns::of("Burov: error of a rate after autocompensation, OIUS-1000", &near)
        .column("positions n", |(n, _)| n)
        .fixed("Δω, 10⁻³ °/h, 1σ", 4, |(_, error)| error * 1e3)
        .into()
}

fn of_devices(devices: &[Device]) -> Part {
    Columns::of("Table 2: devices with and without autocompensation", devices)
        .column("device", |device| device.name)
        .fixed("N, °/√h", 5, |device| device.gyro.n_deg_sqrt_h)
        .fixed("R, °/h²", 3, |device| device.gyro.r_deg_h2)
        .column("best n", |device| device.positions)
        .scientific("rate error, °/h", 3, |device| device.rate_error_deg_h)
        .scientific("with B, °/h", 3, |device| device.with_flicker_deg_h)
        .fixed("one axis, 3σ, °·sec φ", 4, |device| device.three_sigma_secant_deg)
        .fixed("full azimuth, 3σ, °·sec φ", 4, |device| device.full_three_sigma_secant_deg)
        .fixed("without, 1 h, 3σ, °·sec φ", 3, |device| device.without_secant_deg)
        .into()
}

fn of_drift(drift: &[Comparison]) -> Part {
    let both = |found: &Comparison| {
        let gain = format!("{:.3}", found.gain);
        [
            ("planned", found.planned.clone(), String::new()),
            ("one pass", found.one_pass.clone(), gain),
        ]
    };
    let rows: Vec<_> = drift.iter().flat_map(both).collect();
    Columns::of("Schedules under drift", &rows)
        .column("gyro", |(name, row, _)| format!("{name}: {}", row.gyro))
        .column("positions", |(_, row, _)| {
            format!("{} of {:.2} s, {}", row.positions, row.dwell_s, row.order)
        })
        .fixed("predicted, °", 4, |(_, row, _)| row.predicted_deg)
        .precision(|(_, row, _)| &row.precision)
        .column("worse by a factor of", |(.., gain)| gain)
        .into()
}

fn of_classes(rows: &[classes::Row]) -> Part {
    Columns::of("Table 1: azimuth in the time given", rows)
        .column("class", |row| row.class.name)
        .fixed("wanted, 3σ, °", 2, |row| row.class.wanted_deg)
        .column("time, min", |row| row.class.minutes)
        .fixed("3 RMS, °", 3, |row| row.three_rms_deg)
        .fixed("3 limits, °", 3, |row| row.three_limit_deg)
        .column("met", |row| if row.is_met { "yes" } else { "no" })
        .column("how", |row| &row.way)
        .column("gyro (N °/√h, B °/h, K °/h/√h, R °/h²)", |row| {
            format!(
                "{} ({})",
                row.class.gyro,
                row.class.grade.values().map(|value| value.to_string()).join(", ")
            )
        })
        .into()
}
