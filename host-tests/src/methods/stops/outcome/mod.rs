//! Static initial azimuth update from the stops of a vehicle, and inertial-frame alignment of one that stands.

pub(crate) mod figures;

use orientation::alignment::stops::conclusion::Found;
use orientation::alignment::stops::inclination::pitch_and_roll;
use orientation::alignment::stops::residual::Residual;
use orientation::alignment::stops::stop;
use orientation::units::wrapped;
use serde::Serialize;

use crate::cause;
use crate::methods::asked::Asked;
use crate::methods::stops::Replay;
use crate::outcome::{Excluded, Finished, FitDetails, Outcome};
use crate::output::{azimuth_error, degrees, degrees_per_hour, positive_zero};
use crate::recording::{Body, Header, Truth};
use crate::report::{Columns, Lines, Part};

/// What an alignment from stops adds.
#[derive(Clone, Debug, Serialize)]
pub struct StopsDetails {
    /// Azimuth of body x at the beginning, [0, 360) °; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_azimuth_deg: Option<f64>,
    /// 1σ of the azimuth at the beginning, °; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_sigma_deg: Option<f64>,
    /// Error of the azimuth at the beginning, °, where the truth is known; only with `ok`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start_error_deg: Option<f64>,
    /// Biases of the gyros forward, right, down, °/h, where they could be distinguished from the Earth rate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias_dph: Option<[f64; 3]>,
    /// 1σ of the biases, °/h.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bias_sigma_dph: Option<[f64; 3]>,
    /// What the method of Szymanowski 2003 makes of the first and the last stop.
    pub plain: Option<PlainDetails>,
    /// Every stop.
    pub stops: Vec<StopDetails>,
}

/// The method of Szymanowski 2003: azimuths of the least inclination U between the first stop and the last. It
/// finds that at the first stop; what the gyros turned leads to the end.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PlainDetails {
    /// Azimuth at the end, in closed form, [0, 360) °.
    pub azimuth_deg: f64,
    /// 1σ of the azimuth at the end, °.
    pub sigma_deg: f64,
    /// At the first stop, in closed form, °.
    pub start_azimuth_deg: f64,
    /// At the first stop, where Brent's search finds the least U in the angle form, °.
    pub brent_deg: f64,
    /// At the first stop, where Brent's search finds the least √(ΔΘ² + ΔΦ²), °.
    pub euler_deg: f64,
    /// The least U itself, in the angle form, °.
    pub inclination_deg: f64,
}

impl From<&Found> for PlainDetails {
    fn from(found: &Found) -> Self {
        let plain = &found.plain;
        let turned = found.azimuth.angle - found.start.angle;
        Self {
            azimuth_deg: degrees(wrapped(plain.azimuth + turned)),
            sigma_deg: degrees(plain.sigma),
            start_azimuth_deg: degrees(plain.azimuth),
            brent_deg: degrees(plain.angle.at),
            euler_deg: degrees(plain.euler.at),
            inclination_deg: degrees(plain.angle.value),
        }
    }
}

/// A stop.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct StopDetails {
    /// When it began, s on the recording's clock.
    pub from_s: f64,
    /// When it ended, s.
    pub to_s: f64,
    /// Pitch of the body, °.
    pub pitch_deg: f64,
    /// Roll of the body, °.
    pub roll_deg: f64,
    /// 1σ of either from the scatter of its seconds, °.
    pub level_sigma_deg: [f64; 2],
    /// How far it lies from the first, north and east, m; null where that was not known.
    pub displacement_m: Option<[f64; 2]>,
    /// Levelled vertical less the one to which the Earth turned it, north and east, °; null without a fit, or where the
    /// displacement was not known.
    pub residual_deg: Option<[f64; 2]>,
    /// 1σ of either part from white noise alone, °.
    pub residual_sigma_deg: Option<f64>,
}

impl StopDetails {
    /// The details of a stop of a session whose zero is at `zero_s`, with what the solution leaves of it.
    fn of(stop: &stop::Stop, residual: Option<Residual>, zero_s: f64) -> Self {
        let [pitch, roll] = pitch_and_roll(&stop.force.mean());
        let gravity = stop.force.mean().iter().map(|part| part * part).sum::<f64>().sqrt();
        let [forward, right, _] = stop.force.variance();
        let sigma = |variance: f64| degrees((variance / stop.seconds().max(1.0)).sqrt() / gravity);
        Self {
            from_s: zero_s + stop.from,
            to_s: zero_s + stop.to,
            pitch_deg: degrees(pitch),
            roll_deg: degrees(roll),
            level_sigma_deg: [sigma(forward), sigma(right)],
            displacement_m: stop.displacement,
            residual_deg: residual.map(|residual| residual.tilt.map(degrees)),
            residual_sigma_deg: residual.map(|residual| degrees(residual.sigma)),
        }
    }

