//! Recordings of spinning bodies: replay through the three methods of the core, and what the data can show
//! at best.
//!
//! The types that come in here hold no truth; [`errors`] compares with it afterwards.

pub mod errors;
pub mod limit;
pub mod outcome;
pub mod samples;
pub mod track;

use orientation::roll::Progress;
use orientation::roll::{Method, Setting};
use orientation::signal::SpinSample;
use orientation::units::{
    DEGREE_PER_HOUR, DEGREE_PER_SQRT_HOUR, RadiansPerRootSecond, RadiansPerSecond, Seconds,
};

use self::limit::{Noise, Turns};
use self::track::Track;
use crate::assumptions::or_assumed;
use crate::methods::asked::Asked;
use crate::methods::error::ReplayError;
use crate::output::significant;
use crate::recording::period::Steps;
use crate::recording::{Body, GIVEN, Given, Header, SpinRow};

/// The least angle random walk that is told, °/√h: one below a millionth is that of no gyro, but of a simulation without
/// noise.
const LEAST_WALK: f64 = 1e-6;

/// 1σ of a gyro's scale error of which the header says nothing: 1 %.
pub const SCALE_SIGMA: f64 = 0.01;

/// The methods in the order in which they are reported; the last one is the answer.
pub const METHODS: [Method; 3] = [Method::Extrema, Method::Interpolated, Method::PhaseLocked];

/// The name of a method in tables.
pub(crate) fn name(method: Method) -> &'static str {
    match method {
        Method::Extrema => "extrema",
        Method::Interpolated => "interpolated",
        Method::PhaseLocked => "phase-locked",
    }
}

/// A finished replay.
#[derive(Clone, Debug)]
pub struct Replay {
    /// What each of [`METHODS`] made of it.
    pub tracks: [Track; 3],
    /// Sample period, s.
    pub period_s: f64,
    /// The noise, as stated and as the recording shows it.
    pub noise: Noise,
    /// The Cramér–Rao bound at each sample, rad (1σ); none where no turn shows the noise.
    pub bounds: Option<Vec<f64>>,
    /// Greatest accepted standard deviation, rad.
    pub required_sigma: f64,
    /// What had to be assumed.
    pub assumed: Vec<String>,
    /// Why the board that took the samples gave its roll up, if it did.
    pub ended: Option<String>,
    /// Why the gyro of the whole recording counts as stuck, which forbids to believe a roll.
    pub stuck_gyro: Option<String>,
}

impl Replay {
    /// The answer's track.
    #[must_use]
    pub fn answer(&self) -> &Track {
        let [.., answer] = &self.tracks;
        answer
    }

    /// Why there is no roll at the end, if there is none.
    #[must_use]
    pub fn refusal(&self) -> Option<String> {
        let end = &self.answer().end;
        if let Some(reason) = &self.ended {
            return Some(reason.clone());
        }
        match end.sigma_rad {
            None => Some(format!("the roll is not known at the end: {}", end.state)),
            Some(sigma) if sigma > self.required_sigma && self.stuck_gyro.is_none() => {
                Some(format!(
                    "σ of the roll at the end is {:.3}°, more than the {:.3}° asked for: {}",
                    sigma.to_degrees(),
                    self.required_sigma.to_degrees(),
                    end.state
                ))
            }
            Some(_) => self.stuck_gyro.clone(),
        }
    }
}

/// Replays the rows of a recording.
///
/// # Errors
/// A recording of another kind, or of less than two samples.
pub fn replay(header: &Header, body: &Body, asked: &Asked) -> Result<Replay, ReplayError> {
    let Body::Spin(rows) = body else { return Err(ReplayError::NoSpin(body.kind())) };
    let required_sigma = asked.required_sigma();
    if let Some(given) = Given::<Setting>::of(header).map_err(ReplayError::Session)? {
        given.setting.check()?;
        return Ok(again(&given, rows, required_sigma));
    }
    let steps = Steps::of(rows, |row| row.time_s);
    let period_s = steps.ok_or(ReplayError::TooFewSamples(rows.len()))?.period_s(header.rate_hz);
    let samples: Vec<SpinSample> = samples::samples(rows, period_s).collect();
    let (setting, assumed) = setting(header, rows, period_s);
    let replay = follow(&samples, setting, required_sigma, assumed);
    Ok(Replay { stuck_gyro: stuck_gyro(rows), ..replay })
}

