//! Schedules, for people.

pub mod page;

use orientation::planner::FEWEST;
use orientation::units::{ARCSECOND, DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR};

use super::degrees;
use crate::planning::{OfBurov, Optimum, Planned, Request, Wanted};
use crate::report::{Lines, Part, Report};

/// The report for terminal and page: what was asked, and both schedules.
#[must_use]
pub fn report(request: &Request, planned: &Planned) -> Report {
    let parts = [asked(request), burov(planned), optimum(planned)].map(Part::from);
    Report::new("Schedule for a gyro", parts)
}

/// An angle as 1σ and as 3σ.
fn sigmas(sigma_deg: f64) -> String {
    format!("{sigma_deg:.4}° (1σ), {:.4}° (3σ)", 3.0 * sigma_deg)
}

fn burov(planned: &Planned) -> Lines {
    let mut lines = Lines::new("Burov's eq. (1): the error of a rate, 1σ");
    let Some(burov) = &planned.burov else {
        let least = planned.burov_least_sigma_deg.unwrap_or(f64::NAN);
        let text = format!(
            "with the B that no turning takes away in this model, a full azimuth has at least {least:.4}° (1σ)"
        );
        lines.add("out of reach", text);
        return lines;
    };
    let OfBurov { positions, dwell_s, seconds, rate_error_deg_h: rate, .. } = burov;
    lines.add("positions", format!("{positions} of {dwell_s:.2} s, {seconds:.1} s in all"));
    let with_b = rate.hypot(burov.flicker_deg_h);
    lines.add("rate error", format!("{rate:.4e} °/h; with B {with_b:.4e} °/h"));
    let one_axis = sigmas(burov.one_axis_sigma_deg);
    lines.add("from one axis", format!("{one_axis}, the half of the azimuth known"));
    lines.add("full azimuth", format!("{}, √2 of that", sigmas(burov.sigma_deg)));
    lines
}

fn optimum(planned: &Planned) -> Lines {
    let Optimum { order, passes, positions, dwell_s, seconds, sigma_deg, .. } = planned.optimum;
    let mut lines = Lines::new(&format!(
        "The best for Meridian's fit with {FEWEST} positions or more, so that a disturbed dwell is noticed; noise alone, \
         tilt, encoder and scale come on top of it"
    ));
    lines.add("positions", format!("{positions} of {dwell_s:.2} s, {seconds:.1} s in all"));
    lines.add("order", format!("{order}, {passes} passes"));
    lines.add("full azimuth", sigmas(sigma_deg));
    lines.add_found("one pass", planned.one_pass_sigma_deg.map(|sigma| {
        let ratio = sigma / sigma_deg;
        let but = if ratio < 1.0 { "; but it would not notice a disturbed dwell" } else { "" };
        format!("of 0, 180, 90, 270° in the same time: {sigma:.4}° (1σ), {ratio:.2} times as much{but}")
    }));
    lines
}

fn asked(request: &Request) -> Lines {
    let noise = &request.noise;
    let mut lines = Lines::default();
    let [n, b, k, r, q] = [
        noise.angle_random_walk / DEGREE_PER_SQRT_HOUR,
        noise.bias_instability / DEGREE_PER_HOUR,
        noise.rate_random_walk / DEGREE_PER_HOUR * 60.0,
        noise.rate_ramp / DEGREE_PER_HOUR * 3600.0,
        noise.quantisation / ARCSECOND,
    ]
    .map(rounded);
    lines.add("gyro", format!("N {n} °/√h, B {b} °/h, K {k} °/h/√h, R {r} °/h², Q {q}″"));
    lines.add("latitude", format!("{:.4}°", degrees(request.latitude.rad())));
    lines.add("rotation", format!("{} s", request.rotation));
    let wanted = match request.wanted {
        Wanted::Seconds(seconds) => format!("the best in {seconds} s"),
        Wanted::Sigma(sigma) => format!("the least time for {:.4}° (1σ)", degrees(sigma)),
    };
    lines.add("wanted", wanted);
    lines
}

/// Six digits are enough of what was typed in.
fn rounded(value: f64) -> f64 {
    let scale = 10.0_f64.powi(6 - value.abs().max(1e-12).log10().ceil() as i32);
    (value * scale).round() / scale
}
