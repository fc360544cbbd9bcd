//! How a simulated run goes on after its alignment: what the vehicle does, what it is told.

use core::cell::Cell;

use embassy_time::{Duration, Instant};
use orientation::keep::{self, Handover};
use orientation::units::{DEGREE, DEGREE_PER_HOUR};

use super::scenario::{self, Scenario};
use crate::configuration::{Alignment, KeepConfiguration, Realignment};
use crate::ports::Outside;

/// How long a vehicle stands before it is aligned anew on a stage, s.
const STAND_SECONDS: u64 = 30;

/// How a run goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// For how long, s; zero for not at all.
    pub seconds: f64,
    /// Whether it is aligned anew at stops.
    pub realigns: bool,
    /// Length of a drive and of a stop, s.
    pub drive_s: f64,
    /// The same of a stop.
    pub stop_s: f64,
    /// An azimuth that is handed over from outside, with its 1σ, °, and when, s.
    pub handover: Option<([f64; 2], f64)>,
}

impl Default for Hold {
    /// Not at all; else drives of two minutes and stops of one.
    fn default() -> Self {
        Self { seconds: 0.0, realigns: false, drive_s: 120.0, stop_s: 60.0, handover: None }
    }
}

impl Hold {
    /// The default for so many seconds.
    #[must_use]
    pub fn of(seconds: f64) -> Self {
        Self { seconds, ..Self::default() }
    }

    /// What the instrument is told, with what realigns it where it may, and the gyros about down: beside
    /// the two others, and the precise one.
    pub(super) fn configuration(
        &self,
        realignment: Realignment,
        beside: keep::Gyro,
        precise: keep::Gyro,
    ) -> KeepConfiguration {
        let is_told = self.handover.is_some();
        KeepConfiguration {
            hold: Duration::from_micros((self.seconds * 1e6) as u64),
            realignment: if self.realigns { realignment } else { Realignment::Never },
            alignment: if is_told { Alignment::UnlessKnown } else { Alignment::Always },
            beside,
            precise,
        }
    }

    /// The same on a stage or two frames, which are aligned anew where the vehicle stands.
    pub(super) fn on_base(&self, beside: keep::Gyro, precise: keep::Gyro) -> KeepConfiguration {
        let after = Duration::from_secs(STAND_SECONDS);
        self.configuration(Realignment::AtStops { after }, beside, precise)
    }

    /// Who tells the board what it cannot measure.
    #[must_use]
    pub fn outside(&self) -> Teller {
        Teller { told: Cell::new(self.handover) }
    }
}

/// Tells one azimuth, once it is time.
#[derive(Debug)]
pub struct Teller {
    told: Cell<Option<([f64; 2], f64)>>,
}

impl Outside for Teller {
    fn azimuth(&mut self) -> Option<Handover> {
        let ([azimuth, sigma], at_s) = self.told.get()?;
        if Instant::now().as_micros() as f64 * 1e-6 < at_s {
            return None;
        }
        self.told.set(None);
        Some(Handover { azimuth: azimuth * DEGREE, sigma: sigma * DEGREE })
    }

    fn velocity(&mut self) -> Option<[f64; 2]> {
        None
    }
}

impl Scenario {
    /// What the board is told of its precise gyro.
    #[must_use]
    pub fn precise(&self) -> keep::Gyro {
        keep::Gyro {
            noise: self.gyro.noise(),
            bias_sigma: self.gyro.bias_sigma_deg_h * DEGREE_PER_HOUR,
            scale_sigma: scenario::SCALE_SIGMA,
        }
    }
}
