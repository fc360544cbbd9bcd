//! The page of `campaign szymanowski`: errors before and after, and the tables.

use orientation::earth::Latitude;

use crate::campaign::statistics::Precision;
use crate::campaign::szymanowski::{drives, parked};
use crate::outcome::stops::figures;
use crate::output::named;
use crate::report::{Axis, Figure, Part, Report, Series, Style, Table};

/// The page for a campaign.
#[must_use]
pub fn report(drives: &[drives::Row], parked: &[parked::Row]) -> Report {
    let mut parts: Vec<Part> = vec![of_drives(drives).into(), of_parked(parked).into()];
    parts.extend(drives.iter().map(|row| errors(row).into()));
    let latitude = Latitude::from_degrees(drives::LATITUDE_DEG);
    parts.extend(latitude.map(|latitude| figures::heading_error(latitude, None).into()));
    let [walk, bias] = drives::GYRO;
    Report {
        title: "Azimuth from stops".to_owned(),
        subtitle: vec![
            format!(
                "Szymanowski 2003 over many drives; gyros of N {walk} °/√h and {bias} °/h (1σ)"
            ),
            "his Table 1, one drive each: 1.302° before, 0.390° after; 6.592° before, 3.195° after"
                .to_owned(),
        ],
        parts,
    }
}

fn of_drives(rows: &[drives::Row]) -> Table {
    let line = |row: &drives::Row| {
        let before = [row.averaging_rms_deg, row.plain_rms_deg].map(|rms| format!("{rms:.4}"));
        let differences = [row.brent_difference_deg, row.euler_difference_deg];
        let differences = differences.map(|difference| format!("{difference:.1e}"));
        let name = [row.case.to_owned()].into_iter();
        name.chain(before).chain(of_precision(&row.precision)).chain(differences).collect()
    };
    Table {
        title: "Drives: RMS errors, °".to_owned(),
        head: [
            named(&["drive", "before: averaging", "the paper's method"]),
            precision_head(),
            named(&["Brent's search off by", "in Euler form"]),
        ]
        .concat(),
        rows: rows.iter().map(line).collect(),
    }
}

fn of_parked(rows: &[parked::Row]) -> Table {
    let line = |row: &parked::Row| {
        let averaging = format!("{:.4}", row.averaging_rms_deg);
        let name = [row.case.to_owned(), averaging].into_iter();
        name.chain(of_precision(&row.precision)).collect()
    };
    Table {
        title: "Parked vehicles: RMS errors, °".to_owned(),
        head: [named(&["vehicle", "averaging"]), precision_head()].concat(),
        rows: rows.iter().map(line).collect(),
    }
}

fn precision_head() -> Vec<String> {
    named(&["everything", "limit", "error / limit", "within 1, 2, 3 σ, %", "runs", "refused"])
}

fn of_precision(row: &Precision) -> [String; 6] {
    let [one, two, three] = row.coverage_percent;
    [
        format!("{:.4}", row.rms_deg),
        format!("{:.4}", row.limit_deg),
        format!("{:.3}", row.ratio),
        format!("{one:.1}, {two:.1}, {three:.1}"),
        row.runs.to_string(),
        row.refused.to_string(),
    ]
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
