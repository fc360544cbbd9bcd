//! How a simulated run goes on after its alignment: what the vehicle does, what it is given.

use core::cell::Cell;

use embassy_time::Instant;
use orientation::alignment::Azimuth;
use orientation::attitude as keep;
use orientation::navigation::{Policy, Realignment};
use orientation::signal::sway::WATCH_UNTIL;
use orientation::units::{Radians, Seconds};

use firmware::ports::Aiding;

/// From power-on to the first position, and from the last one until the vehicle sets off, s: enough for any schedule, with
/// dwells that are measured again.
const STANDING_SECONDS: f32 = 50.0;
/// Duration of a stop at which nothing is done, s.
pub const STOP_SECONDS: f64 = 60.0;
/// How long a vehicle stands before it is aligned anew by a mechanism, s.
pub(super) const STAND_SECONDS: f64 = 30.0;
/// From the begin of a stop until another alignment begins, for which the base's sway is observed first, and from its
/// end until the vehicle sets off, s.
const BEFORE_ANOTHER_SECONDS: f64 = STAND_SECONDS + WATCH_UNTIL as f64 + 20.0;

/// How a run goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// For how long, s; zero for not at all.
    pub seconds: f64,
    /// Whether it is aligned anew at stops.
    pub realigns: bool,
    /// From power-on to the first position, and from the last one until the vehicle sets off, s; of a base on which an
    /// alignment takes about as long as its schedule.
    pub standing_s: f32,
    /// Duration of a drive after the alignment, s.
    pub drive_s: f64,
    /// Duration of a stop after the alignment, s; as long as it needs where nothing is stated.
    pub stop_s: Option<f64>,
    /// An azimuth that is handed over from outside, with its 1σ, °, and when, s.
    pub handover: Option<([f64; 2], f64)>,
}

impl Default for Hold {
    /// Not at all; else drives of four minutes, and stops of one or as long as another alignment takes.
    fn default() -> Self {
        Self {
            seconds: 0.0,
            realigns: false,
            standing_s: STANDING_SECONDS,
            drive_s: 240.0,
            stop_s: None,
            handover: None,
        }
    }
}

impl Hold {
    /// The default for so many seconds.
    #[must_use]
    pub fn of(seconds: f64) -> Self {
        Self { seconds, ..Self::default() }
    }

    /// Duration of a stop after an alignment of so many seconds, s: long enough for another one where
    /// the instrument aligns anew at stops by a mechanism.
    #[must_use]
    pub fn stop_seconds(&self, alignment_s: f64) -> f64 {
        let another = BEFORE_ANOTHER_SECONDS + alignment_s;
        self.stop_s.unwrap_or(if self.realigns { another } else { STOP_SECONDS })
    }

    /// What the instrument is given, with what realigns it where it may, and the gyros about down: beside
    /// the two others, and the precise one.
    pub(super) fn policy(
        &self,
        realignment: Realignment,
        beside: keep::Gyro,
        precise: keep::Gyro,
    ) -> Policy {
        Policy {
            hold_seconds: Seconds(self.seconds),
            knows_stops: realignment == Realignment::BetweenStops,
            realignment: if self.realigns { realignment } else { Realignment::Never },
            skips_known: self.handover.is_some(),
            beside,
            precise,
        }
    }

    /// Aiding that hands over the azimuth of the scenario.
    #[must_use]
    pub fn aiding(&self) -> HandoverAiding {
        HandoverAiding { pending: Cell::new(self.handover) }
    }
}

/// Hands over one azimuth at its time.
#[derive(Debug)]
pub struct HandoverAiding {
    pending: Cell<Option<([f64; 2], f64)>>,
}

impl Aiding for HandoverAiding {
    fn azimuth(&self) -> Option<Azimuth> {
        let ([azimuth, sigma], at_s) = self.pending.get()?;
        if Instant::now().as_micros() as f64 * 1e-6 < at_s {
            return None;
        }
        self.pending.set(None);
        Some(Azimuth { angle: Radians::from_degrees(azimuth), sigma: Radians::from_degrees(sigma) })
    }
}
