//! The page of `campaign burov`: the paper's Figs. 5 and 6, its tables, and schedules under drift.

use crate::campaign::burov::classes;
use crate::campaign::burov::devices::{Device, curve};
use crate::campaign::burov::drift::{Comparison, Row};
use crate::output::named;
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
        device_table(devices).into(),
    ];
    parts.push(drift_table(drift).into());
    parts.push(class_table(classes).into());
    Report {
        title: "Burov: orientation systems with rotated sensing elements".to_owned(),
        subtitle: vec![
            "device OIUS-1000: N 0.001 °/√h, R 0.127 °/h², 300 s, 2 s a rotation".to_owned(),
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

fn device_table(devices: &[Device]) -> Table {
    let row = |device: &Device| {
        vec![
            device.name.to_owned(),
            device.positions.to_string(),
            format!("{:.3e}", device.rate_error_deg_h),
            format!("{:.3e}", device.with_flicker_deg_h),
            format!("{:.4}", device.three_sigma_secant_deg),
            format!("{:.4}", device.full_three_sigma_secant_deg),
            format!("{:.3}", device.without_secant_deg),
        ]
    };
    Table {
        title: "Table 2: devices with and without autocompensation".to_owned(),
        head: named(&[
            "device",
            "best n",
            "rate error, °/h",
            "with B, °/h",
            "one axis, 3σ, °·sec φ",
            "full azimuth, 3σ, °·sec φ",
            "without, 1 h, 3σ, °·sec φ",
        ]),
        rows: devices.iter().map(row).collect(),
    }
}

fn drift_table(drift: &[Comparison]) -> Table {
    let row = |name: &str, row: &Row| {
        let [one, two, three] = row.precision.coverage_percent;
        vec![
            format!("N {} °/√h, {name}", row.gyro.n_deg_sqrt_h),
            format!("{} of {:.2} s, {}", row.positions, row.dwell_s, row.order),
            row.precision.runs.to_string(),
            format!("{:.4}", row.precision.rms_deg),
            format!("{:.4}", row.precision.limit_deg),
            format!("{:.3}", row.precision.ratio),
            format!("{one:.1}, {two:.1}, {three:.1}"),
        ]
    };
    let both = |c: &Comparison| [row("planned", &c.planned), row("one pass", &c.one_pass)];
    Table {
        title: "Schedules under drift".to_owned(),
        head: named(&[
            "gyro",
            "positions",
            "runs",
            "RMS, °",
            "limit, °",
            "RMS / limit",
            "within 1, 2, 3 σ, %",
        ]),
        rows: drift.iter().flat_map(both).collect(),
    }
}

fn class_table(rows: &[classes::Row]) -> Table {
    let row = |row: &classes::Row| {
        vec![
            row.class.to_owned(),
            format!("{:.2}", row.wanted_deg),
            row.minutes.to_string(),
            format!("{:.3}", row.three_rms_deg),
            row.gyro.to_owned(),
            row.way.clone(),
        ]
    };
    Table {
        title: "Table 1: azimuth in the time given".to_owned(),
        head: named(&["class", "wanted, 3σ, °", "time, min", "3 RMS, °", "gyro", "how"]),
        rows: rows.iter().map(row).collect(),
    }
}
