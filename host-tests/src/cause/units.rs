//! Columns in another unit, or counted the other way: proven by the columns themselves, or found by trying.

use orientation::units::DEGREE;

use crate::campaign::statistics::rms;
use crate::median::{extremes, median};
use crate::methods::asked::Question;
use crate::methods::stepwise;
use crate::recording::{Body, DwellRow, RotatingRow, StageRow};

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;
/// rad/s of a degree an hour.
const PER_HOUR: f64 = DEGREE / 3600.0;
/// rad/s of a turn a minute.
const PER_MINUTE: f64 = 360.0 * DEGREE / 60.0;
/// Longest recordings that are tried again, rows: a try copies them.
pub const MOST_ROWS: usize = 2_000_000;
/// How far what is compared may be off in the unit that is meant, relative.
const NEAR: f64 = 0.2;
/// Angle over which a stage in degrees goes that seems to be in radians, rad: more than a turn.
const TURNS_OVER: f64 = 7.0;
/// Least scatter of dwells in their σ where those are in the unit that is meant.
const LEAST_SCATTER: f64 = 0.3;

/// Another unit of a column: its factor to the one that is meant, and the words for it.
#[derive(Clone, Copy)]
pub struct Unit(pub f64, &'static str);

impl Unit {
    /// What is wrong with a column, in words.
    pub fn describe(&self, column: &str) -> String {
        format!("{column}: {}", self.1)
    }
}

const SAME: Unit = Unit(1.0, "");
const DEGREES: Unit = Unit(DEGREE, "in degrees, as it seems, not rad: multiply by 0.0174532925");
const REVERSED: Unit = Unit(
    -1.0,
    "counted the other way, as it seems, not clockwise from above, or the forces have another sign across the \
     sensitive axis: multiply by -1 once that is sure",
);
/// Units of rates.
pub const RATES: [Unit; 2] = [
    Unit(DEGREE, "in °/s, as it seems, not rad/s: multiply by 0.0174532925"),
    Unit(PER_HOUR, "in °/h, as it seems, not rad/s: multiply by 4.84813681e-6"),
];
const FORCES: [Unit; 2] = [
    Unit(GRAVITY, "in g, as it seems, not m/s²: multiply by 9.80665"),
    Unit(GRAVITY * 1e-3, "in mg, as it seems, not m/s²: multiply by 0.00980665"),
];
const TURN_RATES: [Unit; 3] = [
    RATES[0],
    Unit(PER_MINUTE, "in turns a minute, as it seems, not rad/s: multiply by 0.104719755"),
    Unit(-1.0, "its sign is the other way, as it seems: multiply by -1"),
];

/// What is tried: units of the stage angle, the rate and the forces.
#[derive(Clone, Copy)]
pub struct Trial {
    angle: Unit,
    rate: Unit,
    force: Unit,
    /// Whether what goes with a column is in its unit: the stage's rate with its angle, σ with a mean rate.
    together: bool,
}

impl Trial {
    /// All, those with one change first.
    fn all(body: &Body, force: Option<Unit>) -> Vec<Self> {
        let [second, hour] = RATES;
        let is_turned = turns_over(body) > TURNS_OVER;
        let degrees = [(DEGREES, SAME), (DEGREES, second), (DEGREES, hour)];
        let [first, rest @ ..] = degrees.map(|pair| is_turned.then_some(pair));
        let others = [(REVERSED, SAME), (SAME, second), (SAME, hour)].map(Some);
        let alone = force.map(|_| (SAME, SAME));
        let pairs = [alone, first].into_iter().chain(others).chain(rest).flatten();
        let trial =
            |(angle, rate)| Self { angle, rate, force: force.unwrap_or(SAME), together: true };
        let heavy = FORCES.map(|force| Self { force, ..trial((SAME, SAME)) });
        let with = |trial: Self| [Some(trial), trial.apart(body)].into_iter().flatten();
        pairs
            .map(trial)
            .flat_map(with)
            .chain(heavy.into_iter().filter(|unit| is_heavy(body, unit.force)))
            .collect()
    }

    /// Whether nothing but the sense of the stage is another.
    pub fn is_reversed(&self) -> bool {
        let Self { angle: Unit(angle, _), rate: Unit(rate, _), force: Unit(force, _), .. } = *self;
        angle < 0.0 && rate == 1.0 && force == 1.0
    }

    /// This trial with only one column in another unit; none where both must change together.
    fn apart(self, body: &Body) -> Option<Self> {
        (!matches!(body, Body::Stage(_))).then_some(Self { together: false, ..self })
    }

    /// What is wrong with the columns, in words.
    pub fn describe(&self, body: &Body) -> String {
        let [angle, rate, force] = names(body, self.together);
        let units = [(angle, self.angle), (rate, self.rate), (force, self.force)];
        let wrong = units.into_iter().filter(|(_, Unit(_, words))| !words.is_empty());
        wrong.map(|(name, unit)| unit.describe(name)).collect::<Vec<_>>().join("; ")
    }

    /// The factors of the stage angle, the rate, the forces, and of what goes with angle and rate.
    fn factors(&self) -> [f64; 5] {
        let [angle, rate, force] = [self.angle.0, self.rate.0, self.force.0];
        let companions = if self.together { [angle, rate.abs()] } else { [1.0; 2] };
        [angle, rate, force, companions[0], companions[1]]
    }
}

/// Swing of a platform's force, m/s², that a tilt of 6° makes.
const HEAVY: f64 = 1.0;

/// The columns of a kind, alone or with what goes with them: stage angle, rate, forces.
fn names(body: &Body, together: bool) -> [&'static str; 3] {
    let (angle, rate) = match body {
        Body::Rotating(_) if together => {
            ("columns stage_rad and stage_rate_rad_s", "column g_rad_s")
        }
        Body::Dwells(_) if together => ("column stage_rad", "columns rate_rad_s and sigma_rad_s"),
        Body::Dwells(_) => ("column stage_rad", "column rate_rad_s"),
        _ => ("column stage_rad", "column g_rad_s"),
    };
    [angle, rate, force_columns(body)]
}

/// The forces' columns of a kind.
pub fn force_columns(body: &Body) -> &'static str {
    match body {
        Body::Imu(_) | Body::Static(_) => "columns ax_m_s2 to az_m_s2",
        Body::Rotating(_) => "column a_m_s2",
        _ => "columns fx_m_s2 to fz_m_s2",
    }
}

