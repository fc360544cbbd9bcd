//! The instrument's attitude and state at a moment: all that is sent is made of this.

use core::f64::consts::{FRAC_PI_2, PI};

use orientation::alignment::Azimuth;
use orientation::device::Device;
use orientation::roll::Condition;
use orientation::units::{Instant, Radians, RadiansPerSecond, Seconds};
use orientation::words;

/// What the instrument is doing, and how far its azimuth may be relied upon.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum State {
    /// No azimuth, and none is being determined: an alignment has yet to be ordered.
    #[default]
    Waiting,
    /// No azimuth yet: it is being determined.
    Aligning,
    /// The azimuth is known within the σ that is required.
    Ready,
    /// There is an azimuth that is to be used with care, for this reason.
    Degraded(Degradation),
    /// No azimuth: the last alignment was refused, or the azimuth was lost, or a device was given up.
    Failed,
}

/// Why an azimuth is to be used with care. The first that holds is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Degradation {
    /// It is that from before the last loss of supply: the body may have been turned meanwhile.
    Recalled,
    /// The gyros alone carry the level, or the roll.
    Coasting,
    /// Its σ exceeds that which is required, or the level is being found again.
    Uncertain,
    /// It is that of the end of the alignment: nothing has measured since whether the body has turned.
    Unwatched,
}

words! { Degradation:
    Self::Recalled => "recalled";
    Self::Coasting => "coasting";
    Self::Uncertain => "uncertain";
    Self::Unwatched => "unwatched";
}

words! { State:
    Self::Waiting => "waiting";
    Self::Aligning => "aligning";
    Self::Ready => "ready";
    Self::Degraded(_) => "degraded";
    Self::Failed => "failed";
}

/// Where an azimuth comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Origin {
    /// The instrument's own gyros.
    #[default]
    Gyros,
    /// An operator or another instrument.
    Outside,
    /// The gyros of a simulated world.
    Simulation,
}

/// Pitch and roll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Pitch, nose up positive.
    pub pitch: Radians,
    /// Roll, right side down positive.
    pub roll: Radians,
    /// Standard deviation of each, 1σ.
    pub sigma: Radians,
}

impl Level {
    /// Whether pitch is within a quarter and roll within half of a turn, and σ finite and not below zero.
    #[must_use]
    pub fn is_possible(&self) -> bool {
        let Self { pitch, roll, sigma } = self;
        pitch.0.abs() <= FRAC_PI_2 && roll.0.abs() <= PI && sigma.0.is_finite() && sigma.0 >= 0.0
    }
}

/// Roll of a spinning body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roll {
    /// Roll and its standard deviation, 1σ; [`None`] while it is unknown.
    pub angle: Option<[Radians; 2]>,
    /// What it rests on.
    pub condition: Condition,
}

impl Roll {
    /// Roll and 1σ where they are possible ones: finite, and σ not below zero.
    #[must_use]
    pub fn usable_angle(&self) -> Option<[Radians; 2]> {
        self.angle
            .filter(|[angle, sigma]| angle.0.is_finite() && (0.0..f64::INFINITY).contains(&sigma.0))
    }
}

/// The instrument's attitude and state at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The moment, since the start of the instrument.
    pub time: Instant,
    /// What the instrument is doing.
    pub state: State,
    /// Azimuth of body x; [`None`] while it is unknown.
    pub azimuth: Option<Azimuth>,
    /// Where the azimuth comes from.
    pub origin: Origin,
    /// Pitch and roll; [`None`] while they are unknown.
    pub level: Option<Level>,
    /// Roll of a spinning body; [`None`] on any other carrier.
    pub spin: Option<Roll>,
    /// Rate of the azimuth, clockwise positive, which needs no azimuth; [`None`] while it is unknown.
    pub rate_of_turn: Option<RadiansPerSecond>,
    /// Rates of the body about its axes forward, right, down; [`None`] while they are unknown.
    pub rates: Option<[RadiansPerSecond; 3]>,
    /// How often the azimuth has been set anew rather than carried on; it begins anew after 255.
    pub resets: u8,
    /// Readings that failed since the start.
    pub faults: u32,
    /// Devices that have failed and are not restored.
    pub failed: Devices,
    /// Time since the end of the alignment that the azimuth is of; [`None`] without an azimuth.
    pub since_alignment: Option<Seconds>,
    /// Completed and planned dwells or turns of the alignment that runs.
    pub progress: Option<[u16; 2]>,
}

impl Report {
    /// The azimuth where it may be used without care: the state is [`State::Ready`] and the numbers are possible ones.
    #[must_use]
    pub fn valid_azimuth(&self) -> Option<Azimuth> {
        self.usable_azimuth().filter(|_| self.state == State::Ready)
    }

    /// The azimuth where it may be used, if with care.
    #[must_use]
    pub fn usable_azimuth(&self) -> Option<Azimuth> {
        let is_usable = matches!(self.state, State::Ready | State::Degraded(_));
        self.azimuth.filter(|azimuth| is_usable && azimuth.is_possible())
    }

    /// Pitch and roll where they are possible ones.
    #[must_use]
    pub fn usable_level(&self) -> Option<Level> {
        self.level.filter(Level::is_possible)
    }
}

/// A set of devices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Devices(u16);

impl Devices {
    /// Adds a device.
    pub fn insert(&mut self, device: Device) {
        self.0 |= 1 << device as u16;
    }

    /// Removes a device.
    pub fn remove(&mut self, device: Device) {
        self.0 &= !(1 << device as u16);
    }

    /// Whether it contains a device.
    #[must_use]
    pub const fn contains(self, device: Device) -> bool {
        self.0 & 1 << device as u16 != 0
    }

    /// Whether it contains any of these devices.
    #[must_use]
    pub fn contains_any(self, devices: &[Device]) -> bool {
        devices.iter().any(|device| self.contains(*device))
    }
}
