//! Continuous rotation: what an alignment on a platform that turns all the time found.

pub(crate) mod figures;

use std::f64::consts::TAU;

use orientation::alignment::rotating::average::Average;
use orientation::alignment::rotating::conclusion::Conclusion;
use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::alignment::rotating::solution::Fit;
use orientation::alignment::rotating::turn::{Stretch, Turn};
use serde::Serialize;

use crate::cause;
use crate::methods::asked::Asked;
use crate::methods::rotating::Replay;
use crate::methods::rotating::turns::freed;
use crate::outcome::{Excluded, Finished, FitDetails, Outcome};
use crate::output::{azimuth_error, degrees, degrees_per_hour};
use crate::recording::{Body, Header, RotatingRow, Truth};
use crate::report::{Columns, Lines, Part};

/// What an alignment on a turning platform adds.
#[derive(Clone, Debug, Serialize)]
pub struct RotatingDetails {
    /// `gyro`, or `met` for a molecular-electronic sensor.
    pub sensor: &'static str,
    /// Cramér–Rao bound of a sensor whose gain, lag and g-sensitivity are known, °.
    pub plain_limit_deg: Option<f64>,
    /// Axis misalignment at the first speed; none where no rate-modulated turn showed it.
    #[serde(flatten)]
    pub misalignment: Option<MisalignmentDetails>,
    /// Axis misalignment at each speed, in the order of the speeds.
    pub axis_misalignments: Vec<MisalignmentDetails>,
    /// Tilt of the platform's axis, °.
    pub tilt_deg: Option<f64>,
    /// Integrated g-sensitivity over the Earth rate at the slower speed, ρ; of a molecular-electronic sensor.
    pub met_ratio: Option<f64>,
    /// What the slower speed alone is off by for that, °; its 1σ where there is only one speed.
    pub one_speed_bias_deg: Option<f64>,
    /// The azimuth after each stage of compensation.
    pub stages: Option<Stages>,
    /// Averages of both senses at each speed.
    pub stretches: Vec<StretchDetails>,
    /// Every turn, in the order of its stretch.
    pub turns: Vec<TurnDetails>,
}

/// How the sensitive axis stands, as rate-modulated turns at a speed showed it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MisalignmentDetails {
    /// How far it stands from the platform's plane, up positive, °.
    #[serde(rename = "coupling_deg")]
    pub angle_deg: f64,
    /// 1σ of that angle, °.
    #[serde(rename = "coupling_sigma_deg")]
    pub sigma_deg: f64,
    /// By how much the sensor lags behind the encoder there, s.
    pub lag_s: f64,
    /// Speed of these turns, turns a second.
    pub speed_hz: f64,
}

/// The azimuth after each stage of compensation, °.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Stages {
    /// Clockwise at the first speed, as it came.
    pub raw_deg: f64,
    /// Azimuth without what the axis misalignment makes of the platform's unevenness.
    pub without_unevenness_deg: f64,
    /// Azimuth of both senses together.
    pub both_senses_deg: f64,
    /// Azimuth with all compensations.
    pub full_deg: f64,
}

/// Turns in one sense at one speed.
#[derive(Clone, Debug, Serialize)]
pub struct StretchDetails {
    /// `clockwise` or `counter-clockwise`.
    pub sense: String,
    /// Turns a second.
    pub speed_hz: f64,
    /// Turns that took part.
    pub turns: u32,
    /// Turns left out.
    pub left_out: u32,
    /// Time in those that took part, s.
    pub seconds: f64,
    /// Unevenness once per turn, relative to the speed.
    pub unevenness: f64,
}

/// A turn of the platform, with what the mean of its stretch leaves of it.
#[derive(Clone, Debug, Serialize)]
pub struct TurnDetails {
    /// `clockwise` or `counter-clockwise`.
    pub sense: String,
    /// Turns a second.
    pub speed_hz: f64,
    /// Middle of the turn since the stretch began, s.
    pub middle_s: f64,
    /// Length of the turn, s.
    pub seconds: f64,
    /// Phasor of the gyro's rate less the stretch's mean, axis misalignment compensated: in step with cos θ
    /// and with sin θ, °/h.
    pub residual_deg_h: [f64; 2],
    /// 1σ of either part from white noise alone, °/h.
    pub sigma_deg_h: f64,
}