/// The units with which a recording passes; those of the rate only where the sensor's gain is known.
pub fn tried(
    body: &Body,
    force: Option<Unit>,
    gain_is_known: bool,
    passes: &dyn Fn(&Body) -> bool,
) -> Option<Trial> {
    let is_possible = |trial: &Trial| gain_is_known || trial.rate.0 == 1.0;
    let is_meant = |trial: &Trial| converted(body, trial).is_some_and(|body| passes(&body));
    Trial::all(body, force).into_iter().filter(is_possible).find(is_meant)
}

/// Whether the forces of a platform that turns may be in a unit of gravity: in its thousandths they swing by more than
/// those of a platform in m/s², of which a smaller tilt would explain anything.
fn is_heavy(body: &Body, Unit(factor, _): Unit) -> bool {
    let Body::Rotating(rows) = body else { return false };
    let count = rows.len().max(1) as f64;
    let mean = rows.iter().map(|row| row.force_m_s2).sum::<f64>() / count;
    let power = rows.iter().map(|row| (row.force_m_s2 - mean).powi(2)).sum::<f64>() / count;
    factor > 1.0 || (2.0 * power).sqrt() > HEAVY
}

/// The angle over which a stage turned, rad, were its column in radians.
fn turns_over(body: &Body) -> f64 {
    let angles: Vec<f64> = match body {
        Body::Stage(rows) => rows.iter().map(|row| row.stage_rad).collect(),
        Body::Dwells(rows) => rows.iter().map(|row| row.stage_rad).collect(),
        Body::Rotating(rows) => rows.iter().map(|row| row.stage_rad).collect(),
        _ => Vec::new(),
    };
    let [least, greatest] = extremes(angles);
    greatest - least
}

