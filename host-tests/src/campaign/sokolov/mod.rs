//! Sokolov's numerical experiment ("Determining the Initial Orientation…",
//! 2019, section 3) and what it leaves open.
//!
//! White noise of 0.15 °/h on each sample at 100 Hz, a constant bias of 0.01 °/h (1σ), latitude
//! 47°35′, 60 dwells of 1 s through the sixth-order Butterworth filter in fixed point, first on the
//! paper's arc of 28′ steps, then on the full circle. The paper prints the least error of 90 runs;
//! here it stands beside the RMS and the limit.

pub(super) mod report;

use hal_mock::gyro::GyroConfiguration;
use hal_mock::instruments::InstrumentsConfiguration;
use hal_mock::stage::Stop;
use hal_mock::world::{World, WorldConfiguration};
use orientation::alignment::stepwise::Session;
use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::criterion::Criterion;
use orientation::alignment::stepwise::etalon::{self, Accepted, Limit, Series};
use orientation::alignment::stepwise::session::procedure::Procedure;
use orientation::alignment::stepwise::session::schedule::{Position, Schedule, StopRule};
use orientation::alignment::stepwise::setting::Setting;
use orientation::alignment::{Input, Refusal, Solution};
use orientation::math::reference_table::{ONE, STEP, TURN, Table as Etalon};
use orientation::signal::Sample;
use orientation::signal::dwell::Dwell;
use orientation::units::{DEGREE_PER_HOUR, Radians, RadiansPerSecond, Seconds};
use rayon::prelude::*;
use serde::Serialize;

use super::statistics::{Answer, Precision, least, rms};
use super::{Tick, over, site};
use crate::methods::stepwise::drive;
use crate::output::degrees;
use crate::reference::Filter;
use crate::simulate::stage_path;

/// Latitude of the paper, °.
const LATITUDE_DEG: f64 = 47.0 + 35.0 / 60.0;
/// Angle random walk of 0.15 °/h per sample at 100 Hz, °/√h.
const ANGLE_RANDOM_WALK: f64 = 0.000_25;
/// 1σ of the constant bias S, °/h.
const BIAS_DEG_H: f64 = 0.01;
/// Positions n.
const POSITIONS: usize = 60;
/// Samples of one dwell of 1 s.
const DWELL_SAMPLES: usize = 100;
/// Sample rate, Hz.
const RATE_HZ: f64 = 100.0;
/// Realisations for each azimuth in the paper's Table 1.
const TABLE_RUNS: usize = 90;
/// The paper's azimuths, °, moved off the 10″ grid by a third and more of a step.
const AZIMUTHS_DEG: [f64; 3] =
    [28.0 + 10.0 / 60.0 + 3.7 / 3600.0, 28.5 + 4.1 / 3600.0, 28.0 + 50.0 / 60.0 + 6.3 / 3600.0];
/// The paper's Table 1: the least error over 90 realisations, ″.
const PAPER_LEAST_ARCSEC: [f64; 3] = [7.3, 9.6, 6.0];

/// Where the stage goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// 60 steps of 28′ from azimuth 28° towards north.
    Arc,
    /// 60 steps of 6°.
    Circle,
}

/// The arc and the circle that the schedules turn through.
const TURNS: [Turn; 2] = [Turn::Arc, Turn::Circle];

impl Turn {
    /// Name of the criterion in tables.
    fn name(self) -> &'static str {
        match self {
            Self::Arc => "28° arc, steps of 28′",
            Self::Circle => "full circle, steps of 6°",
        }
    }

    /// Step Δ with its sign, rad.
    fn step(self) -> f64 {
        match self {
            Self::Arc => (-28.0_f64 / 60.0).to_radians(),
            Self::Circle => 6.0_f64.to_radians(),
        }
    }
}

/// The setting that the solver gets.
fn setting() -> Setting {
    Setting::new(site(LATITUDE_DEG, [ANGLE_RANDOM_WALK, 0.0, 0.0, 0.0]))
}

/// The samples of one realisation.
fn samples(turn: Turn, azimuth_deg: f64, seed: u64) -> Vec<Sample> {
    let stops: Vec<Stop> = (0..POSITIONS).map(|i| Stop::new(i as f64 * turn.step(), 1.0)).collect();
    let gyro = GyroConfiguration {
        n_deg_sqrt_h: ANGLE_RANDOM_WALK,
        bias_sigma_deg_h: BIAS_DEG_H,
        ..GyroConfiguration::default()
    };
    let instruments = InstrumentsConfiguration {
        latitude_deg: LATITUDE_DEG,
        azimuth_deg,
        rate_hz: RATE_HZ,
        gyro,
        ..InstrumentsConfiguration::default()
    };
    let configuration = WorldConfiguration { instruments, stops: &stops, disturbances: &[] };
    World::new(configuration, seed).map(|reading| stage_path(&reading)).collect()
}

