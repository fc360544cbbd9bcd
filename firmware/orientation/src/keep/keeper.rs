//! Gyrovertical and heading keeper as one: samples in, from switch-on; pitch, roll and azimuth out.

use super::heading::{Handover, Heading, Realigned, frame_rate};
use super::restart::{self, Doubt, Remembered};
use super::vertical::{Trust, Vertical};
use super::{Gyro, Setting, attitude};
use crate::signal::InertialSample;
use crate::units::Instant;
use crate::words;
use crate::words::Rounded;

pub use super::heading::Azimuth;

/// 1σ of an azimuth that points nowhere, rad: it is withdrawn.
const NOWHERE: f64 = 0.5;

/// How far the level can be trusted, and for how many seconds that has lasted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// The first forces have not come.
    Starting,
    /// Level, by gravity.
    Level,
    /// The body moves so that gravity tells hardly anything of the level, which the gyros alone carry on: its σ grows.
    Coasting {
        /// For how long, s.
        seconds: f64,
    },
    /// The body falls freely.
    FreeFall {
        /// For how long, s.
        seconds: f64,
    },
    /// There are no forces.
    NoForce {
        /// For how long, s.
        seconds: f64,
    },
    /// So much of the rotation was lost that the level must be found again.
    RotationLost {
        /// For how long, s.
        seconds: f64,
    },
}

words! { State:
    Self::Starting => "starting";
    Self::Level => "level";
    Self::Coasting { seconds } => "coasting for {} s: the gyros alone carry the level", Rounded::<1>(seconds);
    Self::FreeFall { seconds } => "falling freely for {} s", Rounded::<1>(seconds);
    Self::NoForce { seconds } => "without forces for {} s", Rounded::<1>(seconds);
    Self::RotationLost { seconds } => "finding the level again for {} s: rotation was lost", Rounded::<1>(seconds);
}

/// What is known now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// When the latest sample ended.
    pub time: Instant,
    /// Pitch, nose up positive, rad.
    pub pitch: f64,
    /// Roll, right side down positive, rad.
    pub roll: f64,
    /// 1σ of either, rad.
    pub level_sigma: f64,
    /// The azimuth; none before one was handed over, or where it was withdrawn.
    pub azimuth: Option<Azimuth>,
    /// From body axes to north, east, down (w, x, y, z); up to a constant heading where there is no azimuth.
    pub attitude: [f64; 4],
    /// How far the level can be trusted.
    pub state: State,
    /// Whether the body stands.
    pub is_at_rest: bool,
    /// Biases of the gyros forward, right, down, rad/s.
    pub biases: [f64; 3],
    /// Their 1σ, rad/s.
    pub bias_sigmas: [f64; 3],
    /// Whether a bias showed to be beyond five of the 1σ stated for it: nothing stated of the biases is believed then.
    pub is_bias_beyond_stated: bool,
    /// For how long the azimuth was kept, s; zero without.
    pub seconds: f64,
}

/// Keeps pitch, roll and azimuth.
#[derive(Clone, Debug)]
pub struct Keeper {
    setting: Setting,
    vertical: Vertical,
    heading: Option<Heading>,
    /// When the azimuth was handed over.
    handed: Instant,
    speed: Option<[f64; 2]>,
    trust: Trust,
    /// Since when it is so.
    since: Instant,
}

impl Keeper {
    /// Begins without an azimuth.
    #[must_use]
    pub fn new(setting: &Setting) -> Self {
        Self {
            setting: *setting,
            vertical: Vertical::new(setting),
            heading: None,
            handed: Instant::default(),
            speed: None,
            trust: Trust::Starting,
            since: Instant::default(),
        }
    }

    /// Takes a sample: every one, from switch-on, while the alignment runs as well.
    #[inline]
    pub fn push(&mut self, sample: &InertialSample) {
        if self.vertical.push(sample) {
            self.judge(sample.time);
        }
    }

    #[inline(never)]
    fn judge(&mut self, now: Instant) {
        if self.trust != self.vertical.trust() {
            self.trust = self.vertical.trust();
            self.since = now;
        }
        let is_nowhere = |heading: &Heading| heading.azimuth(&self.vertical).sigma > NOWHERE;
        // Looked at only where something was lost: the filter's σ grows slowly else.
        if self.trust == Trust::RotationLost && self.heading.as_ref().is_some_and(is_nowhere) {
            self.withdraw();
        }
    }

    /// There is no azimuth any more.
    fn withdraw(&mut self) {
        self.heading = None;
        self.vertical.lose_north(self.frame_rate());
    }