/// Why turns are left out.
const DISTURBED: &str = "disturbed: too far from the other turns";

impl From<&Average> for StretchDetails {
    fn from(average: &Average) -> Self {
        Self {
            sense: average.sense.to_string(),
            speed_hz: average.speed / TAU,
            turns: average.turns,
            left_out: average.left_out,
            seconds: average.seconds,
            unevenness: average.turning.size() / average.speed,
        }
    }
}

impl Stages {
    /// The stages in words, with their azimuths.
    fn named(&self) -> [(&'static str, f64); 4] {
        [
            ("raw, clockwise", self.raw_deg),
            ("without the unevenness", self.without_unevenness_deg),
            ("both senses", self.both_senses_deg),
            ("everything", self.full_deg),
        ]
    }
}

impl From<&Fit> for Stages {
    fn from(fit: &Fit) -> Self {
        Self {
            raw_deg: degrees(fit.stages.raw),
            without_unevenness_deg: degrees(fit.stages.misalignment),
            both_senses_deg: degrees(fit.stages.senses),
            full_deg: degrees(fit.stages.full),
        }
    }
}

/// The averages of a conclusion, clockwise and counter-clockwise at each speed.
fn averages(conclusion: &Conclusion) -> impl Iterator<Item = &Average> {
    conclusion.pairs.iter().flat_map(|pair| [&pair.clockwise, &pair.counter])
}

/// Pitch and roll of the base, rad, from the tilt's phasor F = sin pitch + j sin roll cos pitch.
fn pitch_and_roll(fit: &Fit) -> [f64; 2] {
    let pitch = fit.tilt.re.clamp(-1.0, 1.0).asin();
    [pitch, (fit.tilt.im / pitch.cos()).clamp(-1.0, 1.0).asin()]
}

impl Replay {
    /// Whether the sensor may have a g-sensitivity that integrates acceleration.
    fn is_molecular(&self) -> bool {
        self.session.setting().sensor.molecular_sigma > 0.0
    }

    /// The names of the columns that the fits used.
    fn columns(&self, conclusion: &Conclusion) -> Vec<&'static str> {
        let mut names = vec!["cos", "sin", "1", "t"];
        if conclusion.misalignments.is_empty() {
            return names;
        }
        names.extend(["stage rate", "stage acceleration"]);
        if self.is_molecular() {
            names.extend(["sensor's gain and lag", "g-sensitivity over speed"]);
        }
        names
    }

    /// What one speed leaves of an integrated g-sensitivity, rad: what the second speed showed, or the 1σ
    /// that a single one leaves.
    fn one_speed(&self, conclusion: &Conclusion, fit: &Fit) -> Option<f64> {
        let has_two = conclusion.pairs.len() > 1;
        let bias = if has_two { fit.one_speed } else { fit.budget.g_sensitivity };
        self.is_molecular().then_some(bias)
    }

    /// The turns of all even stretches.
    fn turns(&self, conclusion: &Conclusion) -> Vec<TurnDetails> {
        let stretches = self.session.turn_accumulator().stretches().iter();
        let walk = conclusion.angle_random_walk;
        stretches
            .flat_map(|stretch| of_stretch(stretch, conclusion.misalignments.first(), walk))
            .collect()
    }

    fn details(&self, conclusion: &Conclusion) -> RotatingDetails {
        let fit = conclusion.fit.as_ref();
        let bounded = fit.filter(|_| self.noise_is_known());
        let axis_misalignments: Vec<MisalignmentDetails> =
            conclusion.misalignments.iter().map(Into::into).collect();
        RotatingDetails {
            sensor: if self.session.setting().sensor.is_flat { "gyro" } else { "met" },
            plain_limit_deg: bounded.map(|fit| degrees(fit.plain_limit)),
            misalignment: axis_misalignments.first().copied(),
            axis_misalignments,
            tilt_deg: fit.map(|fit| degrees(fit.tilt.size().min(1.0).asin())),
            met_ratio: fit.filter(|_| self.is_molecular()).map(|fit| fit.molecular.size()),
            one_speed_bias_deg: fit.and_then(|fit| self.one_speed(conclusion, fit)).map(degrees),
            stages: fit.map(Into::into),
            stretches: averages(conclusion).map(Into::into).collect(),
            turns: self.turns(conclusion),
        }
    }
}

