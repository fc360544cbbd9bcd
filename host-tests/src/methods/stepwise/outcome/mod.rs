//! Stepwise gyrocompassing and autocompensated positions: what an alignment at standstills found.

mod figures;
mod sway;

use orientation::alignment::stepwise::conclusion::Conclusion;
use orientation::alignment::stepwise::fit::{Fit, Prediction};
use orientation::alignment::stepwise::quality::Disturbance;
use orientation::alignment::stepwise::session::{Repetition, Session};
use orientation::signal::dwell::Dwell;
use serde::Serialize;
use std::collections::BTreeMap;

use crate::cause::{self, Cause};
use crate::methods::Course;
use crate::methods::asked::Question;
use crate::methods::stepwise::positions::{Autocompensation, autocompensation};
use crate::methods::stepwise::{POSITIONS, Replay};
use crate::outcome::keys::Keys;
use crate::outcome::{Excluded, Finished, FitDetails, Outcome, of_site_and_time};
use crate::output::{azimuth as in_circle, columns, counted, degrees, degrees_per_hour, signed};
use crate::recording::{Body, Truth};
use crate::report::{Columns, Lines, Part, Stretch};

use self::sway::SwayNoise;

/// A dwell, with what the fit leaves of it.
#[derive(Clone, Debug, Serialize)]
pub struct DwellDetails {
    /// Stage angle, clockwise from above, °.
    pub stage_deg: f64,
    /// When the averaged time began, s.
    pub from_s: f64,
    /// Length of the dwell, s.
    pub seconds: f64,
    /// Mean rate about the sensitive axis, °/h.
    pub rate_deg_h: f64,
    /// 1σ of the mean rate from white noise alone, °/h.
    pub sigma_deg_h: f64,
    /// Measured less fitted, drift included, °/h; null where the dwell took no part.
    pub residual_deg_h: Option<f64>,
    /// Measured less what the whole model and the drift of the dwells before explain, °/h; null where the dwell took no
    /// part.
    pub unexplained_deg_h: Option<f64>,
    /// 1σ of that, °/h: white noise, and drift that no dwell before shows; null where the dwell took no part.
    pub unexplained_sigma_deg_h: Option<f64>,
    /// What its predecessors do not explain of it, over its standard deviation, leverage allowed for; null
    /// where the dwell took no part.
    pub studentised: Option<f64>,
    /// Why it took no part.
    pub excluded: Option<String>,
}

impl DwellDetails {
    /// The dwells of a session.
    fn all(session: &Session, conclusion: &Conclusion) -> Vec<Self> {
        let found = conclusion.disturbances.iter().zip(&conclusion.residuals);
        let dwells = session.dwells().iter().zip(predicted(session, conclusion));
        let each = dwells.zip(found).map(|((dwell, prediction), (why, residual))| {
            let kept = why.is_none().then_some(residual);
            let unexplained = prediction.map(|prediction| unexplained_deg_h(dwell, &prediction));
            Self {
                stage_deg: degrees(dwell.stage.rad()),
                from_s: dwell.start().0.max(0.0),
                seconds: dwell.seconds.0,
                rate_deg_h: degrees_per_hour(dwell.rate.0),
                sigma_deg_h: degrees_per_hour(white_sigma(dwell, conclusion.angle_random_walk.0)),
                residual_deg_h: kept.map(|residual| degrees_per_hour(residual.rate.0)),
                unexplained_deg_h: unexplained.map(|[rate, _]| rate),
                unexplained_sigma_deg_h: unexplained.map(|[_, sigma]| sigma),
                studentised: kept.map(|residual| residual.studentised),
                excluded: why.map(|why| why.to_string()),
            }
        });
        each.collect()
    }
}

/// What the fit says of each dwell; none of one that was left out.
fn predicted(session: &Session, conclusion: &Conclusion) -> Vec<Option<Prediction>> {
    let mut predictions = Vec::new();
    conclusion
        .predictions(&session.setting, session.dwells(), |prediction| predictions.push(prediction));
    let mut predictions = predictions.into_iter();
    let of = |why: &Option<Disturbance>| if why.is_none() { predictions.next() } else { None };
    conclusion.disturbances.iter().map(of).collect()
}

/// What the whole model does not explain of a dwell's mean rate, and 1σ of that, °/h.
fn unexplained_deg_h(dwell: &Dwell, prediction: &Prediction) -> [f64; 2] {
    [dwell.rate.0 - prediction.rate.0, prediction.sigma.0].map(degrees_per_hour)
}

/// 1σ of a dwell's mean rate from white noise, rad/s, for a random walk in rad/√s: as stated, or N²/T times what the
/// taper costs.
fn white_sigma(dwell: &Dwell, angle_random_walk: f64) -> f64 {
    let white = || angle_random_walk * angle_random_walk * dwell.taper / dwell.seconds.0;
    dwell.stated_variance.get().unwrap_or_else(white).sqrt()
}

