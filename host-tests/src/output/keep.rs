//! The table of `campaign keep`.

use std::fmt::{self, Write};

use crate::campaign::burov::LATITUDE_DEG;
use crate::campaign::keep::{Row, Spread};

/// Writes what keeping gave, class by class.
///
/// # Errors
/// Those of the writer.
pub fn rows(out: &mut impl Write, rows: &[Row]) -> fmt::Result {
    writeln!(
        out,
        "\nBurov, Table 1: azimuth stored for 0.5 h, pitch and roll meanwhile (1σ); a vehicle that drives without a \
         halt, at {LATITUDE_DEG}° of latitude"
    )?;
    for row in rows {
        let Row { class, gyro, mount, way, runs, grade, .. } = row;
        let (n, b, k, r) =
            (grade.n_deg_sqrt_h, grade.b_deg_h, grade.k_deg_h_sqrt_h, grade.r_deg_h2);
        writeln!(out, "\n{class}: {gyro} (N {n} °/√h, B {b} °/h, K {k} °/h/√h, R {r} °/h²)")?;
        writeln!(out, "  {mount}; {way}; {runs} runs")?;
        let (wanted, limit) = (row.wanted_azimuth_deg, row.azimuth_limit_deg);
        let azimuth = format!("{wanted:.2}° wanted, limit {limit:.3}°");
        spread(out, "azimuth after 0.5 h", &row.azimuth, &azimuth)?;
        spread(out, "azimuth while driving", &row.azimuth_driving, "")?;
        let level = format!("{:.2}° wanted", row.wanted_level_deg);
        spread(out, "pitch, roll on the way", &row.level, &level)?;
        spread(out, "pitch, roll at rest", &row.level_at_rest, "")?;
        if row.lost > 0 {
            writeln!(out, "  azimuth lost in {} of {runs} runs", row.lost)?;
        }
        let met = if row.is_met { "met" } else { "not met" };
        writeln!(out, "  {met}{}", if row.is_wanted { "" } else { " (for comparison)" })?;
    }
    Ok(())
}

fn spread(out: &mut impl Write, name: &str, spread: &Spread, more: &str) -> fmt::Result {
    let Spread { rms_deg, sigma_deg, coverage_percent: [one, two, three] } = spread;
    writeln!(
        out,
        "  {name:<24} RMS {rms_deg:>6.3}°, σ {sigma_deg:>6.3}°, within 1, 2, 3 σ {one:.1}, {two:.1}, {three:.1} %  {more}"
    )
}
