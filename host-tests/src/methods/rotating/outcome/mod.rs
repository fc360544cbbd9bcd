//! Continuous rotation: what an alignment on a platform that turns all the time found.

pub(crate) mod figures;
mod fold;
mod progress;

use std::f64::consts::TAU;

use orientation::alignment::rotating::average::Average;
use orientation::alignment::rotating::conclusion::Conclusion;
use orientation::alignment::rotating::misalignment::AxisMisalignment;
use orientation::alignment::rotating::session::Session;
use orientation::alignment::rotating::solution::{Fit, Stages};
use orientation::alignment::rotating::turn::{Stretch, Turn};
use orientation::units::Radians;
use serde::Serialize;

use crate::cause::{self, Cause};
use crate::median::median;
use crate::methods::Course;
use crate::methods::asked::Question;
use crate::methods::rotating::Replay;
use crate::methods::rotating::turns::freed;
use crate::outcome::keys::Keys;
use crate::outcome::{Excluded, Finished, FitDetails, Outcome, of_site_and_time};
use crate::output::{
    azimuth as in_circle, azimuth_error, counted, degrees, degrees_per_hour, signed,
};
use crate::recording::{Body, RotatingRow, Truth};
use crate::report::{self, Columns, Lines, Part};

/// A turn of the platform, with what the median of its stretch leaves of it.
#[derive(Clone, Debug, Serialize)]
pub struct TurnDetails {
    /// `clockwise` or `counter-clockwise`.
    pub sense: &'static str,
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

/// The azimuth after each stage of compensation, rad, with its key and in words.
fn stages(fit: &Fit) -> [(&'static str, &'static str, f64); 4] {
    let Stages { raw, misalignment, senses, full } = fit.stages;
    [
        ("raw_deg", "raw, clockwise", raw.0),
        ("without_unevenness_deg", "without the unevenness", misalignment.0),
        ("both_senses_deg", "both senses", senses.0),
        ("full_deg", "everything", full.0),
    ]
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
    /// Whether the sensor is a gyro, not a molecular-electronic one.
    fn is_flat(&self) -> bool {
        self.session.setting.sensor.is_flat
    }

    /// Whether the sensor may have a g-sensitivity that integrates acceleration.
    fn is_molecular(&self) -> bool {
        self.session.setting.sensor.molecular_sigma.0 > 0.0
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

    /// The turns of all even stretches.
    fn turns(&self, conclusion: &Conclusion) -> Vec<TurnDetails> {
        let stretches = self.session.turn_accumulator.stretches.iter();
        let walk = conclusion.angle_random_walk;
        stretches
            .flat_map(|stretch| of_stretch(stretch, conclusion.misalignments.first(), walk.0))
            .collect()
    }

    /// Integrated g-sensitivity over the Earth rate at the slower speed, and what that speed alone leaves of it, rad:
    /// what the second speed showed, or the 1σ that a single one leaves; of a molecular-electronic sensor.
    fn g_sensitivity(&self, conclusion: &Conclusion) -> Option<[f64; 2]> {
        let fit = conclusion.fit.as_ref().filter(|_| self.is_molecular())?;
        let has_two = conclusion.pairs.len() > 1;
        let bias = if has_two { fit.one_speed } else { fit.budget.g_sensitivity };
        Some([fit.molecular.size(), bias.0])
    }

    /// Cramér–Rao bounds where the noise was stated, °: of the sensor, and of one whose gain, lag and g-sensitivity are known.
    fn limits_deg(&self, conclusion: &Conclusion) -> Option<[f64; 2]> {
        let is_known = self.session.setting.site.noise.is_white_known();
        let fit = conclusion.fit.as_ref().filter(|_| is_known);
        fit.map(|fit| [fit.limit, fit.plain_limit].map(Radians::degrees))
    }

    fn details(&self, conclusion: &Conclusion) -> Keys {
        let fit = conclusion.fit.as_ref();
        let misalignments: Vec<Keys> = conclusion.misalignments.iter().map(misalignment).collect();
        let of_stages = |fit| {
            let all = stages(fit).into_iter();
            all.fold(Keys::default(), |keys, (key, _, azimuth)| keys.with(key, degrees(azimuth)))
        };
        let g_sensitivity = self.g_sensitivity(conclusion);
        Keys::default()
            .with("sensor", if self.is_flat() { "gyro" } else { "met" })
            .with("plain_limit_deg", self.limits_deg(conclusion).map(|[_, plain]| plain))
            .with_all(misalignments.first())
            .with("axis_misalignments", misalignments)
            .with("tilt_deg", fit.map(tilt_deg))
            .with("met_ratio", g_sensitivity.map(|[ratio, _]| ratio))
            .with("one_speed_bias_deg", g_sensitivity.map(|[_, bias]| degrees(bias)))
            .with("stages", fit.map(of_stages))
            .with("stretches", averages(conclusion).map(stretch).collect::<Vec<_>>())
            .with("turns", self.turns(conclusion))
    }

    /// What turned: tilt, axis misalignment, g-sensitivity.
    fn lines(&self, conclusion: &Conclusion) -> Lines {
        let limit = self.limits_deg(conclusion).filter(|_| !self.is_flat()).map(|[_, plain]| {
            format!("{plain:.4}° were the sensor's gain, lag and g-sensitivity known")
        });
        let tilt = conclusion.fit.as_ref().map(tilt_deg);
        let lines = Lines::new("Platform and sensor")
            .with_found("limit", limit)
            .with_found("tilt", tilt.map(|tilt| format!("{tilt:.4}° of the platform")))
            .with_found("axis misalignment", conclusion.misalignments.iter().map(words));
        match self.g_sensitivity(conclusion) {
            Some([ratio, bias]) => {
                of_g_sensitivity(lines, conclusion.pairs.len() < 2, ratio, degrees(bias))
            }
            None => lines,
        }
    }
}

/// How the sensitive axis stands, as rate-modulated turns at a speed showed it.
fn misalignment(found: &AxisMisalignment) -> Keys {
    Keys::default()
        .with("coupling_deg", found.angle().degrees())
        .with("coupling_sigma_deg", degrees(found.sine_sigma))
        .with("lag_s", found.lag())
        .with("speed_hz", found.frequency.0 / TAU)
}

/// The axis misalignment with its lag, in words.
fn words(found: &AxisMisalignment) -> String {
    let [angle, sigma] = [found.angle().0, found.sine_sigma].map(degrees);
    let (lag, speed) = (1e3 * found.lag().0, found.frequency.0 / TAU);
    format!("{angle:.5}° ± {sigma:.5}°, {lag:.2} ms late, at {speed:.3} Hz")
}

/// Tilt of the platform's axis, °.
fn tilt_deg(fit: &Fit) -> f64 {
    degrees(fit.tilt.size().min(1.0).asin())
}

/// Turns in one sense at one speed.
fn stretch(average: &Average) -> Keys {
    Keys::default()
        .with("sense", average.sense.to_string())
        .with("speed_hz", average.speed / TAU)
        .with("turns", average.turns)
        .with("left_out", average.left_out)
        .with("seconds", average.seconds)
        .with("unevenness", unevenness(average))
}

/// Unevenness once per turn, relative to the speed.
fn unevenness(average: &Average) -> f64 {
    average.turning.size() / average.speed
}

/// The turns of a stretch about their median; a random walk in rad/√s gives either part of a phasor 1σ of
/// N·√(2/T).
fn of_stretch<'a>(
    stretch: &'a Stretch,
    misalignment: Option<&'a AxisMisalignment>,
    walk: f64,
) -> impl Iterator<Item = TurnDetails> + 'a {
    let phasors: Vec<[f64; 2]> =
        stretch.turns.iter().map(|turn| compensated(turn, misalignment)).collect();
    // Turns that are left out are far off, and do not move it.
    let middle = [0, 1].map(|part: usize| median(phasors.iter().map(|at| at[part])));
    stretch.turns.iter().zip(phasors).map(move |(turn, phasor)| {
        let sense = if turn.speed < 0.0 { "counter-clockwise" } else { "clockwise" };
        let seconds = f64::from(turn.seconds);
        TurnDetails {
            sense,
            speed_hz: f64::from(turn.speed.abs()) / TAU,
            middle_s: f64::from(turn.middle),
            seconds,
            residual_deg_h: [0, 1].map(|part: usize| degrees_per_hour(phasor[part] - middle[part])),
            sigma_deg_h: degrees_per_hour(walk * (2.0 / seconds).sqrt()),
        }
    })
}

