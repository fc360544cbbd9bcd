//! Static initial azimuth update from the stops of a vehicle, and inertial-frame alignment of one that stands.

pub(crate) mod figures;
mod progress;

use orientation::alignment::stops::conclusion::Found;
use orientation::alignment::stops::inclination::pitch_and_roll;
use orientation::alignment::stops::residual::Residual;
use orientation::alignment::stops::session::Session;
use orientation::alignment::stops::stop;
use orientation::units::{Radians, wrapped};
use serde::Serialize;

use crate::cause::{self, Cause};
use crate::methods::Course;
use crate::methods::asked::Question;
use crate::methods::stops::{Replay, samples};
use crate::outcome::keys::Keys;
use crate::outcome::{Excluded, Finished, FitDetails, Outcome, of_biases, of_site_and_time};
use crate::output::{
    azimuth as in_circle, azimuth_error, counted, degrees, in_degrees_per_hour, positive_zero,
    signed,
};
use crate::recording::{Body, Truth};
use crate::report::{Columns, Figure, Lines, Part, Stretch};

/// Why seconds of a stop are left out.
const BLOWN: &str = "a blow, or an accelerometer at its limit";

/// Azimuths of the least inclination U between the first stop and the last, as the method of Szymanowski 2003 finds
/// them, °: at the end, to which what the gyros turned leads, and at the first stop.
fn plain_azimuths(found: &Found) -> [f64; 2] {
    let turned = found.azimuth.angle.0 - found.start.angle.0;
    let plain = found.plain.azimuth.0;
    [wrapped(plain + turned), plain].map(degrees)
}