impl From<&AxisMisalignment> for MisalignmentDetails {
    fn from(found: &AxisMisalignment) -> Self {
        let [angle_deg, sigma_deg] = [found.angle(), found.sine_sigma].map(degrees);
        Self { angle_deg, sigma_deg, lag_s: found.lag(), speed_hz: found.frequency / TAU }
    }
}

impl MisalignmentDetails {
    /// The axis misalignment with its lag, in words.
    fn words(&self) -> String {
        let Self { angle_deg: angle, sigma_deg: sigma, lag_s, speed_hz } = self;
        let lag = 1e3 * lag_s;
        format!("{angle:.5}° ± {sigma:.5}°, {lag:.2} ms late, at {speed_hz:.3} Hz")
    }
}

/// The turns of a stretch about their mean; a random walk in rad/√s gives either part of a phasor 1σ of
/// N·√(2/T).
fn of_stretch<'a>(
    stretch: &'a Stretch,
    misalignment: Option<&'a AxisMisalignment>,
    walk: f64,
) -> impl Iterator<Item = TurnDetails> + 'a {
    let phasors: Vec<[f64; 2]> =
        stretch.turns().iter().map(|turn| compensated(turn, misalignment)).collect();
    let count = phasors.len().max(1) as f64;
    let mean = [0, 1].map(|part: usize| phasors.iter().map(|at| at[part]).sum::<f64>() / count);
    stretch.turns().iter().zip(phasors).map(move |(turn, phasor)| {
        let sense = if turn.speed < 0.0 { "counter-clockwise" } else { "clockwise" };
        let seconds = f64::from(turn.seconds);
        TurnDetails {
            sense: sense.to_owned(),
            speed_hz: f64::from(turn.speed.abs()) / TAU,
            middle_s: f64::from(turn.middle),
            seconds,
            residual_deg_h: [0, 1].map(|part: usize| degrees_per_hour(phasor[part] - mean[part])),
            sigma_deg_h: degrees_per_hour(walk * (2.0 / seconds).sqrt()),
        }
    })
}

/// A turn's rate in step with cos θ and sin θ, rad/s, without what an axis misalignment shows of the platform's rate
/// and acceleration.
fn compensated(turn: &Turn, misalignment: Option<&AxisMisalignment>) -> [f64; 2] {
    let [rate, turning] = [turn.rate, turn.turning].map(|phasor| phasor.map(f64::from));
    let parts = |found: &AxisMisalignment| (found.sine, found.quadrature);
    let (sine, quadrature) = misalignment.map_or((0.0, 0.0), parts);
    let speed = f64::from(turn.speed);
    let quickening = [speed * turning[1], -speed * turning[0]];
    [0, 1].map(|part: usize| rate[part] - sine * turning[part] - quadrature * quickening[part])
}

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let Some(conclusion) = self.session.conclusion() else {
            return Outcome::unfinished("rotating");
        };
        let fit = conclusion.fit.as_ref();
        let flat = fit.filter(|fit| fit.ratio_sigma.is_finite());
        let attitude = fit.map(|fit| pitch_and_roll(fit).map(degrees));
        let turns: u32 = averages(conclusion).map(|average| average.turns).sum();
        let left_out = averages(conclusion).filter(|average| average.left_out > 0);
        Outcome {
            limit_deg: fit.filter(|_| self.noise_is_known()).map(|fit| degrees(fit.limit)),
            pitch_deg: attitude.map(|[pitch, _]| pitch),
            roll_deg: attitude.map(|[_, roll]| roll),
            seconds: averages(conclusion).map(|average| average.seconds).sum(),
            fit: Some(FitDetails {
                earth_rate_ratio: flat.map(|fit| fit.ratio),
                earth_rate_ratio_sigma: flat.map(|fit| fit.ratio_sigma),
                model: self.columns(conclusion),
                excluded: left_out.map(excluded).collect(),
                ..FitDetails::of(fit.map(|fit| &fit.budget), turns as usize)
            }),
            assumed: self.assumed.clone(),
            ..Outcome::new("rotating", self.details(conclusion))
        }
        .judged(&conclusion.verdict, truth.azimuth_deg)
    }

    fn parts(&self, outcome: &Outcome) -> Vec<Part> {
        let Some(details) = outcome.details::<RotatingDetails>() else { return Vec::new() };
        let stages = details.stages.as_ref().map(stages);
        let parts = [Some(lines(details).into()), stages, Some(stretches(&details.stretches))];
        parts.into_iter().flatten().collect()
    }

    fn figures(&self, outcome: &Outcome, _: &Truth, body: Option<&Body>) -> Vec<Part> {
        match body {
            Some(Body::Rotating(rows)) => figures(self, outcome, rows),
            _ => Vec::new(),
        }
    }

    fn cause(&self, header: &Header, body: &Body, asked: &Asked) -> Option<String> {
        let refusal = self.session.conclusion()?.verdict.as_ref().err()?;
        cause::of_turning(header, body, asked, refusal)
    }
}

