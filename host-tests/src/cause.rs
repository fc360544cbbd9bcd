//! What a refusal of a recording is likely to come from: a column in another unit, a noise that is not the gyro's, a
//! sensor that is stuck.
//!
//! A unit is found by trying: where the same recording with its column converted gives an azimuth that passes every
//! test, that unit is named. The azimuth itself is not told: the recording is to be put right.

use orientation::align::conclusion::Azimuth;
use orientation::error::Refusal;
use orientation::units::DEGREE;

use crate::recording::{Body, DwellRow, Header, RotatingRow, StageRow};
use crate::replay::{self, Options};
use crate::rotating;

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;
/// rad/s of a degree an hour.
const PER_HOUR: f64 = DEGREE / 3600.0;
/// Longest recordings that are tried again, rows: a try copies them.
const MOST_ROWS: usize = 2_000_000;
/// How far a mean force may be from a unit of gravity, relative.
const NEAR: f64 = 0.2;
/// Part of a recording for which a column must stand still to be stuck.
const STUCK: f64 = 0.5;
/// Factor by which a noise is not the one stated.
const OTHER_NOISE: f64 = 1.5;
/// Times the stated noise power that no residuals are by chance or drift.
const NO_NOISE: f64 = 100.0;

/// Another unit of a column: its factor to the one that is meant, and the words for it.
#[derive(Clone, Copy)]
struct Unit(f64, &'static str);

const ANGLES: [Unit; 2] =
    [Unit(1.0, ""), Unit(DEGREE, "in degrees, as it seems, not rad: multiply by 0.0174532925")];
const RATES: [Unit; 3] = [
    Unit(1.0, ""),
    Unit(DEGREE, "in °/s, as it seems, not rad/s: multiply by 0.0174532925"),
    Unit(PER_HOUR, "in °/h, as it seems, not rad/s: multiply by 4.84813681e-6"),
];
const FORCES: [Unit; 2] = [
    Unit(GRAVITY, "in g, as it seems, not m/s²: multiply by 9.80665"),
    Unit(GRAVITY * 1e-3, "in mg, as it seems, not m/s²: multiply by 0.00980665"),
];

/// What is tried: units of the stage angle, the rate and the forces.
#[derive(Clone, Copy)]
struct Trial {
    angle: Unit,
    rate: Unit,
    force: Option<Unit>,
    /// Whether what goes with a column is in its unit: the stage's rate with its angle, σ with a mean rate.
    together: bool,
}

/// The names of the columns: stage angle, rate, forces.
type Names = [&'static str; 3];

impl Trial {
    /// All, those with one change first; the forces' unit shows by itself.
    fn all(force: Option<Unit>) -> impl Iterator<Item = Self> {
        let with = move |angle, rate| Self { angle, rate, force, together: true };
        let ([same, degrees], [rate, others @ ..]) = (ANGLES, RATES);
        let first = force.map(|_| with(same, rate)).into_iter().chain([with(degrees, rate)]);
        let rates = others.map(|rate| with(same, rate));
        let all = first.chain(rates).chain(others.map(|rate| with(degrees, rate)));
        all.flat_map(|trial| [trial, Self { together: false, ..trial }])
    }

    /// What is wrong with the columns, in words.
    fn told(&self, alone: Names, together: Names) -> String {
        let [angle, rate, force] = if self.together { together } else { alone };
        let units = [(angle, Some(self.angle)), (rate, Some(self.rate)), (force, self.force)];
        let words = units.into_iter().filter_map(|(name, unit)| Some((name, unit?.1)));
        let told = words.filter(|(_, words)| !words.is_empty());
        told.map(|(name, words)| format!("{name}: {words}")).collect::<Vec<_>>().join("; ")
    }

    /// The factors of the stage angle, the rate, the forces, and of what goes with angle and rate.
    fn factors(&self) -> [f64; 5] {
        let [angle, rate] = [self.angle.0, self.rate.0];
        let force = self.force.map_or(1.0, |Unit(factor, _)| factor);
        let companions = if self.together { [angle, rate] } else { [1.0; 2] };
        [angle, rate, force, companions[0], companions[1]]
    }
}

/// The columns of each kind, alone and with what goes with them.
const STAGE: Names = ["column stage_rad", "column g_rad_s", "columns fx_m_s2 to fz_m_s2"];
const DWELLS: [Names; 2] = [
    ["column stage_rad", "column rate_rad_s", "columns fx_m_s2 to fz_m_s2"],
    ["column stage_rad", "columns rate_rad_s and sigma_rad_s", "columns fx_m_s2 to fz_m_s2"],
];
const ROTATING: [Names; 2] = [
    ["column stage_rad", "column g_rad_s", ""],
    ["columns stage_rad and stage_rate_rad_s", "column g_rad_s", ""],
];

/// The likely cause of a refusal of a recording whose stage stops, with its remedy.
#[must_use]
pub fn of_stopping(
    header: &Header,
    body: &Body,
    options: &Options,
    refusal: &Refusal,
) -> Option<String> {
    if let Body::Stage(rows) = body
        && let Some(stuck) = stuck(
            rows,
            |row| row.line,
            [
                ("g_rad_s", |row: &StageRow| row.rate_rad_s),
                ("stage_rad", |row: &StageRow| row.stage_rad),
            ],
        )
    {
        return Some(stuck);
    }
    let passes = |header: &Header, body: &Body| {
        let replay = replay::replay(header, body, options, |_| {});
        replay.is_ok_and(|replay| replay.session.conclusion().is_some_and(|c| c.verdict.is_ok()))
    };
    let force = force_unit(body);
    let [alone, together] = if matches!(body, Body::Dwells(_)) { DWELLS } else { [STAGE; 2] };
    let tried = Trial::all(force)
        .find(|trial| converted(body, trial).is_some_and(|body| passes(header, &body)))
        .map(|trial| trial.told(alone, together));
    let alone = || force.map(|Unit(_, words)| format!("{}: {words}", STAGE[2]));
    tried
        .or_else(alone)
        .or_else(|| sigma_unit(body, &|body| passes(header, body)))
        .or_else(|| noise(header, body, options))
        .or_else(|| too_much(body, refusal))
}

/// The same of one whose platform turns all the time.
#[must_use]
pub fn of_turning(header: &Header, body: &Body, options: &Options) -> Option<String> {
    let Body::Rotating(rows) = body else { return None };
    let stuck = stuck(
        rows,
        |row| row.line,
        [
            ("g_rad_s", |row: &RotatingRow| row.rate_rad_s),
            ("stage_rad", |row: &RotatingRow| row.stage_rad),
        ],
    );
    let passes = |header: &Header, body: &Body| {
        let replay = rotating::replay(header, body, options);
        replay.is_ok_and(|replay| replay.conclusion().is_some_and(|c| c.verdict.is_ok()))
    };
    let try_all = || {
        let mut trials = Trial::all(None).filter(|_| rows.len() <= MOST_ROWS);
        let [alone, together] = ROTATING;
        let found = trials.find(|trial| passes(header, &Body::Rotating(turned(rows, trial))));
        found.map(|trial| trial.told(alone, together))
    };
    let noise = || {
        let stated = header.gyro_n_deg_sqrt_h?;
        let silent = Header { gyro_n_deg_sqrt_h: None, ..header.clone() };
        passes(&silent, body).then(|| {
            format!("key gyro_N_deg_sqrt_h says {stated} °/√h, but the turns show another noise: leave it out")
        })
    };
    stuck.or_else(try_all).or_else(noise)
}

/// Rows of a turning platform in the units that are tried; its rate is in those of its angle.
fn turned(rows: &[RotatingRow], trial: &Trial) -> Vec<RotatingRow> {
    let [angle, rate, _, of_stage, _] = trial.factors();
    let row = |row: &RotatingRow| RotatingRow {
        stage_rad: row.stage_rad * angle,
        stage_rate_rad_s: row.stage_rate_rad_s * of_stage,
        rate_rad_s: row.rate_rad_s * rate,
        ..*row
    };
    rows.iter().map(row).collect()
}

/// The recording in the units that are tried.
fn converted(body: &Body, trial: &Trial) -> Option<Body> {
    let [angle, rate, force, _, of_sigma] = trial.factors();
    match body {
        Body::Stage(rows) if rows.len() <= MOST_ROWS => {
            let row = |row: &StageRow| StageRow {
                stage_rad: row.stage_rad * angle,
                rate_rad_s: row.rate_rad_s * rate,
                force_m_s2: row.force_m_s2.map(|part| part * force),
                ..*row
            };
            Some(Body::Stage(rows.iter().map(row).collect()))
        }
        Body::Dwells(rows) => {
            let row = |row: &DwellRow| DwellRow {
                stage_rad: row.stage_rad * angle,
                rate_rad_s: row.rate_rad_s * rate,
                sigma_rad_s: row.sigma_rad_s * of_sigma,
                force_m_s2: row.force_m_s2.map(|parts| parts.map(|part| part * force)),
                ..*row
            };
            Some(Body::Dwells(rows.iter().map(row).collect()))
        }
        _ => None,
    }
}

/// The unit of the forces, where it is none of m/s²: at rest their size is gravity's.
fn force_unit(body: &Body) -> Option<Unit> {
    let size = |force: [f64; 3]| force.iter().map(|part| part * part).sum::<f64>().sqrt();
    let sizes: Vec<f64> = match body {
        Body::Stage(rows) => rows.iter().map(|row| size(row.force_m_s2)).collect(),
        Body::Dwells(rows) => rows.iter().filter_map(|row| row.force_m_s2.map(size)).collect(),
        _ => Vec::new(),
    };
    let mean = sizes.iter().sum::<f64>() / sizes.len().max(1) as f64;
    FORCES.into_iter().find(|Unit(factor, _)| (mean * factor / GRAVITY - 1.0).abs() < NEAR)
}

/// Whether the σ of averaged dwells alone are in another unit.
fn sigma_unit(body: &Body, passes: &dyn Fn(&Body) -> bool) -> Option<String> {
    let Body::Dwells(rows) = body else { return None };
    let with = |factor: f64| {
        let row = |row: &DwellRow| DwellRow { sigma_rad_s: row.sigma_rad_s * factor, ..*row };
        Body::Dwells(rows.iter().map(row).collect())
    };
    let [_, others @ ..] = RATES;
    let found = others.into_iter().find(|Unit(factor, _)| passes(&with(*factor)))?;
    Some(format!("column sigma_rad_s: {}", found.1))
}

/// Whether the noise that is stated is not the one that the dwells show.
fn noise(header: &Header, body: &Body, options: &Options) -> Option<String> {
    let stated = header.gyro_n_deg_sqrt_h.filter(|_| matches!(body, Body::Stage(_)))?;
    let silent = Header { gyro_n_deg_sqrt_h: None, ..header.clone() };
    let replay = replay::replay(&silent, body, options, |_| {}).ok()?;
    let conclusion = replay.session.conclusion()?;
    let Ok(Azimuth { .. }) = conclusion.verdict else { return None };
    let shown = conclusion.angle_random_walk / DEGREE * 60.0;
    let is_other = shown > OTHER_NOISE * stated || stated > OTHER_NOISE * shown;
    is_other.then(|| {
        format!(
            "key gyro_N_deg_sqrt_h says {stated} °/√h, but the dwells show {shown:.2e} °/√h: correct it, or leave \
             it out"
        )
    })
}

/// Residuals that are no noise of anything.
fn too_much(body: &Body, refusal: &Refusal) -> Option<String> {
    let Refusal::ResidualsNotWhite { ratio } = refusal else { return None };
    let stated = if matches!(body, Body::Dwells(_)) { "sigma_rad_s" } else { "gyro_N_deg_sqrt_h" };
    (*ratio > NO_NOISE)
        .then(|| format!("so much is no noise: check the units of all columns, and {stated}"))
}

/// A column's name, and its value in a row.
type Column<R> = (&'static str, fn(&R) -> f64);

/// A column with one value for most of the time.
fn stuck<R, const N: usize>(
    rows: &[R],
    line: fn(&R) -> u64,
    columns: [Column<R>; N],
) -> Option<String> {
    let longest = |value: fn(&R) -> f64| {
        rows.chunk_by(|a, b| value(a).to_bits() == value(b).to_bits()).max_by_key(|run| run.len())
    };
    columns.into_iter().find_map(|(name, value)| {
        let run = longest(value).filter(|run| run.len() as f64 > STUCK * rows.len() as f64)?;
        let (begin, count) = (line(run.first()?), run.len());
        Some(format!(
            "column {name} holds the same value in {count} rows from line {begin} on: the sensor is stuck; check \
             its supply and cable, or what wrote the column"
        ))
    })
}
