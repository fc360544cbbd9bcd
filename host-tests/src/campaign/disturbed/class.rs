//! A class of faults, and what is spoilt by it: a drawn unit whose recording is aligned with the fault and without.

use std::fmt;

use orientation::alignment::Verdict;
use serde::Serialize;

use crate::assumptions::unseen::Unseen;
use crate::campaign::chance::Chance;
use crate::campaign::faults::WRONG_SIGMAS;
use crate::campaign::statistics::Answer;
use crate::output::azimuth_error;

/// How many times the σ of the healthy run an answer may have that is as good.
const GREATEST_SIGMA: f64 = 3.0;

/// What one recording gave.
#[derive(Clone, Debug)]
pub struct Aligned {
    /// The answer, or why there is none.
    pub answer: Result<Answer, String>,
    /// Error when nothing is checked, °; none where even that has no answer.
    pub unchecked_deg: Option<f64>,
    /// By how much a slow motion of the base may put the answer off unseen, as is stated beside it, °.
    pub unseen_deg: f64,
}

impl Aligned {
    /// A recording that was not even begun.
    pub(super) fn refused(reason: impl fmt::Display) -> Self {
        Self { answer: Err(reason.to_string()), unchecked_deg: None, unseen_deg: 0.0 }
    }

    /// A session's verdict, if it came to its end, the azimuth when nothing is checked, °, and the slow motions of the
    /// base that it cannot see.
    pub(super) fn of(
        verdict: Option<Verdict>,
        unchecked_deg: Option<f64>,
        unseen: &[Unseen],
        truth_deg: f64,
    ) -> Self {
        let answer =
            |verdict| Answer::of(verdict, truth_deg).map_err(|refusal| refusal.to_string());
        let unended = || Err("the session did not end".to_owned());
        let shifts = unseen.iter().map(|unseen| unseen.shift().to_degrees());
        Self {
            answer: verdict.map_or_else(unended, answer),
            unchecked_deg: unchecked_deg.map(|azimuth| azimuth_error(azimuth, truth_deg)),
            unseen_deg: shifts.fold(0.0, f64::max),
        }
    }
}

/// A drawn unit, which a fault may spoil.
pub(super) trait Subject: Clone + 'static {
    /// What the names of its classes begin with.
    const NAME: &'static str;
    /// The random stream of its faults: none of those that a world draws from.
    const FAULT: u64;

    /// A healthy one; what is stated about it is true.
    fn drawn(seed: u64) -> Self;
    /// The seed from which it is drawn.
    fn seed(&self) -> u64;
    /// What its recording gives.
    fn align(&self) -> Aligned;

    /// Whether σ rests on few residuals.
    fn is_few(&self) -> bool {
        false
    }

    /// A fault of such units, between two severities of a unit.
    fn fault(
        name: &str,
        fault: impl Into<String>,
        severity: [f64; 2],
        unit: impl Into<String>,
    ) -> Fault {
        let name = format!("{}{name}", Self::NAME);
        Fault { name, fault: fault.into(), severity, unit: unit.into() }
    }

    /// The class in which a fault spoils drawn units so by a severity.
    fn spoilt(
        name: &str,
        fault: &str,
        severity: [f64; 2],
        unit: &str,
        spoil: fn(&mut Self, &mut Chance, f64),
    ) -> Class {
        Self::fault(name, fault, severity, unit).spoils(Self::drawn, spoil)
    }

    /// This unit with a fault and without.
    fn pair(&self, spoil: impl FnOnce(&mut Self, &mut Chance)) -> Pair {
        let mut spoilt = self.clone();
        spoil(&mut spoilt, &mut Chance::new(self.seed(), Self::FAULT));
        Pair { healthy: self.align().answer, faulty: spoilt.align(), is_few: self.is_few() }
    }
}

/// One run, with its fault and without.
#[derive(Clone, Debug)]
pub struct Pair {
    /// What the healthy recording gave, or why it gave nothing.
    pub healthy: Result<Answer, String>,
    /// What the recording with the fault gave.
    pub faulty: Aligned,
    /// Whether σ rests on few residuals.
    pub is_few: bool,
}

impl Pair {
    /// A fault that contradicts whatever moves: an answer that comes near the true one is luck.
    pub(super) fn never_harmless(self) -> Self {
        Self { faulty: Aligned { unchecked_deg: None, ..self.faulty }, ..self }
    }

    /// Whether the fault moves the answer by less than the healthy run's σ.
    pub(super) fn is_harmless(&self) -> bool {
        let (Ok(healthy), Some(unchecked)) = (&self.healthy, self.faulty.unchecked_deg) else {
            return false;
        };
        (unchecked - healthy.error).abs() <= healthy.sigma
    }

    /// Error of the fault's answer in its own σ; infinite where either is no number.
    pub(super) fn sigmas(&self) -> Option<f64> {
        let answer = self.faulty.answer.as_ref().ok()?;
        let sigmas = (answer.error / answer.sigma).abs();
        Some(if sigmas.is_nan() { f64::INFINITY } else { sigmas })
    }

    /// Whether the fault's answer is wrong, and by how much it may be is stated beside it.
    pub(super) fn is_reported(&self) -> bool {
        let is_within = |answer: &Answer| answer.error.abs() <= self.faulty.unseen_deg;
        self.is_wrong() && self.faulty.answer.as_ref().is_ok_and(is_within)
    }

    /// Whether the fault's answer is beyond [`WRONG_SIGMAS`].
    pub(super) fn is_wrong(&self) -> bool {
        self.sigmas().is_some_and(|sigmas| sigmas > WRONG_SIGMAS)
    }

    /// Whether the fault does no harm, and yet its run was not answered about as well as the healthy one.
    pub(super) fn is_lost(&self) -> bool {
        let is_answered_well = match (&self.healthy, &self.faulty.answer) {
            (Ok(healthy), Ok(faulty)) => faulty.sigma <= GREATEST_SIGMA * healthy.sigma,
            _ => false,
        };
        self.is_harmless() && !is_answered_well
    }
}

/// What happens in a class, in words and numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Fault {
    /// The class's name on the command line.
    #[serde(rename = "class")]
    pub name: String,
    /// What the fault is, in words.
    pub fault: String,
    /// From harmless to gross; severities are drawn evenly in their logarithm.
    pub severity: [f64; 2],
    /// Unit of the severity.
    pub unit: String,
}

/// A fault of any severity.
pub struct Class {
    /// The fault as it is named and described.
    pub fault: Fault,
    /// Part of the answers that may be wrong; zero but where the data cannot show it.
    pub wrong_allowed: f64,
    /// The run of a seed and a severity.
    pub(super) draw: Box<dyn Fn(u64, f64) -> Pair + Send + Sync>,
}

impl Fault {
    /// The class whose runs are drawn so from a seed and a severity.
    pub(super) fn drawn(self, draw: impl Fn(u64, f64) -> Pair + Send + Sync + 'static) -> Class {
        Class { fault: self, wrong_allowed: 0.0, draw: Box::new(draw) }
    }

    /// The class in which drawn units are spoilt so by a severity.
    pub(super) fn spoils<S: Subject>(
        self,
        unit: fn(u64) -> S,
        spoil: fn(&mut S, &mut Chance, f64),
    ) -> Class {
        self.drawn(move |seed, size| unit(seed).pair(|unit, chance| spoil(unit, chance, size)))
    }
}
