//! `meridian plan`: positions, dwell and σ for a gyro's noise, or the time for a wanted σ.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use host::outcome::keys::Keys;
use host::output::manner::Manner;
use host::output::plan;
use host::planning::{Request, Wanted};
use orientation::earth::Latitude;
use orientation::noise::model::GyroNoise;
use serde_json::json;

use super::files::Written;
use super::{Answer, Failure, OUTPUT, files, latitude};

/// The gyro, the place, the stage, and what is asked.
#[derive(Args)]
#[command(group(ArgGroup::new("wanted").required(true).args(["seconds", "sigma"])))]
pub struct PlanOptions {
    /// Angle random walk N, °/√h.
    #[arg(long, value_name = "N", value_parser = coefficient)]
    arw: f64,
    /// Bias instability B, °/h.
    #[arg(long, value_name = "B", default_value = "0", value_parser = coefficient)]
    bias_instability: f64,
    /// Rate random walk K, °/h/√h.
    #[arg(long, value_name = "K", default_value = "0", value_parser = coefficient)]
    rate_random_walk: f64,
    /// Rate ramp R, °/h².
    #[arg(long, value_name = "R", default_value = "0", value_parser = coefficient)]
    ramp: f64,
    /// Quantisation Q, arc seconds.
    #[arg(long, value_name = "Q", default_value = "0", value_parser = coefficient)]
    quantisation: f64,
    /// Latitude, north positive: 47.58, 47°35′, 47:34:48, or 47°35′N.
    #[arg(long, value_name = "DEGREES", value_parser = latitude)]
    latitude: Latitude,
    /// Total time for everything, rotations included, s.
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    seconds: Option<f64>,
    /// Wanted standard deviation of a full azimuth, ° (1σ).
    #[arg(long, value_name = "DEGREES", value_parser = super::sigma)]
    sigma: Option<f64>,
    /// Time of one rotation, s.
    #[arg(long, value_name = "SECONDS", default_value = "2", value_parser = seconds)]
    rotate_seconds: f64,
    /// Writes figures and tables as a page for a browser.
    #[arg(long, value_name = "FILE.html", help_heading = OUTPUT)]
    report: Option<PathBuf>,
}

/// A coefficient of the noise.
fn coefficient(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (0.0..=1e6).contains(&value) => Ok(value),
        _ => Err("not a number from 0 to 1e6".to_owned()),
    }
}

/// A time.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 86_400.0 => Ok(value),
        _ => Err("not a number of seconds above 0, at most 86400".to_owned()),
    }
}

impl From<&PlanOptions> for Request {
    fn from(options: &PlanOptions) -> Self {
        let noise = GyroNoise::from_field_units(
            options.arw,
            options.bias_instability,
            options.rate_random_walk,
            options.ramp,
        );
        // The group makes sure that one of them is there.
        let wanted = match (options.seconds, options.sigma) {
            (Some(seconds), _) => Wanted::Seconds(seconds),
            (None, sigma) => Wanted::Sigma(sigma.unwrap_or(f64::INFINITY)),
        };
        Self {
            noise: noise.with_quantisation(options.quantisation),
            latitude: options.latitude,
            rotation: options.rotate_seconds,
            wanted,
        }
    }
}

/// Plans positions and dwells, and shows them.
pub fn run(options: &PlanOptions, manner: Manner) -> Result<Answer, Failure> {
    let page = Written::page(options.report.as_ref());
    files::check(None, &[page]).map_err(Failure::misuse)?;
    let page = files::opened("the report", options.report.as_ref())?;
    let request = Request::from(options);
    let planned = match request.plan() {
        Ok(planned) => planned,
        Err(why) => return Ok(refused(options, why.to_string(), manner)?),
    };
    let object = Keys::default().with("status", "ok").with_all(Some(&planned));
    let answer = Answer::reported(None, manner, &object, || plan::report(&request, &planned))?;
    Ok(answer.with_page(page, || plan::page::report(&request, &planned)))
}

/// No schedule, and why.
fn refused(options: &PlanOptions, why: String, manner: Manner) -> Result<Answer, String> {
    let object = json!({ "status": "refused", "reason": why });
    let no_page = |_| "--report: without a schedule there is no page".to_owned();
    let warnings = options.report.iter().map(no_page).collect();
    Ok(Answer::of(Some(why), manner, &object, String::new)?.with_warnings(warnings))
}