    /// From now on another gyro shows the axis down.
    pub fn exchange_down(&mut self, gyro: Gyro) {
        self.setting = self.setting.with_down(gyro);
        self.vertical.exchange_down(&self.setting);
    }

    /// Takes an azimuth of body x as it is now, in place of any before.
    pub fn hand_over(&mut self, handover: Handover) {
        let [.., gyro] = &self.setting.gyros;
        let is_first = self.heading.is_none();
        self.heading = Some(Heading::begin(handover, gyro, &mut self.vertical));
        self.handed = self.vertical.time();
        if is_first {
            self.vertical.find_north(self.frame_rate());
        } else {
            self.turn_frame();
        }
    }

    /// Weighs a new alignment with what was kept. Where they disagree, there is no azimuth any more.
    pub fn realign(&mut self, handover: Handover) -> Realigned {
        let [.., gyro] = &self.setting.gyros;
        let realigned = match &mut self.heading {
            None => Realigned::Taken,
            Some(heading) => heading.realign(handover, gyro, &mut self.vertical),
        };
        match realigned {
            Realigned::Taken => self.hand_over(handover),
            Realigned::Fused { .. } => self.turn_frame(),
            Realigned::Disagrees { .. } => self.withdraw(),
        }
        realigned
    }

    /// How fast the vehicle goes north and east, m/s, where that is known.
    pub fn move_at(&mut self, speed: Option<[f64; 2]>) {
        self.speed = speed;
        self.turn_frame();
    }

    /// Has the level frame turn as it does.
    fn turn_frame(&mut self) {
        self.vertical.turn_frame(self.frame_rate());
    }

    /// How the level frame turns, rad/s.
    fn frame_rate(&self) -> [f32; 3] {
        let north = self.heading.as_ref().map(Heading::frame);
        frame_rate(self.setting.latitude, north, self.speed)
    }

    /// What is known now.
    #[must_use]
    pub fn report(&self) -> Report {
        let vertical = &self.vertical;
        let azimuth = self.heading.as_ref().map(|heading| heading.azimuth(vertical));
        let [course, pitch, roll] = attitude::angles(vertical.attitude().parts());
        let course = azimuth.map_or(course, |azimuth| azimuth.angle);
        let time = vertical.time();
        let seconds = azimuth.map_or(0.0, |_| time.seconds() - self.handed.seconds());
        Report {
            time,
            pitch,
            roll,
            level_sigma: vertical.sigma().into(),
            azimuth,
            attitude: attitude::quaternion([course, pitch, roll]),
            state: self.state(time),
            is_at_rest: vertical.is_at_rest(),
            biases: vertical.biases().map(f64::from),
            bias_sigmas: vertical.bias_sigmas().map(f64::from),
            is_bias_beyond_stated: vertical.is_bias_beyond_stated(),
            seconds,
        }
    }

    fn state(&self, now: Instant) -> State {
        let seconds = now.seconds() - self.since.seconds();
        match self.trust {
            Trust::Starting => State::Starting,
            Trust::Level => State::Level,
            Trust::Coasting => State::Coasting { seconds },
            Trust::FreeFall => State::FreeFall { seconds },
            Trust::NoForce => State::NoForce { seconds },
            Trust::RotationLost => State::RotationLost { seconds },
        }
    }

    /// What is to be kept over a loss of supply: only at rest, and with an azimuth.
    #[must_use]
    pub fn remember(&self) -> Option<Remembered> {
        let report = self.report();
        let azimuth = report.azimuth.filter(|_| report.is_at_rest)?;
        Some(Remembered {
            azimuth: azimuth.angle,
            sigma: azimuth.sigma,
            pitch: report.pitch,
            roll: report.roll,
            rates: self.vertical.rest_rates()?,
            rest: f64::from(self.vertical.course().stood),
        })
    }

    /// Takes an azimuth from before a loss of supply, if the body has not moved since as far as can be told.
    ///
    /// # Errors
    /// Why it is not believed.
    pub fn recall(&mut self, remembered: &Remembered) -> Result<(), Doubt> {
        let report = self.report();
        let rates = self.vertical.rest_rates().filter(|_| report.is_at_rest);
        let rest = f64::from(self.vertical.course().stood);
        let now = restart::Now { pitch: report.pitch, roll: report.roll, rates, rest };
        restart::check(remembered, &now, &self.setting)?;
        self.hand_over(Handover { azimuth: remembered.azimuth, sigma: remembered.sigma });
        Ok(())
    }
}
