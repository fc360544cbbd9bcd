//! The report of `campaign szymanowski`: errors before and after, and the tables.

use orientation::earth::Latitude;

use super::{PRECISION, normal, precision, reasons};
use crate::campaign::szymanowski::{drives, parked};
use crate::outcome::stops::figures;
use crate::report::{Axis, Figure, Part, Report, Series, Style, Table};

/// The page for a campaign.
#[must_use]
pub fn report(drives: &[drives::Row], parked: &[parked::Row]) -> Report {
    let mut parts: Vec<Part> = vec![of_drives(drives).into(), of_parked(parked).into()];
    parts.extend(drives.iter().map(|row| errors(row).into()));
    let latitude = Latitude::from_degrees(drives::LATITUDE_DEG);
    parts.extend(latitude.map(|latitude| figures::heading_error(latitude, None).into()));
    Report { title: "Azimuth from stops".to_owned(), subtitle: subtitle(drives, parked), parts }
}

/// What was simulated, and why any was refused.
fn subtitle(drives: &[drives::Row], parked: &[parked::Row]) -> Vec<String> {
    let ([walk, bias], [good_walk, good_bias]) = (drives::GYRO, parked::GOOD);
    let (stop, minutes, latitude) = (drives::STOP_S, drives::DRIVE_S / 60.0, drives::LATITUDE_DEG);
    let gyros = format!("gyros of N {walk} °/√h and {bias} °/h (1σ)");
    let times = format!("stops of {stop} s, {minutes} min from the first to the last, {latitude}°");
    let parked_s = parked::PARKED_S;
    let standing = format!("gyros of N {good_walk} °/√h and {good_bias} °/h (1σ)");
    let lines = [
        format!("Szymanowski 2003 over many drives: {times}; {gyros}"),
        "his Table 1, one drive each: 1.302° before, 0.390° after; 6.592° before, 3.195° after"
            .to_owned(),
        format!("parked for {parked_s} s: {standing}; sway of 0.5° at 0.1 Hz to 2 Hz"),
        normal(),
    ];
    let precisions = drives.iter().map(|row| &row.precision);
    let all = precisions.chain(parked.iter().map(|row| &row.precision));
    lines.into_iter().chain(reasons(all)).collect()
}

fn of_drives(rows: &[drives::Row]) -> Table {
    let line = |row: &drives::Row| {
        let before = [row.averaging_rms_deg, row.plain_rms_deg, row.plain_sigma_deg];
        let differences = [row.brent_difference_deg, row.euler_difference_deg];
        let differences = differences.map(|difference| format!("{difference:.1e}"));
        let biases = [row.bias_sigma_dph, row.bias_ratio]
            .map(|value| value.map_or_else(String::new, |value| format!("{value:.3}")));
        let cells = [row.case.to_owned()].into_iter().chain(before.map(|rms| format!("{rms:.4}")));
        cells.chain(precision(&row.precision)).chain(differences).chain(biases).collect()
    };
    let before = ["drive", "before: averaging, °", "the paper's method, °", "its σ, °"];
    let after =
        ["Brent's search off by, °", "in Euler form, °", "biases: σ, °/h", "error / σ of biases"];
    let head: Vec<&str> = before.into_iter().chain(PRECISION).chain(after).collect();
    Table { rows: rows.iter().map(line).collect(), ..Table::new("Drives: RMS errors", &head) }
}

fn of_parked(rows: &[parked::Row]) -> Table {
    let line = |row: &parked::Row| {
        let cells = [row.case.to_owned(), format!("{:.4}", row.averaging_rms_deg)];
        cells.into_iter().chain(precision(&row.precision)).collect()
    };
    let head: Vec<&str> = ["vehicle", "averaging, °"].into_iter().chain(PRECISION).collect();
    let table = Table::new("Parked vehicles: RMS errors", &head);
    Table { rows: rows.iter().map(line).collect(), ..table }
}

/// The error of each drive over that of averaging at its first stop.
fn errors(row: &drives::Row) -> Figure {
    Figure {
        title: format!("Error after over error before: {}", row.case),
        x: Axis::linear("averaging over the first stop", "°"),
        y: Axis::linear("azimuth at the end", "°"),
        series: vec![Series::new("one drive each", Style::Points, row.errors.iter().copied())],
    }
}
