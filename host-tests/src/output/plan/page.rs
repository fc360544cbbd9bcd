//! The page of a plan: Burov's curve, the orders that were compared, and the time that σ takes.

use orientation::planner::order::Order;
use orientation::planner::{Plan, burov};
use orientation::units::Seconds;

use crate::output::plan;
use crate::planning::{self, Optimum, Planned, Request};
use crate::report::{Axis, Figure, Part, Report, Series, Style};

/// Most passes that the figure shows.
const MOST_PASSES: usize = 21;
/// Times along the curve of σ, and how far they reach on either side of the plan's.
const TIMES: u32 = 24;
/// Times between which the curve reaches, as factors of the plan's.
const REACH: [f64; 2] = [0.3, 6.0];

/// The page for a plan: its report, then the figures.
pub fn report(request: &Request, planned: &Planned) -> Report {
    let seconds = planned.optimum.seconds;
    let burov = autocompensation(request, planned.burov.map_or(seconds, |best| best.seconds));
    let mut report = plan::report(request, planned);
    let figures = [burov, orders(request, planned), times(request, planned)];
    report.parts.extend(figures.map(Part::from));
    report
}

/// Δω over the number of positions.
fn autocompensation(request: &Request, seconds: f64) -> Figure {
    let best = burov::best(&request.noise, Seconds(seconds), Seconds(request.rotation));
    let most = best.map_or(20, |best| 3 * best.positions).min(300);
    let of = |n| burov::rate_error(&request.noise, n, Seconds(seconds), Seconds(request.rotation));
    let curve = (2..=most).filter_map(|n| Some((f64::from(n), of(n)?.degrees_per_hour())));
    let best = best.map(|best| (f64::from(best.positions), best.rate_error.degrees_per_hour()));
    let series =
        [Series::new("rate error", Style::Line, curve), Series::new("best", Style::Points, best)];
    let title = format!("Burov's autocompensation in {seconds:.0} s");
    Figure::new(title, ["number of positions", ""], ["rate error, 1σ", "°/h"], series)
}

/// The plan among others.
fn plan_itself(place: (f64, f64)) -> Series {
    Series::new("the plan", Style::Hollow, [place])
}

/// σ of every order over its number of positions.
fn orders(request: &Request, planned: &Planned) -> Figure {
    let Optimum { seconds, positions, sigma_deg, .. } = planned.optimum;
    let conditions = request.conditions();
    let degrees = |plan: &Plan| plan.sigma(request.latitude).degrees();
    let compared = Order::COMPARED.map(|order| {
        let plans =
            (1..=MOST_PASSES).filter_map(|n| Plan::of(&conditions, order, n, Seconds(seconds)));
        let points = plans.map(|plan| (plan.positions() as f64, degrees(&plan)));
        Series::new(order.name(), Style::LineAndPoints, points)
    });
    let series = compared.into_iter().chain([plan_itself((positions as f64, sigma_deg))]);
    let title = format!("Orders of positions in {seconds:.0} s");
    Figure::new(title, ["number of positions", ""], ["full azimuth, 1σ", "°"], series)
}

/// σ of the best schedule over the total time.
fn times(request: &Request, planned: &Planned) -> Figure {
    let Optimum { seconds, sigma_deg, .. } = planned.optimum;
    let [low, high] = REACH;
    let time = |i| seconds * low * (high / low).powf(f64::from(i) / f64::from(TIMES));
    let curve = (0..=TIMES).map(time).filter_map(|time| {
        let plan = planning::best(&request.conditions(), Seconds(time)).ok()?;
        Some((time, plan.sigma(request.latitude).degrees()))
    });
    let series =
        [Series::new("optimum", Style::LineAndPoints, curve), plan_itself((seconds, sigma_deg))];
    let title = "The best schedule over the time it may take";
    let (x, y) = (Axis::logarithmic("total time", "s"), Axis::logarithmic("full azimuth, 1σ", "°"));
    Figure::new(title, x, y, series)
}
