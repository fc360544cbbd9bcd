//! Procedure of a rotating platform's session, and the conditions that make one impossible.

use heapless::Vec;

use crate::alignment::period::PERIOD_TOLERANCE;
use crate::alignment::rotating::turn::SPEEDS;
use crate::alignment::setup::{LONGEST, PERIODS, SetupError, check_ranges};
use crate::math::Table;
use crate::units::{RadiansPerSecond, Seconds, TURN};

/// Fewest turns in each sense: a single one cannot be distinguished from a disturbed one.
const LEAST_TURNS: f64 = 2.0;
/// Default time in each sense for each speed, s.
const DEFAULT_SECONDS: f64 = 180.0;
/// Greatest time at the faster of two speeds over that at the slower one: the best time for speeds in
/// the ratio of two. The best time grows with the square of the ratio; with this one σ is at most 12 %
/// above that of a session as long with the best times.
const LONGEST_SHARE: f64 = 4.0;
/// Length of a block, s: the platform's rotation within it costs 1e-4 of the signal.
const BLOCK_SECONDS: f64 = 0.02;
/// Least rotation of the platform in a block, rad: a tenth of a degree, so that the encoder's steps
/// are small against it.
const BLOCK_ANGLE: f64 = 0.1 / 360.0 * TURN;

/// Procedure of a session on a rotating platform.
#[must_use]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Procedure {
    /// Speeds of the platform, > 0, one or two; none for a recording.
    pub speeds: Vec<RadiansPerSecond, SPEEDS>,
    /// Turns at constant rate in each sense at the slower speed, two at least; see
    /// [`Self::turns_at`].
    pub turns: u32,
    /// Rate-modulated turns before them; zero where the stored axis misalignments are used.
    pub modulated_turns: u32,
    /// Greatest amplitude of their modulation over the speed, 0 to 1.
    pub modulation: f64,
    /// Sample period.
    pub sample_seconds: Seconds,
    /// Tolerance of the time stamps' mean step against that period, relative.
    pub period_tolerance: f64,
    /// Length of the blocks to which samples are averaged.
    pub block_seconds: Seconds,
    /// Time for which the platform is levelled at rest.
    pub level_seconds: Seconds,
    /// Time that the platform needs to reach any speed.
    pub ramp_seconds: Seconds,
    /// Date with which an axis misalignment is stored, s since 1970; zero where it is unknown.
    pub date: u64,
}

impl Procedure {
    /// Procedure with a default number of turns: three minutes in each sense for each speed, and
    /// twelve turns rate-modulated by a quarter, or twice as many with two speeds, where a lag has
    /// more effect.
    pub fn new(speeds: &[RadiansPerSecond], sample_seconds: Seconds) -> Self {
        let slowest = speeds.iter().map(|speed| speed.0).fold(f64::INFINITY, f64::min);
        Self {
            speeds: speeds.iter().copied().take(SPEEDS).collect(),
            turns: default_turns(speeds, slowest),
            modulated_turns: if speeds.len() > 1 { 24 } else { 12 },
            modulation: 0.25,
            sample_seconds,
            period_tolerance: PERIOD_TOLERANCE,
            block_seconds: Seconds(BLOCK_SECONDS.max(BLOCK_ANGLE / slowest)),
            level_seconds: Seconds(2.0),
            ramp_seconds: Seconds(3.0),
            date: 0,
        }
    }

    /// Procedure for a recording with this sample period, whatever it contains.
    pub fn recorded(sample_seconds: Seconds) -> Self {
        Self { block_seconds: Seconds(BLOCK_SECONDS), ..Self::new(&[], sample_seconds) }
    }

    /// Turns at constant rate in each sense at a speed. Two speeds a < b give the azimuth as (b² B
    /// − a² A)/(b² − a²) of their individual results A and B: with times in proportion to these
    /// weights its noise is least, (b² + a²)/(b² − a²) of that of one speed without a g-sensitivity
    /// (MET 2018). The time at the faster speed is at most four times that at the slower
    /// one.
    #[must_use]
    pub fn turns_at(&self, index: usize) -> u32 {
        let slowest = self.speeds.iter().map(|speed| speed.0).fold(f64::INFINITY, f64::min);
        let faster = self.speeds.get(index).map_or(1.0, |speed| speed.0 / slowest);
        libm::round(f64::from(self.turns) * faster * time_share(faster)).min(1e6) as u32
    }

    /// Checks the procedure.
    ///
    /// # Errors
    /// [`SetupError::TableCorrupt`], [`SetupError::OutOfRange`], and [`SetupError::NoSpeed`] for a
    /// speed of zero, too few turns or no modulation.
    pub fn check(&self) -> Result<(), SetupError> {
        Table::built_in().verify().map_err(|_| SetupError::TableCorrupt)?;
        let time = [0.0, LONGEST];
        check_ranges(&[
            ("sample_seconds", self.sample_seconds.0, PERIODS),
            ("period_tolerance", self.period_tolerance, [0.0, 1.0]),
            ("block_seconds", self.block_seconds.0, time),
            ("level_seconds", self.level_seconds.0, time),
            ("ramp_seconds", self.ramp_seconds.0, time),
        ])?;
        let are_speeds = self.speeds.iter().all(|speed| speed.0 > 0.0 && speed.0.is_finite());
        let is_modulation_possible =
            self.modulated_turns == 0 || (self.modulation > 0.0 && self.modulation < 1.0);
        let has_turns = f64::from(self.turns) >= LEAST_TURNS;
        let is_possible = are_speeds && is_modulation_possible && has_turns;
        is_possible.then_some(()).ok_or(SetupError::NoSpeed)
    }

    /// Number of sample periods in a block.
    pub(super) fn periods(&self) -> u32 {
        libm::round(self.block_seconds.0 / self.sample_seconds.0).clamp(1.0, 1e6) as u32
    }

    /// Half width of the modulation's spectral line over its frequency: the modulation reverses its
    /// sign in the course of all rate-modulated turns.
    pub(super) fn modulation_width(&self) -> f64 {
        0.5 / f64::from(self.modulated_turns.max(1))
    }

    /// Commanded rate of the platform `time` s into the rate-modulated turns at a speed, rad/s;
    /// negative times are before they count. The platform was found to turn at `rate` and is
    /// modulated once per turn, where the relevant unevenness lies too, by a modulation that
    /// reverses its sign meanwhile. So a constant phasor, such as the Earth rate, is separated from
    /// it.
    pub(super) fn modulated_rate(&self, speed: f64, rate: f64, time: f64) -> f64 {
        let depth = self.modulation * libm::cos(self.modulation_width() * rate * time);
        speed * (1.0 + depth * libm::sin(rate * time))
    }
}

/// Time at a speed over that at the slowest, from the ratio of these speeds.
fn time_share(faster: f64) -> f64 {
    (faster * faster).min(LONGEST_SHARE)
}

/// Turns in each sense at the slowest of some speeds, rad/s, for the default time.
fn default_turns(speeds: &[RadiansPerSecond], slowest: f64) -> u32 {
    let shares: f64 = speeds.iter().map(|speed| time_share(speed.0 / slowest)).sum();
    let share = speeds.len() as f64 / shares;
    let turns = libm::ceil(DEFAULT_SECONDS * share * slowest / TURN);
    if turns > LEAST_TURNS { turns.min(1e6) as u32 } else { LEAST_TURNS as u32 }
}