/// What the method of Szymanowski 2003 makes of the first and the last stop: in closed form, and where Brent's search
/// finds the least U in the angle form, and the least √(ΔΘ² + ΔΦ²).
fn plain(found: &Found) -> Keys {
    let (plain, [azimuth_deg, start_azimuth_deg]) = (&found.plain, plain_azimuths(found));
    Keys::default()
        .with("azimuth_deg", azimuth_deg)
        .with("sigma_deg", plain.sigma.degrees())
        .with("start_azimuth_deg", start_azimuth_deg)
        .with("brent_deg", degrees(plain.angle.at))
        .with("euler_deg", degrees(plain.euler.at))
        .with("inclination_deg", degrees(plain.angle.value))
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
        let sigma =
            |variance: f64| degrees((variance / stop.seconds().0.max(1.0)).sqrt() / gravity);
        Self {
            from_s: zero_s + stop.from.0,
            to_s: zero_s + stop.to.0,
            pitch_deg: pitch.degrees(),
            roll_deg: roll.degrees(),
            level_sigma_deg: [sigma(forward), sigma(right)],
            displacement_m: stop.displacement.map(|place| place.map(|part| part.0)),
            residual_deg: residual.map(|residual| residual.tilt.map(Radians::degrees)),
            residual_sigma_deg: residual.map(|residual| residual.sigma.degrees()),
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
        let setting = &self.session.setting;
        let site = &setting.site;
        let parts = [
            (true, "azimuth"),
            (true, "level"),
            (setting.bias_sigma().0 > 0.0, "gyro biases"),
            (site.scale_sigma > 0.0, "gyro scale factors"),
            (site.accelerometer_bias_sigma.0 > 0.0, "accelerometer biases"),
            (site.latitude_sigma.0 > 0.0, "latitude"),
            (self.session.stops().len() > 1, "displacement"),
        ];
        parts.into_iter().filter_map(|(is_there, name)| is_there.then_some(name)).collect()
    }

    /// What was left out: seconds of stops, means, rest rates.
    fn excluded(&self, found: Option<&Found>) -> Vec<Excluded> {
        let stops = self.session.stops().iter().enumerate();
        let blown = stops.filter(|(_, stop)| stop.left_out > 0).map(|(index, stop)| {
            let (stop, seconds) = (index + 1, stop.left_out);
            let reason = format!("{seconds} s: {BLOWN}");
            let words = format!("at stop {stop}, ");
            Excluded { place: Keys::default().with("stop", stop), words, reason }
        });
        let of_found = found.into_iter().flat_map(|found| {
            let (left_out, of) = (found.tally.left_out, found.blocks);
            let means = format!("{left_out} of {of} means of the force: disturbed");
            let turning = format!(
                "rest rates of {}: the vehicle turned",
                counted(found.tally.turning as usize, "stop")
            );
            let both = [(left_out > 0, means), (found.tally.turning > 0, turning)];
            both.into_iter().filter_map(|(is_there, reason)| is_there.then_some(reason))
        });
        let of_found = of_found.map(|reason| {
            let (place, words) = Default::default();
            Excluded { place, words, reason }
        });
        blown.chain(of_found).collect()
    }

    fn stops(&self) -> Vec<StopDetails> {
        let stops = self.session.stops().iter().enumerate();
        let of = |(index, stop)| StopDetails::of(stop, self.session.residual(index), self.zero_s);
        stops.map(of).collect()
    }

    /// The azimuth at the beginning and the biases of the gyros, as keys and in words, and as keys what else an
    /// alignment from stops adds.
    fn details(&self, found: Option<&Found>, is_ok: bool, truth: &Truth) -> (Keys, Lines) {
        let start = found.filter(|_| is_ok).map(|found| found.start);
        let start = start.map(|azimuth| [azimuth.angle, azimuth.sigma].map(Radians::degrees));
        let error = start.zip(truth.start_azimuth_deg);
        let error = error.map(|([azimuth, _], truth)| azimuth_error(azimuth, truth));
        let observed = found.filter(|found| found.are_biases_observed);
        let biases =
            observed.map(|found| [found.biases, found.bias_sigmas].map(in_degrees_per_hour));
        let keys = Keys::default()
            .with_found("start_azimuth_deg", start.map(|[azimuth, _]| azimuth))
            .with_found("start_sigma_deg", start.map(|[_, sigma]| sigma))
            .with_found("start_error_deg", error)
            .with_found("bias_dph", biases.map(|[biases, _]| biases))
            .with_found("bias_sigma_dph", biases.map(|[_, sigmas]| sigmas))
            .with("plain", found.map(plain))
            .with("stops", self.stops());
        let words = |[angle, sigma]: [f64; 2]| format!("{angle:.4}° ± {sigma:.4}° (1σ)");
        let lines = Lines::new("Start and gyros")
            .with_found("at the start", start.map(words))
            .with_found("  truth", error.map(|error| format!("the error is {}°", signed(error, 4))))
            .with_found("gyro biases", biases.map(|biases| of_biases(biases, 4)));
        (keys, lines)
    }
}

impl Course for Session {
    fn stretches(&self) -> Vec<Stretch> {
        progress::stretches(self, 0.0)
    }
}

impl Finished for Replay {
    fn outcome(&self, truth: &Truth) -> Outcome {
        let Some(conclusion) = self.session.conclusion() else {
            return Outcome::unfinished(self.method);
        };
        let is_noise_known = self.session.setting.site.noise.is_white_known();
        let found = conclusion.found.as_ref();
        let stops = self.session.stops();
        let (details, lines) = self.details(found, conclusion.verdict.is_ok(), truth);
        let lines = [lines].into_iter().chain(found.map(of_plain)).map(Part::from);
        let parts = lines.chain([table(&self.stops())]).map(Part::detail).collect();
        let seconds = stops.iter().map(|stop| stop.seconds().0).sum();
        Outcome {
            limit_deg: found.filter(|_| is_noise_known).map(|found| found.limit.degrees()),
            pitch_deg: found.map(|found| found.level[0].degrees()),
            roll_deg: found.map(|found| found.level[1].degrees()),
            seconds,
            fit: Some(FitDetails {
                earth_rate_ratio: found.map(|found| found.plain.ratio),
                earth_rate_ratio_sigma: found.map(|found| found.plain.ratio_sigma),
                model: found.map(|_| self.columns()).unwrap_or_default(),
                excluded: self.excluded(found),
                ..FitDetails::of(found.map(|found| &found.budget), 1.0, stops.len())
            }),
            assumed: self.assumed.clone(),
            circumstances: of_site_and_time(
                &self.session.setting.site,
                seconds,
                (stops.len(), "stop"),
            )
            .lines,
            ..Outcome::new(self.method, details, parts)
        }
        .judged(&conclusion.verdict, truth.azimuth_deg)
    }

