//! `campaign rotating`: its entry in the registry, and its report: where the raw error comes from, the spectra of MET 2018 at two axis
//! misalignments, and the tables.

use serde_json::json;

use super::world::{LATITUDE_DEG, MISALIGNMENT_DEG, TILT_DEG, UNEVENNESS, World, segments};
use super::{molecular, refusals, stages};
use crate::campaign::columns::{Columns, normal, reasons};
use crate::campaign::statistics::Precision;
use crate::campaign::{Asked, Campaign, Done, Tick, tenth, unless};
use crate::methods::rotating::outcome::figures;
use crate::methods::rotating::part::Part;
use crate::report::{Figure, Part as OfPage, Report, Series, Style};

/// The stages of compensation, molecular-electronic sensors, and what must be refused.
pub(in crate::campaign) const CAMPAIGN: Campaign = Campaign {
    name: "rotating",
    meaning: "A platform that turns all the time (MET 2018), its errors and what is done about each",
    runs: 500,
    steps: "alignments",
    count: |asked| {
        let tables = stages::WALKS.len() + molecular::COUNT;
        tables * asked.runs + refusals::COUNT * tenth(asked.runs)
    },
    run: |asked, tick| Ok(run(asked, tick)),
};

/// A result where no healthy run was refused and no north was wrong.
fn run(asked: &Asked, tick: Tick<'_>) -> Done {
    let stages = stages::rows(asked.runs, tick);
    let molecular = molecular::rows(asked.runs, tick);
    let refusals = refusals::rows(tenth(asked.runs), tick);
    let sensors = molecular.iter().map(|row| &row.precision);
    let healthy: Vec<_> = stages.iter().map(|row| &row.precision).chain(sensors).collect();
    let is_right = refusals.iter().all(|row| row.wrong == 0);
    let found = healthy.iter().all(|precision| precision.is_complete()) && is_right;
    Done {
        report: report(&stages, &molecular, &refusals).below(subtitle(healthy)),
        refusal: unless(found, "a healthy run was refused, or a north was wrong"),
        object: json!({ "stages": stages, "molecular": molecular, "refusals": refusals }),
    }
}

/// The misalignments of the figure with two of them, °: as in the campaign, and nearly aligned.
const MISALIGNMENTS_DEG: [f64; 2] = [MISALIGNMENT_DEG, 0.1];
/// When the platform has taken on its speed, s.
const SETTLED: f64 = 5.0;
/// Length of the even stretch that it shows, s.
const SECONDS: f64 = 200.0;

/// The page for a campaign.
fn report(
    stages: &[stages::Row],
    molecular: &[molecular::Row],
    refusals: &[refusals::Row],
) -> Report {
    let mut parts: Vec<OfPage> = stages.iter().map(of_stages).collect();
    parts.extend(stages.first().map(raw));
    parts.extend([
        of_precisions(stages, molecular),
        of_molecular(molecular),
        of_refusals(refusals),
    ]);
    parts.extend(of_misalignments());
    let title = "Dynamic north finding on a turning platform";
    Report::new(title, parts)
}

/// What was simulated, and why any was refused.
fn subtitle(healthy: Vec<&Precision>) -> Vec<String> {
    let unevenness = 100.0 * UNEVENNESS;
    let (hertz, seconds, [slow, fast]) = (stages::TURN_HZ, stages::SECONDS, molecular::SPEEDS_HZ);
    let ([least, most], all, walk) = (molecular::PHASES_DEG, molecular::SECONDS, molecular::WALK);
    let gyro = format!(
        "a flat gyro at {LATITUDE_DEG}°, {hertz} Hz, {seconds} s each way: axis misalignment {MISALIGNMENT_DEG}°, tilt \
         {TILT_DEG}°, unevenness {unevenness} % once per turn"
    );
    let sensor = format!(
        "a molecular-electronic sensor that lags by {least}° to {most}°, gain and g-sensitivity unknown, at {slow} Hz \
         and {fast} Hz, {all} s each way in all, N = {walk} °/√h"
    );
    let lines = ["MET 2018".to_owned(), gyro, sensor, normal()];
    lines.into_iter().chain(reasons(healthy)).collect()
}