/// Replays a run with what its board was given.
fn again(given: &Given<Setting>, rows: &[SpinRow], required_sigma: f64) -> Replay {
    let Given { setting, ended, .. } = *given;
    let samples: Vec<SpinSample> = samples::given(rows, setting.sample_seconds.0).collect();
    let ended = ended.map(|reason| Progress::Ended(reason).to_string());
    let assumed = vec![GIVEN.to_owned()];
    Replay { ended, ..follow(&samples, setting, required_sigma, assumed) }
}

/// Noise of the forces from which sensors are no ideal ones, m/s²: those that turn so fast measure thousands.
const REAL_NOISE: f64 = 0.005;

/// A gyro that shows one rate for most of the time, beside forces that have noise: as they show it by themselves, for
/// turns that are counted by a gyro which is wrong leave some of the lift over.
fn stuck_gyro(rows: &[SpinRow]) -> Option<String> {
    let rates: Vec<f64> = rows.iter().map(|row| row.rate_rad_s).collect();
    let is_one = rates.windows(2).all(|pair| pair[0] == pair[1]);
    let stuck = if is_one { rows.len() } else { limit::stuck(&rates).len() };
    let noise = [0, 1].map(|axis: usize| {
        let forces: Vec<f64> = rows.iter().map(|row| row.force_m_s2[axis]).collect();
        limit::white(&forces)
    });
    (2 * stuck > rows.len() && noise.into_iter().all(|noise| noise > REAL_NOISE)).then(|| {
        let percent = 100 * stuck / rows.len();
        format!("column gx_rad_s shows one value in {percent} % of the rows: stuck or dead, check its supply and wires")
    })
}

/// Follows samples by all methods, whatever the setting's; `required_sigma`, rad, is the greatest standard deviation
/// that is accepted.
#[must_use]
pub fn follow(
    samples: &[SpinSample],
    setting: Setting,
    required_sigma: f64,
    assumed: Vec<String>,
) -> Replay {
    let turns = Turns::of(samples);
    let noise = Noise { force: turns.force_noise, angle_random_walk: setting.angle_random_walk.0 };
    let has_lift = !turns.lifts.is_empty();
    let bounds = has_lift
        .then(|| limit::bounds(samples, noise, setting.scale_sigma, |index| turns.lift(index)));
    Replay {
        tracks: METHODS.map(|method| Track::of(&Setting { method, ..setting }, samples)),
        period_s: setting.sample_seconds.0,
        noise,
        bounds,
        required_sigma,
        assumed,
        ended: None,
        stuck_gyro: None,
    }
}

/// What is known of the gyro; what is not stated is taken from the rows or assumed.
fn setting(header: &Header, rows: &[SpinRow], period_s: f64) -> (Setting, Vec<String>) {
    let (mut assumed, usual) = (Vec::new(), Setting::new(Seconds(period_s)));
    let angle_random_walk = header.gyro_n_deg_sqrt_h.map_or_else(
        || {
            let rates: Vec<f64> = rows.iter().map(|row| row.rate_rad_s).collect();
            let walk = limit::gyro_walk(&rates, period_s);
            let field = walk / DEGREE_PER_SQRT_HOUR;
            let shown = if field < LEAST_WALK {
                format!("below {LEAST_WALK}")
            } else {
                significant(field, 3)
            };
            assumed.push(format!("gyro noise N {shown} °/√h as the recording shows it"));
            walk
        },
        |n| n * DEGREE_PER_SQRT_HOUR,
    );
    let scale = || format!("gyro scale to {SCALE_SIGMA} (1σ)");
    let scale_sigma = or_assumed(header.gyro_scale_sigma, SCALE_SIGMA, &mut assumed, scale);
    assumed.push("no rates across the axis; lift in the vertical plane".to_owned());
    assumed.push("forces and rates of the same moment".to_owned());
    assumed.push("signs of both accelerometers: with the other ones 180° away".to_owned());
    assumed.push(
        "no gyro error that follows the roll, and a scale that is steady for some turns".to_owned(),
    );
    let bias = || format!("gyro bias to {:.0} °/h (1σ)", usual.bias_sigma.degrees_per_hour());
    let stated = header.gyro_bias_deg_h.map(|bias| bias * DEGREE_PER_HOUR);
    let angle_random_walk = RadiansPerRootSecond(angle_random_walk);
    let bias_sigma = or_assumed(stated, usual.bias_sigma.0, &mut assumed, bias);
    let bias_sigma = RadiansPerSecond(bias_sigma);
    (Setting { angle_random_walk, scale_sigma, bias_sigma, ..usual }, assumed)
}
