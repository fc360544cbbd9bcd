//! How `meridian run` goes on after its alignment.

use clap::Args;
use host::angle::Quantity;
use simulated::hold::Hold;

use super::options::{Common, KEEPING, azimuth, seconds};
use crate::command::angle;
use crate::command::stated::{self, Stated};

/// How long a run goes on where nothing is said, s, and where it aligns anew at stops: several come then.
const USUAL: f64 = 60.0;
const REALIGNING: f64 = 1800.0;
/// How long it goes on after another alignment than the usual one, s: that may end long before the vehicle sets off.
const LONGER: f64 = 180.0;
/// From power-on until the vehicle sets off, beside the time of a usual alignment, s: room for one dwell that is measured
/// again.
const STANDING: f32 = 10.0;
/// When an azimuth from outside comes, s from power-on.
const HANDED: f64 = 20.0;

/// Power-on, self-tests and level, s.
const BEGIN: f64 = 10.0;

/// How long a run takes by its own time whose alignment takes so long, s: one that is given its azimuth from outside does
/// not wait for any.
pub fn lasting(hold: &Hold, alignment_s: f64) -> f64 {
    hold.handover.map_or(BEGIN + alignment_s, |(_, at_s)| at_s) + hold.seconds
}

/// What is asked of keeping.
#[derive(Args, Clone, Debug)]
pub struct KeepingOptions {
    /// Seconds for which the azimuth is kept, while the vehicle drives and stops; 0 for not at all (60; 180
    /// after another than the usual alignment; 1800 with --realign; 0 with --fault or --flash, and where an accuracy is
    /// asked for).
    #[arg(long, value_name = "SECONDS", value_parser = seconds(0.0..=14_400.0), help_heading = KEEPING)]
    hold: Option<f64>,
    /// While the azimuth is kept, aligns anew at stops.
    #[arg(long, help_heading = KEEPING)]
    realign: bool,
    /// An azimuth that is handed over from outside instead of an alignment, and its 1σ, in degrees.
    #[arg(long, value_name = "DEGREES,SIGMA", value_parser = handover, help_heading = KEEPING)]
    handover: Option<[f64; 2]>,
}

fn handover(text: &str) -> Result<[f64; 2], String> {
    let wrong = || "not an azimuth within ±360° and a σ up to 30°, as 213.7,0.1".to_owned();
    let (azimuth, sigma) = text.split_once(',').ok_or_else(wrong)?;
    match (self::azimuth(azimuth), angle(sigma, Quantity::Other)) {
        (Ok(azimuth), Ok(sigma)) if sigma > 0.0 && sigma <= 30.0 => {
            Ok([azimuth.rem_euclid(360.0), sigma])
        }
        _ => Err(wrong()),
    }
}

impl KeepingOptions {
    /// Whether an azimuth from outside takes the place of the alignment.
    pub(super) fn is_handed_over(&self) -> bool {
        self.handover.is_some()
    }

    /// How the run goes on; one that is to be the same as ever does not unless it is asked to. After a usual alignment,
    /// which lasts as long as is known, the vehicle soon sets off.
    pub fn hold(&self, is_plain: bool, is_usual: bool) -> Hold {
        let is_known = is_usual && !self.realign && self.handover.is_none();
        let usual = match (is_plain, self.realign) {
            (true, _) => 0.0,
            (false, true) => REALIGNING,
            (false, false) if is_known => USUAL,
            (false, false) => LONGER,
        };
        let plain = Hold::of(self.hold.unwrap_or(usual));
        Hold {
            standing_s: if is_known { STANDING } else { plain.standing_s },
            realigns: self.realign,
            handover: self.handover.map(|handover| (handover, HANDED)),
            ..plain
        }
    }

    /// Refuses options of keeping that need others, for stops of so many seconds; and options that plan an alignment,
    /// where an azimuth from outside takes its place and the vehicle does not align itself anew later.
    ///
    /// # Errors
    /// The option, and why it does not go with the others.
    pub fn check(
        &self,
        stated: &Stated,
        (hold, stop_s): (&Hold, f64),
        common: &Common,
        aligning: &[&'static str],
    ) -> Result<(), String> {
        let asked = stated.first(&["realign", "handover"]);
        let is_csv = common.record.is_some() && common.inputs_file().is_none();
        if let Some(option) = asked.filter(|_| is_csv) {
            let option = stated::long(option);
            return Err(format!(
                "--record: a recording in CSV holds one alignment; leave {option} out, or name FILE.jsonl"
            ));
        }
        if let Some(option) = asked.filter(|_| hold.seconds <= 0.0) {
            let option = stated::long(option);
            return Err(format!("{option}: nothing is kept after this run; add --hold SECONDS"));
        }
        let first = hold.drive_s + stop_s;
        if self.realign && hold.seconds < first {
            return Err(format!(
                "--realign: the first stop after the alignment ends after {first:.0} s; add --hold of more"
            ));
        }
        let is_alone = self.handover.is_some() && !self.realign;
        stated.first(aligning).filter(|_| is_alone).map_or(Ok(()), |option| {
            Err(format!(
                "{}: --handover takes the place of the alignment; add --realign or leave one out",
                stated::long(option)
            ))
        })
    }
}