/// The recording in the units that are tried; none of one that is too long to be copied.
fn converted(body: &Body, trial: &Trial) -> Option<Body> {
    let [angle, rate, force, of_stage, of_sigma] = trial.factors();
    let stage = |row: &StageRow| StageRow {
        stage_rad: row.stage_rad * angle,
        rate_rad_s: row.rate_rad_s * rate,
        force_m_s2: row.force_m_s2.map(|part| part * force),
        ..*row
    };
    let dwell = |row: &DwellRow| DwellRow {
        stage_rad: row.stage_rad * angle,
        rate_rad_s: row.rate_rad_s * rate,
        sigma_rad_s: row.sigma_rad_s * of_sigma,
        force_m_s2: row.force_m_s2.map(|parts| parts.map(|part| part * force)),
        ..*row
    };
    let platform = |row: &RotatingRow| RotatingRow {
        stage_rad: row.stage_rad * angle,
        stage_rate_rad_s: row.stage_rate_rad_s * of_stage,
        rate_rad_s: row.rate_rad_s * rate,
        force_m_s2: row.force_m_s2 * force,
        across_m_s2: row.across_m_s2.map(|part| part * force),
        ..*row
    };
    match body {
        Body::Stage(rows) => all(rows, stage).map(Body::Stage),
        Body::Dwells(rows) => all(rows, dwell).map(Body::Dwells),
        Body::Rotating(rows) => all(rows, platform).map(Body::Rotating),
        _ => None,
    }
}

/// Every row converted; none of more rows than are tried again.
fn all<R>(rows: &[R], converted: impl Fn(&R) -> R) -> Option<Vec<R>> {
    (rows.len() <= MOST_ROWS).then(|| rows.iter().map(converted).collect())
}

/// The unit of the forces, where it is none of m/s²: their size is gravity's most of the time.
pub fn force_unit(body: &Body) -> Option<Unit> {
    let size = |force: [f64; 3]| force.iter().map(|part| part * part).sum::<f64>().sqrt();
    let sizes: Vec<f64> = match body {
        Body::Stage(rows) => rows.iter().map(|row| size(row.force_m_s2)).collect(),
        Body::Dwells(rows) => rows.iter().filter_map(|row| row.force_m_s2.map(size)).collect(),
        Body::Imu(rows) => rows.iter().map(|row| size(row.sample.force_m_s2)).collect(),
        Body::Static(rows) => {
            rows.iter().filter_map(|row| row.imu.map(|imu| size(imu.force_m_s2))).collect()
        }
        Body::Rotating(_) | Body::Spin(_) => Vec::new(),
    };
    let usual = median(sizes);
    FORCES.into_iter().find(|Unit(factor, _)| (usual * factor / GRAVITY - 1.0).abs() < NEAR)
}

/// What is wrong with the forces' unit, in words.
pub fn of_forces(body: &Body) -> Option<String> {
    force_unit(body).map(|unit| unit.describe(force_columns(body)))
}

/// What is wrong with the rate of a platform, which its angle shows.
pub fn of_platform_rate(rows: &[RotatingRow]) -> Option<String> {
    let (mut turned, mut stated) = (0.0, 0.0);
    for pair in rows.windows(2) {
        let (step, seconds) =
            (pair[1].stage_rad - pair[0].stage_rad, pair[1].time_s - pair[0].time_s);
        let rate = 0.5 * (pair[0].stage_rate_rad_s + pair[1].stage_rate_rad_s);
        turned += step * rate.signum();
        stated += rate.abs() * seconds;
    }
    let is = |factor: f64| (turned / (factor * stated) - 1.0).abs() < NEAR;
    if is(1.0 / DEGREE) {
        return Some(DEGREES.describe("column stage_rad"));
    }
    let unit = TURN_RATES.into_iter().find(|Unit(factor, _)| is(*factor))?;
    Some(unit.describe("column stage_rate_rad_s"))
}

/// Whether the σ of averaged dwells alone are in another unit: in the one that is meant they pass, and scatter so.
pub fn of_sigma(of: &Question) -> Option<String> {
    let Question { header, body, asked } = *of;
    let Body::Dwells(rows) = body else { return None };
    let passes = |Unit(factor, _): &Unit| {
        let row = |row: &DwellRow| DwellRow { sigma_rad_s: row.sigma_rad_s * factor, ..*row };
        let body = Body::Dwells(rows.iter().map(row).collect());
        let replay = stepwise::replay(header, &body, asked, |_| {}).ok()?;
        let conclusion = replay.session.conclusion().filter(|found| found.verdict.is_ok())?;
        let scatter = rms(conclusion.residuals.iter().map(|residual| residual.normalised));
        (scatter > LEAST_SCATTER).then_some(())
    };
    let unit = RATES.into_iter().find(|unit| passes(unit).is_some())?;
    Some(unit.describe("column sigma_rad_s"))
}