fn excluded(average: &Average) -> Excluded {
    let StretchDetails { sense, speed_hz, left_out, .. } = average.into();
    let (sense, speed_hz, turns) = (Some(sense), Some(speed_hz), Some(left_out));
    Excluded { sense, speed_hz, turns, reason: DISTURBED.to_owned(), ..Excluded::default() }
}

/// What turned: tilt, axis misalignment, g-sensitivity.
fn lines(details: &RotatingDetails) -> Lines {
    let mut lines = Lines::new("Platform and sensor");
    if let Some(limit) = details.plain_limit_deg.filter(|_| details.sensor == "met") {
        let known = "were the sensor's gain, lag and g-sensitivity known";
        lines.add("limit", format!("{limit:.4}° {known}"));
    }
    let tilt = details.tilt_deg.map(|tilt| format!("{tilt:.4}° of the platform"));
    lines.add_found("tilt", tilt);
    let misalignments = details.axis_misalignments.iter();
    misalignments.for_each(|speed| lines.add("axis misalignment", speed.words()));
    if let Some((ratio, bias)) = details.met_ratio.zip(details.one_speed_bias_deg) {
        let is_one = details.stretches.len() < 3;
        let seen =
            if is_one { "of which one speed shows a part alone" } else { "at the slower speed" };
        lines.add("g-sensitivity", format!("{ratio:.4} of the Earth rate, {seen}"));
        let what = if is_one {
            format!(
                "the g-sensitivity turns the azimuth, by {bias:.4}° (1σ): turn at a second speed"
            )
        } else {
            format!("would be off by {bias:+.4}° for the g-sensitivity")
        };
        lines.add("one speed alone", what);
    }
    lines
}

fn stages(stages: &Stages) -> Part {
    let off = |azimuth| format!("{:+.4}", azimuth_error(azimuth, stages.full_deg));
    Columns::of("Azimuth after each stage of compensation", &stages.named())
        .column("stage", |(stage, _)| stage)
        .fixed("azimuth, °", 4, |(_, azimuth)| *azimuth)
        .column("from the last, °", |(_, azimuth)| off(*azimuth))
        .into()
}

fn stretches(stretches: &[StretchDetails]) -> Part {
    Columns::of("Even turns", stretches)
        .column("sense", |stretch| &stretch.sense)
        .fixed("speed, Hz", 5, |stretch| stretch.speed_hz)
        .column("turns", |stretch| stretch.turns)
        .column("left out", |stretch| stretch.left_out)
        .fixed("time, s", 2, |stretch| stretch.seconds)
        .fixed("uneven by, %", 4, |stretch| 100.0 * stretch.unevenness)
        .into()
}

/// Spectra of every part as it came and freed of the axis misalignment, then the phasors of its turns.
fn figures(replay: &Replay, outcome: &Outcome, rows: &[RotatingRow]) -> Vec<Part> {
    let Some(details) = outcome.details::<RotatingDetails>() else { return Vec::new() };
    let conclusion = replay.session.conclusion();
    let without = match conclusion.and_then(|found| found.misalignments.first()) {
        Some(found) => freed(rows, found.sine, found.quadrature),
        None => rows.to_vec(),
    };
    let (parts, freed) = (replay.parts(rows), replay.parts(&without));
    let mut page: Vec<Part> = Vec::new();
    for (part, freed) in parts.iter().zip(&freed) {
        if !part.is_even {
            page.push(figures::profile(part).into());
        }
        page.push(figures::spectra(part, freed).into());
    }
    page.push(figures::platform(&parts).into());
    page.push(figures::plane(&freed).into());
    page.push(figures::residuals(&details.turns).into());
    page
}
