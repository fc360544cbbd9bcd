//! `meridian campaign`: many simulated alignments.

use std::path::{Path, PathBuf};

use bench::campaign::burov::{classes, devices, drift};
use bench::campaign::rotating::{molecular, refusals, stages};
use bench::campaign::sokolov::{self, Turn};
use bench::campaign::spin::{cases, paper};
use bench::campaign::szymanowski::{drives, parked};
use bench::campaign::{disturbed, faults, instrument, keep};
use bench::output::progress::Progress;
use bench::output::rotating::campaign as of_rotating;
use bench::output::table;
use bench::output::{
    burov as told, disturbed as of_disturbed, keep as of_keep, page, spin as of_spin,
    stops as of_stops,
};
use clap::{Args, ValueEnum};
use firmware::simulated::fault::Platform;
use serde_json::json;

use super::{Told, faults as of_run, files, whole};

/// Which campaign, how long.
#[derive(Args)]
pub struct CampaignOptions {
    /// Which campaign.
    #[arg(value_enum, default_value = "sokolov")]
    name: Campaign,
    /// How many runs: of sokolov on each schedule (5000), of burov on each schedule (5000)
    /// and for each class a tenth of it, of rotating in each table (500), of each of its refusals a
    /// tenth of it, of szymanowski, keep and spin in each row (500), of instrument (500), of each
    /// fault (1), of each class of disturbed (200).
    #[arg(long, value_parser = whole::<1, 1_000_000>)]
    runs: Option<u64>,
    /// Writes figures and tables as a page for a browser; of burov, keep, rotating, spin and szymanowski.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// The only platform to run, of faults: stage, two-frame, turntable, vehicle or spin.
    #[arg(long, value_name = "NAME", value_parser = of_run::platform)]
    platform: Option<Platform>,
    /// The only class to run, of disturbed.
    #[arg(long, value_name = "NAME")]
    class: Option<String>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Campaign {
    /// The numerical experiment of Sokolov 2019: stepwise gyrocompassing, all five criteria.
    Sokolov,
    /// Burov's optimisation, his devices and classes, and schedules under drift.
    Burov,
    /// Papers/004: a platform that turns all the time, its errors and what is done about each.
    Rotating,
    /// The roll of a spinning body: the figures of Nekrasova 2017, then noise, and a lift that fades.
    Spin,
    /// Azimuth from stops: Szymanowski's Table 1 over many drives, and vehicles that stand and sway.
    Szymanowski,
    /// Storage of the azimuth, pitch and roll in vehicles that drive: Burov's classes.
    Keep,
    /// The whole instrument on simulated chips, over drawn sites and attitudes.
    Instrument,
    /// Every fault on every platform: what the board notices, and what comes of it.
    Faults,
    /// Recordings with faults of any severity: what gets past, and what is refused without need.
    Disturbed,
}

impl CampaignOptions {
    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    pub fn check(&self) -> Result<(), String> {
        use Campaign::{Burov, Keep, Rotating, Spin, Szymanowski};
        if self.platform.is_some() && !matches!(self.name, Campaign::Faults) {
            return Err(format!(
                "--platform: {} does not take it: only faults has platforms",
                self.campaign()
            ));
        }
        if self.class.is_some() && !matches!(self.name, Campaign::Disturbed) {
            return Err(format!(
                "--class: {} does not take it: only disturbed has classes",
                self.campaign()
            ));
        }
        if let Some(class) = &self.class
            && disturbed::classes().all(|of| of.name != class)
        {
            let names: Vec<_> = disturbed::classes().map(|class| class.name).collect();
            return Err(format!("--class: the classes are {}", names.join(", ")));
        }
        let draws = matches!(self.name, Burov | Keep | Rotating | Spin | Szymanowski);
        if self.report.is_some() && !draws {
            let campaign = self.campaign();
            let why = "only burov, keep, rotating, spin and szymanowski draw";
            return Err(format!("--report: {campaign} does not take it: {why}"));
        }
        files::check(None, &[files::written("--report", "the page", self.report.as_ref())])
    }