    fn figures(&self, _: &Outcome, truth: &Truth, body: Option<&Body>) -> Vec<Part> {
        let found = self.session.conclusion().and_then(|conclusion| conclusion.found.as_ref());
        let rows = body.and_then(samples::rows);
        let rows = rows.as_deref().unwrap_or_default();
        let mut page = Vec::new();
        if let Some(found) = found {
            page.extend(progress::track(self, rows, found).into_iter().map(Part::from));
            page.extend(progress::residuals(self, &self.stops()).map(Part::from));
            let convergence = progress::convergence(self, rows, found, truth.azimuth_deg);
            page.extend(convergence.into_iter().map(Part::from));
        }
        page.push(progress::timeline(self).into());
        page.extend(self.paper(found).into_iter().map(|figure| Part::from(figure).detail()));
        page
    }

    fn cause(&self, of: &Question) -> Option<Cause> {
        let refusal = self.session.conclusion()?.verdict.as_ref().err()?;
        cause::of_vehicle(of, refusal)
    }
}

impl Replay {
    /// The figures of Szymanowski 2003.
    fn paper(&self, found: Option<&Found>) -> Vec<Figure> {
        let mut page = Vec::new();
        if let Some(Found { plain, .. }) = found {
            page.extend(figures::inclinations(plain));
            let latitude = self.session.setting.site.latitude;
            let drive = seconds(&self.stops()).map(|seconds| (plain, seconds));
            page.push(figures::heading_error(latitude, drive));
        }
        // The criteria are those of the first alignment.
        let begun = self.session.stops().first().map_or(0.0, |stop| stop.from.0);
        if self.criteria.last().is_some_and(|(time_s, ..)| *time_s > begun) {
            page.extend(figures::criteria(self));
        }
        page
    }
}

/// From the middle of the first stop to that of the last, s.
fn seconds(stops: &[StopDetails]) -> Option<f64> {
    let [first, .., last] = stops else { return None };
    Some(0.5 * (last.from_s + last.to_s - first.from_s - first.to_s))
}

fn table(stops: &[StopDetails]) -> Part {
    Columns::of("Stops", stops)
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
        .found("1σ of white noise, °", 5, |stop| stop.residual_sigma_deg)
        .into()
}

/// What the method of Szymanowski 2003 finds from the first stop and the last.
fn of_plain(found: &Found) -> Lines {
    let (plain, [azimuth, start]) = (&found.plain, plain_azimuths(found));
    let [brent, euler] =
        [plain.angle, plain.euler].map(|least| azimuth_error(degrees(least.at), start));
    let title = "The method of Szymanowski 2003: first stop and last, gyros taken as free of bias";
    Lines::new(title)
        .with("azimuth", format!("{}° ± {:.4}° (1σ)", in_circle(azimuth, 4), plain.sigma.degrees()))
        .with("at the start", format!("{start:.7}° in closed form"))
        .with("least angle", format!("{brent:+.2e}° from that, by Brent's search"))
        .with("√(ΔΘ² + ΔΦ²)", format!("least {euler:+.2e}° from that"))
        .with("inclination there", format!("{:.5}°", degrees(plain.angle.value)))
}
