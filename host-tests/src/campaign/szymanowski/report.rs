//! `campaign szymanowski`: its entry in the registry, and its report: errors before and after, and the tables.

use orientation::earth::Latitude;
use serde_json::json;

use super::{drives, parked};
use crate::campaign::columns::{Columns, normal, reasons};
use crate::campaign::statistics::Precision;
use crate::campaign::{Asked, Campaign, Done, Tick, one_by_one, unless};
use crate::methods::stops::outcome::figures;
use crate::report::{Figure, Part, Report, Series, Style};

/// Drives between stops, and parked vehicles.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "szymanowski",
    meaning: "Azimuth from stops: Szymanowski's Table 1 over many drives, and vehicles that stand and sway",
    runs: 500,
    steps: "vehicles",
    count: |asked| (drives::COUNT + parked::COUNT) * asked.runs,
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where none was refused.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let drives = one_by_one(0..drives::COUNT, tick, |case| drives::row(case, asked.runs, tick));
    let parked = one_by_one(0..parked::COUNT, tick, |case| parked::row(case, asked.runs, tick));
    let standing = parked.iter().map(|row| &row.precision);
    let all: Vec<_> = drives.iter().map(|row| &row.precision).chain(standing).collect();
    let found = all.iter().all(|precision| precision.is_complete());
    Done {
        refusal: unless(found, "a healthy vehicle was refused"),
        report: report(&drives, &parked).below(subtitle(all)),
        object: json!({ "drives": drives, "parked": parked }),
    }
}

/// The page for a campaign.
fn report(drives: &[drives::Row], parked: &[parked::Row]) -> Report {
    let mut parts = vec![of_drives(drives), of_parked(parked)];
    parts.extend(drives.iter().map(errors));
    let latitude = Latitude::from_degrees(drives::LATITUDE_DEG);
    parts.extend(latitude.map(|latitude| figures::heading_error(latitude, None).into()));
    Report::new("Azimuth from stops", parts)
}

/// What was simulated, and why any was refused.
fn subtitle(healthy: Vec<&Precision>) -> Vec<String> {
    let ([walk, bias], [good_walk, good_bias]) = (drives::GYRO, parked::GOOD);
    let (stop, minutes, latitude) = (drives::STOP_S, drives::DRIVE_S / 60.0, drives::LATITUDE_DEG);
    let gyros = format!("gyros of N {walk} °/√h and {bias} °/h (1σ)");
    let times = format!("stops of {stop} s, {minutes} min from the first to the last, {latitude}°");
    let parked_s = parked::PARKED_S;
    let standing = format!("gyros of N {good_walk} °/√h and {good_bias} °/h (1σ)");
    let lines = [
        format!("Szymanowski 2003 over many drives: {times}; {gyros}"),
        "his Table 1, one drive each: 1.302° before, 0.390° after; 6.592° before, 3.195° after"
            .into(),
        format!("parked for {parked_s} s: {standing}; sway of 0.5° at 0.1 Hz to 2 Hz"),
        normal(),
    ];
    lines.into_iter().chain(reasons(healthy)).collect()
}

fn of_drives(rows: &[drives::Row]) -> Part {
    let bias = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    Columns::of("Drives: RMS errors", rows)
        .column("drive", |row| row.case)
        .fixed("before: averaging, °", 4, |row| row.averaging_rms_deg)
        .fixed("the paper's method, °", 4, |row| row.plain_rms_deg)
        .fixed("its σ, °", 4, |row| row.plain_sigma_deg)
        .precision(|row| &row.precision)
        .scientific("Brent's search off by, °", 1, |row| row.brent_difference_deg)
        .scientific("in Euler form, °", 1, |row| row.euler_difference_deg)
        .column("biases: σ, °/h", |row| bias(row.bias_sigma_dph))
        .column("error / σ of biases", |row| bias(row.bias_ratio))
        .into()
}

fn of_parked(rows: &[parked::Row]) -> Part {
    Columns::of("Parked vehicles: RMS errors", rows)
        .column("vehicle", |row| row.case)
        .fixed("averaging, °", 4, |row| row.averaging_rms_deg)
        .precision(|row| &row.precision)
        .into()
}

/// The error of each drive over that of averaging at its first stop.
fn errors(row: &drives::Row) -> Part {
    let title = format!("Error after over error before: {}", row.case);
    let series = Series::new("one drive each", Style::Points, row.errors.iter().copied());
    let before = ["averaging over the first stop", "°"];
    Figure::new(title, before, ["azimuth at the end", "°"], [series]).into()
}
