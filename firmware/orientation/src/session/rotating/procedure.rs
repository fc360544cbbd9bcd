//! How a turning platform's session goes about it, and what makes that impossible.

use heapless::Vec;

use crate::align::etalon::Table;
use crate::align::rotating::solution::SPEEDS;
use crate::session::procedure::ProcedureError;
use crate::units::TURN;

/// Least turns in either sense: one alone cannot be told from a disturbed one.
const LEAST_TURNS: f64 = 2.0;
/// Default time in either sense for each speed, s.
const DEFAULT_SECONDS: f64 = 180.0;
/// Length of a block: what the platform turns meanwhile costs 1e-4 of the signal.
const BLOCK_SECONDS: f64 = 0.02;
/// The least that the platform turns in a block, rad: a tenth of a degree, so that the encoder's steps
/// are small.
const BLOCK_ANGLE: f64 = 0.1 / 360.0 * TURN;

/// How the session goes about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Procedure {
    /// Speeds, rad/s, > 0, one or two.
    pub speeds: Vec<f64, SPEEDS>,
    /// Even turns in either sense at the slower speed, two at least; see [`Self::turns_at`].
    pub turns: u32,
    /// Turns that are uneven on purpose before them; zero where the stored couplings are to do.
    pub uneven_turns: u32,
    /// Greatest amplitude of their modulation over the speed.
    pub modulation: f64,
    /// Sample period, s.
    pub sample_seconds: f64,
    /// Length of the blocks to which samples are averaged, s.
    pub block_seconds: f64,
    /// How long the platform is levelled at rest, s.
    pub level_seconds: f64,
    /// How long the platform needs to take on any speed, s.
    pub ramp_seconds: f64,
    /// Date, s since 1970, with which a coupling is stored; zero where nobody knows.
    pub date: u64,
}

impl Procedure {
    /// Speeds with a default number of turns: three minutes in either sense for each, twelve uneven turns
    /// modulated by a quarter, and twice as many where a lag counts for more.
    #[must_use]
    pub fn new(speeds: &[f64], sample_seconds: f64) -> Self {
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        Self {
            speeds: speeds.iter().copied().take(SPEEDS).collect(),
            turns: default_turns(speeds, slowest),
            uneven_turns: if speeds.len() > 1 { 24 } else { 12 },
            modulation: 0.25,
            sample_seconds,
            block_seconds: BLOCK_SECONDS.max(BLOCK_ANGLE / slowest),
            level_seconds: 2.0,
            ramp_seconds: 3.0,
            date: 0,
        }
    }

    /// Whatever a recording with this sample period shows.
    #[must_use]
    pub fn recorded(sample_seconds: f64) -> Self {
        Self { block_seconds: BLOCK_SECONDS, ..Self::new(&[], sample_seconds) }
    }

    /// Even turns in either sense at a speed. Two speeds a < b give the azimuth as
    /// (b² B − a² A)/(b² − a²) of what either says: with times as these weights its noise is least, (b² +
    /// a²)/(b² − a²) of what one speed would have without a g-sensitivity.
    #[must_use]
    pub fn turns_at(&self, index: usize) -> u32 {
        let slowest = self.speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let faster = self.speeds.get(index).map_or(1.0, |speed| speed / slowest);
        libm::round(f64::from(self.turns) * faster * faster * faster).min(1e6) as u32
    }

    /// Sample periods in a block.
    pub(super) fn periods(&self) -> u32 {
        libm::round(self.block_seconds / self.sample_seconds).clamp(1.0, 1e6) as u32
    }

    /// Half the width of the modulation's line over its frequency: it turns into its opposite in all of the
    /// uneven turns.
    pub(super) fn modulation_width(&self) -> f64 {
        0.5 / f64::from(self.uneven_turns.max(1))
    }

    /// Rate of the platform `time` s into the uneven turns at a speed, also before they count, rad/s: of a
    /// platform that was found to turn by `rate`, modulated once per turn, where the unevenness that counts
    /// lies too, by a modulation that turns into its opposite meanwhile. What stays the same, as the Earth
    /// rate does, is told apart from it.
    pub(super) fn uneven_rate(&self, speed: f64, rate: f64, time: f64) -> f64 {
        let depth = self.modulation * libm::cos(self.modulation_width() * rate * time);
        speed * (1.0 + depth * libm::sin(rate * time))
    }
}

/// Turns in either sense at the slowest of some speeds, for the default time.
fn default_turns(speeds: &[f64], slowest: f64) -> u32 {
    let squares: f64 = speeds.iter().map(|speed| speed * speed).sum();
    let share = speeds.len() as f64 * slowest * slowest / squares;
    let turns = libm::ceil(DEFAULT_SECONDS * share * slowest / TURN);
    if turns > LEAST_TURNS { turns.min(1e6) as u32 } else { LEAST_TURNS as u32 }
}

/// What a procedure must be.
///
/// # Errors
/// [`ProcedureError::TableCorrupt`], and [`ProcedureError::NoSpeed`] for a speed that is none, too few turns or no
/// modulation.
pub fn check(procedure: &Procedure) -> Result<(), ProcedureError> {
    Table::built_in().verify().map_err(|_| ProcedureError::TableCorrupt)?;
    let are_speeds = procedure.speeds.iter().all(|speed| *speed > 0.0 && speed.is_finite());
    let is_uneven =
        procedure.uneven_turns == 0 || (procedure.modulation > 0.0 && procedure.modulation < 1.0);
    let has_turns = f64::from(procedure.turns) >= LEAST_TURNS;
    let has_period = procedure.sample_seconds > 0.0 && procedure.sample_seconds.is_finite();
    if are_speeds && is_uneven && has_turns && has_period {
        Ok(())
    } else {
        Err(ProcedureError::NoSpeed)
    }
}