/// A turn's rate in step with cos θ and sin θ, rad/s, without what an axis misalignment shows of the platform's rate
/// and acceleration.
fn compensated(turn: &Turn, misalignment: Option<&AxisMisalignment>) -> [f64; 2] {
    let [rate, turning] = [turn.rate, turn.turning].map(|phasor| phasor.map(f64::from));
    let parts = |found: &AxisMisalignment| (found.sine, found.quadrature.0);
    let (sine, quadrature) = misalignment.map_or((0.0, 0.0), parts);
    let speed = f64::from(turn.speed);
    let quickening = [speed * turning[1], -speed * turning[0]];
    [0, 1].map(|part: usize| rate[part] - sine * turning[part] - quadrature * quickening[part])
}

impl Course for Session {
    fn stretches(&self) -> Vec<report::Stretch> {
        progress::even(self, 0.0)
    }
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
        let stages = fit.map(table_of_stages);
        let parts = [self.lines(conclusion).into()].into_iter().chain(stages);
        let parts = parts.chain([table_of_stretches(conclusion)]).map(Part::detail).collect();
        let seconds = averages(conclusion).map(|average| average.seconds).sum();
        Outcome {
            limit_deg: self.limits_deg(conclusion).map(|[limit, _]| limit),
            pitch_deg: attitude.map(|[pitch, _]| pitch),
            roll_deg: attitude.map(|[_, roll]| roll),
            seconds,
            fit: Some(FitDetails {
                earth_rate_ratio: flat.map(|fit| fit.ratio),
                earth_rate_ratio_sigma: flat.map(|fit| fit.ratio_sigma),
                model: fit.map(|_| self.columns(conclusion)).unwrap_or_default(),
                excluded: left_out.map(excluded).collect(),
                ..FitDetails::of(fit.map(|fit| &fit.budget), 1.0, turns as usize)
            }),
            assumed: self.assumed.clone(),
            circumstances: of_site_and_time(
                &self.session.setting.site,
                seconds,
                (turns as usize, "turn"),
            )
            .lines,
            ..Outcome::new("rotating", self.details(conclusion), parts)
        }
        .judged(&conclusion.verdict, truth.azimuth_deg)
    }

    fn figures(&self, _: &Outcome, truth: &Truth, body: Option<&Body>) -> Vec<Part> {
        match (self.session.conclusion(), body) {
            (Some(conclusion), Some(Body::Rotating(rows))) => {
                figures(self, conclusion, rows, truth.azimuth_deg)
            }
            _ => Vec::new(),
        }
    }

    fn cause(&self, of: &Question) -> Option<Cause> {
        let refusal = self.session.conclusion()?.verdict.as_ref().err()?;
        cause::of_turning(of, refusal)
    }
}