    /// The campaign's name on the command line.
    fn campaign(&self) -> String {
        let value = self.name.to_possible_value();
        format!("campaign {}", value.as_ref().map_or("", |value| value.get_name()))
    }
}

/// Runs a campaign.
pub fn run(options: &CampaignOptions, as_json: bool) -> Result<Told, String> {
    let runs = |usual: u64| options.runs.unwrap_or(usual) as usize;
    match options.name {
        Campaign::Sokolov => sokolov(runs(5000), as_json),
        Campaign::Burov => burov(runs(5000), options.report.as_deref(), as_json),
        Campaign::Rotating => rotating(runs(500), options.report.as_deref(), as_json),
        Campaign::Spin => spin(runs(500), options.report.as_deref(), as_json),
        Campaign::Szymanowski => szymanowski(runs(500), options.report.as_deref(), as_json),
        Campaign::Keep => keep(runs(500), options.report.as_deref(), as_json),
        Campaign::Instrument => instrument(runs(500), as_json),
        Campaign::Faults => faults(options.platform, runs(1), as_json),
        Campaign::Disturbed => disturbed(runs(200), options.class.as_deref(), as_json),
    }
}

/// Both schedules: the paper's table, then the precision.
fn sokolov(runs: usize, as_json: bool) -> Result<Told, String> {
    let turns = [Turn::Arc, Turn::Circle];
    let total = turns.len() * (3 * sokolov::TABLE_RUNS + runs);
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let tables = turns.map(|turn| sokolov::tabulate(turn, tick));
    let tables = tables.into_iter().collect::<Result<Vec<_>, _>>()?;
    let precisions = turns.map(|turn| sokolov::precision(turn, runs, tick));
    let precisions = precisions.into_iter().collect::<Result<Vec<_>, _>>()?;
    progress.finish();
    let object = json!({
        "campaign": "sokolov", "status": "ok", "tables": tables, "precision": precisions,
    });
    Told::of(true, as_json, &object, |text| table::sokolov(text, &tables, &precisions))
}

/// The paper's example and devices, schedules under drift, the five classes; a result where every row
/// is met.
fn burov(runs: usize, report: Option<&Path>, as_json: bool) -> Result<Told, String> {
    let of_class = (runs / 10).max(1);
    let total = 2 * drift::GYROS.len() * runs + classes::COUNT * of_class;
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let compared = drift::GYROS.map(|gyro| drift::compare(gyro, runs, tick));
    let compared: Vec<_> = compared.into_iter().flatten().collect();
    let rows = classes::rows(of_class, tick);
    progress.finish();
    let (curve, devices) = (devices::curve(8..=14), devices::devices());
    let found = rows.iter().all(|row| row.is_met);
    let status = if found { "ok" } else { "failed" };
    let object = json!({
        "campaign": "burov", "status": status, "devices": devices, "rate_error_deg_h": curve,
        "drift": compared, "classes": rows,
    });
    let told = Told::of(found, as_json, &object, |text| {
        told::devices(text, &curve, &devices)?;
        told::drift(text, &compared)?;
        told::classes(text, &rows)
    })?;
    let refusal = (!found).then(|| {
        "a class does not meet its row; with few runs (a tenth of --runs) that may be chance"
            .to_owned()
    });
    let told = Told { refusal, ..told };
    Ok(told.with_page(report, || page::burov::report(&devices, &compared, &rows)))
}

/// The stages of compensation, molecular-electronic sensors, and what must be refused; a result where no
/// healthy run was refused and no north was wrong.
fn rotating(runs: usize, report: Option<&Path>, as_json: bool) -> Result<Told, String> {
    let of_case = (runs / 10).max(1);
    let tables = stages::WALKS.len() + molecular::COUNT;
    let total = tables * runs + refusals::COUNT * of_case;
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let stages = stages::rows(runs, tick);
    let molecular = molecular::rows(runs, tick);
    let refusals = refusals::rows(of_case, tick);
    progress.finish();
    let healthy = stages.iter().map(|row| &row.precision);
    let mut healthy = healthy.chain(molecular.iter().map(|row| &row.precision));
    let found = healthy.all(|row| row.refused == 0) && refusals.iter().all(|row| row.wrong == 0);
    let status = if found { "ok" } else { "failed" };
    let object = json!({
        "campaign": "rotating", "status": status, "stages": stages, "molecular": molecular,
        "refusals": refusals,
    });
    let told = Told::of(found, as_json, &object, |text| {
        of_rotating::stages(text, &stages)?;
        of_rotating::molecular(text, &molecular)?;
        of_rotating::refusals(text, &refusals)
    })?;
    let refusal = (!found).then(|| "a healthy run was refused, or a north was wrong".to_owned());
    let told = Told { refusal, ..told };
    Ok(told.with_page(report, || page::rotating::campaign::report(&stages, &molecular, &refusals)))
}

/// The paper's second, and flights with noise; a result where no roll was lost and no turn miscounted.
fn spin(runs: usize, report: Option<&Path>, as_json: bool) -> Result<Told, String> {
    let progress = Progress::new((cases::COUNT * runs) as u64, "flights");
    let paper = paper::paper();
    let rows = cases::rows(runs, || progress.step());
    progress.finish();
    let found = rows.iter().all(|row| row.lost == 0 && row.miscounted == 0);
    let status = if found { "ok" } else { "failed" };
    let object = json!({ "campaign": "spin", "status": status, "paper": paper, "flights": rows });
    let told = Told::of(found, as_json, &object, |text| {
        of_spin::campaign::paper(text, &paper)?;
        of_spin::campaign::cases(text, &rows)
    })?;
    let refusal = (!found).then(|| "a roll was lost, or a turn miscounted".to_owned());
    let told = Told { refusal, ..told };
    Ok(told.with_page(report, || page::spin::campaign::report(&paper, &rows)))
}

/// Drives between stops, and parked vehicles; a result where none was refused.
fn szymanowski(runs: usize, report: Option<&Path>, as_json: bool) -> Result<Told, String> {
    let progress = Progress::new(((drives::COUNT + parked::COUNT) * runs) as u64, "vehicles");
    let tick = || progress.step();
    let drives = drives::rows(runs, tick);
    let parked = parked::rows(runs, tick);
    progress.finish();
    let driven = drives.iter().map(|row| &row.precision);
    let mut all = driven.chain(parked.iter().map(|row| &row.precision));
    let found = all.all(|row| row.refused == 0);
    let status = if found { "ok" } else { "failed" };
    let object = json!({
        "campaign": "szymanowski", "status": status, "drives": drives, "parked": parked,
    });
    let told = Told::of(found, as_json, &object, |text| {
        of_stops::campaign::drives(text, &drives)?;
        of_stops::campaign::parked(text, &parked)
    })?;
    let refusal = (!found).then(|| "a healthy vehicle was refused".to_owned());
    let told = Told { refusal, ..told };
    Ok(told.with_page(report, || page::stops::campaign::report(&drives, &parked)))
}

/// Azimuth, pitch and roll through half an hour of driving; a result where every row that is to be met is.
fn keep(runs: usize, report: Option<&Path>, as_json: bool) -> Result<Told, String> {
    let progress = Progress::new((keep::COUNT * runs) as u64, "vehicles");
    let rows = keep::rows(runs, || progress.step());
    progress.finish();
    let found = rows.iter().all(|row| row.is_met || !row.is_wanted);
    let status = if found { "ok" } else { "failed" };
    let object = json!({ "campaign": "keep", "status": status, "classes": rows });
    let told = Told::of(found, as_json, &object, |text| of_keep::rows(text, &rows))?;
    let refusal = (!found)
        .then(|| "a class does not meet its row; with few runs that may be chance".to_owned());
    let told = Told { refusal, ..told };
    Ok(told.with_page(report, || page::keep::report(&rows)))
}

/// The whole instrument over many seeds; a result where none was refused.
fn instrument(runs: usize, as_json: bool) -> Result<Told, String> {
    let progress = Progress::new(runs as u64, "alignments");
    let row = instrument::precision(runs, || progress.step()).map_err(|error| error.to_string())?;
    progress.finish();
    let found = row.precision.refused == 0;
    let status = if found { "ok" } else { "failed" };
    let object = json!({ "campaign": "instrument", "status": status, "precision": row });
    let told = Told::of(found, as_json, &object, |text| table::instrument(text, &row))?;
    let refusal = (!found).then(|| "a healthy board was refused".to_owned());
    Ok(Told { refusal, ..told })
}

/// Every fault of one platform or of all with every seed; a result where none was answered wrongly or missed.
fn faults(platform: Option<Platform>, runs: usize, as_json: bool) -> Result<Told, String> {
    let platforms = platform.map_or_else(|| Platform::ALL.to_vec(), |platform| vec![platform]);
    let progress = Progress::new((faults::count(&platforms) * runs) as u64, "faults");
    let rows = faults::rows(&platforms, 1..=runs as u64, || progress.step());
    progress.finish();
    let bad = rows.iter().filter(|row| row.is_bad()).count();
    let status = if bad == 0 { "ok" } else { "failed" };
    let object = json!({ "campaign": "faults", "status": status, "faults": rows });
    let told = Told::of(bad == 0, as_json, &object, |text| table::faults(text, &rows))?;
    let words = "gave a wrong north or roll, came to no end, or went unnoticed";
    let refusal = (bad > 0).then(|| format!("{bad} of {} faults {words}", rows.len()));
    Ok(Told { refusal, ..told })
}

/// Healthy recordings for each run of a class.
const HEALTHY: usize = 15;

/// Every class of faults in recordings; a result where each passes.
fn disturbed(runs: usize, class: Option<&str>, as_json: bool) -> Result<Told, String> {
    let chosen: Vec<_> =
        disturbed::classes().filter(|of| class.is_none_or(|name| of.name == name)).collect();
    let healthy_runs = if class.is_none() { HEALTHY * runs } else { 0 };
    let progress = Progress::new((chosen.len() * runs + healthy_runs) as u64, "recordings");
    let tick = || progress.step();
    let healthy = match class {
        None => disturbed::healthy(healthy_runs, &tick),
        Some(_) => Vec::new(),
    };
    let rows: Vec<_> = chosen.into_iter().map(|class| disturbed::row(class, runs, &tick)).collect();
    progress.finish();
    let found = rows.iter().all(|row| row.is_met);
    let status = if found { "ok" } else { "failed" };
    let object = json!({
        "campaign": "disturbed", "status": status, "healthy": healthy, "classes": rows,
    });
    let told = Told::of(found, as_json, &object, |text| {
        of_disturbed::healthy(text, &healthy)?;
        of_disturbed::rows(text, &rows)
    })?;
    let refusal =
        (!found).then(|| "a class of faults gets past, or is refused without need".to_owned());
    Ok(Told { refusal, ..told })
}
