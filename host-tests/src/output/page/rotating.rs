//! The page of `campaign rotating`: where the raw error comes from, papers/004's spectra at two couplings,
//! and the tables.

use crate::campaign::rotating::world::{COUPLING_DEG, World, segments};
use crate::campaign::rotating::{molecular, refusals, stages};
use crate::campaign::statistics::Precision;
use crate::outcome::rotating::figures;
use crate::output::named;
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
        subtitle: vec![
            "papers/004, with the figures of equations.md §4; errors beside the Cramér–Rao limit"
                .to_owned(),
        ],
        parts,
    }
}

fn of_stages(row: &stages::Row) -> Table {
    let line = |stage: &stages::Stage| {
        let [rms, greatest] = [stage.rms_deg, stage.greatest_deg].map(|x| format!("{x:.4}"));
        vec![stage.stage.to_owned(), rms, greatest]
    };
    Table {
        title: format!("Error after each stage, N = {} °/√h", row.n_deg_sqrt_h),
        head: named(&["stage", "RMS, °", "greatest, °"]),
        rows: row.stages.iter().map(line).collect(),
    }
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
    let gyro =
        |row: &stages::Row| line(&format!("gyro, N {} °/√h", row.n_deg_sqrt_h), &row.precision);
    let sensor = |row: &molecular::Row| {
        let name = format!(
            "molecular, coupling {}°, ρ {}, N {} °/√h",
            row.coupling_deg,
            row.ratio,
            molecular::WALK
        );
        line(&name, &row.precision)
    };
    Table {
        title: "Azimuths with noise".to_owned(),
        head: named(&[
            "sensor",
            "runs",
            "refused",
            "RMS, °",
            "limit, °",
            "error / limit",
            "within 1, 2, 3 σ, %",
        ]),
        rows: stages.iter().map(gyro).chain(molecular.iter().map(sensor)).collect(),
    }
}

fn line(name: &str, row: &Precision) -> Vec<String> {
    let [one, two, three] = row.coverage_percent;
    vec![
        name.to_owned(),
        row.runs.to_string(),
        row.refused.to_string(),
        format!("{:.4}", row.rms_deg),
        format!("{:.4}", row.limit_deg),
        format!("{:.3}", row.ratio),
        format!("{one:.1}, {two:.1}, {three:.1}"),
    ]
}

fn of_molecular(rows: &[molecular::Row]) -> Table {
    let line = |row: &molecular::Row| {
        let numbers = [
            row.one_speed_rms_deg,
            row.predicted_rms_deg,
            row.off_prediction_deg,
            row.bound_deg,
            row.two_speeds_rms_deg,
            row.two_speeds_greatest_deg,
        ];
        let numbers = numbers.map(|number| format!("{number:.4}"));
        let ratio = [row.coupling_deg, row.ratio].map(|number| number.to_string()).into_iter();
        ratio.chain(numbers).chain([format!("{:.2}", row.noise_ratio)]).collect()
    };
    Table {
        title: "Molecular-electronic sensor: what is left of its g-sensitivity without noise"
            .to_owned(),
        head: named(&[
            "coupling, °",
            "ρ",
            "one speed: RMS, °",
            "as §4 predicts, °",
            "greatest difference, °",
            "bound ρ²/2, °",
            "two speeds: RMS, °",
            "greatest, °",
            "with noise: RMS over the limit without G and H",
        ]),
        rows: rows.iter().map(line).collect(),
    }
}

fn of_refusals(rows: &[refusals::Row]) -> Table {
    let line = |row: &refusals::Row| {
        let reason = row.reason.clone().unwrap_or_default();
        let counts = [row.runs, row.refused, row.wrong].map(|count| count.to_string());
        [row.case.to_owned()].into_iter().chain(counts).chain([reason]).collect()
    };
    Table {
        title: "What must be refused".to_owned(),
        head: named(&["what went wrong", "runs", "refused", "wrong", "most often because"]),
        rows: rows.iter().map(line).collect(),
    }
}

/// Papers/004's first figures: the sensor's spectrum at two couplings, and the platform's.
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