    /// How far it lies from the first one in a direction, m, or these words.
    fn displaced(&self, direction: usize, unknown: &str) -> String {
        let words = |displacement: [f64; 2]| format!("{:.1}", displacement[direction]);
        self.displacement_m.map_or_else(|| unknown.to_owned(), words)
    }
}

impl Replay {
    /// The names of what a solution finds, all of it together.
    fn columns(&self) -> Vec<&'static str> {
        let setting = self.session.setting();
        let site = &setting.site;
        let parts = [
            (true, "azimuth"),
            (true, "level"),
            (setting.bias_sigma() > 0.0, "gyro biases"),
            (site.scale_sigma > 0.0, "gyro scale factors"),
            (site.accelerometer_bias_sigma > 0.0, "accelerometer biases"),
            (site.latitude_sigma > 0.0, "latitude"),
            (self.session.stops().len() > 1, "displacement"),
        ];
        parts.into_iter().filter_map(|(is_there, name)| is_there.then_some(name)).collect()
    }

    /// What was left out: seconds of stops, means, rest rates.
    fn excluded(&self, found: Option<&Found>) -> Vec<Excluded> {
        let stops = self.session.stops().iter().enumerate();
        let blown = stops.filter(|(_, stop)| stop.left_out > 0).map(|(index, stop)| {
            let seconds = stop.left_out;
            let reason = format!("{seconds} s: a blow, or an accelerometer at its limit");
            Excluded { stop: Some(index + 1), reason, ..Excluded::default() }
        });
        let of_found = found.into_iter().flat_map(|found| {
            let (left_out, of) = (found.tally.left_out, found.blocks);
            let means = format!("{left_out} of {of} means of the force: disturbed");
            let turning =
                format!("rest rates of {} stop(s): the vehicle turned", found.tally.turning);
            let both = [(left_out > 0, means), (found.tally.turning > 0, turning)];
            let excluded =
                both.into_iter().filter_map(|(is_there, reason)| is_there.then_some(reason));
            excluded.map(|reason| Excluded { reason, ..Excluded::default() })
        });
        blown.chain(of_found).collect()
    }

    fn details(&self, found: Option<&Found>, is_ok: bool, truth: &Truth) -> StopsDetails {
        let start = found.filter(|_| is_ok).map(|found| found.start);
        let start_deg = start.map(|azimuth| degrees(azimuth.angle));
        let observed = found.filter(|found| found.are_biases_observed);
        let stops = self.session.stops().iter().enumerate();
        let stop = |(index, stop)| StopDetails::of(stop, self.session.residual(index), self.zero_s);
        StopsDetails {
            start_azimuth_deg: start_deg,
            start_sigma_deg: start.map(|azimuth| degrees(azimuth.sigma)),
            start_error_deg: start_deg
                .zip(truth.start_azimuth_deg)
                .map(|(azimuth, truth)| azimuth_error(azimuth, truth)),
            bias_dph: observed.map(|found| found.biases.map(degrees_per_hour)),
            bias_sigma_dph: observed.map(|found| found.bias_sigmas.map(degrees_per_hour)),
            plain: found.map(Into::into),
            stops: stops.map(stop).collect(),
        }
    }

    fn found(&self) -> Option<&Found> {
        self.session.conclusion()?.found.as_ref()
    }
}

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let method = self.method.name();
        let Some(conclusion) = self.session.conclusion() else {
            return Outcome::unfinished(method);
        };
        let found = conclusion.found.as_ref();
        let stops = self.session.stops();
        let details = self.details(found, conclusion.verdict.is_ok(), truth);
        Outcome {
            limit_deg: found.filter(|_| self.noise_is_known()).map(|found| degrees(found.limit)),
            pitch_deg: found.map(|found| degrees(found.level[0])),
            roll_deg: found.map(|found| degrees(found.level[1])),
            seconds: stops.iter().map(stop::Stop::seconds).sum(),
            fit: Some(FitDetails {
                earth_rate_ratio: found.map(|found| found.plain.ratio),
                earth_rate_ratio_sigma: found.map(|found| found.plain.ratio_sigma),
                model: found.map(|_| self.columns()).unwrap_or_default(),
                excluded: self.excluded(found),
                ..FitDetails::of(found.map(|found| &found.budget), stops.len())
            }),
            assumed: self.assumed.clone(),
            ..Outcome::new(method, details)
        }
        .judged(&conclusion.verdict, truth.azimuth_deg)
    }

    fn parts(&self, outcome: &Outcome) -> Vec<Part> {
        let Some(details) = outcome.details::<StopsDetails>() else { return Vec::new() };
        let lines = lines(details);
        let lines = (!lines.lines.is_empty()).then_some(lines);
        let papers = details.plain.as_ref().map(of_plain);
        let stops = Columns::of("Stops", &details.stops)
            .numbered("stop")
            .fixed("from, s", 2, |stop| stop.from_s)
            .fixed("to, s", 2, |stop| stop.to_s)
            .fixed("pitch, °", 4, |stop| positive_zero(stop.pitch_deg, 5e-5))
            .fixed("1σ, °", 4, |stop| stop.level_sigma_deg[0])
            .fixed("roll, °", 4, |stop| positive_zero(stop.roll_deg, 5e-5))
            .fixed("1σ, °", 4, |stop| stop.level_sigma_deg[1])
            .column("north, m", |stop| stop.displaced(0, "not known"))
            .column("east, m", |stop| stop.displaced(1, ""))
            .found("residual north, °", 5, |stop| stop.residual_deg.map(|[north, _]| north))
            .found("east, °", 5, |stop| stop.residual_deg.map(|[_, east]| east))
            .found("1σ of white noise, °", 5, |stop| stop.residual_sigma_deg);
        let both = [lines, papers].into_iter().flatten().map(Part::from);
        both.chain([stops.into()]).collect()
    }

    fn figures(&self, outcome: &Outcome, _: &Truth, _: Option<&Body>) -> Vec<Part> {
        let Some(details) = outcome.details::<StopsDetails>() else { return Vec::new() };
        let mut parts: Vec<Part> = Vec::new();
        parts.extend(figures::azimuths(outcome, details.plain.as_ref()).map(Part::from));
        if let Some(found) = self.found() {
            let plain = &found.plain;
            parts.extend(figures::inclinations(plain).map(Part::from));
            let latitude = self.session.setting().site.latitude;
            let drive = seconds(&details.stops).map(|seconds| (plain, seconds));
            parts.push(figures::heading_error(latitude, drive).into());
        }
        parts.extend(figures::criteria(self).into_iter().map(Part::from));
        parts
    }

    fn cause(&self, header: &Header, body: &Body, asked: &Asked) -> Option<String> {
        let refusal = self.session.conclusion()?.verdict.as_ref().err()?;
        cause::of_vehicle(header, body, asked, refusal)
    }
}