/// The procedure that follows this turn.
fn procedure(turn: Turn) -> Procedure {
    let position =
        |i| Position { angle: Radians(f64::from(i) * turn.step()), seconds: Seconds(1.0) };
    let positions: Vec<Position> = (0..POSITIONS as u32).map(position).collect();
    let schedule =
        Schedule::listed(&positions).unwrap_or_else(|| Schedule::circle(0, Seconds(1.0)));
    let everywhere = [f64::NEG_INFINITY, f64::INFINITY].map(Radians);
    Procedure { travel: everywhere, retries: 0, ..Procedure::new(schedule, Seconds(1.0 / RATE_HZ)) }
}

/// The dwells of one realisation, through the session's fixed-point filter.
fn dwells(turn: Turn, samples: &[Sample]) -> Result<Vec<Dwell>, String> {
    let mut session =
        Session::new(setting(), procedure(turn)).map_err(|error| format!("{error:?}"))?;
    drive(&mut session, samples.iter().copied(), Input::End, |_| {});
    Ok(session.dwells().to_vec())
}

/// These dwells with rates from the filter in `f64`.
fn in_floating_point(turn: Turn, samples: &[Sample], dwells: &[Dwell]) -> Vec<Dwell> {
    let filter = Filter::low_pass(6, procedure(turn).cutoff(), RATE_HZ);
    let rates: Vec<f64> = samples.iter().map(|sample| sample.rate.rad_per_s()).collect();
    let means = rates.chunks(DWELL_SAMPLES).map(|chunk| filter.dwell_mean(chunk));
    let means = means.map(RadiansPerSecond);
    dwells.iter().zip(means).map(|(dwell, rate)| Dwell { rate, ..*dwell }).collect()
}

/// Solves by a criterion: the answer against the truth, and its bound where the Earth rate is free, °.
fn solve(dwells: &[Dwell], by: Criterion, azimuth_deg: f64) -> Result<(Answer, f64), Refusal> {
    let Conclusion { verdict, fit, .. } = Conclusion::of(&setting(), dwells, by);
    let [limit, limit_free] = fit.map_or([f64::NAN; 2], |fit| [fit.limit.0, fit.limit_free.0]);
    let solution = verdict.map(|azimuth| Solution { azimuth, limit: Radians(limit) });
    Ok((Answer::of(solution, azimuth_deg)?, degrees(limit_free)))
}

/// The paper's bounds: 1.5 and 1.25 of what the noise alone is expected to leave, so that the truth
/// is accepted nearly always.
fn criteria() -> [(&'static str, Criterion); 6] {
    // White noise of a dwell of 1 s, and of a difference of two, rad/s.
    let dwell = ANGLE_RANDOM_WALK * 60.0 * DEGREE_PER_HOUR;
    let difference = dwell * std::f64::consts::SQRT_2;
    let terms = (POSITIONS - 1) as f64;
    let absolute = terms * difference * (2.0 / std::f64::consts::PI).sqrt();
    [
        ("ml", Criterion::MaximumLikelihood),
        ("ml on the table", Criterion::OnTable),
        ("least-squares", Criterion::LeastSquares),
        ("least-absolute", Criterion::LeastAbsolute),
        ("within-squares", Criterion::WithinSquares(1.5 * terms * difference * difference)),
        ("within-absolute", Criterion::WithinAbsolute(1.25 * absolute)),
    ]
}

/// A row of the table: one criterion on one turn. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The criterion.
    pub criterion: &'static str,
    /// Errors against the bound with the Earth rate known, and σ.
    #[serde(flatten)]
    pub precision: Precision,
    /// Least error over the realisations of each azimuth.
    pub least_deg: [f64; 3],
    /// RMS of the standard deviations that were stated.
    pub sigma_deg: f64,
    /// Bound with the Earth rate free.
    pub limit_free_deg: f64,
}

/// The table of one turn. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct Table {
    /// Arc or circle that the schedule turns through.
    pub schedule: &'static str,
    /// One row for each criterion.
    pub rows: Vec<Row>,
    /// The paper's figures for its least error.
    pub paper_least_deg: [f64; 3],
    /// The stop rules on these dwells.
    pub stop_rules: Vec<StopRow>,
    /// What the paper's α accepts.
    pub paper_alpha: Vec<AlphaRow>,
}

