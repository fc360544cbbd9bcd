//! Schedules, for people.

pub mod page;

use std::fmt::{self, Write};

use orientation::planner::FEWEST;
use orientation::units::{ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR};

use super::degrees;
use crate::planning::{Optimum, Planned, Request, Wanted};

/// Writes what was planned.
///
/// # Errors
/// Those of the writer.
pub fn block(out: &mut impl Write, request: &Request, planned: &Planned) -> fmt::Result {
    asked(out, request)?;
    of_burov(out, planned)?;
    optimum(out, &planned.optimum, planned.one_pass_sigma_deg)
}

fn of_burov(out: &mut impl Write, planned: &Planned) -> fmt::Result {
    writeln!(out, "\nBurov's eq. (1): the error of a rate, 1σ")?;
    let Some(burov) = &planned.burov else {
        let least = planned.burov_least_sigma_deg.unwrap_or(f64::NAN);
        return writeln!(
            out,
            "  out of reach: with the B that no turning takes away in this model, a full azimuth has \
             at least {least:.4}° (1σ)"
        );
    };
    writeln!(
        out,
        "  {} positions of {:.2} s, {:.1} s in all: {:.4e} °/h; with B {:.4e} °/h",
        burov.positions,
        burov.dwell_s,
        burov.seconds,
        burov.rate_error_deg_h,
        burov.rate_error_deg_h.hypot(burov.flicker_deg_h)
    )?;
    writeln!(
        out,
        "  as an azimuth along one axis (its half known): {:.4}° (1σ), {:.4}° (3σ)",
        burov.one_axis_sigma_deg,
        3.0 * burov.one_axis_sigma_deg
    )?;
    writeln!(
        out,
        "  as a full azimuth from one gyro, √2 of that:   {:.4}° (1σ), {:.4}° (3σ)",
        burov.sigma_deg,
        3.0 * burov.sigma_deg
    )
}

/// Writes the project's own schedule.
///
/// # Errors
/// Those of the writer.
pub fn optimum(out: &mut impl Write, optimum: &Optimum, one_pass: Option<f64>) -> fmt::Result {
    writeln!(
        out,
        "\nThe best for Meridian's fit with {FEWEST} positions or more, so that a disturbed dwell is \
         noticed:\nthe covariance of a full azimuth, noise alone"
    )?;
    writeln!(
        out,
        "  {} positions of {:.2} s, {:.1} s in all: {:.4}° (1σ), {:.4}° (3σ)",
        optimum.positions,
        optimum.dwell_s,
        optimum.seconds,
        optimum.sigma_deg,
        3.0 * optimum.sigma_deg
    )?;
    writeln!(out, "  order {}, {} passes", optimum.order, optimum.passes)?;
    if let Some(sigma) = one_pass {
        let ratio = sigma / optimum.sigma_deg;
        let but = if ratio < 1.0 { "; but it would not notice a disturbed dwell" } else { "" };
        writeln!(
            out,
            "  one pass of 0, 180, 90, 270° in the same time: {sigma:.4}° (1σ), {ratio:.2} times as much{but}"
        )?;
    }
    Ok(())
}

/// Writes what was asked.
///
/// # Errors
/// Those of the writer.
pub fn asked(out: &mut impl Write, request: &Request) -> fmt::Result {
    let noise = &request.noise;
    writeln!(
        out,
        "\nGyro: N {} °/√h, B {} °/h, K {} °/h/√h, R {} °/h², Q {}″",
        rounded(noise.angle_random_walk / DEGREE_PER_SQRT_HOUR),
        rounded(noise.bias_instability / DEGREE_PER_HOUR),
        rounded(noise.rate_random_walk / DEGREE_PER_HOUR * 60.0),
        rounded(noise.rate_ramp / DEGREE_PER_HOUR * 3600.0),
        rounded(noise.quantisation / ARCSECOND)
    )?;
    write!(
        out,
        "Latitude {:.4}°, {} s for a rotation; ",
        degrees(request.latitude.rad()),
        request.rotation
    )?;
    match request.wanted {
        Wanted::Seconds(seconds) => writeln!(out, "the best in {seconds} s"),
        Wanted::Sigma(sigma) => {
            writeln!(out, "the least time for {:.4}° (1σ)", degrees(sigma))
        }
    }
}

/// Six digits are enough of what was typed in.
fn rounded(value: f64) -> f64 {
    let scale = 10.0_f64.powi(6 - value.abs().max(1e-12).log10().ceil() as i32);
    (value * scale).round() / scale
}