/// From the middle of the first stop to that of the last, s.
fn seconds(stops: &[StopDetails]) -> Option<f64> {
    let [first, .., last] = stops else { return None };
    Some(0.5 * (last.from_s + last.to_s - first.from_s - first.to_s))
}

/// The azimuth at the beginning, and the biases of the gyros.
fn lines(details: &StopsDetails) -> Lines {
    let mut lines = Lines::new("Start and gyros");
    let start = details.start_azimuth_deg.zip(details.start_sigma_deg);
    let words = |(angle, sigma)| format!("{angle:.4}° ± {sigma:.4}° (1σ)");
    lines.add_found("at the start", start.map(words));
    let error = details.start_error_deg.map(|error| format!("the error is {error:+.4}°"));
    lines.add_found("  truth", error);
    if let Some((biases, sigmas)) = details.bias_dph.zip(details.bias_sigma_dph) {
        let both = biases.into_iter().zip(sigmas);
        let all: Vec<String> =
            both.map(|(bias, sigma)| format!("{bias:+.4} ± {sigma:.4}")).collect();
        lines.add("gyro biases", format!("{} °/h forward, right, down", all.join(", ")));
    }
    lines
}

/// What the method of Szymanowski 2003 finds from the first stop and the last.
fn of_plain(plain: &PlainDetails) -> Lines {
    let PlainDetails { azimuth_deg, sigma_deg, start_azimuth_deg, brent_deg, euler_deg, .. } =
        *plain;
    let [brent, euler] =
        [brent_deg, euler_deg].map(|angle| azimuth_error(angle, start_azimuth_deg));
    let mut lines = Lines::new(
        "The method of Szymanowski 2003: first stop and last, gyros taken as free of bias",
    );
    lines.add("azimuth", format!("{azimuth_deg:.4}° ± {sigma_deg:.4}° (1σ)"));
    lines.add("at the start", format!("{start_azimuth_deg:.7}° in closed form"));
    lines.add("least angle", format!("{brent:+.2e}° from that, by Brent's search"));
    lines.add("√(ΔΘ² + ΔΦ²)", format!("least {euler:+.2e}° from that"));
    lines.add("U there", format!("{:.5}°", plain.inclination_deg));
    lines
}
