//! How slowly a base may move that a recording does not show it, and where that puts north.

use std::f64::consts::FRAC_PI_4;
use std::fmt;

use orientation::align::level;
use orientation::align::slow::SlowMotion;
use orientation::align::stepwise::Problem;
use orientation::session::{Session, rotating};
use orientation::signal::dwell::Dwell;

/// From how many of its σ on a slow motion of the base is told, or taken off.
const TOLD: f64 = 5.0;
/// By how much of its σ an azimuth may be off with which its noise makes it wrong, beyond five of them: worth telling.
const WORTH_TELLING: f64 = 3.0;

/// How a base moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Motion {
    /// About the vertical.
    Turning,
    /// About an axis that is level.
    Tilting,
}

/// A slow motion of the base that does not show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unseen {
    motion: Motion,
    /// Its rate at the most, rad/s; infinite where the recording shows none.
    rate: f64,
    /// By how much the azimuth is off over that, s.
    lever: f64,
}

/// What a stage's session does not show, where it may put the azimuth wrong.
#[must_use]
pub fn of_stage(session: &Session) -> Vec<Unseen> {
    let Some(conclusion) = session.conclusion() else { return Vec::new() };
    let (Some(fit), Ok(azimuth)) = (&conclusion.fit, conclusion.verdict) else { return Vec::new() };
    let judged = session.dwells().iter().zip(&conclusion.disturbances);
    let kept: Vec<&Dwell> =
        judged.filter(|(_, why)| why.is_none()).map(|(dwell, _)| dwell).collect();
    let white = conclusion.angle_random_walk * conclusion.angle_random_walk;
    let (setting, tilt) = (session.setting(), &conclusion.tilt);
    let problem = Problem { setting, tilt, white, dwells: &kept };
    let (gravity, bias) = (setting.latitude.gravity(), setting.accelerometer_bias_sigma);
    let tilting = level::tilting(&setting.mount, kept.iter().copied(), gravity, bias);
    let tilting = tilting.filter(|_| tilt.measured);
    let turn = Unseen::of(Motion::Turning, problem.slow_turn(fit), azimuth.sigma);
    let tilting = problem.slow_tilting(fit, tilting.as_ref());
    let tilting = Unseen::of(Motion::Tilting, tilting, azimuth.sigma);
    turn.into_iter().chain(tilting).collect()
}

/// The same of a turning platform's.
#[must_use]
pub fn of_platform(session: &rotating::Session) -> Option<Unseen> {
    let conclusion = session.conclusion()?;
    let turn = conclusion.slow_turn(session.setting(), session.follower());
    Unseen::of(Motion::Turning, turn, conclusion.verdict.ok()?.sigma)
}

impl Unseen {
    /// Nothing where it hides in the azimuth's σ, rad.
    fn of(motion: Motion, slow: Option<SlowMotion>, sigma: f64) -> Option<Self> {
        let slow = slow?;
        let unseen = Self { motion, rate: TOLD * slow.sigma, lever: slow.lever.abs() };
        (unseen.rate * unseen.lever > WORTH_TELLING * sigma).then_some(unseen)
    }

    /// By how much it puts north off at the most, rad; infinite where the recording tells nothing of it.
    #[must_use]
    pub fn shift(&self) -> f64 {
        let shift = self.rate * self.lever;
        if shift < FRAC_PI_4 { shift } else { f64::INFINITY }
    }
}

impl Motion {
    /// What it is called, the unit of its rates with how many seconds that has, and a rate in it that may well be.
    fn words(self) -> (&'static str, &'static str, f64, f64) {
        match self {
            Self::Turning => ("slow turn", "°/min", 60.0, 0.01),
            Self::Tilting => ("slow tilting", "°/h", 3600.0, 0.1),
        }
    }
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (name, unit, seconds, usual) = self.motion.words();
        let shift = self.shift().to_degrees();
        if shift.is_infinite() {
            let shift = usual / seconds * self.lever;
            return write!(
                f,
                "no {name} of the base, which the recording does not show: with {usual} {unit} north is {shift:.2}° off"
            );
        }
        let rate = significant((self.rate * seconds).to_degrees());
        write!(
            f,
            "no {name} of the base: up to {rate} {unit} would not show, and put north {shift:.2}° off"
        )
    }
}

/// A number with two significant digits.
fn significant(value: f64) -> String {
    let digits = (1.0 - value.abs().max(f64::MIN_POSITIVE).log10().floor()).clamp(0.0, 9.0);
    format!("{value:.0$}", digits as usize)
}
