//! The report of `campaign burov`: the paper's Figs. 5 and 6, its tables, and schedules under drift.

use super::{PRECISION, normal, precision};
use crate::campaign::burov::devices::{Device, ROTATION, SECONDS, curve};
use crate::campaign::burov::drift::{Comparison, Row};
use crate::campaign::burov::{LATITUDE_DEG, classes};
use crate::report::{Axis, Figure, Part, Report, Series, Style, Table};

/// Positions that the figures show.
const POSITIONS: std::ops::RangeInclusive<u32> = 5..=25;

/// The page for a campaign.
#[must_use]
pub fn report(devices: &[Device], drift: &[Comparison], classes: &[classes::Row]) -> Report {
    let errors = curve(POSITIONS);
    let mut parts: Vec<Part> = vec![
        figure("Fig. 5: change of the rate error with n", "change a position", change(&errors)),
        figure("Fig. 6: rate error after autocompensation", "rate error, 1σ", points(&errors)),
        curve_table(&errors).into(),
        device_table(devices).into(),
    ];
    parts.push(drift_table(drift).into());
    parts.push(class_table(classes).into());
    Report {
        title: "Burov: orientation systems with rotated sensing elements".to_owned(),
        subtitle: vec![
            format!("{SECONDS} s in all, {ROTATION} s a rotation, {LATITUDE_DEG}° of latitude"),
            "angles times the secant of the latitude; a full azimuth takes √2 of one axis"
                .to_owned(),
            normal(),
        ],
        parts,
    }
}

fn figure(title: &str, label: &str, curve: Vec<(f64, f64)>) -> Part {
    let figure = Figure {
        title: title.to_owned(),
        x: Axis::linear("number of positions n", ""),
        y: Axis::linear(label, "°/h"),
        series: vec![Series::new("eq. (1)", Style::LineAndPoints, curve)],
    };
    figure.into()
}

fn points(errors: &[(u32, f64)]) -> Vec<(f64, f64)> {
    errors.iter().map(|(n, error)| (f64::from(*n), *error)).collect()
}

/// The slope of Δω over n by differences, between the positions.
fn change(errors: &[(u32, f64)]) -> Vec<(f64, f64)> {
    errors.windows(2).map(|pair| (f64::from(pair[0].0) + 0.5, pair[1].1 - pair[0].1)).collect()
}

/// Positions of the table around the optimum.
const NEAR: std::ops::RangeInclusive<u32> = 8..=14;

fn curve_table(errors: &[(u32, f64)]) -> Table {
    let near = errors.iter().filter(|(n, _)| NEAR.contains(n));
    let row = |(n, error): &(u32, f64)| vec![n.to_string(), format!("{:.4}", error * 1e3)];
    let title = "Burov, eq. (1): error of a rate after autocompensation, OIUS-1000";
    let table = Table::new(title, &["positions n", "Δω, 10⁻³ °/h, 1σ"]);
    Table { rows: near.map(row).collect(), ..table }
}

fn device_table(devices: &[Device]) -> Table {
    let row = |device: &Device| {
        vec![
            device.name.to_owned(),
            format!("{:.5}", device.gyro.n_deg_sqrt_h),
            format!("{:.3}", device.gyro.r_deg_h2),
            device.positions.to_string(),
            format!("{:.3e}", device.rate_error_deg_h),
            format!("{:.3e}", device.with_flicker_deg_h),
            format!("{:.4}", device.three_sigma_secant_deg),
            format!("{:.4}", device.full_three_sigma_secant_deg),
            format!("{:.3}", device.without_secant_deg),
        ]
    };
    let head = [
        "device",
        "N, °/√h",
        "R, °/h²",
        "best n",
        "rate error, °/h",
        "with B, °/h",
        "one axis, 3σ, °·sec φ",
        "full azimuth, 3σ, °·sec φ",
        "without, 1 h, 3σ, °·sec φ",
    ];
    let title = "Table 2: devices with and without autocompensation";
    Table { rows: devices.iter().map(row).collect(), ..Table::new(title, &head) }
}

fn drift_table(drift: &[Comparison]) -> Table {
    let row = |name: &str, row: &Row, gain: String| -> Vec<String> {
        let gyro = &row.gyro;
        let (n, b, k, r) = (gyro.n_deg_sqrt_h, gyro.b_deg_h, gyro.k_deg_h_sqrt_h, gyro.r_deg_h2);
        let names = [
            format!("{name}: N {n} °/√h, B {b} °/h, K {k} °/h/√h, R {r} °/h²"),
            format!("{} of {:.2} s, {}", row.positions, row.dwell_s, row.order),
            format!("{:.4}", row.predicted_deg),
        ];
        names.into_iter().chain(precision(&row.precision)).chain([gain]).collect()
    };
    let both = |c: &Comparison| {
        let gain = format!("{:.3}", c.gain);
        [row("planned", &c.planned, String::new()), row("one pass", &c.one_pass, gain)]
    };
    let names = ["gyro", "positions", "predicted, °"].into_iter().chain(PRECISION);
    let head: Vec<&str> = names.chain(["worse by a factor of"]).collect();
    let table = Table::new("Schedules under drift", &head);
    Table { rows: drift.iter().flat_map(both).collect(), ..table }
}

fn class_table(rows: &[classes::Row]) -> Table {
    let row = |row: &classes::Row| {
        let (gyro, grade) = (row.gyro, &row.grade);
        let (n, b, k, r) =
            (grade.n_deg_sqrt_h, grade.b_deg_h, grade.k_deg_h_sqrt_h, grade.r_deg_h2);
        vec![
            row.class.to_owned(),
            format!("{:.2}", row.wanted_deg),
            row.minutes.to_string(),
            format!("{:.3}", row.three_rms_deg),
            format!("{:.3}", row.three_limit_deg),
            if row.is_met { "yes" } else { "no" }.to_owned(),
            row.way.clone(),
            format!("{gyro} ({n}, {b}, {k}, {r})"),
        ]
    };
    let head = [
        "class",
        "wanted, 3σ, °",
        "time, min",
        "3 RMS, °",
        "3 limits, °",
        "met",
        "how",
        "gyro (N °/√h, B °/h, K °/h/√h, R °/h²)",
    ];
    let title = "Table 1: azimuth in the time given";
    Table { rows: rows.iter().map(row).collect(), ..Table::new(title, &head) }
}