impl Replay {
    /// Number, dwell and angle of each dwell that was left out.
    fn excluded(&self, conclusion: &Conclusion) -> Vec<Excluded> {
        let dwells = self.session.dwells().iter().zip(&conclusion.disturbances).enumerate();
        let left_out = dwells.filter_map(|(index, (dwell, why))| {
            let reason = why.as_ref()?.to_string();
            let (number, stage) = (index + 1, degrees(dwell.stage.rad()));
            let (from, to) = (dwell.start().0.max(0.0), dwell.end().0);
            let place = Keys::default()
                .with("dwell", number)
                .with("stage_deg", stage)
                .with("from_s", from)
                .with("to_s", to);
            let words = format!("dwell {number}, {stage:.2}°, {from:.1}…{to:.1} s: ");
            Some(Excluded { place, words, reason })
        });
        left_out.collect()
    }

    /// The positions and what plain least squares makes of them; of method `positions`.
    fn autocompensation(&self, conclusion: &Conclusion) -> Option<Autocompensation> {
        (self.method == POSITIONS).then(|| autocompensation(&self.session, conclusion))
    }

    /// Where the noise comes from that the fit was weighted by.
    fn noise_source(&self) -> &'static str {
        match (&self.session.surveyed, self.noise_is_known()) {
            (Some(_), _) => "surveyed",
            (None, true) if self.has_stated_dwells() => "dwells",
            (None, true) => "stated",
            (None, false) => "estimated",
        }
    }

    /// Place, gyro, and the time that took part.
    fn circumstances(&self, kept: &[&Dwell]) -> Vec<[String; 2]> {
        let seconds: f64 = kept.iter().map(|dwell| dwell.seconds.0).sum();
        let site = &self.session.setting.site;
        let mut lines = of_site_and_time(site, seconds, (kept.len(), "dwell")).lines;
        if self.has_stated_dwells() {
            for [_, words] in lines.iter_mut().filter(|[label, _]| label == "gyro") {
                OF_DWELLS.clone_into(words);
            }
        }
        lines
    }

    fn details(&self, conclusion: &Conclusion, dwells: &[DwellDetails]) -> Keys {
        let fit = conclusion.fit.as_ref();
        Keys::default()
            .with("criterion", self.criterion_name())
            .with("horizontal_earth_rate", fit.map(earth_rate))
            .with("gyro_n_deg_sqrt_h", self.walk_deg_sqrt_h(conclusion))
            .with("gyro_noise", self.noise_source())
            .with("chi_square", fit.map(|fit| fit.chi_square))
            .with("degrees_of_freedom", fit.map(|fit| fit.degrees))
            .with_found("autocompensation", self.autocompensation(conclusion))
            .with("dwells", dwells)
            .with_found("measured_again", repeated(&self.session))
    }

    /// How the fit was made.
    fn lines(&self, conclusion: &Conclusion, fit: &Fit) -> Lines {
        let noise = self.walk_deg_sqrt_h(conclusion).map_or(OF_DWELLS.to_owned(), |noise| {
            format!("{noise:.6} °/√h ({})", self.noise_source())
        });
        let residuals = format!("χ² {:.1} for {} degrees of freedom", fit.chi_square, fit.degrees);
        let lines = Lines::new("Fit")
            .with("criterion", self.criterion_name())
            .with("Earth rate is", earth_rate(fit))
            .with("gyro noise N", noise)
            .with("residuals", residuals);
        self.autocompensation(conclusion).iter().fold(lines, positions)
    }

    /// N of the gyro, °/√h, that a fit was weighted by; none where the 1σ of each dwell was stated.
    fn walk_deg_sqrt_h(&self, conclusion: &Conclusion) -> Option<f64> {
        (!self.has_stated_dwells()).then(|| degrees(conclusion.angle_random_walk.0) * 60.0)
    }
}

/// Each dwell that was discarded and measured again; nothing where none was.
fn repeated(session: &Session) -> Option<Vec<Keys>> {
    let keys = |repetition: &Repetition| {
        Keys::default()
            .with("dwell", repetition.position + 1)
            .with("reason", repetition.why.to_string())
    };
    let all: Vec<Keys> = session.repetitions.iter().map(keys).collect();
    (!all.is_empty()).then_some(all)
}

/// How many dwells were measured again and which, label and value; nothing where none was.
fn measured_again(session: &Session) -> Option<[String; 2]> {
    let mut times = BTreeMap::new();
    session.repetitions.iter().for_each(|again| *times.entry(again.position + 1).or_insert(0) += 1);
    let dwells = times.iter().map(|(dwell, times)| match times {
        1 => dwell.to_string(),
        _ => format!("{dwell} ({})", counted(*times, "time")),
    });
    let which = dwells.collect::<Vec<_>>().join(", ");
    let least = if session.repetitions.is_full() { "at least " } else { "" };
    let words = || format!("{least}{}: {which}", counted(times.len(), "dwell"));
    (!times.is_empty()).then(|| ["measured again".to_owned(), words()])
}

/// What stands for N of the gyro where none weighs the dwells.
const OF_DWELLS: &str = "the stated 1σ of each dwell";

