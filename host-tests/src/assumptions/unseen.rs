//! How slowly a base may move that a recording does not show it, and where that puts north.

use std::f64::consts::FRAC_PI_4;
use std::fmt;

use orientation::alignment::rotating::session as rotating;
use orientation::alignment::slow::SlowMotion;
use orientation::alignment::stepwise::session::Session;

/// From how many of its σ on a slow motion of the base is stated, or taken off.
const STATED: f64 = 5.0;
/// By how much of its σ an azimuth may be off with which its noise makes it wrong, beyond five of them: worth stating.
const WORTH_STATING: f64 = 3.0;

/// How a base moves: what that is called, the unit of its rates with how many seconds that has, and a rate in it that may
/// well be.
type Motion = (&'static str, &'static str, f64, f64);
/// About the vertical.
const TURNING: Motion = ("slow turn", "°/min", 60.0, 0.01);
/// About an axis that is level.
const TILTING: Motion = ("slow tilting", "°/h", 3600.0, 0.1);

/// A slow motion of the base that does not show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unseen {
    motion: Motion,
    /// Rate of the base at the most, rad/s; infinite where the recording shows none.
    rate: f64,
    /// By how much the azimuth is off over that, s.
    lever: f64,
}

/// What a stage's session does not show, where it may put the azimuth wrong.
pub fn of_stage(session: &Session) -> Vec<Unseen> {
    let found = session.conclusion().and_then(|found| Some((found, found.verdict.ok()?)));
    let Some((conclusion, azimuth)) = found else { return Vec::new() };
    let slow = conclusion.slow_motions(&session.setting, session.dwells());
    let motions = [TURNING, TILTING].into_iter().zip(slow);
    motions.filter_map(|(motion, slow)| Unseen::of(motion, slow, azimuth.sigma.0)).collect()
}

/// Slow motions of the base that a turning platform does not show.
pub fn of_platform(session: &rotating::Session) -> Vec<Unseen> {
    let found = session.conclusion().and_then(|found| Some((found, found.verdict.ok()?)));
    let Some((conclusion, azimuth)) = found else { return Vec::new() };
    let turn = conclusion.slow_turn(&session.setting, &session.turn_accumulator);
    Unseen::of(TURNING, turn, azimuth.sigma.0).into_iter().collect()
}

impl Unseen {
    /// Nothing where it hides in the azimuth's σ, rad.
    fn of(motion: Motion, slow: Option<SlowMotion>, sigma: f64) -> Option<Self> {
        let slow = slow?;
        let unseen = Self { motion, rate: STATED * slow.sigma.0, lever: slow.lever.0.abs() };
        (unseen.rate * unseen.lever > WORTH_STATING * sigma).then_some(unseen)
    }

    /// By how much it puts north off at the most, rad; infinite where the recording shows nothing of it.
    pub fn shift(&self) -> f64 {
        let shift = self.rate * self.lever;
        if shift < FRAC_PI_4 { shift } else { f64::INFINITY }
    }
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (name, unit, seconds, usual) = self.motion;
        let shift = self.shift().to_degrees();
        if shift.is_infinite() {
            let shift = significant(usual / seconds * self.lever);
            return write!(
                f,
                "no {name} of the base, which the recording does not show: by each {usual} {unit} north is {shift}° off"
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