/// When a stop rule fires.
#[derive(Clone, Debug, Serialize)]
pub struct StopRow {
    /// The rule.
    pub rule: &'static str,
    /// Median of the step at which it fires.
    pub median_step: usize,
    /// Runs in which all positions are reached.
    pub all_positions: usize,
    /// Number of runs.
    pub runs: usize,
}

/// What a bound α of Σ|·| accepts of the full circle.
#[derive(Clone, Debug, Serialize)]
pub struct AlphaRow {
    /// α, °/h.
    pub alpha_deg_h: f64,
    /// Number of runs.
    pub runs: usize,
    /// Runs in which nothing is accepted.
    pub nothing: usize,
    /// Runs in which every candidate of the paper's range, 0 to 90°, is accepted.
    pub whole_range: usize,
    /// Mean width of the accepted arc in the others, °.
    pub mean_width_deg: f64,
}

/// Three azimuths, `TABLE_RUNS` realisations each, all criteria.
///
/// # Errors
/// What keeps a session from beginning.
pub fn tabulate(turn: Turn, tick: Tick<'_>) -> Result<Table, String> {
    let realisations = over(3 * TABLE_RUNS, tick, |seed| {
        let azimuth = AZIMUTHS_DEG[(seed as usize - 1) / TABLE_RUNS];
        dwells(turn, &samples(turn, azimuth, seed))
    });
    let all = realisations.into_iter().collect::<Result<Vec<_>, String>>()?;
    let is_arc = turn == Turn::Arc;
    Ok(Table {
        schedule: turn.name(),
        rows: criteria().map(|(name, criterion)| row(&all, name, criterion)).to_vec(),
        paper_least_deg: PAPER_LEAST_ARCSEC.map(|least| least / 3600.0),
        stop_rules: if is_arc { stop_rules(&all) } else { Vec::new() },
        paper_alpha: if is_arc { paper_alpha(&all) } else { Vec::new() },
    })
}

fn row(all: &[Vec<Dwell>], name: &'static str, criterion: Criterion) -> Row {
    let of = |(run, dwells): (usize, &Vec<Dwell>)| {
        solve(dwells, criterion, AZIMUTHS_DEG[run / TABLE_RUNS])
    };
    let solved: Vec<Result<(Answer, f64), Refusal>> = all.par_iter().enumerate().map(of).collect();
    let answers: Vec<_> = solved.iter().map(|run| run.map(|(answer, _)| answer)).collect();
    Row {
        criterion: name,
        precision: Precision::of(&answers),
        least_deg: [0, 1, 2].map(|place: usize| {
            let runs = answers.iter().skip(place * TABLE_RUNS).take(TABLE_RUNS);
            least(runs.flatten().map(|answer| answer.error))
        }),
        sigma_deg: rms(answers.iter().flatten().map(|answer| answer.sigma)),
        limit_free_deg: rms(solved.iter().flatten().map(|(_, limit_free)| limit_free)),
    }
}

/// The step at which a rule would have stopped; `POSITIONS` where it never does.
fn stopped_at(dwells: &[Dwell], rule: StopRule) -> usize {
    let sigma = ANGLE_RANDOM_WALK * 60.0 * DEGREE_PER_HOUR * std::f64::consts::SQRT_2;
    let difference = |pair: &[Dwell]| RadiansPerSecond(pair[1].rate.0 - pair[0].rate.0);
    let stops = |pair: &[Dwell]| rule.stops(difference(pair), RadiansPerSecond(sigma));
    dwells.windows(2).position(stops).map_or(POSITIONS, |index| index + 2)
}

fn stop_rules(all: &[Vec<Dwell>]) -> Vec<StopRow> {
    let rules = [
        ("the paper's: δ changes sign", StopRule::SignChange),
        ("significant: δ < −3 σ", StopRule::Significant(3.0)),
    ];
    let row = |(name, rule)| {
        let mut steps: Vec<usize> = all.iter().map(|dwells| stopped_at(dwells, rule)).collect();
        steps.sort_unstable();
        StopRow {
            rule: name,
            median_step: steps.get(steps.len() / 2).copied().unwrap_or(POSITIONS),
            all_positions: steps.iter().filter(|&&step| step == POSITIONS).count(),
            runs: steps.len(),
        }
    };
    rules.into_iter().map(row).collect()
}

