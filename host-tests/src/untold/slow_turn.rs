//! How slowly a base may turn about the vertical that a recording does not show it, and where that puts north.

use std::f64::consts::PI;
use std::fmt;

use orientation::align::slow_turn::SlowTurn;
use orientation::align::stepwise::Problem;
use orientation::session::{Session, rotating};
use orientation::signal::dwell::Dwell;

/// From how many of its σ on a slow turn of the base is told, or taken off.
const TOLD: f64 = 4.0;
/// Error of an azimuth in its σ that is worth telling.
const WRONG: f64 = 5.0;
/// A rate of which nothing else is known, rad/s: 0.01 °/min.
const SLOW: f64 = 0.01 / 60.0 / 180.0 * PI;

/// A slow turn of the base that does not show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unseen {
    /// Its rate at the most, rad/s; infinite where the recording shows none.
    rate: f64,
    /// By how much the azimuth is off over that, s.
    lever: f64,
}

/// What a stage's session does not show of it, where an azimuth that it found would be wrong.
#[must_use]
pub fn of_stage(session: &Session) -> Option<Unseen> {
    let conclusion = session.conclusion()?;
    let judged = session.dwells().iter().zip(&conclusion.disturbances);
    let kept: Vec<&Dwell> =
        judged.filter(|(_, why)| why.is_none()).map(|(dwell, _)| dwell).collect();
    let white = conclusion.angle_random_walk * conclusion.angle_random_walk;
    let (setting, tilt) = (session.setting(), &conclusion.tilt);
    let turn = Problem { setting, tilt, white, dwells: &kept }.slow_turn(conclusion.fit.as_ref()?);
    Unseen::of(&turn?, conclusion.verdict.ok()?.sigma)
}

/// The same of a turning platform's.
#[must_use]
pub fn of_platform(session: &rotating::Session) -> Option<Unseen> {
    let conclusion = session.conclusion()?;
    let turn = conclusion.slow_turn(session.setting(), session.follower())?;
    Unseen::of(&turn, conclusion.verdict.ok()?.sigma)
}

impl Unseen {
    /// Nothing where it hides in the azimuth's σ, rad.
    fn of(turn: &SlowTurn, sigma: f64) -> Option<Self> {
        let unseen = Self { rate: TOLD * turn.sigma, lever: turn.lever.abs() };
        (unseen.shift() > WRONG * sigma).then_some(unseen)
    }

    /// By how much it puts north off at the most, rad.
    #[must_use]
    pub fn shift(&self) -> f64 {
        (self.rate * self.lever).min(PI)
    }
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.rate.is_infinite() {
            let each = (SLOW * self.lever).to_degrees();
            return write!(
                f,
                "no slow turn of the base, which these positions do not show: with 0.01 °/min north is {each:.2}° off"
            );
        }
        let rate = significant((self.rate * 60.0).to_degrees());
        let shift = self.shift().to_degrees();
        write!(
            f,
            "no slow turn of the base: up to {rate} °/min would not show, and put north {shift:.2}° off"
        )
    }
}

/// A number with two significant digits.
fn significant(value: f64) -> String {
    let digits = (1.0 - value.abs().max(f64::MIN_POSITIVE).log10().floor()).clamp(0.0, 9.0);
    format!("{value:.0$}", digits as usize)
}
