//! The tables of `campaign burov`.

use std::fmt::{self, Write};

use super::table::errors;
use crate::campaign::burov::LATITUDE_DEG;
use crate::campaign::burov::classes;
use crate::campaign::burov::devices::{Device, ROTATION, SECONDS};
use crate::campaign::burov::drift::{Comparison, Row};

/// Writes the paper's example and its Table 2.
///
/// # Errors
/// Those of the writer.
pub fn devices(out: &mut impl Write, curve: &[(u32, f64)], devices: &[Device]) -> fmt::Result {
    writeln!(
        out,
        "\nBurov, eq. (1): error of a rate after autocompensation, {SECONDS} s in all, {ROTATION} s a \
         rotation"
    )?;
    write!(out, "  n (Δω, 10⁻³ °/h, 1σ):")?;
    for (n, error) in curve {
        write!(out, " {n} ({:.4})", error * 1e3)?;
    }
    writeln!(
        out,
        "\n\n  {:<21} {:>8} {:>7} {:>3} {:>10} {:>10} {:>12} {:>12} {:>12}",
        "device",
        "N °/√h",
        "R °/h²",
        "n",
        "Δω °/h",
        "with B",
        "one axis 3σ",
        "full 3σ",
        "without, 1 h"
    )?;
    for device in devices {
        writeln!(
            out,
            "  {:<21} {:>8.5} {:>7.3} {:>3} {:>10.3e} {:>10.3e} {:>10.4}°  {:>10.4}°  {:>10.3}°",
            device.name,
            device.gyro.n_deg_sqrt_h,
            device.gyro.r_deg_h2,
            device.positions,
            device.rate_error_deg_h,
            device.with_flicker_deg_h,
            device.three_sigma_secant_deg,
            device.full_three_sigma_secant_deg,
            device.without_secant_deg
        )?;
    }
    writeln!(
        out,
        "  angles times the secant of the latitude; a full azimuth from one gyro takes √2 of it"
    )
}

/// Writes the schedules under drift.
///
/// # Errors
/// Those of the writer.
pub fn drift(out: &mut impl Write, comparisons: &[Comparison]) -> fmt::Result {
    for comparison in comparisons {
        let gyro = &comparison.planned.gyro;
        writeln!(
            out,
            "\nUnder drift: N {} °/√h, B {} °/h, K {} °/h/√h, R {} °/h²; {SECONDS} s in all, \
             {LATITUDE_DEG}° of latitude",
            gyro.n_deg_sqrt_h, gyro.b_deg_h, gyro.k_deg_h_sqrt_h, gyro.r_deg_h2
        )?;
        schedule(out, "planned", &comparison.planned)?;
        schedule(out, "one pass", &comparison.one_pass)?;
        writeln!(out, "  the plan is better by a factor of {:.3}", comparison.gain)?;
    }
    Ok(())
}

fn schedule(out: &mut impl Write, name: &str, row: &Row) -> fmt::Result {
    writeln!(
        out,
        " {name}: {} positions of {:.2} s, {}; predicted {:.4}°",
        row.positions, row.dwell_s, row.order, row.predicted_deg
    )?;
    errors(out, &row.precision)
}

/// Writes the five classes.
///
/// # Errors
/// Those of the writer.
pub fn classes(out: &mut impl Write, rows: &[classes::Row]) -> fmt::Result {
    writeln!(
        out,
        "\nBurov, Table 1: azimuth (3σ) in the time given, at {LATITUDE_DEG}° of latitude"
    )?;
    writeln!(
        out,
        "  {:<24} {:>7} {:>5} {:>9} {:>9} {:>5}  {:<36} gyro (N °/√h, B °/h, K °/h/√h, R °/h²)",
        "class", "wanted", "min", "3 RMS", "3 σ", "met", "how"
    )?;
    for row in rows {
        let grade = &row.grade;
        writeln!(
            out,
            "  {:<24} {:>6.2}° {:>5} {:>8.3}° {:>8.3}° {:>5}  {:<36} {} ({}, {}, {}, {})",
            row.class,
            row.wanted_deg,
            row.minutes,
            row.three_rms_deg,
            row.three_limit_deg,
            if row.is_met { "yes" } else { "no" },
            row.way,
            row.gyro,
            grade.n_deg_sqrt_h,
            grade.b_deg_h,
            grade.k_deg_h_sqrt_h,
            grade.r_deg_h2
        )?;
    }
    Ok(())
}
