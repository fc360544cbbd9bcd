//! Schedules, for people.

pub mod page;

use orientation::planner::FEWEST;

use super::{counted, degrees, fixed, noise_in_words, significant};
use crate::planning::{OfBurov, Optimum, Planned, Request, Wanted};
use crate::report::{Lines, Part, Report, Summary};

/// The report for terminal and page: the answer, what was asked, and both schedules.
pub fn report(request: &Request, planned: &Planned) -> Report {
    let parts = [optimum(planned), burov(planned)].map(Part::from);
    let summary = Summary { facts: asked(request).lines, ..Summary::default() };
    Report::new(answer(planned), parts).headed(summary)
}

/// The answer in a line: the best schedule, its σ, and its time.
fn answer(planned: &Planned) -> String {
    let Optimum { positions, dwell_s, seconds, sigma_deg, .. } = planned.optimum;
    format!("{positions} positions of {dwell_s:.2} s: {sigma_deg:.4}° (1σ) in {seconds:.1} s")
}

/// An angle as 1σ and as 3σ.
fn sigmas(sigma_deg: f64) -> String {
    format!("{sigma_deg:.4}° (1σ), {:.4}° (3σ)", 3.0 * sigma_deg)
}

fn burov(planned: &Planned) -> Lines {
    let lines = Lines::new("Burov's autocompensation: the error of a rate, 1σ");
    let Some(burov) = &planned.burov else {
        let least = planned.burov_least_sigma_deg.unwrap_or(f64::NAN);
        return lines.with("out of reach", format!(
            "with the B that no turning takes away in this model, a full azimuth has at least {least:.4}° (1σ)"
        ));
    };
    let OfBurov { positions, dwell_s, seconds, rate_error_deg_h: rate, .. } = burov;
    let [rate, with_b] = [*rate, rate.hypot(burov.flicker_deg_h)].map(|rate| significant(rate, 4));
    let one_axis = sigmas(burov.one_axis_sigma_deg);
    lines
        .with("positions", format!("{positions} of {dwell_s:.2} s, {seconds:.1} s in all"))
        .with("rate error", format!("{rate} °/h; with B {with_b} °/h"))
        .with("from one axis", format!("{one_axis}, the half of the azimuth known"))
        .with("full azimuth", format!("{}, √2 of that", sigmas(burov.sigma_deg)))
}

fn optimum(planned: &Planned) -> Lines {
    let Optimum { order, passes, positions, dwell_s, seconds, sigma_deg, .. } = planned.optimum;
    let title = format!(
        "The best for Meridian's fit with {FEWEST} positions or more, so that a disturbed dwell is noticed; noise alone, \
         tilt, encoder and scale come on top of it"
    );
    let one_pass = planned.one_pass_sigma_deg.map(|sigma| {
        let ratio = sigma / sigma_deg;
        let but = if ratio < 1.0 { "; but it would not notice a disturbed dwell" } else { "" };
        format!(
            "of 0, 180, 90, 270° in the same time: {sigma:.4}° (1σ), {ratio:.2} times as much{but}"
        )
    });
    Lines::new(&title)
        .with("positions", format!("{positions} of {dwell_s:.2} s, {seconds:.1} s in all"))
        .with("order", format!("{order}, {}", counted(passes, "pass")))
        .with("full azimuth", sigmas(sigma_deg))
        .with_found("one pass", one_pass)
}

fn asked(request: &Request) -> Lines {
    let wanted = match request.wanted {
        Wanted::Seconds(seconds) => format!("the best in {seconds} s"),
        Wanted::Sigma(sigma) => format!("the least time for {:.4}° (1σ)", degrees(sigma)),
    };
    Lines::default()
        .with("gyro", noise_in_words(&request.noise, true))
        .with("latitude", format!("{}°", fixed(degrees(request.latitude.rad()), 4)))
        .with("rotation", format!("{} s", request.rotation))
        .with("wanted", wanted)
}