fn excluded(average: &Average) -> Excluded {
    let Average { sense, left_out: turns, .. } = average;
    let speed = average.speed / TAU;
    let place = Keys::default()
        .with("sense", sense.to_string())
        .with("speed_hz", speed)
        .with("turns", turns);
    let words = format!("{} {sense} at {speed:.5} Hz: ", counted(*turns as usize, "turn"));
    Excluded { place, words, reason: DISTURBED.to_owned() }
}

/// What an integrated g-sensitivity makes of the azimuth, °, where there is one speed, and where there are two.
fn of_g_sensitivity(lines: Lines, is_one: bool, ratio: f64, bias: f64) -> Lines {
    let seen = if is_one { "of which one speed shows a part alone" } else { "at the slower speed" };
    let what = if is_one {
        format!("the g-sensitivity turns the azimuth, by {bias:.4}° (1σ): turn at a second speed")
    } else {
        format!("would be off by {}° for the g-sensitivity", signed(bias, 4))
    };
    lines
        .with("g-sensitivity", format!("{ratio:.4} of the Earth rate, {seen}"))
        .with("one speed alone", what)
}

fn table_of_stages(fit: &Fit) -> Part {
    let stages = stages(fit).map(|(_, name, azimuth)| (name, degrees(azimuth)));
    let off = |azimuth| azimuth_error(azimuth, fit.stages.full.degrees());
    Columns::of("Azimuth after each stage of compensation", &stages)
        .column("stage", |(stage, _)| stage)
        .column("azimuth, °", |(_, azimuth)| in_circle(*azimuth, 4))
        .column("from the last, °", |(_, azimuth)| signed(off(*azimuth), 4))
        .into()
}

fn table_of_stretches(conclusion: &Conclusion) -> Part {
    Columns::of("Even turns", &averages(conclusion).collect::<Vec<_>>())
        .column("sense", |average| average.sense)
        .fixed("speed, Hz", 5, |average| average.speed / TAU)
        .column("turns", |average| average.turns)
        .column("left out", |average| average.left_out)
        .fixed("time, s", 2, |average| average.seconds)
        .fixed("uneven by, %", 4, |average| 100.0 * unevenness(average))
        .into()
}

/// The fold with what the solution leaves, how the azimuth converged, what was done when; then spectra of every part
/// as it came and freed of the axis misalignment, and the phasors of its turns.
fn figures(
    replay: &Replay,
    conclusion: &Conclusion,
    rows: &[RotatingRow],
    truth_deg: Option<f64>,
) -> Vec<Part> {
    let without = match conclusion.misalignments.first() {
        Some(found) => freed(rows, found.sine, found.quadrature.0),
        None => rows.to_vec(),
    };
    let (parts, freed) = (replay.parts(rows), replay.parts(&without));
    let mut page: Vec<Part> = fold::figures(replay, conclusion, rows).map(Part::from).into();
    page.extend(progress::convergence(replay, rows, truth_deg).into_iter().map(Part::from));
    page.push(progress::timeline(replay).into());
    for (part, freed) in parts.iter().zip(&freed) {
        let profile = (!part.is_even).then(|| figures::profile(part).into());
        page.extend(profile.into_iter().chain([figures::spectra(part, freed).into()]));
    }
    let turns = replay.turns(conclusion);
    let last = [figures::platform(&parts), figures::plane(&freed), figures::residuals(&turns)];
    page.extend(last.map(Part::from));
    page
}
