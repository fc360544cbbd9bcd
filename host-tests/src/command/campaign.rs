//! `meridian campaign`: many simulated alignments.

use std::path::PathBuf;

use clap::Args;
use host::campaign::{Asked, CAMPAIGNS, Campaign, Done, disturbed};
use host::interrupt;
use host::output::manner::Manner;
use host::output::progress::Progress;
use host::report::{Grade, Summary};
use simulated::fault::Platform;

use super::files::Written;
use super::mistyped::nearest;
use super::{Answer, Failure, OUTPUT, faults as of_run, files, registered, whole};

/// Which campaign, how long.
#[derive(Args)]
pub struct CampaignOptions {
    /// Which campaign.
    #[arg(value_name = "NAME", value_parser = registered(&CAMPAIGNS, |of| [of.name, of.meaning]), default_value = CAMPAIGNS[0].name)]
    campaign: &'static Campaign,
    /// How many runs: of sokolov on each schedule (5000), of burov on each schedule (5000)
    /// and for each class a tenth of it, of rotating in each table (500), of each of its refusals a
    /// tenth of it, of szymanowski, keep and spin in each row (500), of instrument (500), of each
    /// fault (1), of each class of disturbed (200).
    #[arg(long, value_parser = whole::<1, 1_000_000>)]
    runs: Option<u64>,
    /// Writes figures and tables as a page for a browser.
    #[arg(long, value_name = "FILE.html", help_heading = OUTPUT)]
    report: Option<PathBuf>,
    /// The only platform to run, of faults: stage, two-frame, turntable, vehicle or spin.
    #[arg(long, value_name = "NAME", value_parser = of_run::platform)]
    platform: Option<Platform>,
    /// The only class to run, of disturbed.
    #[arg(long, value_name = "NAME")]
    class: Option<String>,
}

impl CampaignOptions {
    /// What cannot go together.
    ///
    /// # Errors
    /// The options, and why.
    fn check(&self) -> Result<(), String> {
        let own = [
            ("platform", self.platform.is_some(), "faults", "platforms"),
            ("class", self.class.is_some(), "disturbed", "classes"),
        ];
        let name = self.campaign.name;
        let alien = own.iter().find(|(_, is_given, owner, _)| *is_given && *owner != name);
        if let Some((option, _, owner, things)) = alien {
            return Err(format!(
                "--{option}: campaign {name} does not take it: only {owner} has {things}"
            ));
        }
        if let Some(class) = &self.class
            && disturbed::classes().all(|of| of.fault.name != *class)
        {
            let names: Vec<_> = disturbed::classes().map(|class| class.fault.name).collect();
            let meant = nearest(class, names.iter());
            return Err(format!("--class: the classes are {}{meant}", names.join(", ")));
        }
        files::check(None, &[Written::page(self.report.as_ref())])
    }
}

/// That the campaign was interrupted, where it was.
fn interrupted() -> Option<String> {
    let reason = || format!("{}: the tables rest on the runs that were done", interrupt::reason());
    interrupt::is_asked().then(reason)
}

/// Runs a campaign.
pub fn run(options: &CampaignOptions, manner: Manner) -> Result<Answer, Failure> {
    options.check().map_err(Failure::misuse)?;
    let campaign = options.campaign;
    let asked = Asked {
        runs: options.runs.map_or(campaign.runs, |runs| runs as usize),
        platform: options.platform,
        class: options.class.clone(),
    };
    let page = files::opened("the report", options.report.as_ref())?;
    let progress = Progress::of_steps(manner, (campaign.count)(&asked) as u64, campaign.steps);
    interrupt::heed();
    let Done { mut object, mut report, refusal } = (campaign.run)(&asked, &progress)?;
    progress.finish();
    if let Some(why) = interrupted() {
        let grade = Grade::Interrupted;
        report.summary = Some(Summary { grade, reasons: vec![why], ..Summary::default() });
    }
    let refusal = interrupted().or(refusal.map(str::to_owned));
    object["campaign"] = campaign.name.into();
    object["status"] = match (&refusal, interrupted()) {
        (None, _) => Grade::Found.status(),
        (Some(_), Some(_)) => Grade::Interrupted.status(),
        (Some(_), None) => "failed",
    }
    .into();
    let answer = Answer::reported(refusal, manner, &object, || report.clone())?;
    Ok(answer.with_page(page, || report))
}