fn of_stages(row: &stages::Row) -> OfPage {
    Columns::of(&format!("Error after each stage, N = {} °/√h", row.n_deg_sqrt_h), &row.stages)
        .column("stage", |stage| stage.stage)
        .fixed("RMS, °", 4, |stage| stage.rms_deg)
        .fixed("greatest, °", 4, |stage| stage.greatest_deg)
        .into()
}

/// The raw error over where the unevenness acts.
fn raw(row: &stages::Row) -> OfPage {
    let series = Series::new("one run each", Style::Points, row.raw.iter().copied());
    let title = "Raw error over where the gear's unevenness acts";
    Figure::new(title, ["from the azimuth", "°"], ["error of the raw azimuth", "°"], [series])
        .into()
}

fn of_precisions(stages: &[stages::Row], molecular: &[molecular::Row]) -> OfPage {
    let gyro = |row: &stages::Row| format!("gyro, N {} °/√h", row.n_deg_sqrt_h);
    let sensor = |row: &molecular::Row| {
        let walk = molecular::WALK;
        let (misalignment, ratio) = (row.coupling_deg, row.ratio);
        format!("molecular-electronic, axis misalignment {misalignment}°, ρ {ratio}, N {walk} °/√h")
    };
    let gyros = stages.iter().map(|row| (gyro(row), row.precision.clone()));
    let sensors = molecular.iter().map(|row| (sensor(row), row.precision.clone()));
    Columns::of("Azimuths with noise", &gyros.chain(sensors).collect::<Vec<_>>())
        .column("sensor", |(name, _)| name)
        .precision(|(_, precision)| precision)
        .into()
}

fn of_molecular(rows: &[molecular::Row]) -> OfPage {
    let title = "Molecular-electronic sensor: what is left of its g-sensitivity without noise";
    Columns::of(title, rows)
        .column("axis misalignment, °", |row| row.coupling_deg)
        .column("ρ", |row| row.ratio)
        .fixed("one speed: RMS, °", 4, |row| row.one_speed_rms_deg)
        .fixed("greatest, °", 4, |row| row.one_speed_greatest_deg)
        .fixed("as predicted, °", 4, |row| row.predicted_rms_deg)
        .fixed("greatest difference, °", 4, |row| row.off_prediction_deg)
        .fixed("bound ρ²/2, °", 4, |row| row.bound_deg)
        .fixed("limit without G and H, °", 4, |row| row.plain_limit_deg)
        .fixed("two speeds: RMS, °", 5, |row| row.two_speeds_rms_deg)
        .fixed("greatest, °", 5, |row| row.two_speeds_greatest_deg)
        .fixed("with noise: RMS over that limit", 2, |row| row.noise_ratio)
        .into()
}

fn of_refusals(rows: &[refusals::Row]) -> OfPage {
    Columns::of("What must be refused", rows)
        .column("what went wrong", |row| row.case)
        .column("runs", |row| row.runs)
        .column("refused", |row| row.refused)
        .column("wrong", |row| row.wrong)
        .column("most often because", |row| row.reason.as_deref().unwrap_or_default())
        .into()
}

/// The first figures of MET 2018: the sensor's spectrum at two axis misalignments, and the platform's.
fn of_misalignments() -> Vec<OfPage> {
    let rows = MISALIGNMENTS_DEG.map(|coupling_deg| {
        let even = segments(&[stages::TURN_HZ], SECONDS).split_off(1);
        let world = World { coupling_deg, segments: even, ..stages::world(stages::WALKS[0], 1) };
        world.rows(1)
    });
    let parts = rows.each_ref().map(|rows| Part::between(rows, SETTLED, SECONDS, true));
    let names = MISALIGNMENTS_DEG.map(|misalignment| format!("axis misalignment {misalignment}°"));
    let platform = figures::platform(&parts[..1]);
    vec![figures::compared(&parts, &names).into(), platform.into()]
}
