//! The report of `campaign rotating`: where the raw error comes from, the spectra of MET 2018 at two axis
//! misalignments, and the tables.

use super::{normal, precisions, reasons};
use crate::campaign::rotating::world::{
    COUPLING_DEG, LATITUDE_DEG, TILT_DEG, UNEVENNESS, World, segments,
};
use crate::campaign::rotating::{molecular, refusals, stages};
use crate::outcome::rotating::figures;
use crate::report::{Axis, Figure, Part as OfPage, Report, Series, Style, Table};
use crate::rotating::part::Part;

/// The couplings of the figure with two of them, °: as in the campaign, and nearly aligned.
const COUPLINGS_DEG: [f64; 2] = [COUPLING_DEG, 0.1];
/// When the platform has taken on its speed, s.
const SETTLED: f64 = 5.0;
/// Length of the even stretch that it shows, s.
const SECONDS: f64 = 200.0;

/// The page for a campaign.
#[must_use]
pub fn report(
    stages: &[stages::Row],
    molecular: &[molecular::Row],
    refusals: &[refusals::Row],
) -> Report {
    let mut parts: Vec<OfPage> = stages.iter().map(|row| of_stages(row).into()).collect();
    parts.extend(stages.first().map(|row| raw(row).into()));
    parts.push(of_precisions(stages, molecular).into());
    parts.push(of_molecular(molecular).into());
    parts.push(of_refusals(refusals).into());
    parts.extend(of_couplings());
    Report {
        title: "Dynamic north finding on a turning platform".to_owned(),
        subtitle: subtitle(stages, molecular),
        parts,
    }
}

/// What was simulated, and why any was refused.
fn subtitle(stages: &[stages::Row], molecular: &[molecular::Row]) -> Vec<String> {
    let unevenness = 100.0 * UNEVENNESS;
    let (hertz, seconds, [slow, fast]) = (stages::TURN_HZ, stages::SECONDS, molecular::SPEEDS_HZ);
    let ([least, most], all, walk) = (molecular::PHASES_DEG, molecular::SECONDS, molecular::WALK);
    let gyro = format!(
        "a flat gyro at {LATITUDE_DEG}°, {hertz} Hz, {seconds} s each way: axis misalignment {COUPLING_DEG}°, tilt \
         {TILT_DEG}°, unevenness {unevenness} % once per turn"
    );
    let sensor = format!(
        "a molecular-electronic sensor that lags by {least}° to {most}°, gain and g-sensitivity unknown, at {slow} Hz \
         and {fast} Hz, {all} s each way in all, N = {walk} °/√h"
    );
    let precisions = stages.iter().map(|row| &row.precision);
    let all = precisions.chain(molecular.iter().map(|row| &row.precision));
    let lines = ["MET 2018".to_owned(), gyro, sensor, normal()];
    lines.into_iter().chain(reasons(all)).collect()
}

fn of_stages(row: &stages::Row) -> Table {
    let line = |stage: &stages::Stage| {
        let [rms, greatest] = [stage.rms_deg, stage.greatest_deg].map(|x| format!("{x:.4}"));
        vec![stage.stage.to_owned(), rms, greatest]
    };
    let title = format!("Error after each stage, N = {} °/√h", row.n_deg_sqrt_h);
    let table = Table::new(&title, &["stage", "RMS, °", "greatest, °"]);
    Table { rows: row.stages.iter().map(line).collect(), ..table }
}

/// The raw error over where the unevenness acts.
fn raw(row: &stages::Row) -> Figure {
    Figure {
        title: "Raw error over where the gear's unevenness acts".to_owned(),
        x: Axis::linear("from the azimuth", "°"),
        y: Axis::linear("error of the raw azimuth", "°"),
        series: vec![Series::new("one run each", Style::Points, row.raw.iter().copied())],
    }
}

fn of_precisions(stages: &[stages::Row], molecular: &[molecular::Row]) -> Table {
    let gyro = |row: &stages::Row| format!("gyro, N {} °/√h", row.n_deg_sqrt_h);
    let sensor = |row: &molecular::Row| {
        let walk = molecular::WALK;
        let (coupling, ratio) = (row.coupling_deg, row.ratio);
        format!("molecular-electronic, axis misalignment {coupling}°, ρ {ratio}, N {walk} °/√h")
    };
    let gyros = stages.iter().map(|row| (gyro(row), &row.precision));
    let sensors = molecular.iter().map(|row| (sensor(row), &row.precision));
    precisions("Azimuths with noise", "sensor", gyros.chain(sensors))
}

fn of_molecular(rows: &[molecular::Row]) -> Table {
    let line = |row: &molecular::Row| -> Vec<String> {
        let numbers = [
            row.one_speed_rms_deg,
            row.one_speed_greatest_deg,
            row.predicted_rms_deg,
            row.off_prediction_deg,
            row.bound_deg,
            row.plain_limit_deg,
        ];
        let two = [row.two_speeds_rms_deg, row.two_speeds_greatest_deg];
        let names = [row.coupling_deg, row.ratio].map(|number| number.to_string()).into_iter();
        let numbers = names.chain(numbers.map(|number| format!("{number:.4}")));
        let numbers = numbers.chain(two.map(|number| format!("{number:.5}")));
        numbers.chain([format!("{:.2}", row.noise_ratio)]).collect()
    };
    let head = [
        "axis misalignment, °",
        "ρ",
        "one speed: RMS, °",
        "greatest, °",
        "as predicted, °",
        "greatest difference, °",
        "bound ρ²/2, °",
        "limit without G and H, °",
        "two speeds: RMS, °",
        "greatest, °",
        "with noise: RMS over that limit",
    ];
    let title = "Molecular-electronic sensor: what is left of its g-sensitivity without noise";
    Table { rows: rows.iter().map(line).collect(), ..Table::new(title, &head) }
}

fn of_refusals(rows: &[refusals::Row]) -> Table {
    let line = |row: &refusals::Row| {
        let reason = row.reason.clone().unwrap_or_default();
        let counts = [row.runs, row.refused, row.wrong].map(|count| count.to_string());
        [row.case.to_owned()].into_iter().chain(counts).chain([reason]).collect()
    };
    let head = ["what went wrong", "runs", "refused", "wrong", "most often because"];
    let table = Table::new("What must be refused", &head);
    Table { rows: rows.iter().map(line).collect(), ..table }
}

/// The first figures of MET 2018: the sensor's spectrum at two axis misalignments, and the platform's.
fn of_couplings() -> Vec<OfPage> {
    let rows = COUPLINGS_DEG.map(|coupling_deg| {
        let even = segments(&[stages::TURN_HZ], SECONDS).split_off(1);
        let world = World { coupling_deg, segments: even, ..stages::world(stages::WALKS[0], 1) };
        world.rows(1)
    });
    let parts = rows.each_ref().map(|rows| Part::between(rows, SETTLED, SECONDS, true));
    let names = COUPLINGS_DEG.map(|coupling| format!("coupling {coupling}°"));
    let platform = figures::platform(&parts[..1]);
    vec![figures::compared(&parts, &names).into(), platform.into()]
}
