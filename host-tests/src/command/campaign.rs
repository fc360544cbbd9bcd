//! `meridian campaign`: many simulated alignments.

use std::path::PathBuf;

use bench::campaign::burov::{classes, devices, drift};
use bench::campaign::rotating::{molecular, refusals, stages};
use bench::campaign::sokolov::{self, Turn};
use bench::campaign::spin::{cases, paper};
use bench::campaign::szymanowski::{drives, parked};
use bench::campaign::{disturbed, faults, instrument, keep};
use bench::output::campaign as reports;
use bench::output::progress::Progress;
use bench::report::Report;
use clap::{Args, ValueEnum};
use firmware::simulated::fault::Platform;
use serde_json::{Value, json};

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
    /// Writes figures and tables as a page for a browser.
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
    /// A platform that turns all the time (MET 2018), its errors and what is done about each.
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
            && disturbed::classes().all(|of| of.fault.name != *class)
        {
            let names: Vec<_> = disturbed::classes().map(|class| class.fault.name).collect();
            return Err(format!("--class: the classes are {}", names.join(", ")));
        }
        files::check(None, &[files::written("--report", "the page", self.report.as_ref())])
    }

    /// The campaign's name on the command line.
    fn campaign(&self) -> String {
        let value = self.name.to_possible_value();
        format!("campaign {}", value.as_ref().map_or("", |value| value.get_name()))
    }
}

/// What a campaign gave, ready to be shown.
struct Done {
    /// Its JSON object but for the status.
    object: Value,
    /// Its text and page.
    report: Report,
    /// Why it is no result, where it is none.
    refusal: Option<&'static str>,
}

/// Runs a campaign.
pub fn run(options: &CampaignOptions, as_json: bool) -> Result<Told, String> {
    let runs = |usual: u64| options.runs.unwrap_or(usual) as usize;
    let Done { mut object, report, refusal } = match options.name {
        Campaign::Sokolov => sokolov(runs(5000))?,
        Campaign::Burov => burov(runs(5000)),
        Campaign::Rotating => rotating(runs(500)),
        Campaign::Spin => spin(runs(500)),
        Campaign::Szymanowski => szymanowski(runs(500)),
        Campaign::Keep => keep(runs(500)),
        Campaign::Instrument => instrument(runs(500))?,
        Campaign::Faults => faults(options.platform, runs(1)),
        Campaign::Disturbed => disturbed(runs(200), options.class.as_deref()),
    };
    object["campaign"] =
        options.name.to_possible_value().map_or(Value::Null, |name| name.get_name().into());
    object["status"] = if refusal.is_none() { "ok" } else { "failed" }.into();
    let told = Told::of(refusal.is_none(), as_json, &object, |text| {
        text.push_str(&report.text());
        Ok(())
    })?;
    let told = Told { refusal: refusal.map(str::to_owned), ..told };
    Ok(told.with_page(options.report.as_deref(), || report))
}