/// The paper's α = 5″ read as 5 °/h, and as 5″/h.
fn paper_alpha(all: &[Vec<Dwell>]) -> Vec<AlphaRow> {
    [5.0, 5.0 / 3600.0].into_iter().map(|alpha| alpha_row(all, alpha)).collect()
}

fn alpha_row(all: &[Vec<Dwell>], alpha_deg_h: f64) -> AlphaRow {
    let rate = setting().site.latitude.horizontal_rate();
    let limit = Limit::WithinAbsolute((alpha_deg_h * DEGREE_PER_HOUR / rate.0 * ONE) as u64);
    let step = (Turn::Arc.step() / STEP).round() as i32;
    let accepted: Vec<Accepted> = all
        .par_iter()
        .filter_map(|dwells| {
            let series =
                Series::new(dwells.iter().map(|dwell| dwell.rate.0 / rate.0), step).ok()?;
            Some(etalon::accepted(Etalon::built_in(), &series, limit).accepted)
        })
        .collect();
    let widths: Vec<f64> = accepted.iter().filter_map(|&accepted| width_deg(accepted)).collect();
    AlphaRow {
        alpha_deg_h,
        runs: accepted.len(),
        nothing: accepted.iter().filter(|&&accepted| accepted == Accepted::Nothing).count(),
        whole_range: accepted.iter().filter(|&&accepted| covers_quarter(accepted)).count(),
        mean_width_deg: widths.iter().fold(0.0, |sum, width| sum + width)
            / widths.len().max(1) as f64,
    }
}

fn width_deg(accepted: Accepted) -> Option<f64> {
    match accepted {
        Accepted::Nothing => None,
        Accepted::Arc { width, .. } => Some((f64::from(width) * STEP).to_degrees()),
        Accepted::Everything => Some(360.0),
    }
}

/// Whether 0 to 90° of the last position's azimuth, the paper's range, are all accepted.
fn covers_quarter(accepted: Accepted) -> bool {
    let Accepted::Arc { first, width, .. } = accepted else {
        return accepted == Accepted::Everything;
    };
    let turned = (Turn::Arc.step() / STEP * (POSITIONS - 1) as f64).round() as i32;
    let from = (0 - turned - first).rem_euclid(TURN);
    from + TURN / 4 <= width
}

/// How maximum likelihood does over many azimuths, and what fixed point costs it. Angles in degrees.
#[derive(Clone, Debug, Serialize)]
pub struct FixedPoint {
    /// Arc or circle that the schedule turns through.
    pub schedule: &'static str,
    /// Errors through fixed point against limit and σ.
    #[serde(flatten)]
    pub precision: Precision,
    /// RMS error of the same path in `f64`.
    pub rms_floating_point_deg: f64,
    /// RMS of the fixed-point path over that of the `f64` path.
    pub fixed_point_ratio: f64,
}

/// Azimuths of the realisations: 28°…29° on the arc, all around on the circle, off the grid.
fn azimuth_of(turn: Turn, run: u64) -> f64 {
    // Steps of the golden section fill the range evenly.
    let fraction = (run as f64 * 0.618_033_988_749_895).fract();
    match turn {
        Turn::Arc => 28.0 + fraction,
        Turn::Circle => 360.0 * fraction,
    }
}

/// Runs `runs` realisations through the fixed-point path and through `f64`.
///
/// # Errors
/// What keeps a session from beginning.
pub fn fixed_point(turn: Turn, runs: usize, tick: Tick<'_>) -> Result<FixedPoint, String> {
    let pairs = over(runs, tick, |seed| {
        let azimuth = azimuth_of(turn, seed - 1);
        let samples = samples(turn, azimuth, (1 << 32) + seed - 1);
        let fixed = dwells(turn, &samples)?;
        let floating = in_floating_point(turn, &samples, &fixed);
        let [fixed, floating] =
            [fixed, floating].map(|of| solve(&of, Criterion::MaximumLikelihood, azimuth));
        Ok(fixed.and_then(|(fixed, _)| floating.map(|(floating, _)| [fixed, floating])))
    });
    let pairs = pairs.into_iter().collect::<Result<Vec<Result<_, Refusal>>, String>>()?;
    let [precision, floating] = [0, 1].map(|path: usize| {
        let answers: Vec<_> = pairs.iter().map(|pair| pair.map(|both| both[path])).collect();
        Precision::of(&answers)
    });
    Ok(FixedPoint {
        schedule: turn.name(),
        rms_floating_point_deg: floating.rms_deg,
        fixed_point_ratio: precision.rms_deg / floating.rms_deg,
        precision,
    })
}