/// Every dwell in the order of time.
fn table(dwells: &[DwellDetails]) -> Part {
    Columns::of("Dwells", dwells)
        .numbered("dwell")
        .fixed("stage, °", 4, |dwell| dwell.stage_deg)
        .fixed("from, s", 2, |dwell| dwell.from_s)
        .fixed("for, s", 2, |dwell| dwell.seconds)
        .fixed("rate, °/h", 5, |dwell| dwell.rate_deg_h)
        .found("unexplained, °/h", 5, |dwell| dwell.unexplained_deg_h)
        .found("1σ, °/h", 5, |dwell| dwell.unexplained_sigma_deg_h)
        .found("studentised", 2, |dwell| dwell.studentised)
        .column("left out", |dwell| dwell.excluded.as_deref().unwrap_or_default())
        .into()
}

/// How the Earth rate entered a fit.
fn earth_rate(fit: &Fit) -> &'static str {
    if fit.earth_rate_is_free() { "free" } else { "known" }
}

impl Course for Session {
    fn stretches(&self) -> Vec<Stretch> {
        let conclusion = self.conclusion();
        conclusion.map_or_else(Vec::new, |conclusion| figures::stretches(self, conclusion))
    }
}

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let Some(conclusion) = self.session.conclusion() else {
            return Outcome::unfinished(self.method);
        };
        let fit = conclusion.fit.as_ref();
        let seen = fit.filter(|fit| !fit.model.is_single_axis);
        let tilt = conclusion.tilt.measured.then_some(&conclusion.tilt);
        let dwell_details = DwellDetails::all(&self.session, conclusion);
        let lines = fit.map(|fit| Part::from(self.lines(conclusion, fit)));
        let parts = lines.into_iter().chain([table(&dwell_details)]).map(Part::detail).collect();
        let dwells = self.session.dwells().iter().zip(&conclusion.disturbances);
        let kept: Vec<&Dwell> =
            dwells.filter(|(_, why)| why.is_none()).map(|(dwell, _)| dwell).collect();
        let sway = SwayNoise::of(&self.session, conclusion, &kept);
        let sway_deg_h = sway.as_ref().map(|sway| degrees_per_hour(sway.sigma));
        let details =
            self.details(conclusion, &dwell_details).with_found("sway_sigma_deg_h", sway_deg_h);
        Outcome {
            limit_deg: fit.filter(|_| self.noise_is_known()).map(|fit| fit.limit.degrees()),
            pitch_deg: tilt.map(|tilt| tilt.pitch().degrees()),
            roll_deg: tilt.map(|tilt| tilt.roll().degrees()),
            seconds: kept.iter().map(|dwell| dwell.seconds.0).sum(),
            fit: Some(FitDetails {
                earth_rate_ratio: seen.map(|fit| fit.ratio),
                earth_rate_ratio_sigma: seen.map(|fit| fit.ratio_sigma),
                model: fit.map(columns).unwrap_or_default(),
                excluded: self.excluded(conclusion),
                more_noise: sway.as_ref().map(|_| "and the coarse IMU's"),
                ..FitDetails::of(
                    fit.map(|fit| &fit.budget),
                    fit.map_or(1.0, |fit| fit.excess),
                    kept.len(),
                )
            }),
            assumed: self.assumed.clone(),
            circumstances: self.circumstances(&kept),
            facts: measured_again(&self.session)
                .into_iter()
                .chain(sway.iter().map(SwayNoise::in_words))
                .collect(),
            ..Outcome::new(self.method, details, parts)
        }
        .judged(&conclusion.verdict, truth.azimuth_deg)
    }

    fn figures(&self, _: &Outcome, truth: &Truth, _: Option<&Body>) -> Vec<Part> {
        let Some(conclusion) = self.session.conclusion() else { return Vec::new() };
        let timeline = figures::timeline(&self.session, conclusion).into();
        let Some(fit) = &conclusion.fit else { return vec![timeline] };
        let mut all: Vec<Part> =
            figures::fit(&self.session, conclusion, fit).map(Part::from).into();
        let convergence = figures::convergence(&self.session, truth.azimuth_deg);
        all.extend(convergence.into_iter().map(Part::from));
        all.push(timeline);
        all
    }

    fn cause(&self, of: &Question) -> Option<Cause> {
        let refusal = self.session.conclusion()?.verdict.as_ref().err()?;
        cause::of_stopping(of, &self.session, refusal)
    }
}

/// How often each position was visited, and what plain autocompensation gives.
fn positions(lines: Lines, found: &Autocompensation) -> Lines {
    let visited = found.angles_deg.iter().zip(&found.visits);
    let list: Vec<String> =
        visited.map(|(angle, times)| format!("{angle:.1}° × {times}")).collect();
    let plain = found.plain_azimuth_deg.zip(found.plain_off_sigmas).map(|(azimuth, off)| {
        let off = signed(off, 2);
        format!("{}° by plain least squares, {off} σ from the azimuth", in_circle(azimuth, 4))
    });
    lines.with("positions", list.join(", ")).with_found("without weights", plain)
}