/// A reason where something is not so.
fn unless(found: bool, reason: &'static str) -> Option<&'static str> {
    (!found).then_some(reason)
}

/// Both schedules: the paper's table, then the precision.
fn sokolov(runs: usize) -> Result<Done, String> {
    let turns = [Turn::Arc, Turn::Circle];
    let total = turns.len() * (3 * sokolov::TABLE_RUNS + runs);
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let tables = turns.map(|turn| sokolov::tabulate(turn, tick));
    let tables = tables.into_iter().collect::<Result<Vec<_>, _>>()?;
    let precisions = turns.map(|turn| sokolov::precision(turn, runs, tick));
    let precisions = precisions.into_iter().collect::<Result<Vec<_>, _>>()?;
    progress.finish();
    let object = json!({ "tables": tables, "precision": precisions });
    Ok(Done { object, report: reports::sokolov::report(&tables, &precisions), refusal: None })
}

/// The paper's example and devices, schedules under drift, the five classes; a result where every row is met.
fn burov(runs: usize) -> Done {
    let of_class = (runs / 10).max(1);
    let total = 2 * drift::GYROS.len() * runs + classes::COUNT * of_class;
    let progress = Progress::new(total as u64, "alignments");
    let tick = || progress.step();
    let compared = drift::GYROS.map(|gyro| drift::compare(gyro, runs, tick));
    let compared: Vec<_> = compared.into_iter().flatten().collect();
    let rows = classes::rows(of_class, tick);
    progress.finish();
    let (curve, devices) = (devices::curve(8..=14), devices::devices());
    Done {
        report: reports::burov::report(&devices, &compared, &rows),
        refusal: unless(
            rows.iter().all(|row| row.is_met),
            "a class does not meet its row; with few runs (a tenth of --runs) that may be chance",
        ),
        object: json!({
            "devices": devices, "rate_error_deg_h": curve, "drift": compared, "classes": rows,
        }),
    }
}

/// The stages of compensation, molecular-electronic sensors, and what must be refused; a result where no healthy run
/// was refused and no north was wrong.
fn rotating(runs: usize) -> Done {
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
    Done {
        report: reports::rotating::report(&stages, &molecular, &refusals),
        refusal: unless(found, "a healthy run was refused, or a north was wrong"),
        object: json!({ "stages": stages, "molecular": molecular, "refusals": refusals }),
    }
}

/// The paper's second, and flights with noise; a result where no roll was lost and no turn miscounted.
fn spin(runs: usize) -> Done {
    let progress = Progress::new((cases::COUNT * runs) as u64, "flights");
    let paper = paper::paper();
    let rows = cases::rows(runs, || progress.step());
    progress.finish();
    let found = rows.iter().all(|row| row.lost == 0 && row.miscounted == 0);
    Done {
        report: reports::spin::report(&paper, &rows),
        refusal: unless(found, "a roll was lost, or a turn miscounted"),
        object: json!({ "paper": paper, "flights": rows }),
    }
}

/// Drives between stops, and parked vehicles; a result where none was refused.
fn szymanowski(runs: usize) -> Done {
    let progress = Progress::new(((drives::COUNT + parked::COUNT) * runs) as u64, "vehicles");
    let tick = || progress.step();
    let drives = drives::rows(runs, tick);
    let parked = parked::rows(runs, tick);
    progress.finish();
    let driven = drives.iter().map(|row| &row.precision);
    let mut all = driven.chain(parked.iter().map(|row| &row.precision));
    Done {
        refusal: unless(all.all(|row| row.refused == 0), "a healthy vehicle was refused"),
        report: reports::szymanowski::report(&drives, &parked),
        object: json!({ "drives": drives, "parked": parked }),
    }
}

/// Azimuth, pitch and roll through half an hour of driving; a result where every row that is to be met is.
fn keep(runs: usize) -> Done {
    let progress = Progress::new((keep::COUNT * runs) as u64, "vehicles");
    let rows = keep::rows(runs, || progress.step());
    progress.finish();
    let found = rows.iter().all(|row| row.is_met || !row.is_wanted);
    let refusal = unless(found, "a class does not meet its row; with few runs that may be chance");
    Done { report: reports::keep::report(&rows), refusal, object: json!({ "classes": rows }) }
}

/// The whole instrument over many seeds; a result where none was refused.
fn instrument(runs: usize) -> Result<Done, String> {
    let progress = Progress::new(runs as u64, "alignments");
    let row = instrument::precision(runs, || progress.step()).map_err(|error| error.to_string())?;
    progress.finish();
    let refusal = unless(row.precision.refused == 0, "a healthy board was refused");
    let report = reports::instrument::report(&row);
    Ok(Done { report, refusal, object: json!({ "precision": row }) })
}

/// Every fault of one platform or of all with every seed; a result where none was answered wrongly or missed.
fn faults(platform: Option<Platform>, runs: usize) -> Done {
    let platforms = platform.map_or_else(|| Platform::ALL.to_vec(), |platform| vec![platform]);
    let progress = Progress::new((faults::count(&platforms) * runs) as u64, "faults");
    let rows = faults::rows(&platforms, 1..=runs as u64, || progress.step());
    progress.finish();
    let is_good = rows.iter().all(|row| !row.is_bad());
    let reason = "a fault gave a wrong north or roll, came to no end, or went unnoticed";
    let (report, refusal) = (reports::faults::report(&rows), unless(is_good, reason));
    Done { report, refusal, object: json!({ "faults": rows }) }
}

/// Healthy recordings for each run of a class.
const HEALTHY: usize = 15;

/// Every class of faults in recordings; a result where each passes.
fn disturbed(runs: usize, class: Option<&str>) -> Done {
    let chosen: Vec<_> =
        disturbed::classes().filter(|of| class.is_none_or(|name| of.fault.name == name)).collect();
    let healthy_runs = if class.is_none() { HEALTHY * runs } else { 0 };
    let progress = Progress::new((chosen.len() * runs + healthy_runs) as u64, "recordings");
    let tick = || progress.step();
    let healthy = match class {
        None => disturbed::healthy(healthy_runs, &tick),
        Some(_) => Vec::new(),
    };
    let rows: Vec<_> = chosen.iter().map(|class| disturbed::row(class, runs, &tick)).collect();
    progress.finish();
    Done {
        report: reports::disturbed::report(&healthy, &rows),
        refusal: unless(
            rows.iter().all(|row| row.is_met),
            "a class of faults gets past, or is refused without need",
        ),
        object: json!({ "healthy": healthy, "classes": rows }),
    }
}
